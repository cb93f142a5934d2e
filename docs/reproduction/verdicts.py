#!/usr/bin/python3
"""The table of docs/cases/point-load-verdict.md: eight models of stress beside Roul's packings under a point load.

    docs/reproduction/verdicts.py             prints it
    docs/reproduction/verdicts.py --write     puts it into the page

Reads the records of runs/verdict.txt. A cell is the misfit; n marks the nearest model of a packing, s one that its grains
support.
"""
import argparse
import json
import pathlib
import sys

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE))
sys.path.insert(0, str(HERE / "runs"))

from record import write_file  # noqa: E402
from tables import put, table  # noqa: E402

PAGE = HERE.parent / "cases/point-load-verdict.md"
RECORDS = HERE / "states/verdict"
PACKINGS = {"mono": "lattice", "mono_3": "lattice, 3 N", "friction_03": "shifted, μ = 0.3", "friction_06": "0.6",
            "friction_09": "0.9", "bidisperse": "two sizes", "pentagons": "pentagons", "polydisperse": "many sizes",
            "rough": "on fixed grains"}
MODELS = {"orthotropic_half_plane": "orthotropic half plane (2)",
          "orthotropic_layer_rough": "orthotropic layer, rough base (3)",
          "layer_rough": "isotropic layer, rough base (1)",
          "orthotropic_layer_smooth": "orthotropic layer, smooth base (2)",
          "layer_smooth": "isotropic layer, smooth base (0)",
          "flamant": "isotropic half plane (0)",
          "osl_layer_absorbing": "OSL layer, absorbing base (3)",
          "osl_layer_reflecting": "OSL layer, reflecting base (3)"}
HEAD = "| model (free numbers) | " + " | ".join(PACKINGS.values()) + " |"


def plain(value):
    """Three figures, none of them a power of ten."""
    return f"{value:.0f}" if value >= 100 else f"{value:#.3g}"


def misfit(found, model):
    marks = []
    if found["verdict.best_model"] == model:
        marks.append("n")
    if found[f"fit.{model}.supported"] == "yes":
        marks.append("s")
    return " ".join([plain(found[f"fit.{model}.chi2_per_dof"]), ", ".join(marks)]).strip()


def constant(found, key, digits=2):
    value, error = found[key], found[f"{key}.error"]
    if not isinstance(error, (int, float)):  # it ends at its bound
        return f"{value:.{digits}f}".replace("-", "−")
    while digits < 6 and error < 1.5 * 10**-digits:
        digits += 1
    return f"{value:.{digits}f} ± {error:.{digits}f}".replace("-", "−")


def made(found):
    """The table of {packing: summary}."""
    def row(words, cell):
        return [words, *(cell(found[packing]) for packing in PACKINGS)]

    rows = [row(words, lambda one, model=model: misfit(one, model)) for model, words in MODELS.items()]
    rows.append(row("chance of the nearest", lambda one: plain(one[f"fit.{one['verdict.best_model']}.chi2_chance"])))
    rows.append(row("ν of the isotropic rough layer", lambda one: constant(one, "fit.layer_rough.nu")))
    rows.append(row("$\\rho = r/\\sqrt t$, half plane", lambda one: constant(one, "fit.orthotropic_half_plane.rho")))
    return [table(HEAD, rows)]


def records():
    return {packing: json.loads((RECORDS / f"{packing}.json").read_text())["summary"] for packing in PACKINGS}


def main(words=None):
    options = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    options.add_argument("--write", action="store_true", help="put it into the page")
    tables = made(records())
    if options.parse_args(words).write:
        write_file(PAGE, put(PAGE.read_text(), tables, PAGE).encode())
    else:
        print("\n".join(tables), end="")
    return 0


if __name__ == "__main__":
    sys.exit(main())

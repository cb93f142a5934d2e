#!/usr/bin/python3
"""Makes docs/reproduction.md, the sources' figures beside ours.

    docs/reproduction/page.py                  writes the page
    docs/reproduction/page.py --check          says whether the page is what it would write
    docs/reproduction/page.py --add RUN ...    takes finished runs in first: their summaries, profiles
                                               and pictures go to docs/reproduction/results/

The sources' figures are in figures/*.toml; how ours are read and judged is in rows.py. Ends with 0, with 1
where --check finds another page, with 2 where it cannot. Needs Python 3.11 and nothing else.
"""
from __future__ import annotations

import argparse
import math
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))

from record import record_run, write_file  # noqa: E402
from rows import NOT_RUN, TOO_WIDE, Row, all_rows, judged, read_toml, with_unit  # noqa: E402
from summaries import Refused, Results  # noqa: E402

HERE = pathlib.Path(__file__).resolve().parent
PAGE = HERE.parent / "reproduction.md"
NO_COMMAND = "run before commands were stored: see the case's page"


def number(results: Results, study: str, key: str, form: str) -> str:
    """A number of a summary; empty where there is none."""
    value = results.plain(study, key)
    return "" if value is None or math.isnan(value) else format(value, form)


def grains_of(results: Results, study: str) -> float | None:
    """Of a run, or of all members of a sweep where they have the same number."""
    own = results.plain(study, "dem.grains")
    if own is not None:
        return own
    of_members = {value for key, value in results.all[study].items() if key.startswith("dem.grains.least.")}
    return of_members.pop() if len(of_members) == 1 else None


def study_cell(results: Results, study: str) -> str:
    """`box-shear`, or of a quick run `box-shear` (quick, 200 grains)."""
    if " --quick" not in (results.text(study, "case.command") or ""):
        return f"`{study}`"
    grains = grains_of(results, study)
    return f"`{study}` (quick" + ("" if grains is None else f", {grains:.0f} grains") + ")"


def grain_seconds(results: Results, study: str) -> str:
    """What the grains took: CPU time where every start was counted."""
    cpu = number(results, study, "time.dem_cpu_s", ".0f")
    if cpu:
        return cpu + " CPU"
    wall = results.plain(study, "time.dem_s")
    if wall is None or math.isnan(wall):
        return ""
    return "taken up again, not counted" if wall < 1 else f"{wall:.0f} wall"


def figure_line(row: Row, results: Results) -> str:
    ours, said = judged(row, results)
    study, lacking = row["study"], said == ""
    realizations = "" if lacking else number(results, study, "ensemble.realizations", "g")
    cells = [row["source"], row["what"], with_unit(row["theirs"], row), ours, said, realizations,
             study_cell(results, study)]
    return "| " + " | ".join(cells) + " |\n"


def dips(results: Results) -> str:
    """All ensembles' dips, also those that the sources do not have."""
    found = results.dips()
    if not found:
        return ""
    out = (
        "\n## Dips and peaks of all pours\n\n"
        "Mean base pressure beside the apex minus that under it, over ρ g h of each pile; p: chance of so "
        "large a difference either way if there were none (Student's t over realizations), and the same "
        f"corrected for all {len(found)} pours of this table (Holm). The last column counts. Ensembles of "
        "which only the states are kept are not in it ([which they are](reproduction/results/README.md)).\n\n"
        "| study | realizations | shoulder − centre (ρgh) | p | p (Holm) | at 5 % |\n"
        "|---|---|---|---|---|---|\n")
    for dip in found:
        realizations = number(results, dip.study, "ensemble.realizations", "g")
        out += (f"| `{dip.study}` | {realizations} | {dip.difference.value:.3f} ± {dip.difference.error:.3f} "
                f"| {dip.p:.2g} | {dip.p_holm:.2g} | {dip.word} |\n")
    return out


def verdicts(results: Results, studies: list[str]) -> str:
    """What the studies themselves conclude."""
    lines = ""
    for study in studies:
        sentence = results.text(study, "verdict.sentence")
        if sentence and (study.startswith("fit-") or results.text(study, "dip.verdict")):
            lines += f"- `{study}`: {sentence}\n"
    if not lines:
        return ""
    return (
        "\n## Which theory the grains support\n\n"
        "As each study said when it was run, by itself and by the rules of its version. Where no model "
        "agrees, \"supported\" meant the nearest of those asked.\n\n"
        + lines +
        "\nLayers under a point load: [verdict over all packings](cases/point-load-verdict.md); lattice "
        "piles: [Liffman](cases/liffman-lattice.md).\n")


def profiles_and_maps(results: Results, studies: list[str]) -> str:
    """Links to the profiles and the pictures themselves, of the studies that have them."""
    out = ""
    for study in studies:
        links = pictures = ""
        for file in results.beside(study):
            path = f"reproduction/results/{file}"
            if file.endswith(".md"):
                links += f" ([profiles as tables]({path}))"
            elif file.endswith((".svg", ".png")):
                pictures += f"![{file[len(study) + 1 : file.rindex('.')]}]({path})\n"
        if pictures:
            out += f"`{study}`{links}:\n\n{pictures}\n"
    if not out:
        return ""
    return ("\n## Base pressure and volume fraction\n\n"
            "To be laid beside Roul 3.3 and 3.4: mean over the piles with standard errors, the pressure in "
            "units of each pile's own ρ g h.\n\n" + out)


def how_run(results: Results, studies: list[str]) -> str:
    out = (
        "\n## How they were run\n\n"
        "Grain-steps count every grain, asleep or not. Roul's interval was 0.1 s, his time step 2e-6 s. "
        "`pile-line-source` and `pile-asymmetric-line` were poured with today's default of sleeping: "
        "sleepers hide at most 1 % of their load. That [gains nothing](benchmarks.md) on piles of hundreds "
        "and 6 times on a heap of 6,500. `pile-point-source`, `pile-elliptic` and `pile-asymmetric-point` "
        "were poured with the earlier default, whose sleepers hid up to about 20 %; so were the piles that "
        "`pile-fields-line` took. The case `liffman-dropped` sets its own limit, 5 %. With the earlier "
        "default small piles came out denser than with all grains awake, by 0.3 % from a line source and "
        "by 1 % from a funnel at 0.1 s, and without a reach of waking denser still ([what sleeping "
        "changes](cases/pile-rest-detection.md)).\n\n"
        "| study | grains | realizations | interval (s) | reach of waking | time step (s) | steps | "
        "grain-steps | time of the grains (s) | base force / weight | version | command |\n"
        "|---|---|---|---|---|---|---|---|---|---|---|---|\n")
    for study in studies:
        if not results.has(study):
            out += f"| `{study}` | {NOT_RUN} |" + " |" * 10 + "\n"
            continue
        command = results.text(study, "case.command")
        cells = [number(results, study, key, form) for key, form in (
            ("dem.grains", ".0f"), ("ensemble.realizations", "g"), ("source.interval", "g"),
            ("sleep.wake_reach", "g"), ("dem.time_step", ".3g"), ("dem.steps", ".4g"),
            ("dem.grain_steps", ".3g"))]
        cells += [grain_seconds(results, study), number(results, study, "base.weight_ratio", ".6f"),
                  results.text(study, "version") or "",
                  "`" + command.replace("|", "\\|") + "`" if command else NO_COMMAND]
        out += f"| `{study}` | " + " | ".join(cells) + " |\n"
    return out


def misprints() -> str:
    out = ("\n## Misprints and inconsistencies of the sources\n\n"
           "Re-derived from the field equations; the program uses what holds.\n\n"
           "| where | printed | holds |\n|---|---|---|\n")
    for one in read_toml("misprints")["misprint"]:
        out += f"| {one['where']} | {one['printed']} | {one['holds']} |\n"
    return out


def page(results: Results) -> str:
    """The page: every figure of the sources beside ours, and how each study was run."""
    rows = all_rows()
    studies = list(dict.fromkeys(row["study"] for row in rows))
    return (
        "# Figures of the sources beside ours\n\n"
        "Generated from the summaries in `docs/reproduction/results/` (`CASE.json` is the `summary.json` of "
        "`grainfield run cases/CASE.toml`) by\n\n"
        "    docs/reproduction/page.py\n\n"
        "`--add DIR` takes the summary, the profiles and the pictures of a finished run in.\n\n"
        "Errors are standard errors over realizations. A number agrees when the source's value with its "
        "reading error (angles 1°, fractions 0.01, \"about\" 25 %) and ours ± 2 standard errors meet; the "
        f"spread is too wide to tell when 2 standard errors exceed {100 * TOO_WIDE:.0f} % of the value, or, for "
        "the ratios of volume fraction and coordination, of the effect that the source reports (0.09, 0.08, "
        "0.04). The steeper flank is the one with the larger mean, whichever side it is: the study's page "
        "says which was meant. The error of a ratio of two ensembles is that of the one minus the source's "
        "ratio times the other. The error of a fitted constant is the larger of the fit's own and the "
        "bootstrap's over piles. The fit's own is the jackknife's, of fits recorded under older weights "
        "(point source, OSL, asymmetric) the covariance's. A fit is beyond the errors when its χ²/dof "
        "exceeds what a true model's does by chance: in 1 of 100, under the older weights in 1.35 of 1000. A "
        "dip or peak is one at 5 % over [all pours together](#dips-and-peaks-of-all-pours); a peak meets \"no "
        "dip\" too; neither is uninformative: it agrees with a dip as with none. A stress ratio hardly "
        "changes where it does by less than a tenth also with 2 standard errors more, and changes where it "
        "does by more than a tenth also with 2 less; between, the spread is too wide to tell. Nothing was "
        "tuned to agree, but for the window of Liffman's H at 32.6°, of which its row tells; the value over "
        "the whole way to the bend is not among the stored results.\n\n"
        "| source | figure | theirs | ours | agreement | realizations | study |\n"
        "|---|---|---|---|---|---|---|\n"
        + "".join(figure_line(row, results) for row in rows)
        + dips(results) + verdicts(results, studies) + profiles_and_maps(results, studies)
        + how_run(results, studies) + misprints())


def main(words: list[str] | None = None) -> int:
    options = argparse.ArgumentParser(description="Makes docs/reproduction.md, the sources' figures beside ours.")
    options.add_argument("--add", type=pathlib.Path, action="append", default=[], metavar="RUN",
                         help="folder of a finished run, taken in first; may be given several times")
    options.add_argument("--check", action="store_true", help="write nothing: compare the page")
    options.add_argument("--results", type=pathlib.Path, default=HERE / "results", metavar="DIR",
                         help="the summaries; default: docs/reproduction/results")
    options.add_argument("-o", "--output", type=pathlib.Path, default=PAGE, metavar="FILE",
                         help="the page; default: docs/reproduction.md")
    given = options.parse_args(words)
    try:
        for run in given.add:
            for file in record_run(run, given.results):
                print(file)
        made = page(Results(given.results)).encode()
        if given.check:
            same = given.output.exists() and given.output.read_bytes() == made
            print(f"{given.output}: " + ("up to date" if same else "differs; docs/reproduction/page.py writes it"))
            return 0 if same else 1
        write_file(given.output, made)
        print(given.output)
        return 0
    except (Refused, OSError) as error:
        print(f"page.py: {error}", file=sys.stderr)
        return 2


if __name__ == "__main__":
    sys.exit(main())

#!/usr/bin/python3
"""The tables of docs/cases/wellmann-box.md: its results, their causes and the steps of the computation.

    docs/reproduction/causes.py             prints them
    docs/reproduction/causes.py --write     puts them into the page

Reads results/wellmann-box.json and results/wellmann-box-causes.json (collect.py makes both), the lists of runs and,
for the last table, the tables of the runs. A cell is the mean over packings with its standard error. One that was not
planned is empty, and one that has not run has "–". The last table compares the same packings, without an error.
"""
import argparse
import math
import pathlib
import re
import sys

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE))
sys.path.insert(0, str(HERE / "runs"))

from collect import mean_of, read_runs  # noqa: E402
from next import read_list  # noqa: E402
from record import write_file  # noqa: E402
from rows import SHORT, WITHIN_SHORT  # noqa: E402
from summaries import Measured, Results  # noqa: E402

PAGE = HERE.parent / "cases/wellmann-box.md"
BASE, CAUSES = "wellmann-box", "wellmann-box-causes"
FIGURES = "| | source | here | packings |"
#: what, the source's, key, member, digits; a member A/B is the share by which A exceeds B, packing by packing
FIGURE_ROWS = (
    ("spheres below the lid", "79", "sample.gap_spheres", "packing", 0),
    ("height of the lid", "23.6", "lid_height", "packing", 2),
    ("strain of RVEs of radius 5 over the imposed one, up to 0.02, μ = 0.5", "1 within about 10 %",
     "strain_slope.early", "hertz_05", 2),
    ("beyond 0.02, μ = 0.5", "the same", "strain_slope.late", "hertz_05", 3),
    ("from 0.02 to 0.04, μ = 0.25", "the same", "strain_slope.late", "hertz_025", 2),
    ("late over early stiffness of the RVEs, Hertz", "above 1.1", "rve_stiffening_late", "hertz_05", 2),
    ("penalty law", "0.9 to 1.1", "rve_stiffening_late", "penalty_05", 2),
    ("plastic strain, μ = 0.5", "none", "sample.plastic_strain", "hertz_05", 4),
    ("change of q/p from cT/cN = 0.25 to 1, μ = 0.5", "negligible", "q_over_p_at_0.04", "penalty_05/penalty_05_soft", 0),
    ("shear: mean stress over its start, μ = 0.25", "about 1.7", "sample.pressure_ratio", "shear_hertz_025", 2),
    ("μ = 0.5", "about 3", "sample.pressure_ratio", "shear_hertz_05", 2),
    ("μ = 0", "about 1", "sample.pressure_ratio", "shear_hertz_0", 3),
    ("shear stress over that start, μ = 0.25", "about 1", "sample.shear_over_pressure",
     "shear_hertz_025", 2),
    ("μ = 0.5", "about 2", "sample.shear_over_pressure", "shear_hertz_05", 2),
    ("change of the first shear stiffness from μ = 0.25 to 0.5", "about none", "sample.first_shear_stiffness",
     "shear_hertz_05/shear_hertz_025", 0),
    ("shear strain of RVEs over the imposed one, μ = 0.5", "1 within 10 %", "rve.r5.strain_ratio", "shear_hertz_05", 3),
    ("shear strain at their least volume, μ = 0.5", "about 0.05", "rve.contraction_strain", "shear_hertz_05", 3),
    ("mean stress with four times the stiffness", "times 4", "pressure_at_0.04", "hertz_05_stiff over hertz_05", 3),
)
CHANGES = {"densest": "densest", "dense": "denser", "loose": "looser", "smooth": "smooth walls",
           "pressed": "from 10 kPa", "slow": "a tenth of the rate"}
COMPARED = "| | source | as on this page | " + " | ".join(CHANGES.values()) + " |"
#: what, the source's, key, member, digits
CAUSE_ROWS = (
    ("solid fraction of the packing", "0.63", "sample.dropped_solid_fraction", "packing", 3),
    ("strain of RVEs over the imposed one, up to 0.02, μ = 0.5", "about 1", "strain_slope.early", "hertz_05", 2),
    ("from 0.02 to 0.04, μ = 0.5", "about 1", "strain_slope.middle", "hertz_05", 2),
    ("error bar of the axial stress over its mean at 0.04, radius 5", "about 0.02", "error_bar_at_0.04.r5",
     "hertz_05", 3),
    ("radius 7", "about 0.01", "error_bar_at_0.04.r7", "hertz_05", 3),
    ("q/p at 0.04, μ = 0", "about 0.1", "q_over_p_at_0.04", "hertz_0", 3),
    ("plastic strain, μ = 0", "about 0.02", "sample.plastic_strain", "hertz_0", 3),
    ("shear: mean stress over its start, μ = 0", "about 1", "sample.pressure_ratio", "shear_hertz_0", 2),
    ("μ = 0.25", "about 1.7", "sample.pressure_ratio", "shear_hertz_025", 2),
    ("μ = 0.5", "about 3", "sample.pressure_ratio", "shear_hertz_05", 2),
    ("shear strain of RVEs over the imposed one, μ = 0.5", "1 within 10 %", "rve.r5.strain_ratio", "shear_hertz_05", 2),
)
STEPS = {"half_step": "half the step", "half_rate": "half the rate", "tight": "tenfold tighter rest"}
STEPPED = "| μ = 0.5, Hertz | as on this page | " + " | ".join(STEPS.values()) + " |"
#: what, key, digits
STEP_ROWS = (
    ("strain of RVEs over the imposed one, up to 0.02", "strain_slope.early", 3),
    ("beyond 0.02", "strain_slope.late", 3),
    ("late over early stiffness", "rve_stiffening_late", 3),
    ("q/p at 0.04", "q_over_p_at_0.04", 4),
    ("mean stress at 0.04 (Pa)", "pressure_at_0.04", 0),
    ("largest kinetic over elastic energy", "sample.kinetic_share", 4),
)


def cell(found, digits, unit=""):
    if found is None:
        return "–"
    while digits < 6 and 0 < found.error < 0.5 * 10**-digits:
        digits += 1
    value = f"{found.value:{'+' if unit else ''}.{digits}f}".replace("-", "−")
    return value + unit if math.isnan(found.error) else f"{value} ± {found.error:.{digits}f}{unit}"


def heading(line):
    return line + "\n|" + "---|" * (line.count("|") - 1) + "\n"


def figures(results):
    """What the page has found beside the source's."""
    out = heading(FIGURES)
    for what, source, key, member, digits in FIGURE_ROWS:
        unit, name = "", member
        if "/" in member or " over " in member:
            name = re.sub("/| over ", "_over_", member)
        found = results.number(BASE, key, name)
        if "/" in member and found is not None:
            found, unit = Measured(100 * (found.value - 1), 100 * found.error, found.freedom), " %"
        count = results.realizations(BASE, name)
        out += f"| {what} | {source} | {cell(found, digits, unit)} | {'' if count is None else f'{count:.0f}'} |\n"
    return out


def planned(listed):
    return {name.rpartition("-")[0] for name, *_ in read_list(listed)[1]}


def causes(results, names):
    """What a figure becomes when one thing changes; names: of the runs that are planned."""
    out = heading(COMPARED)
    for what, source, key, member, digits in CAUSE_ROWS:
        cells = [cell(results.number(BASE, key, member), digits)]
        for change in CHANGES:
            name = change if member == "packing" else f"{member}_{change}"
            alike = change not in SHORT or WITHIN_SHORT.search(key)
            cells.append(cell(results.number(CAUSES, key, name), digits) if name in names and alike else "")
        out += f"| {what} | {source} | " + " | ".join(cells) + " |\n"
    return out


def steps(bases, changed):
    """The same packings computed otherwise; both: figures by (name, number of the packing)."""
    out = heading(STEPPED)
    numbers = sorted({number for name, number in changed if name in {f"hertz_05_{change}" for change in STEPS}
                      and ("hertz_05", number) in bases})
    for what, key, digits in STEP_ROWS:
        cells = [mean_of(bases, "hertz_05", key, numbers),
                 *(mean_of(changed, f"hertz_05_{change}", key, numbers) for change in STEPS)]
        out += f"| {what} | " + " | ".join("–" if value is None else f"{value:.{digits}f}" for value in cells) + " |\n"
    return out


def tables():
    results, listed = Results(HERE / "results"), HERE / "runs/wellmann-causes.txt"
    return [figures(results), causes(results, planned(listed)),
            steps(read_runs(HERE / "runs/wellmann.txt"), read_runs(listed))]


def put(text, made):
    """The page's text with its tables, which their first lines tell, as they are made."""
    for table in made:
        first = re.escape(table.partition("\n")[0])
        if len(re.findall(rf"^{first}$", text, flags=re.M)) != 1:
            sys.exit(f"causes.py: {PAGE}: found no table with the line \"{table.partition(chr(10))[0]}\", or several")
        text = re.sub(rf"^{first}\n(\|.*\n)+", lambda _: table, text, flags=re.M)
    return text


if __name__ == "__main__":
    options = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    options.add_argument("--write", action="store_true", help="put the tables into the page")
    made = tables()
    if options.parse_args().write:
        write_file(PAGE, put(PAGE.read_text(), made).encode())
        print(PAGE)
    else:
        print("\n".join(made), end="")

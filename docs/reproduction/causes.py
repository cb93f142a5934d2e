#!/usr/bin/python3
"""Prints the table of causes of docs/cases/wellmann-box.md: what a figure becomes when one thing changes.

    docs/reproduction/causes.py

Reads results/wellmann-box.json and results/wellmann-box-causes.json (collect.py makes both). A cell is the
mean over packings with its standard error; an empty one was not planned, "–" has not run.
"""
import math
import pathlib

from summaries import Results

HERE = pathlib.Path(__file__).resolve().parent
BASE, CAUSES = "wellmann-box", "wellmann-box-causes"
CHANGES = ("dense", "loose", "smooth", "slow")
HEADER = ("| | source | as on this page | denser | looser | smooth walls | slower |\n"
          "|---|---|---|---|---|---|---|\n")
#: what, the source's, key, member, digits, the changes that were planned
ROWS = (
    ("solid fraction of the packing", "0.63", "sample.dropped_solid_fraction", "packing", 3, ("dense", "loose")),
    ("strain of RVEs over the imposed one, up to 0.02, μ = 0.5", "about 1", "strain_slope.early", "hertz_05", 2,
     CHANGES),
    ("from 0.02 on, μ = 0.5", "about 1", "strain_slope.late", "hertz_05", 3, CHANGES),
    ("error bar of the axial stress over its mean, RVEs of radius 5, μ = 0.5", "about 0.02", "rve.r5.error_bar",
     "hertz_05", 3, CHANGES),
    ("the same, radius 7", "about 0.01", "rve.r7.error_bar", "hertz_05", 3, CHANGES),
    ("q/p at the end, μ = 0", "about 0.1", "sample.end_axial_stress_ratio", "hertz_0", 3, ("dense", "slow")),
    ("plastic strain, μ = 0", "about 0.02", "sample.plastic_strain", "hertz_0", 3, ("dense",)),
    ("shear strain of RVEs over the imposed one, μ = 0.5", "1 within 10 %", "rve.r5.strain_ratio", "shear_hertz_05",
     2, ("dense", "loose")),
    ("mean stress under shear over its start, μ = 0.25", "about 1.7", "sample.pressure_ratio", "shear_hertz_025", 2,
     ("dense", "loose")),
    ("the same, μ = 0.5", "about 3", "sample.pressure_ratio", "shear_hertz_05", 2, ("dense", "loose")),
    ("first shear stiffness over the first mean stress, μ = 0.25", "as with μ = 0.5", "shear_stiffness.first",
     "shear_hertz_025", 1, ("dense", "loose")),
    ("the same, μ = 0.5", "as with μ = 0.25", "shear_stiffness.first", "shear_hertz_05", 1, ("dense", "loose")),
)


def cell(found, digits):
    if found is None:
        return "–"
    while digits < 6 and 0 < found.error < 0.5 * 10**-digits:
        digits += 1
    value = f"{found.value:.{digits}f}"
    return value if math.isnan(found.error) else f"{value} ± {found.error:.{digits}f}"


def table(results):
    """The table; results: of the folder results."""
    out = HEADER
    for what, source, key, member, digits, planned in ROWS:
        cells = [cell(results.number(BASE, key, member), digits)]
        for change in CHANGES:
            name = change if member == "packing" else f"{member}_{change}"
            cells.append(cell(results.number(CAUSES, key, name), digits) if change in planned else "")
        out += f"| {what} | {source} | " + " | ".join(cells) + " |\n"
    return out


if __name__ == "__main__":
    print(table(Results(HERE / "results")), end="")

#!/usr/bin/python3
"""The tables of docs/cases/wellmann-box.md: its results, their causes and the steps of the computation.

    docs/reproduction/causes.py             prints them
    docs/reproduction/causes.py --write     puts them into the page

The rows are those of figures/wellmann-tables.toml. Reads results/wellmann-box.json and
results/wellmann-box-causes.json (collect.py makes both), the lists of runs and, for the last table, the tables of the
runs. A cell is the mean over packings with its standard error. One that was not planned is empty, and one that has not
run has "–". The last table compares the same packings, without an error.
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
from rows import SHORT, WITHIN_SHORT, read_toml  # noqa: E402
from summaries import Measured, Results  # noqa: E402
from tables import put, table  # noqa: E402

PAGE = HERE.parent / "cases/wellmann-box.md"
BASE, CAUSES = "wellmann-box", "wellmann-box-causes"
ROWS = read_toml("wellmann-tables")
FIGURES = "| | source | here | packings |"
CHANGES = {"densest": "densest", "dense": "denser", "loose": "looser", "smooth": "smooth walls",
           "pressed": "from 10 kPa", "slow": "a tenth of the rate"}
COMPARED = "| | source | as on this page | " + " | ".join(CHANGES.values()) + " |"
STEPS = {"half_step": "half the step", "half_rate": "half the rate", "tight": "tenfold tighter rest"}
STEPPED = "| μ = 0.5, Hertz | as on this page | " + " | ".join(STEPS.values()) + " |"


def cell(found, digits, unit=""):
    if found is None:
        return "–"
    while digits < 6 and 0 < found.error < 0.5 * 10**-digits:
        digits += 1
    value = f"{found.value:{'+' if unit else ''}.{digits}f}".replace("-", "−")
    return value + unit if math.isnan(found.error) else f"{value} ± {found.error:.{digits}f}{unit}"


def figures(results):
    """What the page has found beside the source's."""
    rows = []
    for what, source, key, member, digits in ROWS["results"]:
        unit, name = "", member
        if "/" in member or " over " in member:
            name = re.sub("/| over ", "_over_", member)
        found = results.number(BASE, key, name)
        if "/" in member and found is not None:
            found, unit = Measured(100 * (found.value - 1), 100 * found.error, found.freedom), " %"
        count = results.realizations(BASE, name)
        rows.append([what, source, cell(found, digits, unit), "" if count is None else f"{count:.0f}"])
    return table(FIGURES, rows)


def planned(listed):
    return {name.rpartition("-")[0] for name, *_ in read_list(listed)[1]}


def causes(results, names):
    """What a figure becomes when one thing changes; names: of the runs that are planned."""
    rows = []
    for what, source, key, member, digits in ROWS["causes"]:
        cells = [cell(results.number(BASE, key, member), digits)]
        for change in CHANGES:
            name = change if member == "packing" else f"{member}_{change}"
            alike = change not in SHORT or WITHIN_SHORT.search(key)
            cells.append(cell(results.number(CAUSES, key, name), digits) if name in names and alike else "")
        rows.append([what, source, *cells])
    return table(COMPARED, rows)


def steps(bases, changed):
    """The same packings computed otherwise; both: figures by (name, number of the packing)."""
    rows = []
    numbers = sorted({number for name, number in changed if name in {f"hertz_05_{change}" for change in STEPS}
                      and ("hertz_05", number) in bases})
    for what, key, digits in ROWS["steps"]:
        values = [mean_of(bases, "hertz_05", key, numbers),
                  *(mean_of(changed, f"hertz_05_{change}", key, numbers) for change in STEPS)]
        rows.append([what, *("–" if value is None else f"{value:.{digits}f}" for value in values)])
    return table(STEPPED, rows)


def tables():
    results, listed = Results(HERE / "results"), HERE / "runs/wellmann-causes.txt"
    return [figures(results), causes(results, planned(listed)),
            steps(read_runs(HERE / "runs/wellmann.txt"), read_runs(listed))]


if __name__ == "__main__":
    options = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    options.add_argument("--write", action="store_true", help="put the tables into the page")
    made = tables()
    if options.parse_args().write:
        write_file(PAGE, put(PAGE.read_text(), made, PAGE).encode())
        print(PAGE)
    else:
        print("\n".join(made), end="")

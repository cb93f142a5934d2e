#!/usr/bin/python3
"""Joins the finished runs of a list into one summary, results/CASE.json or results/NAME.json.

    docs/reproduction/collect.py docs/reproduction/runs/wellmann.txt
    docs/reproduction/collect.py docs/reproduction/runs/wellmann-causes.txt --name wellmann-box-causes

A run NAME-NUMBER of the list is one realization of NAME (states/LIST/NAME-NUMBER.json). A number of its
summary becomes KEY.NAME, the mean over the realizations, with KEY.standard_error.NAME, KEY.least.NAME
and KEY.most.NAME, as in the summary of a sweep. The recorded states add ADDED:

    q_over_p_at_0.04, pressure_at_0.04 (Pa): axial_q_over_p and p of a compression at a strain of 0.04
    quasistatic_from: the recorded strain of a compression from which kinetic over elastic energy stays below
        QUASISTATIC up to the largest strain
    shear_stiffness.PART: of a NAME that begins with shear_, the slope of |sigma_xz| over the shear,
        divided by the first mean stress; PART names an interval of shears in PARTS
    strain_slope.PART: of the RVEs of radius RVE, the axial strain of a compression (the shear strain of
        a NAME that begins with shear_) over the imposed one by least squares, while it is loaded;
        PART is "early" up to an imposed strain of SET, else "late"
    lid_height: of a run that left its states, the distance of the walls across z at the start, over EDGE

Ends with 2 if no run of the list has ended. Needs h5py and numpy.
"""
import argparse
import csv
import io
import json
import lzma
import math
import pathlib
import sys

import h5py
import numpy

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE / "runs"))

from next import fail, read_list  # noqa: E402
from record import write_file  # noqa: E402

PARTS = {"first": (0.0, 0.04), "middle": (0.08, 0.12), "last": (0.14, 0.20)}
RVE, SET = 5, 0.02
QUASISTATIC = 1e-3  # kinetic over elastic energy (Wellmann figure 5)
EDGE = 0.001  # m, Wellmann's unit of length
#: The keys that this script adds to those of a summary.
ADDED = ("q_over_p_at_0.04", "pressure_at_0.04", "quasistatic_from", *(f"shear_stiffness.{part}" for part in PARTS),
         "strain_slope.early", "strain_slope.late", "lid_height")
TOLERANCE = 1e-3  # of the strain at which a state is recorded


def read_columns(file):
    """The columns of a CSV of a run as arrays, nan where a value is missing."""
    lines = [line for line in file.read_text().splitlines() if not line.startswith("#")]
    rows = list(csv.DictReader(lines))
    return {name.removesuffix("_Pa"): numpy.array([float(row[name] or "nan") for row in rows]) for name in rows[0]}


def compression_figures(states):
    """What a compression has while it is loaded; of 0.04 nothing where no state is recorded there."""
    loading = states["strain"][: int(numpy.argmax(states["strain"])) + 1]
    n = len(loading)
    elastic = states["elastic_energy_J"][:n]
    share = numpy.divide(states["kinetic_energy_J"][:n], elastic, out=numpy.full(n, math.inf), where=elastic > 0)
    out = {}
    still = n - int(numpy.argmax((share >= QUASISTATIC)[::-1])) if (share >= QUASISTATIC).any() else 0
    if still < n:
        out["quasistatic_from"] = loading[still]
    at = int(numpy.argmin(abs(loading - 0.04)))
    if abs(loading[at] - 0.04) <= TOLERANCE:
        out |= {"q_over_p_at_0.04": states["axial_q_over_p"][at], "pressure_at_0.04": states["p"][at]}
    return out


def shear_figures(states):
    """Slopes of |sigma_xz| / p0 over the shear by least squares, by part."""
    shear, stress = states["strain"], abs(states["sigma_xz"]) / states["p"][0]
    out = {}
    for part, (low, high) in PARTS.items():
        within = (shear >= low - TOLERANCE) & (shear <= high + TOLERANCE)
        if within.sum() > 1:
            out[f"shear_stiffness.{part}"] = numpy.polyfit(shear[within], stress[within], 1)[0]
    return out


def strain_slopes(rves, component):
    """Slopes of the RVEs' strain over the imposed one, early and late."""
    of = rves["radius"] == RVE
    imposed, found = (abs(rves[f"{kind}_{component}"][of]) for kind in ("imposed", "strain"))
    loading = numpy.arange(len(imposed)) <= numpy.argmax(imposed)
    out = {}
    for part, within in {"early": imposed <= SET + TOLERANCE, "late": imposed >= SET - TOLERANCE}.items():
        if (within & loading).sum() > 1:
            out[f"strain_slope.{part}"] = numpy.polyfit(imposed[within & loading], found[within & loading], 1)[0]
    return out


def lid_height(file):
    """The distance of the walls across z in the first state of FILE.h5.xz, over EDGE."""
    with lzma.open(file) as packed, h5py.File(io.BytesIO(packed.read())) as states:
        walls = states["realization_000/state_000/walls"]
        across = abs(walls["normal"][:, 2]) > 0.5
        return float(numpy.ptp(walls["point"][across, 2])) / EDGE


def figures_of(name, record, states, rves, height):
    """The finite numbers of a run by key."""
    numbers = {key: value for key, value in record["summary"].items() if isinstance(value, (int, float))
               and not key.startswith(("ensemble.", "time.", "memory."))}
    numbers["time.cpu_s"] = record["cpu_seconds"]
    if states is not None:
        numbers |= shear_figures(states) if name.startswith("shear_") else compression_figures(states)
    if rves is not None:
        numbers |= strain_slopes(rves, "xz" if name.startswith("shear_") else "zz")
    if height is not None:
        numbers["lid_height"] = height
    return {key: float(value) for key, value in numbers.items() if math.isfinite(value)}


def collect(runs):
    """The joined summary of [(name, record, states or None, RVEs or None, height or None)]."""
    out = {}
    for name in {name for name, *_ in runs}:
        of = [figures_of(*run) for run in runs if run[0] == name]
        out[f"ensemble.realizations.{name}"] = len(of)
        for key in set().union(*of):
            values = [figures[key] for figures in of if key in figures]
            out[f"{key}.{name}"] = float(numpy.mean(values))
            out[f"{key}.least.{name}"], out[f"{key}.most.{name}"] = min(values), max(values)
            if len(values) > 1:
                out[f"{key}.standard_error.{name}"] = float(numpy.std(values, ddof=1) / math.sqrt(len(values)))
    return out


def main():
    options = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    options.add_argument("list", type=pathlib.Path, help="the runs")
    options.add_argument("--name", help="of the summary; default: the name of the case")
    given = options.parse_args()
    listed = given.list
    if not listed.is_file():
        fail(f"{listed}: no such list")
    tag, planned = read_list(listed)
    folder, runs, cases = HERE / "states" / listed.stem, [], set()
    for name, _, case, _ in planned:
        file = folder / f"{name}.json"
        if file.exists():
            tables = (folder / f"{name}.{table}.csv" for table in ("states_of_realizations", "rve"))
            packed = folder / f"{name}.h5.xz"
            runs.append((name.rpartition("-")[0], json.loads(file.read_text()),
                         *(read_columns(table) if table.exists() else None for table in tables),
                         lid_height(packed) if packed.exists() else None))
            cases.add(case)
    if len(cases) != 1:
        fail(f"{listed}: found finished runs of {len(cases)} cases; allowed: one case")
    case, joined = cases.pop(), collect(runs)
    most = max(value for key, value in joined.items() if key.startswith("ensemble.realizations."))
    command = f"docs/reproduction/collect.py docs/reproduction/runs/{listed.name}"
    if given.name:
        command += f" --name {given.name}"
    joined |= {"case.name": case, "case.command": command, "version": tag, "ensemble.realizations": most}
    name = given.name or case
    write_file(HERE / "results" / f"{name}.json", (json.dumps(joined, indent=1, sort_keys=True) + "\n").encode())
    print(f"{name}.json: {len(runs)} of {len(planned)} runs")


if __name__ == "__main__":
    main()

#!/usr/bin/python3
"""Joins the finished runs of a list (runs/LIST.txt) into one summary, results/CASE.json.

    docs/reproduction/collect.py docs/reproduction/runs/wellmann.txt

Every run is one realization of one value of a sweep: states/LIST/VALUE-NUMBER.json. A number of its
summary becomes KEY.VALUE, the mean over the realizations, with KEY.standard_error.VALUE, KEY.least.VALUE
and KEY.most.VALUE, as a sweep's own summary has them. Four more come from the recorded states:

    q_over_p_at_0.04, pressure_at_0.04 (Pa), lateral_ratio_at_0.04 of compressions, at a strain of 0.04:
        axial_q_over_p, p, and sigma_xx + sigma_yy over 2 sigma_zz
    shear_stiffness.PART.VALUE, of shears: the slope of |sigma_xz| over the shear, over the first mean
        stress; PART is first (shears up to 0.04), middle (0.08 to 0.12) or last (0.14 to 0.20)

Exits with 2 where no run of the list has ended. Needs numpy.
"""
import csv
import json
import math
import pathlib
import sys

import numpy

from record import write_file

HERE = pathlib.Path(__file__).resolve().parent
PARTS = {"first": (0.0, 0.04), "middle": (0.08, 0.12), "last": (0.14, 0.20)}
#: The keys that this script adds to those of a summary.
ADDED = ("q_over_p_at_0.04", "pressure_at_0.04", "lateral_ratio_at_0.04", "shear_stiffness.*.*")
TOLERANCE = 1e-3  # of the strain at which a state is recorded


def read_states(file):
    """The columns of NAME.states_of_realizations.csv as arrays."""
    lines = [line for line in file.read_text().splitlines() if not line.startswith("#")]
    rows = list(csv.DictReader(lines))
    return {name.removesuffix("_Pa"): numpy.array([float(row[name] or "nan") for row in rows]) for name in rows[0]}


def compression_figures(states):
    """What a compression has at 0.04, on its way there; nothing where no state is recorded at it."""
    loading = states["strain"][: int(numpy.argmax(states["strain"])) + 1]
    at = int(numpy.argmin(abs(loading - 0.04)))
    if abs(loading[at] - 0.04) > TOLERANCE:
        return {}
    lateral = 0.5 * (states["sigma_xx"][at] + states["sigma_yy"][at]) / states["sigma_zz"][at]
    return {"q_over_p_at_0.04": states["axial_q_over_p"][at], "pressure_at_0.04": states["p"][at],
            "lateral_ratio_at_0.04": lateral}


def shear_stiffness(states):
    """Slopes of |sigma_xz| / p0 by least squares, by part."""
    shear, stress = states["strain"], abs(states["sigma_xz"]) / states["p"][0]
    out = {}
    for part, (low, high) in PARTS.items():
        within = (shear >= low - TOLERANCE) & (shear <= high + TOLERANCE)
        if within.sum() > 1:
            out[part] = numpy.polyfit(shear[within], stress[within], 1)[0]
    return out


def put(out, key, member, values):
    """Mean, standard error and range of finite values."""
    values = [v for v in values if math.isfinite(v)]
    if not values:
        return
    out[f"{key}.{member}"] = float(numpy.mean(values))
    out[f"{key}.least.{member}"], out[f"{key}.most.{member}"] = min(values), max(values)
    if len(values) > 1:
        out[f"{key}.standard_error.{member}"] = float(numpy.std(values, ddof=1) / math.sqrt(len(values)))


def collect(runs):
    """The joined summary of [(value, record, states or None)]."""
    out = {}
    for member in sorted({value for value, *_ in runs}):
        of = [(record, states) for value, record, states in runs if value == member]
        summaries = [record["summary"] for record, _ in of]
        out[f"ensemble.realizations.{member}"] = len(of)
        out[f"time.cpu_s.{member}"] = float(numpy.mean([record["cpu_seconds"] for record, _ in of]))
        for key in sorted(set().union(*summaries)):
            values = [s[key] for s in summaries if isinstance(s.get(key), (int, float))]
            if values and not key.startswith(("ensemble.", "time.", "memory.")):
                put(out, key, member, values)
        derived, slopes = [], []
        for _, states in of:
            if states is not None and member.startswith("shear_"):
                slopes.append(shear_stiffness(states))
            elif states is not None:
                derived.append(compression_figures(states))
        for key in sorted(set().union(*derived)):
            put(out, key, member, [d[key] for d in derived if key in d])
        for part in PARTS:
            values = [s[part] for s in slopes if part in s]
            if values:
                key = f"shear_stiffness.{part}.{member}"
                out[key] = float(numpy.mean(values))
                if len(values) > 1:
                    out[f"{key}.standard_error"] = float(numpy.std(values, ddof=1) / math.sqrt(len(values)))
    return out


def main():
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    listed = pathlib.Path(sys.argv[1])
    folder = HERE / "states" / listed.stem
    runs, cases, tags = [], set(), set()
    for file in sorted(folder.glob("*.json")):
        record = json.loads(file.read_text())
        states = file.with_name(f"{file.stem}.states_of_realizations.csv")
        runs.append((file.stem.rpartition("-")[0], record, read_states(states) if states.exists() else None))
        cases.add(record["case"])
        tags.add(record["tag"])
    if len(cases) != 1:
        print(f"collect.py: {folder}: found runs of {len(cases)} cases; allowed: one", file=sys.stderr)
        sys.exit(2)
    case = cases.pop()
    out = {"case.name": case, "case.command": f"docs/reproduction/collect.py docs/reproduction/runs/{listed.name}",
           "version": ", ".join(sorted(tags)),
           "ensemble.realizations": max(sum(v == value for v, *_ in runs) for value, *_ in runs), **collect(runs)}
    write_file(HERE / "results" / f"{case}.json", (json.dumps(out, indent=1, sort_keys=True) + "\n").encode())
    print(f"{case}.json: {len(runs)} runs")


if __name__ == "__main__":
    main()

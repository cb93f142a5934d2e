#!/usr/bin/python3
"""What continuum models say of a heap by its own constants, before anybody looks at its base.

    docs/reproduction/predict.py make PROGRAM STATES.h5 RUN ... --name NAME
    docs/reproduction/predict.py compare STATES.h5 --name NAME

make takes one RUN of study pile-fields a pile, in the order of the states (topic elastic): its elastic_map.csv and
its summary give E, nu, and the friction angle is the pile's steeper slope. A Poisson's ratio of the map outside POISSON
becomes the nearer end. It writes predictions/NAME.json: by model and
pile the shoulder less the centre of the pressure on the base and sigma_xx / sigma_yy on the axis, in the windows of
axis.stress_ratio and dip.difference of a summary. The half angle of the free core is that of Roul's fit (roul_fit.py)
to a row at ROW of the height, so that no model sees the base. The models:

    layers    fe_mohr_coulomb_wedge with the map, built up in layers along the slopes
    at_once   the same with gravity on the whole heap
    even      the same without the map: nu alone counts
    core      fe_cantelaube_core, the core's half angle as fitted above the base
    zero, minus, plus    closed Cantelaube;  bcc, fpa    closed OSL

compare measures both in the states and adds the predictions, the measured values and the mean miss of each, pile by
pile, with its error to results/pile-predictions.json as NAME.MODEL.FIGURE, NAME.measured.FIGURE and
NAME.MODEL.FIGURE_miss. It refuses a prediction that is not committed as it is. Needs git, h5py, numpy and scipy.
"""
import argparse
import csv
import json
import math
import pathlib
import subprocess
import sys
import tempfile

import h5py
import numpy

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE))

import roul_fit  # noqa: E402
from heaps import AXIS, CENTRE, SHOULDER, Heap  # noqa: E402
from record import write_file  # noqa: E402

PREDICTIONS = HERE / "predictions"
STORED = HERE / "results/pile-predictions.json"
FIGURES = ("dip", "axis_ratio")
ROW = 0.3
POISSON = (0.0, 0.45)
POINTS = 41  # of a window
ABOVE = 1e-6  # of the height: the base itself is the domain's edge
DIGITS = 6


def windows(half_left, half_right):
    """Points of a heap of height 1: on the base with the window they are of, and on the axis."""
    spans = [("centre", -CENTRE * half_left, CENTRE * half_right)]
    spans += [("shoulder", *sorted((side * SHOULDER[0] * half, side * SHOULDER[1] * half)))
              for side, half in ((-1, half_left), (1, half_right))]
    out = []
    for name, low, high in spans:
        step = (high - low) / POINTS
        out += [(name, low + (k + 0.5) * step, ABOVE - 1) for k in range(POINTS)]
    for x in numpy.linspace(-CENTRE * half_left, CENTRE * half_right, 5):
        out += [("axis", x, y - 1) for y in numpy.linspace(*AXIS, POINTS)]
    return out


def read_stresses(text):
    """Columns by their names of what `grainfield model` prints."""
    rows = list(csv.DictReader(line for line in text.splitlines() if not line.startswith("#")))
    return {name: numpy.array([float(row[name]) for row in rows]) for name in ("sigma_xx", "sigma_yy")}


def figures_of(points, stresses, unit, half_left, half_right):
    """dip and axis_ratio by stresses at windows(); shoulders count by their widths, as in dip.difference."""
    names, x = numpy.array([name for name, *_ in points]), numpy.array([x for _, x, _ in points])
    sides = [-stresses["sigma_yy"][(names == "shoulder") & (x * side > 0)].mean() for side in (-1, 1)]
    beside = (half_left * sides[0] + half_right * sides[1]) / (half_left + half_right)
    centre = -stresses["sigma_yy"][names == "centre"].mean()
    axis = names == "axis"
    return {"dip": float((beside - centre) / unit),
            "axis_ratio": float(stresses["sigma_xx"][axis].mean() / stresses["sigma_yy"][axis].mean())}


def models_of(heap, nu, half_deg, elastic_map):
    """name: (model, its settings) of a pile."""
    slopes = [math.degrees(math.atan(abs(line[0]))) for line in (heap.left, heap.right)]
    mean = sum(slopes) / 2
    wedge = {"phi_deg": max(slopes), "left_deg": slopes[0], "right_deg": slopes[1], "h": heap.height,
             "rho_g": heap.pressure / heap.height}
    mapped = wedge | {"map": elastic_map}
    closed = {"phi_deg": mean, "rho_g": heap.pressure / heap.height}
    core = closed | {"h": heap.height, "axis": "continuous", "beta_hat_deg": min(half_deg, 89 - mean), "nu": nu}
    return {"layers": ("fe_mohr_coulomb_wedge", mapped | {"history": "grow"}),
            "at_once": ("fe_mohr_coulomb_wedge", mapped), "even": ("fe_mohr_coulomb_wedge", wedge | {"nu": nu}),
            "core": ("fe_cantelaube_core", core),
            **{branch: ("cantelaube", closed | {"branch": branch}) for branch in ("zero", "minus", "plus")},
            "bcc": ("bcc", closed), "fpa": ("fpa", closed)}


def usable_map(file, folder):
    """A copy of elastic_map.csv whose Poisson's ratios the program takes, and the share of its points that this moved."""
    lines = file.read_text().splitlines(keepends=True)
    begin = next(k for k, line in enumerate(lines) if not line.startswith("#"))
    at = lines[begin].strip().split(",").index("poisson")
    out, known, moved = lines[:begin + 1], 0, 0
    for line in lines[begin + 1:]:
        cells = line.rstrip("\n").split(",")
        nu = float(cells[at])
        if math.isfinite(nu):
            known += 1
            moved += not POISSON[0] <= nu <= POISSON[1]
            cells[at] = repr(min(max(nu, POISSON[0]), POISSON[1]))
        out.append(",".join(cells) + "\n")
    copy = pathlib.Path(folder) / file.name
    copy.write_text("".join(out))
    return copy, moved / known


def stresses_of(program, model, settings, points):
    """Of a model at points in m; None where it finds no equilibrium, which is told on standard error."""
    with tempfile.NamedTemporaryFile("w", suffix=".csv") as file:
        file.write("x,y\n" + "".join(f"{x!r},{y!r}\n" for x, y in points))
        file.flush()
        words = [word for key, value in settings.items() for word in ("--set", f"{key}={value}")]
        done = subprocess.run([program, "model", model, *words, "--points", file.name], capture_output=True, text=True)
    if done.returncode == 3:
        print(f"predict.py: {model}: {done.stderr.strip()}", file=sys.stderr)
        return None
    if done.returncode != 0:
        raise SystemExit(f"predict.py: {model}: {done.stderr.strip()}")
    return read_stresses(done.stdout)


def heaps_of(states):
    with h5py.File(states) as file:
        return [Heap(file[name]["pile"]) for name in sorted(file)]


def predict(program, states, runs):
    """What a prediction holds."""
    heaps = heaps_of(states)
    if len(heaps) != len(runs):
        raise SystemExit(f"predict.py: {len(heaps)} piles and {len(runs)} runs; one run a pile, in their order")
    slope = numpy.mean([math.degrees(math.atan(abs(line[0]))) for one in heaps for line in (one.left, one.right)])
    half_deg = roul_fit.figures(heaps, slope, ROW)["roul_fit.beta_hat_deg"]
    version = subprocess.run([program, "--version"], capture_output=True, text=True, check=True).stdout.strip()
    out = {"version": version, "beta_hat_deg": round(half_deg, DIGITS), "moved_poisson": [],
           "piles": []}
    for heap, run in zip(heaps, runs):
        made = tempfile.TemporaryDirectory()
        elastic_map, moved = usable_map(run / "elastic_map.csv", made.name)
        out["moved_poisson"].append(round(moved, DIGITS))
        nu = json.loads((run / "summary.json").read_text())["elastic.poisson"]
        left, right = heap.half_left / heap.height, heap.half_right / heap.height
        points = windows(left, right)
        found = {}
        for name, (model, settings) in models_of(heap, nu, half_deg, elastic_map).items():
            stresses = stresses_of(program, model, settings, [(x * heap.height, y * heap.height) for _, x, y in points])
            figures = ({key: math.nan for key in FIGURES} if stresses is None else
                       figures_of(points, stresses, heap.pressure, left, right))
            found[name] = {key: None if math.isnan(value) else round(value, DIGITS) for key, value in figures.items()}
        out["piles"].append(found)
        print(f"{run}: {found}", flush=True)
    return out


def compared(prediction, heaps):
    """Keys of results/pile-predictions.json without the name; the miss is of piles for which a model has an answer."""
    measured = {"dip": [heap.dip(0) for heap in heaps], "axis_ratio": [heap.axis_ratio(*AXIS) for heap in heaps]}
    out = {"realizations": len(heaps), "version": prediction["version"], "beta_hat_deg": prediction["beta_hat_deg"]}

    def put(key, values):
        values = numpy.array(values, dtype=float)
        out[key] = float(values.mean()) if len(values) else None
        if len(values) > 1:
            out[f"{key}.standard_error"] = float(values.std(ddof=1) / math.sqrt(len(values)))

    for figure in FIGURES:
        put(f"measured.{figure}", measured[figure])
        for name in prediction["piles"][0]:
            told = [(pile[name][figure], own) for pile, own in zip(prediction["piles"], measured[figure])
                    if pile[name][figure] is not None]
            put(f"{name}.{figure}", [one for one, _ in told])
            put(f"{name}.{figure}_miss", [one - own for one, own in told])
            out[f"{name}.{figure}.piles"] = len(told)
    return out


def committed(file):
    """The commit of a file that is committed as it is."""
    done = subprocess.run(["git", "status", "--porcelain", "--", str(file)], cwd=HERE, capture_output=True, text=True)
    last = subprocess.run(["git", "log", "-1", "--format=%h", "--", str(file)], cwd=HERE, capture_output=True, text=True)
    if done.stdout.strip() or not last.stdout.strip():
        raise SystemExit(f"predict.py: {file}: commit the prediction before it is compared")
    return last.stdout.strip()


def main(words=None):
    options = argparse.ArgumentParser(description="Predicts heaps by their own constants, and compares.")
    commands = options.add_subparsers(dest="command", required=True)
    make, compare = commands.add_parser("make"), commands.add_parser("compare")
    make.add_argument("program", type=pathlib.Path)
    for one in (make, compare):
        one.add_argument("states", type=pathlib.Path)
        one.add_argument("--name", required=True)
    make.add_argument("run", type=pathlib.Path, nargs="+")
    given = options.parse_args(words)
    file = PREDICTIONS / f"{given.name}.json"
    if given.command == "make":
        PREDICTIONS.mkdir(exist_ok=True)
        write_file(file, (json.dumps(predict(given.program.resolve(), given.states, given.run), indent=1) + "\n").encode())
        print(file)
        return 0
    commit = committed(file)
    found = compared(json.loads(file.read_text()), heaps_of(given.states)) | {"commit": commit}
    stored = json.loads(STORED.read_text()) if STORED.exists() else {}
    stored = {key: value for key, value in stored.items() if not key.startswith(f"{given.name}.")}
    stored |= {f"{given.name}.{key}": value for key, value in found.items()}
    write_file(STORED, (json.dumps(stored, indent=2) + "\n").encode())
    print(STORED)
    return 0


if __name__ == "__main__":
    sys.exit(main())

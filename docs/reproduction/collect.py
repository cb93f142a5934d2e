#!/usr/bin/python3
"""Joins the finished runs of a list into one summary, results/CASE.json or results/NAME.json.

    docs/reproduction/collect.py docs/reproduction/runs/wellmann.txt
    docs/reproduction/collect.py docs/reproduction/runs/wellmann-causes.txt --name wellmann-box-causes

A run NAME-NUMBER of the list is one realization of NAME (states/LIST/NAME-NUMBER.json). A number of its
summary becomes KEY.NAME, the mean over the realizations, with KEY.standard_error.NAME, KEY.least.NAME
and KEY.most.NAME, as in the summary of a sweep. The recorded states add ADDED:

    q_over_p_at_0.02, q_over_p_at_0.04, pressure_at_0.04 (Pa): axial_q_over_p and p of a compression at that strain
    quasistatic_from: the recorded strain of a compression from which kinetic over elastic energy stays below
        QUASISTATIC up to the largest strain
    shear_stiffness.PART: of a NAME that begins with shear_, the slope of |sigma_xz| over the shear,
        divided by the first mean stress; PART names an interval of shears in PARTS
    strain_slope.PART: of the RVEs of radius RVE, the axial strain of a compression (the shear strain of
        a NAME that begins with shear_) over the imposed one by least squares, while it is loaded;
        PART is "early" up to an imposed strain of SET, else "late"; "middle" is from SET to STRAIN
    strain_ratio_at_0.04: of the same RVEs, the strain over the imposed one at a compression of STRAIN
    error_bar_at_0.04.rRADIUS: of RVEs of that radius, the error bar of sigma_zz over its mean at the same strain
    rve_stiffening_late: of the same RVEs, the slope of the axial stress over their own axial strain in the last quarter
        of the loading, over that in the second one (as Wellmann's figure 10)
    other_shear_stress: of a NAME that begins with shear_, the larger of |sigma_xy| and |sigma_yz| over |sigma_xz| at
        the end of the loading
    sliding_share: sliding contacts over all, in the last state
    lid_height: of a run that left its states, the distance of the walls across z at the start, over EDGE

Runs of one NUMBER load the same packing. For every pair of a row of figures/wellmann.toml there is the mean over
packings of the difference, KEY.TO_less_FROM, and of the ratio, KEY.TO_over_FROM, with their standard errors; for two
keys of one NAME these are TO_less_FROM.NAME and TO_over_FROM.NAME.

Keys that begin with one of KEPT are another script's, and stay (slip_through.py).

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
from record import read_text, write_file  # noqa: E402
from rows import CAUSES, all_rows  # noqa: E402

PARTS = {"first": (0.0, 0.04), "middle": (0.08, 0.12), "last": (0.14, 0.20)}
RVE, SET, STRAIN = 5, 0.02, 0.04
BARS = (5, 7)  # radii of error_bar_at_0.04
QUASISTATIC = 1e-3  # kinetic over elastic energy (Wellmann figure 5)
EDGE = 0.001  # m, Wellmann's unit of length
KEPT = "slip_through."
#: The keys that this script adds to those of a summary.
ADDED = ("q_over_p_at_0.02", "q_over_p_at_0.04", "pressure_at_0.04", "quasistatic_from",
         *(f"shear_stiffness.{part}" for part in PARTS),
         *(f"strain_slope.{part}" for part in ("early", "middle", "late")), "strain_ratio_at_0.04",
         "rve_stiffening_late", *(f"error_bar_at_0.04.r{radius}" for radius in BARS), "other_shear_stress",
         "sliding_share", "lid_height", "slip_through.largest_miss")
TOLERANCE = 1e-3  # of the strain at which a state is recorded


def read_columns(file):
    """The columns of a CSV of a run as arrays, nan where a value is missing."""
    lines = [line for line in read_text(file).splitlines() if not line.startswith("#")]
    rows = list(csv.DictReader(lines))
    return {name.replace("_Pa", ""): numpy.array([float(row[name] or "nan") for row in rows]) for name in rows[0]}


def nearest(strains, strain):
    """The index of a recorded strain, None where no state is recorded there."""
    at = int(numpy.argmin(abs(strains - strain)))
    return at if abs(strains[at] - strain) <= TOLERANCE else None


def compression_figures(states):
    """What a compression has while it is loaded; of a strain nothing where no state is recorded there."""
    loading = states["strain"][: int(numpy.argmax(states["strain"])) + 1]
    n = len(loading)
    elastic = states["elastic_energy_J"][:n]
    share = numpy.divide(states["kinetic_energy_J"][:n], elastic, out=numpy.full(n, math.inf), where=elastic > 0)
    out = {}
    still = n - int(numpy.argmax((share >= QUASISTATIC)[::-1])) if (share >= QUASISTATIC).any() else 0
    if still < n:
        out["quasistatic_from"] = loading[still]
    for strain in (SET, STRAIN):
        at = nearest(loading, strain)
        if at is not None:
            out[f"q_over_p_at_{strain}"] = states["axial_q_over_p"][at]
            if strain == STRAIN:
                out["pressure_at_0.04"] = states["p"][at]
    return out


def shear_figures(states):
    """Slopes of |sigma_xz| / p0 over the shear by least squares, by part."""
    shear, stress = states["strain"], abs(states["sigma_xz"]) / states["p"][0]
    out = {}
    for part, (low, high) in PARTS.items():
        within = (shear >= low - TOLERANCE) & (shear <= high + TOLERANCE)
        if within.sum() > 1:
            out[f"shear_stiffness.{part}"] = numpy.polyfit(shear[within], stress[within], 1)[0]
    others = max(abs(states[name][-1]) for name in ("sigma_xy", "sigma_yz"))
    return out | {"other_shear_stress": float(others / abs(states["sigma_xz"][-1]))}


def bars_of(rves):
    """Error bars of the axial stress over its mean at a compression of STRAIN, and the strain over the imposed one."""
    out = {}
    for radius in BARS:
        of = rves["radius"] == radius
        imposed = abs(rves["imposed_zz"][of])
        at = nearest(imposed[: int(numpy.argmax(imposed)) + 1], STRAIN) if of.any() else None
        if at is None:
            continue
        out[f"error_bar_at_0.04.r{radius}"] = abs(rves["sigma_zz_error_bar"][of][at] / rves["sigma_zz"][of][at])
        if radius == RVE:
            out["strain_ratio_at_0.04"] = abs(rves["strain_zz"][of][at]) / imposed[at]
    return out


def stiffening(rves):
    """The slope of the axial stress over the RVEs' axial strain in the last quarter of the loading, over that in the
    second one."""
    of = rves["radius"] == RVE
    end = int(numpy.argmax(abs(rves["imposed_zz"][of]))) + 1
    strain, stress = (abs(rves[f"{name}_zz"][of][:end]) for name in ("strain", "sigma"))
    slopes = []
    for low, high in ((0.25, 0.5), (0.75, 1)):
        within = (strain >= low * strain.max() - TOLERANCE) & (strain <= high * strain.max() + TOLERANCE)
        slopes.append(numpy.polyfit(strain[within], stress[within], 1)[0] if within.sum() > 1 else math.nan)
    return {"rve_stiffening_late": float(slopes[1] / slopes[0])}


def strain_slopes(rves, component):
    """Slopes of the RVEs' strain over the imposed one, early and late."""
    of = rves["radius"] == RVE
    imposed, found = (abs(rves[f"{kind}_{component}"][of]) for kind in ("imposed", "strain"))
    loading = numpy.arange(len(imposed)) <= numpy.argmax(imposed)
    out = {}
    late = imposed >= SET - TOLERANCE
    for part, within in {"early": imposed <= SET + TOLERANCE, "middle": late & (imposed <= STRAIN + TOLERANCE),
                         "late": late}.items():
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
    if numbers.get("dem.contacts"):
        numbers["sliding_share"] = numbers["dem.sliding_contacts"] / numbers["dem.contacts"]
    numbers["time.cpu_s"] = record["cpu_seconds"]
    if states is not None:
        numbers |= shear_figures(states) if name.startswith("shear_") else compression_figures(states)
    if rves is not None:
        numbers |= strain_slopes(rves, "xz") if name.startswith("shear_") else (
            strain_slopes(rves, "zz") | bars_of(rves) | stiffening(rves))
    if height is not None:
        numbers["lid_height"] = height
    return {key: float(value) for key, value in numbers.items() if math.isfinite(value)}


def read_runs(listed):
    """The figures of the finished runs of a list by (name, number)."""
    folder, out = HERE / "states" / listed.stem, {}
    for run, *_ in read_list(listed)[1]:
        file, packed = folder / f"{run}.json", folder / f"{run}.h5.xz"
        if file.exists():
            tables = (folder / f"{run}.{table}.csv.xz" for table in ("states_of_realizations", "rve"))
            name, _, number = run.rpartition("-")
            out[name, number] = figures_of(name, json.loads(file.read_text()),
                                           *(read_columns(table) if table.exists() else None for table in tables),
                                           lid_height(packed) if packed.exists() else None)
    return out


def mean_of(figures, name, key, numbers):
    """The mean over packings, None where one lacks it."""
    values = [figures.get((name, number), {}).get(key) for number in numbers]
    return None if not values or None in values else float(numpy.mean(values))


def standard_error(values):
    return float(numpy.std(values, ddof=1) / math.sqrt(len(values)))


def collect(runs):
    """The joined summary of [(name, figures)]."""
    out = {}
    for name in {name for name, _ in runs}:
        of = [figures for run, figures in runs if run == name]
        out[f"ensemble.realizations.{name}"] = len(of)
        for key in set().union(*of):
            values = [figures[key] for figures in of if key in figures]
            out[f"{key}.{name}"] = float(numpy.mean(values))
            out[f"{key}.least.{name}"], out[f"{key}.most.{name}"] = min(values), max(values)
            if len(values) > 1:
                out[f"{key}.standard_error.{name}"] = standard_error(values)
    return out


def pairs_of(rows):
    """((key, name), (key, name), key of the pair, its name) of the rows that compare, with every change."""
    out = set()
    for row in rows:
        if row["study"] not in CAUSES or "from" not in row:
            continue
        for end in ("", *(f"_{change}" for change in CAUSES[row["study"]][1])):
            if "key" in row:
                first, second = (row["key"], row["from"] + end), (row["key"], row["to"] + end)
                out.add((first, second, f"{row['key']}.{second[1]}_{{}}_{first[1]}", ""))
            else:
                name = row["member"] + end
                out.add(((row["from"], name), (row["to"], name), f"{row['to']}_{{}}_{row['from']}", f".{name}"))
    return out


def paired(figures, pairs):
    """Differences and ratios of {(name, number of the packing): figures} over common packings, two at least."""
    out = {}
    for (from_key, from_name), (to_key, to_name), key, dot in pairs:
        both = [(of[from_key], figures[to_name, number][to_key]) for (name, number), of in figures.items()
                if name == from_name and from_key in of and to_key in figures.get((to_name, number), {})]
        if len(both) < 2:
            continue
        for word, values in (("less", [b - a for a, b in both]), ("over", [b / a for a, b in both])):
            out[f"{key.format(word)}{dot}"] = float(numpy.mean(values))
            if dot:
                out[f"{key.format(word)}.standard_error{dot}"] = standard_error(values)
            else:
                pair = f"{to_name}_{word}_{from_name}"
                out[f"{key.partition('.' + to_name)[0]}.standard_error.{pair}"] = standard_error(values)
                out[f"ensemble.realizations.{pair}"] = len(both)
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
    figures, ended = read_runs(listed), HERE / "states" / listed.stem
    cases = {case for name, _, case, _ in planned if (ended / f"{name}.json").exists()}
    if len(cases) != 1:
        fail(f"{listed}: found finished runs of {len(cases)} cases; allowed: one case")
    case, joined = cases.pop(), collect([(test, of) for (test, _), of in figures.items()])
    most = max(value for key, value in joined.items() if key.startswith("ensemble.realizations."))
    joined |= paired(figures, pairs_of(all_rows()))
    command = f"docs/reproduction/collect.py docs/reproduction/runs/{listed.name}"
    if given.name:
        command += f" --name {given.name}"
    joined |= {"case.name": case, "case.command": command, "version": tag, "ensemble.realizations": most}
    name = given.name or case
    file = HERE / "results" / f"{name}.json"
    if file.exists():
        joined |= {key: value for key, value in json.loads(file.read_text()).items() if key.startswith(KEPT)}
    write_file(file, (json.dumps(joined, indent=1, sort_keys=True) + "\n").encode())
    print(f"{name}.json: {len(figures)} of {len(planned)} runs")


if __name__ == "__main__":
    main()

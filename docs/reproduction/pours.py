#!/usr/bin/python3
"""What stored piles say of the dip: all pours, and piles of 800 grains of which one thing was changed.

    docs/reproduction/pours.py            table of all pours
    docs/reproduction/pours.py --write    puts those that only states are kept of into results/pours.json
    docs/reproduction/pours.py causes     table of the causes of runs/pile-causes.txt, of the piles that are there

Both read the states (states/*.h5.xz), or else results/*.json, and measure as heaps.py does: sigma_xx / sigma_yy on the
axis, shoulder less centre of the pressure in the windows of dip.difference, at the base (over rho g h) and a quarter of
the height above it (over that of the part above), volume fraction and slope. A cell is the mean over piles with its
standard error.

A pour: how many piles would bring the error of the difference to ERROR, and how many would see DIP, Roul's by his
constants, with a probability of POWER if there were none (two-sided, 5 %). A cause: its difference from the base, bold
beyond chance (Welch's t, two-sided, 5 %, Holm over the causes of a column), and the difference that as many piles could
have seen: with POWER at the first step of Holm's correction over all planned causes. The base of pressures and stresses
are all piles of BASE, that of volume fraction and slope those of the first one, which slept by the rules of the causes.

docs/images/pile_pours draws both. Needs h5py, numpy and scipy.
"""
import argparse
import io
import json
import lzma
import math
import pathlib
import sys

import h5py
import numpy
from scipy import stats

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE))
sys.path.insert(0, str(HERE / "runs"))

from heaps import AXIS, Heap  # noqa: E402
from next import read_list  # noqa: E402
from record import write_file  # noqa: E402
from summaries import Measured, Results, holm, two_sided  # noqa: E402

STATES = HERE / "states"
CAUSES = HERE / "runs/pile-causes.txt"
#: what, the files of its states, the study and member that results/ has it as. A file holds one pile or more.
POURS = (
    ("point source, 300 grains", ("pile-rest-300-awake",), ("pours", "point_300")),  # those asleep slept by older rules
    ("point source, 800 grains", ("pile-rest-800-awake", "pile-rest-800-sleeping", "memory/memory-800-*"),
     ("pours", "point_800")),
    ("point source, 2,000 grains", ("pile-point-source-2000", "piles/point-2000-*"), ("pours", "point_2000")),
    ("point source, 6,500 grains", ("piles/point-6500-*",), ("pours", "point_6500")),
    ("elliptic grains from a point, 800", ("memory/elliptic-800-*",), ("pours", "elliptic_800")),
    ("disks from a point, 2,000", ("disks/disks-2000-*",), ("pours", "disks_2000")),
    ("disks from a point in LAMMPS, 2,000", ("lammps/disks-2000-*",), ("pours", "lammps_disks_2000")),
    ("layers, 6,300 grains", ("pile-line-source",), ("pile-line-source", "")),
    ("shifted layers, 6,500 grains", ("pile-asymmetric-line",), ("pile-asymmetric-line", "")),
)
#: Studies and members of which results/ has the difference alone: states are lost or not kept. Other sleep: older rules.
RECORDED = (("equal disks from a point, 968", "liffman-dropped-grains", "equal_968"),
            ("equal disks with friction, 968", "liffman-dropped-grains", "coulomb_968"),
            ("disks of unlike radii, 968", "liffman-dropped-grains", "unlike_968"),
            ("disks of unlike radii with friction, 968", "liffman-dropped-grains", "coulomb_unlike_968"),
            ("equal disks with friction, free to roll, 968", "liffman-dropped-grains", "coulomb_free_968"),
            ("pentagons with friction, 968", "liffman-dropped-grains", "pentagons_968"),
            ("equal disks, Liffman's dynamics, 968", "liffman-dropped", "implicit"),
            ("equal disks with friction, Liffman's dynamics, 968", "liffman-dropped", "implicit_coulomb"),
            ("layers, 6,300 grains, that slept", "pile-line-source", "asked"),
            ("point source, 6,500 grains, other sleep", "pile-point-source", ""),
            ("elliptic grains from a point, 6,500, other sleep", "pile-elliptic", ""),
            ("moving point source, 6,500 grains, other sleep", "pile-asymmetric-point", ""))
BASE = ("memory/memory-800-*", "pile-rest-800-awake", "pile-rest-800-sleeping")
FIGURES = ("axis", "dip", "inside", "fraction", "slope")
OF_ALL_BASES = ("axis", "dip", "inside")
#: In the order of the list, as a reader says them.
WORDS = {"layers": "in horizontal layers", "friction_0.9": "friction 0.9 (0.54)",
         "follow": "source 2 diameters above the top", "equal": "equal sizes (± 30 %)",
         "fall": "from 0.5 m (0.25 m)", "broad": "source within ± 6 mean radii (± 0.5)",
         "corners_24": "24 corners (6 to 8)", "friction_0.3": "friction 0.3 (0.54)",
         "energy": "law `energy` (`overlap_area`)", "stiff": "grains ten times stiffer",
         "tangential_11": "tangential over normal stiffness 11 (2/7)"}
ERROR, AXIS_ROUL, POWER, LEVEL = 0.016, 0.77, 0.8, 0.05
DIP, DIP_ERROR = 0.08, 0.02  # Roul's, and the error of his nine piles if they scatter as ours of 6,500 grains
MOST_PILES = 10_000
LEAST, PLANNED = 3, 8  # piles below which nothing is said, and piles of a cause


def heaps_in(pattern, folder=STATES):
    """The heaps of the files of a pattern; one without slopes is told on standard error and left out."""
    for file in sorted(folder.glob(f"{pattern}.h5.xz")):
        with lzma.open(file) as packed, h5py.File(io.BytesIO(packed.read())) as states:
            for name in sorted(states):
                try:
                    yield Heap(states[name]["pile"])
                except (IndexError, ValueError) as error:
                    print(f"pours.py: {file.name}: {name}: no heap: {error}", file=sys.stderr)


def figures_of(heap):
    """FIGURES of a heap."""
    slopes = [math.degrees(math.atan(abs(line[0]))) for line in (heap.left, heap.right)]
    return (heap.axis_ratio(*AXIS), heap.dip(0), heap.dip(0.25), heap.fraction, sum(slopes) / 2)


def measured(patterns, folder=STATES):
    """FIGURES of all heaps of some patterns: {figure: an array}."""
    rows = [figures_of(heap) for pattern in patterns for heap in heaps_in(pattern, folder)]
    return dict(zip(FIGURES, numpy.array(rows).reshape(len(rows), len(FIGURES)).T))


def mean_of(values):
    """Mean and standard error over piles; no error of one pile."""
    count = len(values)
    error = values.std(ddof=1) / math.sqrt(count) if count > 1 else math.nan
    return Measured(float(values.mean()), float(error), count - 1)


def least_piles(enough):
    """The smallest number from 3 on for which a rule holds that holds from some number on; None above MOST_PILES."""
    if not enough(MOST_PILES):
        return None
    low, high = 2, MOST_PILES
    while high - low > 1:
        middle = (low + high) // 2
        low, high = (low, middle) if enough(middle) else (middle, high)
    return high


def piles_to_see(scatter, effect, level=LEVEL):
    """How many piles of this scatter see an effect against a known value, with POWER, two-sided."""
    return least_piles(lambda n: (stats.t.ppf(1 - level / 2, n - 1) + stats.t.ppf(POWER, n - 1)) * scatter
                       <= effect * math.sqrt(n))


def piles_for_error(scatter, error):
    return least_piles(lambda n: scatter <= error * math.sqrt(n))


def cell(found, digits=3, bold=False):
    text = f"{found.value:.{digits}f} ± {found.error:.{digits}f}"
    return f"**{text}**" if bold else text


def table(lines):
    lines = list(lines)
    lines.insert(1, ["---"] * len(lines[0]))
    return "".join(f"| {' | '.join(line)} |\n" for line in lines)


def pours(folder=STATES):
    """{what: FIGURES of its heaps} of the pours of which LEAST heaps are there, and of all from a point."""
    found = {what: measured(patterns, folder) for what, patterns, _ in POURS}
    return {what: one for what, one in found.items() if len(one["dip"]) >= LEAST}


def recorded_pours(results):
    """{what: shoulder less centre} of RECORDED."""
    found = {what: results.number(study, "dip.difference", member) for what, study, member in RECORDED}
    return {what: one for what, one in found.items() if one is not None}


def corrected(results):
    """{what: p over all pours} as reproduction.md has it, of the pours that results/ has."""
    names = {what: name for what, _, name in POURS} | {what: name for what, *name in RECORDED}
    judged = {(dip.study, dip.member): dip.p_holm for dip in results.dips()}
    return {what: judged[tuple(name)] for what, name in names.items() if tuple(name) in judged}


def write_measured(found, results=HERE / "results"):
    """Writes results/pours.json, the difference of every pour that only POURS has."""
    out = {}
    for what, _, name in POURS:
        if name[0] == "pours" and what in found:
            one = mean_of(found[what]["dip"])
            out |= {f"dip.difference.{name[1]}": one.value, f"dip.standard_error.{name[1]}": one.error,
                    f"ensemble.realizations.{name[1]}": one.freedom + 1}
    write_file(results / "pours.json", (json.dumps(out, indent=1) + "\n").encode())


def pours_table(found, recorded, judged):
    lines = [["pour", "piles", "σxx/σyy on the axis", "shoulder − centre (ρgh)", "a quarter of the height above",
              "p, no dip and no peak", "the same, Holm", f"piles for ± {ERROR}", f"piles that see {DIP}"]]
    dips = {what: mean_of(one["dip"]) for what, one in found.items()} | recorded
    for what, one in dips.items():
        p, corrected = two_sided(one), judged.get(what, math.nan)
        scatter = one.error * math.sqrt(one.freedom + 1)
        others = [cell(mean_of(found[what][figure])) if what in found else "" for figure in ("axis", "inside")]
        over_all = "not in results/" if math.isnan(corrected) else f"{corrected:.2g}"
        lines.append([what, f"{one.freedom + 1:g}", others[0], cell(one, bold=corrected < LEVEL), others[1], f"{p:.2g}",
                      over_all, str(piles_for_error(scatter, ERROR)), str(piles_to_see(scatter, DIP))])
    return table(lines)


def small_piles(found):
    """What all piles of at most 2,000 grains from a point say together, each counting as its scatter lets it, and the
    two-sided p of this if the truth is Roul's dip, whose error counts."""
    of = [mean_of(one["dip"]) for what, one in found.items()
          if what.startswith("point source") and "6,500" not in what]
    weights = numpy.array([one.error**-2 for one in of])
    value = float(weights @ [one.value for one in of] / weights.sum())
    error = float(weights.sum() ** -0.5)
    freedom = sum(one.freedom for one in of)
    away = abs(value - DIP) / math.hypot(error, DIP_ERROR)
    return Measured(value, error, freedom), float(2 * stats.t.sf(away, freedom))


def compared(cause, base):
    """The difference of a cause from the base by Welch, and its two-sided p."""
    by = mean_of(cause).less(mean_of(base))
    return by, float(2 * stats.t.sf(abs(by.value) / by.error, by.freedom))


def could_see(by, planned):
    """The difference that is seen with POWER at the first step of Holm's correction over planned causes."""
    return float((stats.t.ppf(1 - LEVEL / (2 * planned), by.freedom) + stats.t.ppf(POWER, by.freedom)) * by.error)


def causes(listed=CAUSES, folder=STATES):
    """What of the causes is there: base {figure: values}, {cause: {figure: values}} by the list, empty ones too."""
    names = list(dict.fromkeys(name.rpartition("-")[0] for name, *_ in read_list(listed)[1]))
    first, every = measured(BASE[:1], folder), measured(BASE, folder)
    base = {figure: (every if figure in OF_ALL_BASES else first)[figure] for figure in FIGURES}
    return base, {name: measured((f"{listed.stem}/{name}-*",), folder) for name in names}


def judged_causes(base, found):
    """{cause: {figure: (difference, p over all causes, what it could have seen)}}, of LEAST piles each."""
    out = {name: {} for name, one in found.items() if len(one["dip"]) >= LEAST}
    for figure in FIGURES:
        both = [compared(found[name][figure], base[figure]) for name in out]
        for name, (by, _), p in zip(out, both, holm([p for _, p in both])):
            out[name][figure] = (by, p, could_see(by, len(found)))
    return out


def causes_table(base, found):
    lines = [["one change", "piles", "σxx/σyy on the axis", "less the base", "it could see", "shoulder − centre (ρgh)",
              "less the base", "it could see", "volume fraction", "slope, °"]]
    lines.append(["base", str(len(base["dip"])), cell(mean_of(base["axis"])), "", "", cell(mean_of(base["dip"])),
                  "", "", cell(mean_of(base["fraction"]), 4), cell(mean_of(base["slope"]), 1)])
    judged = judged_causes(base, found)
    for name, one in found.items():
        words = WORDS.get(name, f"`{name}`")
        if name not in judged:
            lines.append([words, str(len(one["dip"])), "not run" if len(one["dip"]) == 0 else "too few", *[""] * 7])
            continue
        row = [words, str(len(one["dip"]))]
        for figure in ("axis", "dip"):
            by, p, seen = judged[name][figure]
            row += [cell(mean_of(one[figure])), cell(by, bold=p < LEVEL), f"{seen:.2f}"]
        row += [cell(mean_of(one[figure]), digits, judged[name][figure][1] < LEVEL)
                for figure, digits in (("fraction", 4), ("slope", 1))]
        lines.append(row)
    return table(lines)


def foresight(base, planned, piles=PLANNED):
    """What a cause of so many piles can see if they scatter as the base does: {figure: difference}."""
    out = {}
    for figure in ("axis", "dip"):
        one = mean_of(base[figure])
        of_piles = Measured(one.value, one.error * math.sqrt(len(base[figure]) / piles), piles - 1)
        out[figure] = could_see(of_piles.less(one), planned)
    return out


def main(words=None):
    options = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    options.add_argument("table", choices=("pours", "causes"), nargs="?", default="pours")
    options.add_argument("--write", action="store_true", help="write results/pours.json")
    given = options.parse_args(words)
    if given.table == "causes":
        base, found = causes()
        print(causes_table(base, found), end="")
        for piles in (PLANNED, 3 * PLANNED):
            seen = foresight(base, len(found), piles)
            print(f"\n{piles} piles of the base's scatter see differences of {seen['axis']:.2f} in σxx/σyy and "
                  f"{seen['dip']:.2f} ρgh.", end="")
        print()
        return 0
    found = pours()
    if given.write:
        write_measured(found)
    results = Results(HERE / "results")
    print(pours_table(found, recorded_pours(results), corrected(results)), end="")
    together, p = small_piles(found)
    print(f"\nAll piles of up to 2,000 grains from a point: {together.value:.3f} ± {together.error:.3f}; p = {p:.1g} "
          f"of a true difference of {DIP} ± {DIP_ERROR}")
    return 0


if __name__ == "__main__":
    sys.exit(main())

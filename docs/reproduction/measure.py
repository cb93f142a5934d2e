#!/usr/bin/python3
"""Measures on the states of finished runs what no summary has, and adds it to a stored summary.

    docs/reproduction/measure.py KIND STUDY FILE ... --member MEMBER

KEY.MEMBER in results/STUDY.json is the mean over the realizations of the file, KEY.standard_error.MEMBER
its error, ensemble.realizations.MEMBER their number. The keys, by what is measured (ADDED):

    angles    of the packing before it is loaded: angles.near_60 and angles.near_30 are the shares of the contact
              forces within NEAR of a multiple of 60 degrees, and of 30 degrees from the horizontal,
              angles.normals_near_60 and angles.normals_near_30 those of the contacts' normals,
              angles.strong_near_60 and angles.strong_near_30 those of the forces above the mean; angles.order is 1
              less the entropy of the forces' histogram (BINS over 180 degrees) over that of an even one
    gravity   of a heap under changed gravity, by the sum over contacts of force times branch: gravity.xx_ratio and
              gravity.yy_ratio are sigma at 20 m/s2 over that at 5; gravity.top_over_bottom is the mean
              displacement in the upper third of the height over that in the lower one at half of gravity
    forces    of a heap: forces.middle_over_surface is the mean contact force inside the middle half of the base,
              deeper than SKIN of the height, over that nearer to the surface; forces.centre_over_beside is the STRONG
              quantile of the forces in the lower half of the height within CENTRE half bases of the axis over
              that within BESIDE
    network   of a heap's, or layer's, grains with two contacts or more: network.components_over_equations is the number of force
              components, of which a sliding contact has one, over that of equations of equilibrium (isostatic: 1).
              network.g2 is tr F over nu c of the grains DEEP mean diameters from surface and floor, and
              network.g2_over_theory that over its value by the contacts that fit on a grain (Luding)
    poured    of heaps poured under 5 m/s2 and, in a second file, under 20: gravity.poured_xx_ratio and
              gravity.poured_yy_ratio, the mean of the second over that of the first, by the same sums
    strain    of layers, by a field of `grainfield strain` each, on one grid: strain.peaks is the largest number of
              peaks of the mean vertical strain at the depths DEPTHS, strain.width_ratio the width at the last over
              that at the first
    tails     of the packing of layers before it is loaded: how often forces n above their mean are, n the normal force
              of a contact between grains deeper than DEPTHS[0] of the layer, over a line fitted to all against the
              depth. With the share above n as exp(-c (n^a - 1)), n > 1, tails.exponent is a by maximum likelihood (1 of
              an exponential tail, 2 of a Gaussian one), of all layers together with its error by the jackknife;
              tails.rate is that of an exponential tail, 1 over the mean of n - 1
    pieces    of an ensemble of layers in pieces of equal size, by their profiles.csv: response.near_axis is the mean
              pressure on the base within AXIS of the depth about the load, response.largest the largest of the
              pieces' mean; errors by the scatter of the pieces. response.flamant_rel_l2 is the distance of that mean
              from the half plane's, as compare.flamant.base.rel_l2
    centre    of layers, by their profiles.csv: response.centre_over_largest is the pressure on the base below the load
              over the largest one
    fields    of heaps, by the maps of a fields.h5 of each: inside.bulk, inside.shear, inside.young, inside.poisson
              and inside.fabric_trace are the mean over the points of a column of the map that lie deeper than its
              middle over that of the others; curvature.bulk, curvature.shear and curvature.young are those of the
              constant against tr F over the points of the mean maps: the quadratic over the linear term at one
              standard deviation, its error by the jackknife; signed.cundall, signed.liao and signed.derivative are the sum of that vertical strain along the lowest
              row of the map over that of Cambou's
    stiffness  of heaps, by a fields.h5 for each heap and level of gravity, in folders NAME-HEAP: how well a power law of
              tr F, of the mean stress, of the volume fraction and of all three predicts K of the heaps left out:
              stiffness.fabric, stiffness.pressure, stiffness.density and stiffness.all are the share of the variance of
              log K over the points of the heap left out that the law of the others explains, mean over heaps (below 0:
              worse than the mean of the others); stiffness.fabric_less_pressure is a difference of two
    rve       of heaps, by the summary.json of a run of all and of a run without each of them: the grains that an RVE
              needs, rve_size.*_grains, with the .least and the .most without one heap
    base      of a lattice pile, by its profiles.csv, over the base disks between the bends of the line model's H (57),
              |x| < h/sqrt 3: base.horizontal_off_line and base.normal_off_mean are the largest distance of H from its
              straight line by least squares and of N from its mean, over the largest H and N of all base disks;
              base.horizontal_explained the share of H's variance that the line explains, base.horizontal_slope its
              slope over the line model's. N and H of every base disk, and those of lattice and lines, go into
              results/STUDY.base.MEMBER.csv, in m g
    heap      of heaps, by their states (heaps.py): levels.H.dip is shoulder less centre of the vertical pressure at
              these LEVELS of the height, in the windows of the dip and over rho g h of the part above; axis.whole is
              sigma_xx over sigma_yy on the axis in the window of axis.stress_ratio, axis.low and axis.high in its halves;
              density.circles is the density on the axis over that of circles that touch the surface from inside,
              density.cut_circles over that of circles of which a part of half a radius is outside; axes.A_less_B_deg
              are mean angles between the axes of the fabric along branches, of that along normals and of the stress
              in the two lowest rows, the left half mirrored, and axes.A_deg those axes, from the horizontal, the
              stress's of the greatest compression: the axis of a right half that falls outwards is below 0; with a
              state gravity_G also those of the strain, by Cambou; axes.stress_core_deg and axes.stress_flank_deg are the
              stress's in CORE half bases of the apex and beyond FLANK half bases
    memory    of heaps with states poured_N: memory.turned_deg, memory.early_deg, memory.late_deg and
              memory.correlation are what grains keep of their stress since they were buried (heaps.py, remembered),
              mean over these states
    roul_fit  of heaps, by their states: Cantelaube's constants as Roul fits them (roul_fit.py), with the friction
              angle --phi
    summary   of another run of the study, by its summary.json or its record NAME.json in states/: the keys that begin
              with those of --keys; with response. among them response.one_peak_to, the share of the depth down to
              which every profile has one peak

Needs h5py, numpy and scipy.
"""
import argparse
import csv
import json
import math
import pathlib
import re
import sys

import h5py
import numpy
from scipy.optimize import brentq
from scipy.signal import find_peaks

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE))

from heaps import AXIS as AXIS_WINDOW, RVE, Heap, angle_deg, remembered  # noqa: E402
from record import read_text, write_file  # noqa: E402
from roul_fit import FIGURES as FITTED, figures as fitted_as_roul  # noqa: E402

LEVELS = (0, 0.1, 0.25, 0.5)
CORE, FLANK = (0.1, 0.2), 0.4  # nearer to the axis both halves mix
TENSORS = ("branch", "normal", "stress", "strain")
PAIRS = (("branch", "stress"), ("normal", "stress"), ("branch", "normal"), ("strain", "stress"))
LAWS = {"fabric": [0], "pressure": [1], "density": [2], "all": [0, 1, 2]}  # of the columns of samples_of()
REMEMBERED = ("turned_deg", "early_deg", "late_deg", "correlation")
CONSTANTS = ("bulk", "shear", "young")
ADDED = ("angles.near_60", "angles.near_30", "angles.normals_near_60", "angles.normals_near_30", "angles.order",
         "angles.strong_near_60", "angles.strong_near_30", "response.near_axis", "response.largest",
         "response.flamant_rel_l2", "response.centre_over_largest", "response.one_peak_to",
         "network.components_over_equations", "network.g2", "network.g2_over_theory",
         "gravity.xx_ratio", "gravity.yy_ratio", "gravity.top_over_bottom", "gravity.poured_xx_ratio",
         "gravity.poured_yy_ratio", "forces.middle_over_surface", "forces.centre_over_beside", "strain.peaks",
         "strain.width_ratio", *(f"inside.{name}" for name in ("bulk", "shear", "young", "poisson", "fabric_trace")),
         *(f"base.{name}" for name in ("horizontal_off_line", "normal_off_mean", "horizontal_explained",
                                       "horizontal_slope")),
         *(f"curvature.{name}" for name in CONSTANTS), *(f"levels.{level}.dip" for level in LEVELS), "axis.whole",
         "axis.low", "axis.high", "density.circles", "density.cut_circles", *(f"axes.{name}_deg" for name in TENSORS),
         *(f"axes.{a}_less_{b}_deg" for a, b in PAIRS), *(f"roul_fit.{name}" for name in FITTED),
         *(f"memory.{name}" for name in REMEMBERED), "tails.exponent", "tails.rate", "axes.stress_core_deg",
         "axes.stress_flank_deg", *(f"stiffness.{name}" for name in LAWS),
         "stiffness.fabric_less_pressure",
         *(f"signed.{name}" for name in ("cundall", "liao", "derivative")))
NEAR = 5.0  # degrees
BINS = 36
SKIN, CENTRE, BESIDE, STRONG = 0.2, 0.1, (0.15, 0.4), 0.95
DEPTHS = (0.25, 0.5, 0.75)
AXIS = 0.25
DEEP = 2


def order(angles):
    """1 less the entropy of a histogram of angles (degrees, modulo 180) over that of an even one.

    The entropy of a sample is too small by (occupied bins - 1) / (2 N) (Miller), which is added.
    """
    share = numpy.histogram(angles % 180, BINS, (0, 180))[0] / len(angles)
    share = share[share > 0]
    entropy = (len(share) - 1) / (2 * len(angles)) - float(share @ numpy.log(share))
    return 1 - entropy / math.log(BINS)


def near(angles, directions):
    """Share of angles within NEAR of one of the directions, all in degrees and modulo 180."""
    away = abs((angles[:, None] - numpy.array(directions) + 90) % 180 - 90)
    return float((away.min(axis=1) <= NEAR).mean())


def angles_of(run):
    """Figures of the directions of the forces between grains."""
    state = run["unloaded"]["contacts"]
    size = numpy.linalg.norm(state["force"][:], axis=1)
    bears = (state["j"][:].astype(int) >= 0) & (size > 0)
    strong = size[bears] > size[bears].mean()
    angles, normals = (numpy.degrees(numpy.arctan2(state[name][:][bears, 1], state[name][:][bears, 0]))
                       for name in ("force", "normal"))
    return {"angles.near_60": near(angles, (0, 60, 120)), "angles.near_30": near(angles, (30, 150)),
            "angles.normals_near_60": near(normals, (0, 60, 120)),
            "angles.normals_near_30": near(normals, (30, 150)), "angles.order": order(angles),
            "angles.strong_near_60": near(angles[strong], (0, 60, 120)),
            "angles.strong_near_30": near(angles[strong], (30, 150))}


def stress_sums(state):
    """The sums over the contacts of a heap of f_x l_x and f_y l_y, l the branch."""
    contacts, places = state["contacts"], state["grains/position"][:]
    i, j = contacts["i"][:].astype(int), contacts["j"][:].astype(int)
    other = numpy.where((j >= 0)[:, None], places[j], contacts["point"][:])  # a wall's j is negative
    return (contacts["force"][:] * (places[i] - other)).sum(axis=0)


def gravity_of(run):
    """Stresses and displacements of a heap under changed gravity."""
    low, high = stress_sums(run["gravity_5"]), stress_sums(run["gravity_20"])
    before, after = (run[name]["grains/position"][:] for name in ("pile", "gravity_4.905"))
    moved, height = numpy.linalg.norm(after - before, axis=1), before[:, 1] - before[:, 1].min()
    third = height.max() / 3
    return {"gravity.xx_ratio": high[0] / low[0], "gravity.yy_ratio": high[1] / low[1],
            "gravity.top_over_bottom": moved[height > 2 * third].mean() / moved[height < third].mean()}


def surface(places):
    """The height of the surface above every grain: the highest grain of its column."""
    column = ((places[:, 0] - places[:, 0].min()) / (numpy.ptp(places[:, 0]) / 60)).astype(int)
    highest = numpy.full(column.max() + 1, -numpy.inf)
    numpy.maximum.at(highest, column, places[:, 1])
    return highest[column]


def forces_of(run):
    """Where in a heap the contact forces are large."""
    contacts, places = run["pile/contacts"], run["pile/grains/position"][:]
    i, force = contacts["i"][:].astype(int), contacts["normal_force"][:]
    off = abs(places[:, 0] - places[:, 0].mean())
    off = off[i] / (3 * off.mean())  # the mean of a triangle is a third of its half base
    height = numpy.ptp(places[:, 1])
    deep = (surface(places) - places[:, 1])[i] >= SKIN * height
    low = (places[:, 1] - places[:, 1].min())[i] < height / 2
    centre, beside = (numpy.quantile(force[low & part], STRONG)
                      for part in (off < CENTRE, (off > BESIDE[0]) & (off < BESIDE[1])))
    return {"forces.middle_over_surface": force[deep & (off < 0.5)].mean() / force[~deep].mean(),
            "forces.centre_over_beside": centre / beside}


def network_of(run):
    """How many forces hold a heap or a layer, and how the contacts of a heap's grains grow with their size.

    A contact without friction has one component, and a disk without any two equations: none of its forces turns it.
    """
    state = run["pile"] if "pile" in run else run["unloaded"]
    contacts, volumes, places = state["contacts"], state["grains/volume"][:], state["grains/position"][:]
    i, j, sliding = (contacts[name][:].astype(int) for name in ("i", "j", "sliding"))
    bears = contacts["normal_force"][:] > 0

    def numbers(of):
        ends = numpy.concatenate((i[of], j[of & (j >= 0)]))
        return numpy.bincount(ends, minlength=len(volumes))

    left = bears
    while True:  # without grains of one contact, and those that this leaves with one
        alive = numbers(left) >= 2
        less = left & alive[i] & ((j < 0) | alive[j])
        if less.sum() == left.sum():
            break
        left = less
    rough = left & (contacts["friction"][:] > 0)
    components = left.sum() + (rough & (sliding == 0)).sum()
    turned = alive & ((numbers(rough) > 0) | ("grains/outline" in state))
    found = {"network.components_over_equations": components / (2 * alive.sum() + turned.sum())}
    if "pile" not in run:
        return found
    radii = numpy.sqrt(volumes / math.pi)
    skin = 2 * DEEP * radii.mean()
    deep = (surface(places) - places[:, 1] > skin) & (places[:, 1] - places[:, 1].min() > skin)
    if not deep.any():
        return found
    cover = 1 / numpy.arcsin(1 / (1 + radii[deep] / radii[deep].mean()))
    measured, theory = (float(volumes[deep] @ one / volumes[deep].sum() / one.mean())
                        for one in (numbers(bears)[deep], cover))
    return found | {"network.g2": measured, "network.g2_over_theory": measured / theory}


def heap_of(run):
    """Dips and stresses at levels, density by circles and axes of fabric and stress of a heap."""
    heap = Heap(run["pile"])
    low, high = AXIS_WINDOW
    middle = (low + high) / 2
    lower = [name for name in run if name.startswith("gravity_")]
    axes = heap.deviators(moved=run[lower[0]]["grains/position"][:][:, :2] if lower else None)
    return ({f"levels.{level}.dip": heap.dip(level) for level in LEVELS}
            | {"axis.whole": heap.axis_ratio(low, high), "axis.low": heap.axis_ratio(low, middle), "axis.high": heap.axis_ratio(middle, high),
               "density.circles": heap.density_ratio(RVE), "density.cut_circles": heap.density_ratio(RVE / 2)}
            | {f"axes.{a}_less_{b}_deg": angle_deg(axes[a], axes[b]) for a, b in PAIRS
               if a in axes}
            | {f"axes.{name}_deg": angle_deg(axes[name]) for name in TENSORS if name in axes}
            | {"axes.stress_core_deg": angle_deg(axes["stress"][(axes["x"] >= CORE[0]) & (axes["x"] < CORE[1])]),
               "axes.stress_flank_deg": angle_deg(axes["stress"][axes["x"] >= FLANK])})


def memory_of(run):
    """What the grains of a heap remember, mean over the states that were left while it grew."""
    late = Heap(run["pile"])
    found = [remembered(Heap(run[name]), late) for name in run if name.startswith("poured_")]
    return {f"memory.{name}": float(numpy.mean([one[name] for one in found])) for name in REMEMBERED}


def peaks(values):
    """Number of maxima of at least half of the largest value that rise by a tenth of it."""
    return len(find_peaks([0.0, *values, 0.0], height=values.max() / 2, prominence=values.max() / 10)[0])


def width(places, values):
    """Distance of the outermost crossings of half of the largest value, or of the ends that are above it."""
    half, above = values.max() / 2, numpy.flatnonzero(values >= values.max() / 2)
    first, last = above[0], above[-1]
    left = numpy.interp(half, values[first - 1:first + 1], places[first - 1:first + 1]) if first > 0 else places[0]
    right = numpy.interp(-half, -values[last:last + 2], places[last:last + 2])
    return right - left


def read_table(file):
    """The rows of a table: {column without its unit: number or text}."""
    lines = [line for line in read_text(file).splitlines() if not line.startswith("#")]
    return [{re.sub(r" \(.*|_(m|N/m)$", "", name): value if name == "profile" else float(value or "nan")
             for name, value in row.items()} for row in csv.DictReader(lines)]


def line_at(table, depth):
    """Places and vertical compression along the row of a field that is nearest to this part of its depth."""
    heights = numpy.array([row["y"] for row in table])
    height = heights[numpy.argmin(abs(heights - depth * heights.min()))]
    return numpy.array(sorted((row["x"], -row["strain_yy"]) for row in table
                              if row["y"] == height and math.isfinite(row["strain_yy"]))).T


def strain_of(files):
    """Peaks and widths of the mean vertical strain of loaded layers, by the tables of their fields."""
    tables = [read_table(file) for file in files]
    found = []
    for depth in DEPTHS:
        lines = [line_at(table, depth) for table in tables]
        x = lines[0][0]
        values = numpy.mean([numpy.interp(x, *line) for line in lines], axis=0)
        found.append((peaks(values), width(x, values)))
    return {"ensemble.realizations": len(files), "strain.peaks": max(n for n, _ in found),
            "strain.width_ratio": found[-1][1] / found[0][1]}


def base_of(file):
    """The rows of a profiles.csv on the base, and the number of its realizations."""
    record = json.loads(file.with_name(re.sub(r"\.profiles\.csv(\.xz)?$", ".json", file.name)).read_text())
    return ([row for row in read_table(file) if row["profile"] == "base"],
            record["summary"]["ensemble.realizations"])


def column(rows, name):
    return numpy.array([row[name] for row in rows])


def pieces_of(files):
    """The response on the base of the layers of all pieces, and how many they are."""
    bases, counts = zip(*map(base_of, files))
    if len(set(counts)) != 1:
        raise ValueError("pieces of unlike size")
    x = column(bases[0], "x")
    near_axis = abs(x) <= AXIS * bases[0][0]["depth"]
    values = numpy.array([numpy.interp(x, column(base, "x"), column(base, "simulation")) for base in bases])
    mean = values.mean(axis=0)
    out = summarized([{"response.near_axis": one[near_axis].mean(), "response.largest": one[mean.argmax()]}
                      for one in values])
    away = mean - numpy.mean([numpy.interp(x, column(base, "x"), column(base, "flamant")) for base in bases], axis=0)
    out["response.flamant_rel_l2"] = float(math.sqrt((away @ away) / (mean @ mean)))
    return out | {"ensemble.realizations": sum(counts), "ensemble.pieces": len(files)}


def centre_of(file):
    """The pressure on the base below the load over the largest one."""
    base, count = base_of(file)
    x, values, errors = (column(base, name) for name in ("x", "simulation", "standard_error"))
    at, largest = abs(x).argmin(), values.argmax()
    out = {"ensemble.realizations": count, "response.centre_over_largest": float(values[at] / values[largest])}
    if math.isfinite(errors[at]) and at != largest:
        share = out["response.centre_over_largest"]
        out["response.centre_over_largest.standard_error"] = float(
            math.hypot(errors[at], share * errors[largest]) / values[largest])
    return out


def lattice_base(file):
    """The base disks of a lattice pile: x over the base, N and H in m g of grains, lattice and lines; the share of
    the half base within which the line model's H is straight."""
    head = file.read_text().partition("\n")[0]
    height, spacing, weight = (float(re.search(f"{name} ([0-9.e+-]+) {unit}", head)[1])
                               for name, unit in (("h =", "m,"), ("spacing", "m,"), ("m g =", "N;")))
    rows = read_table(file)
    normal, shear = ([row for row in rows if row["profile"] == name] for name in ("base", "base sigma_xy"))
    out = {"x": column(normal, "x") / (len(normal) * spacing)}
    for name, of in (("N", normal), ("H", shear)):
        for model in ("simulation", "lattice", "liffman"):
            out[name if model == "simulation" else f"{name}_{model}"] = column(of, model) * spacing / weight
    return out, height / math.sqrt(3) / (len(normal) * spacing)


def straightness(base, within):
    """How straight H and how even N are in the middle of the base."""
    middle = abs(base["x"]) < within
    x, h, n = (base[name][middle] for name in ("x", "H", "N"))
    line = numpy.polyfit(x, h, 1)
    off = h - numpy.polyval(line, x)
    return {"base.horizontal_off_line": float(abs(off).max() / abs(base["H"]).max()),
            "base.horizontal_explained": float(1 - off @ off / ((h - h.mean()) @ (h - h.mean()))),
            "base.horizontal_slope": float(line[0] / numpy.polyfit(x, base["H_liffman"][middle], 1)[0]),
            "base.normal_off_mean": float(abs(n - n.mean()).max() / base["N"].max())}


def base_table(base):
    """The base disks as CSV."""
    lines = [",".join(base)]
    lines += [",".join(f"{value:.6g}" for value in row) for row in zip(*base.values())]
    return "\n".join(lines) + "\n"


def forces_over_mean(run):
    """The normal forces between grains deeper than DEPTHS[0] of a layer over their mean at each depth."""
    grains, contacts = run["unloaded/grains"], run["unloaded/contacts"]
    heights, radii = grains["position"][:][:, 1], grains["radius"][:]
    top, bottom = numpy.quantile(heights + radii, 0.98), (heights - radii).min()
    depth = (top - contacts["point"][:][:, 1]) / (top - bottom)
    force = contacts["normal_force"][:]
    chosen = (contacts["j"][:].astype(int) >= 0) & (force > 0) & (depth > DEPTHS[0])
    depth, force = depth[chosen], force[chosen]
    return force / numpy.polyval(numpy.polyfit(depth, force, 1), depth)


def tail_exponent(n):
    """a of exp(-c (n^a - 1)), the share above n of the numbers above 1, by maximum likelihood."""
    n = n[n > 1]
    logs = numpy.log(n)

    def slope(a):  # of the likelihood, at the best c
        powers = n**a
        return 1 / a + logs.mean() - (powers * logs).sum() / (powers - 1).sum()

    return float(brentq(slope, 0.05, 20))


def tails_of(layers):
    """The figures of `tails`, of the forces over their mean of each layer."""
    out = summarized([{"tails.rate": 1 / (n[n > 1] - 1).mean()} for n in layers])
    left = numpy.array([tail_exponent(numpy.concatenate(layers[:k] + layers[k + 1:])) for k in range(len(layers))])
    error = math.sqrt((len(left) - 1) * ((left - left.mean()) ** 2).mean())
    return out | {"tails.exponent": tail_exponent(numpy.concatenate(layers)), "tails.exponent.standard_error": error}


def inside(points, values):
    """Mean of the values in the lower half of every column of points over that in the upper one."""
    known = numpy.isfinite(values)
    (x, y), values = points[known].T, values[known]
    column = numpy.round(x / (numpy.ptp(x) / 1000)).astype(int)
    deep = numpy.array([at < (y[column == one].min() + y[column == one].max()) / 2 for at, one in zip(y, column)])
    return float(values[deep].mean() / values[~deep].mean())


def inside_of(fields):
    """How the constants and the fabric of a heap change from the surface inwards, and with one another."""
    constants, fabric = fields["elastic_constants"], fields["fabric"]
    trace = fabric["value/fabric_trace"][:]
    out = {f"inside.{name}": inside(constants["points"][:], constants["value"][name][:])
           for name in ("bulk", "shear", "young", "poisson")}
    cambou = fields["strain_cambou"]
    out |= {f"signed.{name}": along_base(cambou["points"][:], fields[f"strain_{name}/value/strain_yy"][:],
                                         cambou["value/strain_yy"][:]) for name in ("cundall", "liao", "derivative")}
    return out | {"inside.fabric_trace": inside(fabric["points"][:], trace)}


def curvature(places, values):
    """The quadratic over the linear term of values against places, by least squares, at one standard deviation."""
    known = numpy.isfinite(places) & numpy.isfinite(values)
    at = (places[known] - places[known].mean()) / places[known].std()
    quadratic, linear, _ = numpy.polyfit(at, values[known], 2)
    return float(quadratic / linear)


def curvatures(maps):
    """The curvatures of the constants against tr F, the first of the maps, over the points that all heaps have."""
    def of(some):
        mean = some.mean(axis=0)
        return numpy.array([curvature(mean[0], one) for one in mean[1:]])

    heaps = len(maps)
    left = numpy.array([of(numpy.delete(maps, one, axis=0)) for one in range(heaps)])
    errors = numpy.sqrt((heaps - 1) * ((left - left.mean(axis=0)) ** 2).mean(axis=0))
    out = {}
    for name, value, error in zip(CONSTANTS, of(maps), errors):
        out[f"curvature.{name}"], out[f"curvature.{name}.standard_error"] = float(value), float(error)
    return out


def samples_of(fields):
    """log of tr F, of the mean stress, of the volume fraction and of K at the points that have all four."""
    fabric, density = fields["fabric/value"], fields["density/value/volume_fraction"][:]
    pressure = -(fabric["sigma_xx"][:] + fabric["sigma_yy"][:]) / 2
    columns = numpy.array([fabric["fabric_trace"][:], pressure, density, fields["elastic_constants/value/bulk"][:]])
    with numpy.errstate(invalid="ignore"):
        known = (numpy.isfinite(columns) & (columns > 0)).all(axis=0)
    return numpy.log(columns[:, known])


def explained(heaps, columns):
    """For every heap the share of the variance of its log K that a power law fitted to the other heaps explains.

    heaps: samples_of() of each; columns: those that the law takes."""
    out = []
    for k, own in enumerate(heaps):
        others = numpy.concatenate(heaps[:k] + heaps[k + 1:], axis=1)

        def matrix(samples):
            return numpy.stack([numpy.ones(samples.shape[1]), *samples[columns]], axis=1)

        law, *_ = numpy.linalg.lstsq(matrix(others), others[3], rcond=None)
        miss = ((own[3] - matrix(own) @ law) ** 2).sum()
        out.append(1 - miss / ((own[3] - own[3].mean()) ** 2).sum())
    return out


def stiffness_of(files):
    """The figures of `stiffness`; files of one heap have the same number at the end of their folder's name."""
    of_heaps = {}
    for file in files:
        with h5py.File(file) as fields:
            of_heaps.setdefault(re.search(r"-(\d+)$", file.parent.name)[1], []).append(samples_of(fields))
    heaps = [numpy.concatenate(levels, axis=1) for levels in of_heaps.values()]
    shares = {name: explained(heaps, columns) for name, columns in LAWS.items()}
    found = [{f"stiffness.{name}": shares[name][k] for name in LAWS} for k in range(len(heaps))]
    for one in found:
        one["stiffness.fabric_less_pressure"] = one["stiffness.fabric"] - one["stiffness.pressure"]
    return summarized(found)


def sizes_of(every, *without_one):
    """The sizes that an RVE needs by all heaps, and by all but one."""
    out = {"ensemble.realizations": every["ensemble.realizations"]}
    for key in (f"rve_size.{name}_grains" for name in ("stress", "strain", "fabric")):
        found = [summary[key] if summary[key] is not None else math.inf for summary in without_one]
        out |= {key: every[key], f"{key}.least": min(found), f"{key}.most": max(found)}
    return out


def along_base(points, values, others):
    """The sum of the values of the lowest row of points over that of the others, where both are known."""
    known = numpy.isfinite(values) & numpy.isfinite(others)
    low = known & (points[:, 1] == points[known, 1].min())
    return float(values[low].sum() / others[low].sum())


def summarized(found):
    """The mean, its standard error and the number of realizations of the figures of realizations."""
    out = {"ensemble.realizations": len(found)}
    for key in found[0]:
        values = numpy.array([one[key] for one in found], dtype=float)
        out[key] = float(values.mean())
        if len(values) > 1:
            out[f"{key}.standard_error"] = float(values.std(ddof=1) / math.sqrt(len(values)))
    return out


def poured(low, high):
    """The ratios of the stresses of heaps poured under two gravities, with the errors of independent ensembles."""
    out = {}
    for axis, name in ((0, "xx"), (1, "yy")):
        (a, a_error), (b, b_error) = (
            (values.mean(), values.std(ddof=1) / math.sqrt(len(values)))
            for values in (numpy.array([one[axis] for one in sums]) for sums in (low, high)))
        out[f"gravity.poured_{name}_ratio"] = float(b / a)
        out[f"gravity.poured_{name}_ratio.standard_error"] = float(b / a * math.hypot(a_error / a, b_error / b))
    return out | {"ensemble.realizations": min(len(low), len(high))}


def of_summary(summary, beginnings):
    """The keys of a summary, or of a record of runs/next.py, that begin with one of these, and the number of
    realizations."""
    summary = summary.get("summary", summary)
    out = {key: value for key, value in summary.items() if key.startswith((*beginnings, "ensemble.realizations"))}
    return out | one_peak_to(summary) if "response." in beginnings else out


def one_peak_to(summary):
    """The share of the depth down to which the profiles have one peak; 0 where the first one has more."""
    found = {float(key.split("depth_")[1].removesuffix(".peaks")): value for key, value in summary.items()
             if key.startswith("response.depth_") and key.endswith(".peaks")}
    found[1.0] = summary["response.peaks"]
    reached = 0.0
    for depth in sorted(found):
        if found[depth] != 1:
            break
        reached = depth
    return {"response.one_peak_to": reached}


def with_keys(text, added):
    """A summary, one key a line, with these in it; its other lines as they are. Refuses another form."""
    lines = [line.rstrip(",") for line in text.splitlines()[1:-1]]
    if len(lines) != len(json.loads(text)):
        raise ValueError("a summary with other than one key a line")
    lines = [line for line in lines if line.split('"')[1] not in added]
    lines += [f"  {json.dumps(key)}: {json.dumps(value)}" for key, value in added.items()]
    return "{\n" + ",\n".join(lines) + "\n}\n"


def figures(kind, files, keys, phi_deg=None):
    """What is added to the summary, without its member."""
    if kind == "summary":
        return of_summary(json.loads(files[0].read_text()), keys)
    if kind == "fields":
        found, maps = [], []
        for file in files:
            with h5py.File(file) as fields:
                found.append(inside_of(fields))
                maps.append([fields["fabric/value/fabric_trace"][:],
                             *(fields["elastic_constants/value"][name][:] for name in CONSTANTS)])
        return summarized(found) | curvatures(numpy.array(maps))
    if kind == "roul_fit":
        heaps = []
        for file in files:
            with h5py.File(file) as states:
                heaps += [Heap(states[name]["pile"]) for name in sorted(states)]
        return fitted_as_roul(heaps, phi_deg)
    if kind == "stiffness":
        return stiffness_of(files)
    if kind == "tails":
        with h5py.File(files[0]) as states:
            return tails_of([forces_over_mean(states[name]) for name in sorted(states)])
    if kind == "rve":
        return sizes_of(*(json.loads(file.read_text()) for file in files))
    if kind == "base":
        return {"ensemble.realizations": 1} | straightness(*lattice_base(files[0]))
    if kind in ("strain", "pieces", "centre"):
        return {"strain": strain_of, "pieces": pieces_of, "centre": lambda found: centre_of(found[0])}[kind](files)
    found = []
    for file in files:
        of = {"angles": angles_of, "gravity": gravity_of, "forces": forces_of, "network": network_of, "heap": heap_of, "memory": memory_of,
              "poured": lambda run: stress_sums(run["pile"])}[kind]
        with h5py.File(file) as states:
            found.append([of(states[name]) for name in sorted(states)])
    return poured(*found) if kind == "poured" else summarized(sum(found, []))


def main():
    options = argparse.ArgumentParser(description="Measures on states what no summary has.")
    options.add_argument("kind", choices=("angles", "gravity", "forces", "network", "poured", "fields", "strain",
                                          "pieces", "centre", "rve", "base", "summary", "heap", "memory",
                                          "roul_fit", "stiffness", "tails"))
    options.add_argument("study", help="results/STUDY.json takes the keys")
    options.add_argument("file", type=pathlib.Path, nargs="+")
    options.add_argument("--member", required=True, help="ends the keys")
    options.add_argument("--keys", nargs="+", default=[], help="of a summary: the keys' beginnings")
    options.add_argument("--phi", type=float, help="of roul_fit: the friction angle, degrees")
    given = options.parse_args()
    if (given.phi is None) == (given.kind == "roul_fit"):
        options.error("--phi is the friction angle of roul_fit")
    stored = HERE / "results" / f"{given.study}.json"
    added = {f"{key}.{given.member}": value for key, value in figures(given.kind, given.file, given.keys, given.phi).items()}
    write_file(stored, with_keys(stored.read_text(), added).encode())
    if given.kind == "base":
        table = base_table(lattice_base(given.file[0])[0])
        write_file(HERE / "results" / f"{given.study}.base.{given.member}.csv", table.encode())
    print(stored)


if __name__ == "__main__":
    main()

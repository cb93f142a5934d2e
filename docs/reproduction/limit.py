#!/usr/bin/python3
"""Prints the tables of docs/cases/boussinesq-limit.md, boussinesq-limit-tables.md and the pentagons of
point-load-packings.md, or puts them into the pages, and draws the picture.

    docs/reproduction/limit.py [--write] [--picture PICTURE] [--states FOLDER]

Reads the runs of the LISTS in states/boussinesq/ and states/boussinesq-space/ (runs/next.py computes them): the
figures in NAME.json, and on the axis NAME.profiles.csv.xz where it is kept. What they lack is taken from LATER runs of the
same layers. A misfit is the root of the squared distance of the grains' mean from a prediction less the variance of
that mean, over the root of the squared prediction; where it is within its noise, "<" and the upper end of 95 % stand
for it. "–" has not run.
--write replaces the tables of the pages that have the same heads. Needs gnuplot for the picture.
"""
import argparse
import csv
import json
import math
import pathlib
import re
import sys

from scipy import stats

HERE = pathlib.Path(__file__).resolve().parent
sys.path[:0] = [str(HERE), str(HERE / "runs"), str(HERE.parent / "images")]

from gnuplot import block, draw  # noqa: E402
from next import fail, read_list  # noqa: E402
from record import read_text, write_file  # noqa: E402
from tables import line, put, table  # noqa: E402

PAGE = HERE.parent / "cases" / "boussinesq-limit.md"
DETAILS = PAGE.with_name("boussinesq-limit-tables.md")
PACKINGS = PAGE.with_name("point-load-packings.md")
ISOTROPIC = HERE / "results" / "point-load-pentagons.profiles.md"  # has the isotropic layer, smooth base
LISTS = ("boussinesq", "boussinesq-space")
LATER = "boussinesq-centres"
ROUGH = "rough"  # the base on which no contact slides
HOMOGENEOUS, BY_DEPTH = f"homogeneous_{ROUGH}", f"by_depth_{ROUGH}"
#: Layers that end at the centres of the loaded grains; the whole layer, with the load as deep as these.
ONE_CENTRES, CENTRES, INSIDE = "homogeneous_centres", "by_depth_centres", "by_depth_inside"
REGIONS = {"base": "on the base", "axis": "on the axis", "all": "of all profiles"}
AT = 0.25  # of the depth: where the axis is looked at
RIGHT = (2, 5, 10, 20)  # %
SPACE = ("superellipsoids", "spheres")  # shapes of the grains that variants are named by
#: Drawn models, with what the picture calls them.
DRAWN = {HOMOGENEOUS: ("#8a8a8a", "one stiffness"), BY_DEPTH: ("#c5502f", "stiffness by depth"),
         ONE_CENTRES: ("#1a5fa8", "one stiffness, layer to the centres of the loaded grains")}
SHAPES = {"disk": "disks", "superellipsoid": "superellipsoids", "regular": "regular polygons", "irregular": "pentagons"}  # by packing.shape
#: Drawn layers: gnuplot's points by shape and friction.
POINTS = {("disks", 0.0): 6, ("disks", 0.2): 4, ("disks", 0.5): 7, ("disks", 1.0): 9, ("spheres", 0.5): 5,
          ("superellipsoids", 0.5): 13}


class Run:
    """A finished run: its figures, what its settings say, and its axis."""

    def __init__(self, folder, name, settings):
        record = json.loads((folder / f"{name}.json").read_text())
        self.name, self.summary, self.cpu = name, record["summary"], record["cpu_seconds"]
        later = folder.parent / LATER  # the same layers, by a program that tells more
        if (later / f"{name}.json").exists():
            self.summary = {**json.loads((later / f"{name}.json").read_text())["summary"], **self.summary}
        files = [one / f"{name}.profiles.csv.xz" for one in (folder, later)]
        self.profiles = next((read_text(file) for file in files if file.exists()), "")
        given = dict(s.split("=", 1) for s in settings)
        self.friction = float(given.get("material.friction", 0.5))
        self.grains = int(given.get("response.grains", 1))
        self.shape = SHAPES[given.get("packing.shape", "disk")]
        self.shape = next((shape for shape in SPACE if shape in given.get("sweep.values", "")), self.shape)
        self.width = next((float(value) for key, value in given.items() if key.endswith("packing.width")), None)

    def number(self, key):
        value = self.summary.get(key)
        return math.nan if value is None or isinstance(value, str) else float(value)

    @property
    def layers(self):
        return int(self.number("ensemble.realizations"))

    @property
    def depth(self):
        return self.number("layer.depth_diameters")

    def misfit(self, model, region, kernel="w_depths"):
        return Misfit(self, f"limit.{model}.{region}.{kernel}")

    def axis(self, model, kernel):
        """On the axis at each depth over h: grains, their standard error, the model; {} where it is not kept."""
        out = {}
        for row in csv.DictReader(line for line in self.profiles.splitlines() if not line.startswith("#")):
            width = float(re.search(r"w = (\S+) m", row["profile"])[1]) / self.number("layer.depth")
            if abs(float(row["x_m"])) < 1e-9 and (abs(width - 0.1) < 1e-3) == (kernel == "w_depths"):
                values = [float(row[next(key for key in row if re.fullmatch(rf"{part}_(N/m|Pa)", key))] or "nan")
                          for part in ("simulation", "standard_error", model)]
                out[round(float(row["depth_m"]) / self.number("layer.depth"), 3)] = values
        first = f"compare.{model}.peak"  # of the first profile, which is at AT and at fixed width over d
        if not out and kernel == "w_diameters" and first in self.summary:
            return {AT: [self.number(key) for key in ("response.peak", "response.peak.standard_error", first)]}
        return out

    def excess(self, model, kernel, at=AT):
        """Of the grains over the model on the axis, and its standard error; nan where it is not kept."""
        grains, error, own = self.axis(model, kernel).get(at, [math.nan] * 3)
        return grains / own - 1, error / own

    def shift(self, model, kernel, at):
        """By how much less deep than h AT, over d, the model has the grains' stress on the axis, and its error."""
        axis = self.axis(model, kernel)
        if at not in axis or len(axis) < 2:
            return math.nan, math.nan
        depths = sorted(axis)
        k = depths.index(at)
        low, high = depths[max(k - 1, 0)], depths[min(k + 1, len(depths) - 1)]
        slope = math.log(axis[low][2] / axis[high][2]) / math.log(high / low)  # of the model's decay there
        value, error = self.excess(model, kernel, at)
        z = at * self.depth
        return z * (1 - (1 + value) ** (-1 / slope)), z / slope * error / (1 + value)


#: Misfits within their noise whose bound is above, %, are not drawn: the layers scatter too much to tell anything.
UNBOUNDED = 30


class Misfit:
    """The misfit beyond noise of limit.*, %."""

    def __init__(self, run, key):
        self.squared, error, noise = (run.number(f"{key}.{name}")
                                      for name in ("squared", "squared.standard_error", "noise"))
        self.bound = 100 * run.number(f"{key}.right_to")
        freedom = run.layers - 1
        self.known = math.isfinite(self.squared) and math.isfinite(self.bound)
        #: of the square: the jackknife's, and that of one mode of noise, as the bound has it
        scatter = math.hypot(error, math.sqrt(2) * noise)
        self.resolved = self.known and self.squared > stats.t.ppf(0.95, freedom) * scatter
        self.value = 100 * math.sqrt(max(self.squared, 0)) if self.known else math.nan
        self.error = 100 * error / 2 / math.sqrt(self.squared) if self.resolved else math.nan
        self.low = 100 * math.sqrt(max(self.squared - error, 0)) if self.known else math.nan
        self.high = 100 * math.sqrt(max(self.squared + error, 0)) if self.known else math.nan

    def cell(self):
        if not self.known:
            return "–"
        if not self.resolved:
            return f"< {shown(self.bound)}"
        digits = 0 if self.error >= 2 else 1
        return f"{self.value:.{digits}f} ± {self.error:.{digits}f}"

    def right(self):
        """The smallest of RIGHT that the bound is below, or that there is none."""
        if not self.known:
            return "–"
        return next((f"{x} %" for x in RIGHT if self.bound < x), "none")


def shown(value):
    """Two digits."""
    return f"{value:.0f}" if value >= 10 else f"{value:.1f}"


def percent(value, error=math.nan):
    if not math.isfinite(value):
        return "–"
    if not math.isfinite(error):
        return f"{100 * value:.1f} %"
    return f"{100 * value:.1f} ± {100 * error:.1f} %"


def finished(states):
    """The runs that are there, by depth and friction."""
    runs = []
    for name in LISTS:
        listed = HERE / "runs" / f"{name}.txt"
        for run, _, _, settings in read_list(listed)[1] if listed.exists() else []:
            if (states / name / f"{run}.json").exists():
                runs.append(Run(states / name, run, settings))
    return sorted(runs, key=lambda run: (run.shape, run.depth, run.friction, run.grains))


def usual(runs):
    """Those of the usual width under a load on one grain; of a run and its larger ensemble NAME-more the latter."""
    names = {run.name for run in runs}
    return [run for run in runs if run.grains == 1 and run.width is None and f"{run.name}-more" not in names]


def of(run):
    """What layer it is, as the first cells of every table."""
    wide = f"{run.number('dem.layer_width') / run.number('layer.depth'):.0f} depths wide" if run.width else ""
    what = ", ".join(word for word in (run.shape, wide) if word not in ("", "disks"))
    return [f"{run.depth:.1f}" + (f" ({what})" if what else ""), f"{run.friction:g}"]


def misfits(runs):
    """Of all profiles, for layers to the surface and to the centres of the loaded grains."""
    head = ["depth / d", "μ", "one stiffness: layer to the surface", "to the centres",
            "stiffness by depth: to the surface", "to the centres", "to the centres, right to: one stiffness", "by depth",
            "agrees"]
    rows = []
    for run in usual(runs):
        cells = [run.misfit(model, "all").cell() for model in (HOMOGENEOUS, ONE_CENTRES, BY_DEPTH, CENTRES)]
        cells += [run.misfit(model, "all").right() for model in (ONE_CENTRES, CENTRES)]
        agree = [said for model, said in ((ONE_CENTRES, "one stiffness"), (CENTRES, "by depth"))
                 if run.number(f"compare.{model}.chi2_per_dof") <= run.number(f"compare.{model}.chance")]
        known = run.misfit(ONE_CENTRES, "all").known
        rows.append([*of(run), *cells, {0: "none", 2: "both"}.get(len(agree), "".join(agree)) if known else "–"])
    return table(line(head), rows)


def parts(runs):
    """Misfits in parts of the layer, of a load inside it, and with the wide kernel."""
    head = ["depth / d", "μ", "centres below the surface / d", "base, to the surface: one stiffness", "by depth",
            "base, to the centres: one stiffness", "axis, to the surface: one stiffness", "by depth",
            "by depth, load inside", "w = 1.5 d, one stiffness: to the surface", "to the centres"]
    columns = ((HOMOGENEOUS, "base"), (BY_DEPTH, "base"), (ONE_CENTRES, "base"), (HOMOGENEOUS, "axis"), (BY_DEPTH, "axis"),
               (INSIDE, "all"), (HOMOGENEOUS, "all", "w_diameters"), (ONE_CENTRES, "all", "w_diameters"))
    rows = []
    for run in usual(runs) + [run for run in runs if run.width is not None]:
        below = run.number("response.load_depth") / run.number("layer.depth") * run.depth
        rows.append([*of(run), f"{below:.2f}" if math.isfinite(below) else "–",
                     *(run.misfit(*one).cell() for one in columns)])
    return table(line(head), rows)


def bases(runs):
    head = ["depth / d", "μ", "half space", "layer, smooth base", "layer, rough base", "nearer by the judge", "position"]
    rows = []
    for run in usual(runs):
        models = ("by_depth_half_space", "by_depth_smooth", BY_DEPTH)
        at, error = run.number("verdict.position"), run.number("verdict.position_error")
        place = f"{at:.2f} ± {error:.2f}" if 0 <= at <= 1 else "beyond"
        rows.append(of(run) + [run.misfit(model, "base").cell() for model in models] + [words(run), place])
    return table(line(head), rows)


def words(run):
    """What the judge says of layer and half space, in short."""
    said = run.summary.get("verdict.sentence", "")
    if "cannot be distinguished" in said:
        return "not distinguished"
    return "layer" if "finite layer is nearer" in said else "–"


def shifted(value):
    """A shift of shift()."""
    return f"{value[0]:.2f} ± {value[1]:.2f}" if math.isfinite(value[0]) else "–"


def causes(runs):
    head = ["depth / d", "excess over one stiffness, w = 0.1 h", "over stiffness by depth", "w = 1.5 d",
            "load on 3 grains, w = 0.1 h", "on 10 grains", "shift / d at 0.25 h", "at 0.5 h", "at 0.75 h"]
    rows = []
    for run in usual(runs):
        if run.friction != 0.5 or run.shape not in ("disks", "spheres"):
            continue
        cells = [of(run)[0]]
        cells += [percent(*run.excess(model, kernel)) for model, kernel in (
            (HOMOGENEOUS, "w_depths"), (BY_DEPTH, "w_depths"), (HOMOGENEOUS, "w_diameters"))]
        for grains in (3, 10):
            name = f"{run.name.removesuffix('-mu-0.5')}-grains-{grains}"
            more = next((other for other in runs if other.name == name), None)
            cells.append(percent(*more.excess(HOMOGENEOUS, "w_depths")) if more else "–")
        cells += [shifted(run.shift(BY_DEPTH, "w_depths", at)) for at in (0.25, 0.5, 0.75)]
        rows.append(cells)
    return table(line(head), rows)


def linearity(runs):
    head = ["depth / d", "μ", "load in weights of a grain", "contacts that close", "open", "begin to slide",
            "peaks at 0.25, 0.5, 0.75 h and on the base", "E at the base over that at the surface"]
    rows = []
    for run in usual(runs):
        shares = [percent(run.number(f"linearity.{name}"), run.number(f"linearity.{name}.standard_error"))
                  for name in ("gained", "lost", "sliding")]
        places = ("depth_0.25", "depth_0.5", "depth_0.75", "base")
        peaks = ", ".join(f"{run.number(f'response.{place}_w_depths.peaks'):.0f}" for place in places)
        rows.append(of(run) + [f"{run.number('linearity.weights'):.2g}", *shares, peaks,
                               f"{run.number('moduli.growth'):.2f}"])
    return table(line(head), rows)


def with_error(run, key, digits):
    """A figure over packings and its standard error."""
    value, error = run.number(key), run.number(f"{key}.standard_error")
    if not math.isfinite(value):
        return "–"
    return f"{value:.{digits}f}" + (f" ± {error:.{digits}f}" if math.isfinite(error) else "")


def ends(runs):
    """Where linear response ends, of the runs that tell."""
    head = ["depth / d", "μ", "first contact slides or opens at (weights of a grain)", "first opens at",
            "a hundredth have at", "the same over depth / d"]
    rows = []
    for run in usual(runs):
        key = "linearity.hundredth_changes"
        if math.isfinite(run.number(key)):
            shares = [run.number(k) / run.depth for k in (key, f"{key}.standard_error")]
            rows.append(of(run) + [with_error(run, f"linearity.first_{name}", 2) for name in ("changes", "opens")]
                        + [with_error(run, key, 1), f"{shares[0]:.2f} ± {shares[1]:.2f}"])
    return table(line(head), rows)


def settlements(runs):
    """Settlements over the predicted ones, of the runs that tell."""
    head = ["depth / d", "μ", "surface, h/4 to h from the load: over one stiffness", "over stiffness by depth",
            "of the layer to the centres", "below the load, h/4 to 3h/4: over one stiffness", "over stiffness by depth",
            "of the layer to the centres", "loaded grain: E_v u / F, in space E_v u h / F"]
    rows = []
    for run in usual(runs):
        keys = [f"settlement.{model}.{place}" for place in ("surface", "axis")
                for model in (HOMOGENEOUS, BY_DEPTH, CENTRES)]
        if math.isfinite(run.number(keys[0])):
            rows.append(of(run) + [with_error(run, key, 2) for key in [*keys, "response.settlement"]])
    return table(line(head), rows)


def costs(runs):
    """Of the deepest layers of each shape, with the friction that all shapes have."""
    head = ["depth / d", "μ", "grains in a layer", "layers", "CPU min", "deposit and load",
            "rest, moduli, response (clock)", "finite elements (clock)", "memory (MB)"]
    rows = []
    deepest = {run.shape: run for run in usual(runs) if run.friction == 0.5}  # by depth, see finished()
    for run in deepest.values():
        dem, fe, all_analysis = (run.number(f"time.{name}") for name in ("dem_cpu_s", "continuum_s", "analysis_s"))
        fe += run.summary.get("time.settlement_s", 0)
        rows.append(of(run) + [f"{run.number('dem.grains'):.0f}", f"{run.layers}", shown(run.cpu / 60), shown(dem / 60),
                               shown((all_analysis - fe) / 60), shown(fe / 60), f"{run.number('memory.peak_MB'):.0f}"])
    return table(line(head), rows)


def isotropic_axis():
    """Pressure below the load in an isotropic layer on a smooth base, over F/h, by depth over h."""
    out = {}
    for part in ISOTROPIC.read_text().split("\n## ")[1:]:
        lines = [[cell.strip() for cell in one.strip("|").split("|")] for one in part.splitlines() if one[:1] == "|"]
        at = re.match(r"depth (\S+) h", part)
        below = next(row for row in lines[2:] if float(row[0]) == 0)
        out[float(at[1]) if at else 1.0] = float(below[lines[0].index("layer")])
    return out


def anisotropy(runs):
    """By how much pentagons exceed on the axis an isotropic layer, one of their anisotropy, and one by depth."""
    run = next(one for one in usual(runs) if one.name == "deep-15-pentagons")
    rows = [["isotropic"]]
    unit = run.number("load.force") / run.number("layer.depth")
    for at, own in isotropic_axis().items():
        grains, error, _ = run.axis("homogeneous_smooth", "w_depths")[at]
        rows[0].append(percent(grains / (unit * own) - 1, error / (unit * own)))
    for words, model in (("anisotropic", "homogeneous_smooth"), ("the same, stiffness by depth", "by_depth_smooth")):
        rows.append([words] + [percent(*run.excess(model, "w_depths", at)) for at in isotropic_axis()])
    return table(line(["layer", *(f"{at:g} $h$" for at in (0.25, 0.5, 0.75)), "base"]), rows)


#: The tables of each page. Some are of figures that not every run has: of none, there is no table.
TABLES = {PAGE: (misfits, causes, settlements, costs), DETAILS: (parts, bases, linearity, ends), PACKINGS: (anisotropy,)}


def draw_misfits(runs, picture):
    """Three panels of misfit against depth, w = 0.1 h, and one of all profiles with w = 1.5 d."""
    panels = [(region, "w_depths", f"{title}, w = 0.1 h") for region, title in REGIONS.items()]
    panels.append(("all", "w_diameters", "of all profiles, w = 1.5 d"))
    data, plots = "", ""
    wide = max((run.depth for run in usual(runs)), default=10) * 1.25
    most = 0.0
    for number, (region, kernel, title) in enumerate(panels):
        curves = []
        for side, (model, (colour, _)) in enumerate(DRAWN.items(), -1):
            for place, (kind, point) in enumerate(POINTS.items()):
                shift = 1 + side * (0.01 + 0.01 * place)  # points of equal depth stand side by side
                rows = []
                for run in usual(runs):
                    if (run.shape, run.friction) == kind:
                        m = run.misfit(model, region, kernel)
                        if m.known and (m.resolved or m.bound < UNBOUNDED):
                            rows.append((run.depth * shift, m.value, m.low, max(m.high, m.value)))
                            most = max(most, m.high if m.resolved else 0)
                if not rows:
                    continue
                name = f"p{number}{model}{place}".replace("_", "")
                data += block(name, rows)
                told = f"title '{kind[0]}, μ = {kind[1]:g}'" if number == 0 and model == HOMOGENEOUS else "notitle"
                paint = f"lc rgb '{colour}'"
                curves.append(f"${name} using 1:2:3:4 with yerrorbars pt {point} ps 0.7 {paint} {told}")
                curves.append(f"${name} using 1:2 with lines {paint} notitle")
        if curves:
            plots += f"set title 'Misfit {title}'\nplot " + ", ".join(curves) + "\nunset key\nunset label\n"
    if not plots:
        fail("no run has ended; nothing to draw")
    layout = ("set multiplot layout 2,2 margins 0.08,0.99,0.09,0.88 spacing 0.08,0.13\n"
              "set logscale x\nset xtics (6, 8, 15, 30, 60, 120)\nset grid\n"
              f"set xrange [5:{wide:g}]\nset yrange [0:{1.15 * most or 100:g}]\nset xlabel 'depth / mean diameter'\n"
              "set ylabel 'misfit (%)'\nset key top right\n"
              + "".join(f"set label {k} '{said}' at screen {at},0.96 center tc rgb '{colour}'\n"
                        for k, (at, (colour, said)) in enumerate(zip((0.12, 0.35, 0.74), DRAWN.values()), 1)))
    draw(picture, "960,840", data + layout + plots + "unset multiplot\n")


def main():
    options = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    options.add_argument("--states", type=pathlib.Path, default=HERE / "states")
    options.add_argument("--picture", type=pathlib.Path)
    options.add_argument("--write", action="store_true", help="put the tables into the pages")
    given = options.parse_args()
    runs = finished(given.states)
    made = {page: [new for new in (one(runs) for one in tables) if new.count("\n") > 2] for page, tables in TABLES.items()}
    if given.picture:
        draw_misfits(runs, given.picture)
    for page, tables in made.items():
        if given.write:
            write_file(page, put(page.read_text(), tables, page).encode())
        elif not given.picture:
            print("\n".join(tables))


if __name__ == "__main__":
    main()

#!/usr/bin/env python3
"""Grains, field, models and verdict of a layer under a load, side by side: door.py RUN OUT.png

RUN is the folder of `./bootstrap demo` (results/demo/floor_rough). Needs h5py and matplotlib.
"""
import csv
import json
import sys

import h5py
import matplotlib
import numpy as np

matplotlib.use("Agg")
import matplotlib.pyplot as plt
from matplotlib.collections import CircleCollection, LineCollection

RED, BLUE, GREY = "#c1272d", "#2166ac", "#8c8c8c"


def grains(ax, snapshots):
    """What the load changes in the contact forces of the first realization."""
    loaded, before = (snapshots[f"realization_000/{state}"] for state in ("loaded", "unloaded"))
    x = loaded["grains/position"][:, :2]
    radius = loaded["grains/radius"][:]
    load = x[list(loaded["grains/id"]).index(int(loaded.attrs["loaded_grain"]))]
    x = 1000 * (x - load)
    for centre, r in zip(x, 1000 * radius):
        ax.add_patch(plt.Circle(centre, r, fc="#f2efe8", ec="#c9c2b2", lw=0.4))

    def forces(state):
        c = state["contacts"]
        return {(i, j): f for i, j, f in zip(c["i"], c["j"], c["normal_force"])}

    new, old = forces(loaded), forces(before)
    place = dict(zip(loaded["grains/id"], x))
    change = {k: new.get(k, 0) - old.get(k, 0) for k in {*new, *old} if k[1] >= 0}
    most = max(map(abs, change.values()))
    for sign, colour in ((-1, BLUE), (1, RED)):
        kept = [(k, f) for k, f in change.items() if sign * f > 0.004 * most]
        ax.add_collection(LineCollection([(place[i], place[j]) for (i, j), _ in kept], colors=colour,
                                         linewidths=[12 * abs(f) / most + 0.15 for _, f in kept]))
    ax.annotate("", (0, 1), (0, 24), arrowprops={"arrowstyle": "-|>", "color": "black", "lw": 2})
    ax.set(xlim=(-72, 72), ylim=(-100, 29), aspect="equal", title="grains", xticks=[], yticks=[])
    ax.set_xlabel("change of the contact forces\nunder 10 N: red more, blue less")


def field(ax, fields):
    """The averaged response of the ensemble."""
    group = fields["coarse_graining_response"]
    h, force = group.attrs["attribute.h"], group.attrs["attribute.F"]
    nx, ny = int(group.attrs["nx"]), int(group.attrs["ny"])
    x, y = (group["points"][:, k].reshape(ny, nx) / h for k in (0, 1))
    stress = -group["value/sigma_yy"][:].reshape(ny, nx) * h / force
    drawn = ax.contourf(x, y, stress, levels=np.linspace(-0.2, 1.6, 19), cmap="RdBu_r",
                        norm=matplotlib.colors.TwoSlopeNorm(0, -1.6, 1.6), extend="both")
    bar = plt.colorbar(drawn, cax=ax.inset_axes([0.15, 0.88, 0.7, 0.05]), orientation="horizontal",
                       ticks=[0, 0.5, 1, 1.5])
    bar.ax.tick_params(labelsize=6, length=2, pad=1)
    ax.set(xlim=(-0.75, 0.75), ylim=(-1.04, 0.3), aspect="equal", title="field", yticks=[0, -1])
    ax.set_xlabel("x / h\nvertical stress (F/h), mean of 16 layers")


def models(ax, profiles):
    """The stress on the base and the theories."""
    with open(profiles) as lines:
        rows = list(csv.DictReader(line for line in lines if not line.startswith("#")))
    with open(profiles) as lines:
        unit = float(lines.readline().split("F/h =")[1].split()[0])
    h = 10 / unit
    base = [r for r in rows if r["profile"] == "base"]

    def column(name):
        return np.array([float(r[name]) for r in base]) / (unit if name != "x_m" else h)

    x = column("x_m")
    stress, error = column("simulation_N/m"), column("standard_error_N/m")
    ax.fill_between(x, stress - error, stress + error, color=GREY, alpha=0.4, lw=0)
    ax.plot(x, stress, "o", ms=2.5, color="black", label="grains")
    for name, label, style in (("layer_rough", "layer on a rough base", "-"),
                               ("layer", "layer on a smooth base", "--"),
                               ("flamant", "half plane", ":")):
        colour = BLUE if name == "flamant" else RED
        ax.plot(x, column(name + "_N/m"), style, color=colour, label=label)
    ax.legend(frameon=False, fontsize=7, loc="upper right", borderaxespad=0)
    ax.set(xlim=(-1.5, 1.5), ylim=(-0.15, 1.75), title="models", xlabel="x / h on the base",
           ylabel="vertical stress (F/h)")


def verdict(ax, summary):
    """Where the grains stand between two theories."""
    at, error = summary["verdict.position"], summary["verdict.position_error"]
    ax.axhline(0, color="black", lw=1)
    for place, text, colour in ((0, "half\nplane", BLUE), (1, "finite\nlayer", RED)):
        ax.plot(place, 0, "s", color=colour, ms=9)
        ax.annotate(text, (place, -0.18), ha="center", va="top", color=colour)
    ax.errorbar(at, 0, xerr=error, fmt="o", color="black", capsize=4, ms=8, zorder=3)
    ax.annotate(f"grains\n{at:.2f} ± {error:.2f}", (at, 0.16), ha="center")
    words = {name: f"{summary[f'compare.{name}.chi2_per_dof']:.1f}" for name in ("flamant", "layer_rough")}
    ax.annotate("“" + summary["verdict.sentence"].split(":")[0] + "”", (0.75, 0.86), ha="center",
                wrap=True, style="italic", fontsize=9)
    ax.annotate(f"χ²/dof: half plane {words['flamant']}, layer {words['layer_rough']}", (0.75, -0.82),
                ha="center", fontsize=8)
    ax.set(xlim=(-0.4, 2.0), ylim=(-1, 1.1), title="verdict")
    ax.axis("off")


def main(run, out):
    with open(f"{run}/summary.json") as text:
        summary = json.load(text)
    plt.rcParams.update({"font.size": 8, "axes.titlesize": 11, "axes.titleweight": "bold"})
    figure, axes = plt.subplots(1, 4, figsize=(12.5, 3.2), layout="constrained",
                                width_ratios=[1.2, 1.2, 1.2, 1.3])
    with h5py.File(f"{run}/snapshots.h5") as snapshots, h5py.File(f"{run}/fields.h5") as fields:
        grains(axes[0], snapshots)
        field(axes[1], fields)
    models(axes[2], f"{run}/profiles.csv")
    verdict(axes[3], summary)
    figure.savefig(out, dpi=110)


if __name__ == "__main__":
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    main(*sys.argv[1:])

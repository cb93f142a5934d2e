"""Pictures with matplotlib, where it is there."""

from __future__ import annotations

import re
from typing import Any

import numpy as np

from ._data import Field, Packing, Table
from ._show import axes_of_field


def axes_of(ax: Any) -> Any:
    try:
        import matplotlib.pyplot as plt
    except ImportError as error:
        raise ImportError(
            "plots need matplotlib, which is not installed (Debian: python3-matplotlib)"
        ) from error
    return plt.subplots(layout="constrained")[1] if ax is None else ax


def _change(packing: Packing, before: Packing) -> np.ndarray:
    """Normal forces less those of the same contacts in the state before, N."""
    contacts = before.contacts
    then = dict(zip(map(tuple, contacts.pairs), contacts.normal_forces))
    return np.array([
        force - then.get(pair, 0.0)
        for pair, force in zip(map(tuple, packing.contacts.pairs), packing.contacts.normal_forces)
    ])


def plot_packing(packing: Packing, ax: Any, *, forces: bool, change: Packing | None) -> Any:
    ax = axes_of(ax)
    from matplotlib.collections import LineCollection, PatchCollection
    from matplotlib.patches import Circle, Polygon

    across = [0, packing.dim - 1]
    places = packing.positions[:, across]
    shapes = []
    outlines = packing.outlines if packing.dim == 2 else [np.empty((0, 2))] * len(packing)
    for place, radius, angle, outline in zip(places, packing.radii, packing.angles, outlines):
        if len(outline) == 0:
            shapes.append(Circle(place, radius))
            continue
        turn = np.array([[np.cos(angle), np.sin(angle)], [-np.sin(angle), np.cos(angle)]])
        shapes.append(Polygon(place + outline @ turn))
    faces = np.where(packing.fixed, "0.75", "0.92")
    ax.add_collection(PatchCollection(shapes, facecolors=faces, edgecolors="0.6", linewidths=0.4))
    contacts = packing.contacts
    if forces and len(contacts):
        sizes = contacts.normal_forces if change is None else _change(packing, change)
        largest = np.abs(sizes).max() or 1.0
        start = places[contacts.pairs[:, 0]]
        lines = np.stack([start, start + contacts.branches[:, across]], axis=1)
        colours = np.where(sizes < 0, "tab:blue", "tab:red")
        ax.add_collection(LineCollection(lines, linewidths=4 * np.abs(sizes) / largest, colors=colours))
    for shape, point, normal in zip(packing.walls.shapes, packing.walls.points, packing.walls.normals):
        if shape == "plane" and np.hypot(*normal[across]) > 0:
            slope = [-normal[across[1]], normal[across[0]]]
            ax.axline(point[across], point[across] + slope, color="0.3", linewidth=1)
    ax.set_xlim(places[:, 0].min() - packing.radii.max(), places[:, 0].max() + packing.radii.max())
    ax.set_ylim(places[:, 1].min() - packing.radii.max(), places[:, 1].max() + packing.radii.max())
    ax.set_aspect("equal")
    ax.set_xlabel("x (m)")
    ax.set_ylabel("y (m)" if packing.dim == 2 else "z (m)")
    return ax


def plot_field(field: Field, column: str, ax: Any) -> Any:
    values, unit = field[column], field.units[column]
    ax = axes_of(ax)
    name = column
    if re.fullmatch(r"sigma_(\w)\1", column):  # pressure upwards, as in reports
        name, values = "-" + column, -values
    over = "/h" if field.is_over_height else " (m)"
    shape = field.shape
    points = field.points
    axes = axes_of_field(field)
    if shape is not None and len(shape) == 2:
        grid = (shape[1], shape[0])
        drawn = ax.pcolormesh(points[:, 0].reshape(grid), points[:, 1].reshape(grid),
                              values.reshape(grid), shading="nearest", cmap="viridis")
        ax.set_aspect("equal")
        # Beside the map and as tall as it, whatever its aspect.
        ax.figure.colorbar(drawn, cax=ax.inset_axes([1.03, 0, 0.03, 1]), label=f"{name} ({unit})")
        ax.set_xlabel(axes[0] + over)
        ax.set_ylabel(axes[1] + over)
        return ax
    heights = points[:, -1]
    for height in np.unique(heights):
        row = np.flatnonzero(heights == height)
        row = row[np.argsort(points[row, 0])]
        band(ax, points[row, 0], values[row], field.error(column), row, f"{height:g}")
    ax.set_xlabel(axes[0] + over)
    ax.set_ylabel(f"{name} ({unit})")
    ax.legend(title=axes[-1] + over)
    return ax


def label_of(table: Table, column: str) -> str:
    """A column of a table for an axis, with its unit."""
    unit = table.units.get(column, "1")
    return column if unit in ("1", "deg") else f"{column} ({unit})"


def band(ax: Any, x: np.ndarray, mean: np.ndarray, error: np.ndarray | None, row: Any, label: str) -> None:
    """A line, and about it one standard error where it is known; of `error` the rows of the line count."""
    (line,) = ax.plot(x, mean, label=label)
    if error is not None and np.isfinite(error[row]).any():
        ax.fill_between(x, mean - error[row], mean + error[row], alpha=0.3, color=line.get_color())


def plot_profiles(profiles: Table, ax: Any, profile: str | None, of: str, models: bool = True) -> Any:
    """A profile of a table with grains (called `of`) beside models."""
    names = list(dict.fromkeys(profiles["profile"].tolist()))
    if profile is None:
        profile = _nearest_to_the_base(names)
    if profile not in names:
        raise ValueError(f"profile: found {profile}, allowed: {', '.join(names)}")
    ax = axes_of(ax)
    here = profiles["profile"] == profile
    x = profiles["x"][here]
    data = "measured" if "measured" in profiles else "simulation"
    band(ax, x, profiles[data][here], profiles["standard_error"], here, of)
    for model in models_in(profiles) if models else ():
        ax.plot(x, profiles[model][here], "--", label=model)
    quantity = _quantity(profiles, profile)
    ax.set_title("-" + profile if profile.startswith("sigma") and quantity.startswith("-") else profile)
    ax.set_xlabel(f"x ({profiles.units['x']})")
    ax.set_ylabel(f"{quantity} ({profiles.units[data]})".strip())
    ax.legend()
    return ax


def _nearest_to_the_base(names: list[str]) -> str:
    """Of profiles at several heights that of the vertical stress at the lowest one, else the first."""
    at = [re.fullmatch(r"sigma_(yy|zz) at (\S+) h", name) for name in names]
    vertical = sorted((match[1] != "zz", float(match[2]), match[0]) for match in at if match)
    return vertical[0][2] if vertical else names[0]


def _quantity(profiles: Table, profile: str) -> str:
    """What a profile shows: tables of profiles have compression positive, "-sigma_yy"; shears as
    they are. "" where neither the profile's name nor the table's notes tell it."""
    named = re.match(r"sigma_(\w)(\w)\b", profile)
    if named:
        return ("-" if named[1] == named[2] else "") + named[0]
    told = (re.match(r"#?\s*(-?sigma_\w\w)\b", note) for note in profiles.notes)
    return next((match[1] for match in told if match), "")


def models_in(profiles: Table) -> list[str]:
    """The columns of models: each has its difference beside it."""
    return [name for name in profiles if f"{name}_difference" in profiles]

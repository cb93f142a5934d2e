"""What .plot() of a run draws, by the tables that its study leaves."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from ._data import Table
from ._plots import axes_of, band, label_of, plot_profiles


@dataclass(frozen=True)
class _Drawing:
    """A table with these columns is drawn as these columns against x, each of `beside` dashed."""

    table: str
    x: str
    column: str
    beside: tuple[str, ...] = ()
    lines: str = ""  # a column whose values tell the lines apart
    title: str = ""
    sorted: bool = False  # by x; else in the table's order, along which a path may turn back


#: The first whose columns are there is drawn.
_DRAWINGS = (
    _Drawing("states", "strain", "q_over_p", title="mean over the realizations"),
    _Drawing("impacts", "angle_deg", "restitution_tangential", ("closed_form_restitution_tangential",),
             sorted=True),
    _Drawing("impacts", "speed", "restitution_normal", ("closed_form_restitution_normal",),
             sorted=True),
    _Drawing("loops", "loop", "work_over_energy", lines="realization"),
    _Drawing("profiles", "depth", "normal_force", lines="realization", title="normal force of the pair"),
    _Drawing("profiles", "fraction", "compressibility", ("theory", "virial_series"), title="p / (n k T)"),
    _Drawing("profiles", "time_over_haff", "temperature", ("haff",), title="temperature over that at first"),
    _Drawing("profiles", "x_over_width", "normal", ("normal_closed_form",), title="normal forces on the base, m g"),
    _Drawing("history", "time", "kinetic", ("elastic",), title="energies"),
)


def _varies(values: np.ndarray) -> bool:
    return len(values) > 1 and bool(np.ptp(values) > 0)


def _found(result: Any) -> tuple[_Drawing, Table] | None:
    for drawing in _DRAWINGS:
        table = result.tables.get(drawing.table)
        if table is not None and {drawing.x, drawing.column} <= set(table) and _varies(table[drawing.x]):
            return drawing, table
    return None


def _plot_table(drawing: _Drawing, table: Table, ax: Any, column: str | None, label: str) -> Any:
    columns = [name for name in table
               if table[name].dtype.kind == "f" and name != drawing.x
               and not (name.endswith("_error") and name.removesuffix("_error") in table)]
    if column is not None and column not in columns:
        raise ValueError(f"profile: found {column}, allowed: {', '.join(columns)}")
    drawn = column or drawing.column
    ax = axes_of(ax)
    x = table[drawing.x]
    groups = np.unique(table[drawing.lines]) if drawing.lines in table else [None]
    for group in groups:
        rows = np.arange(len(x)) if group is None else np.flatnonzero(table[drawing.lines] == group)
        rows = rows[np.argsort(x[rows], kind="stable")] if drawing.sorted else rows
        name = label or (drawn if group is None else f"{drawing.lines} {group:g}")
        band(ax, x[rows], table[drawn][rows], table.get(f"{drawn}_error"), rows, name)
    for other in drawing.beside if column is None and not label else ():
        if other in table:
            rows = np.argsort(x, kind="stable") if drawing.sorted else np.arange(len(x))
            ax.plot(x[rows], table[other][rows], "--", label=other)
    ax.set_title(drawing.title if column is None else "")
    ax.set_xlabel(label_of(table, drawing.x))
    ax.set_ylabel(label_of(table, drawn))
    ax.legend()
    return ax


def _plot_members(result: Any, ax: Any, profile: str | None) -> Any:
    """A curve for every member that is drawn as the first is."""
    first, *others = result.members.values()
    kind = _kind(first)
    alike = [member for member in others if _kind(member) == kind]
    ax = axes_of(ax)
    for member in [first, *alike]:
        plot_result(member, ax, profile, member.folder.rpartition("/")[2])
    return ax


def _kind(result: Any) -> Any:
    """Equal of results that one pair of axes can show."""
    if result.profiles is not None and "profile" in result.profiles:
        return "profile"
    found = _found(result)
    return found and found[0]


def plot_result(result: Any, ax: Any, profile: str | None, label: str = "") -> Any:
    """label: of the one curve that a member of a sweep has among the others'."""
    if result.members and not result.tables:
        return _plot_members(result, ax, profile)
    kind, found = _kind(result), _found(result)
    if kind is None:
        there = "; its tables: " + ", ".join(result.tables) if result.tables else ""
        raise ValueError(f"{result.folder}: holds no table that has a drawing{there}")
    if kind == "profile":
        of = "grains" if result.snapshots is not None else "simulation"
        return plot_profiles(result.profiles, ax, profile, label or of, models=not label)
    assert found is not None  # of every other kind
    drawing, table = found
    return _plot_table(drawing, table, ax, profile, label)

"""import_packing and export: files of other programs in and out."""

from __future__ import annotations

import os
import tempfile
from typing import Any, Mapping, Sequence

from . import _given, _program
from ._commands import _overrides
from ._data import Field, Packing
from ._files import Collection, packings_of, write
from ._packing import _periods


def _vector(values: Sequence[float]) -> str:
    return ",".join(repr(float(value)) for value in values)


def _number(value: Any) -> Any:
    """A number with all its digits, or a text with a unit as it is."""
    return value if isinstance(value, str) else repr(float(value))


def import_packing(
    format: str,
    *files: str | os.PathLike,
    units: str = "",
    columns: Mapping[str, Any] | Sequence[str] | None = None,
    dim: int | None = None,
    gravity: Sequence[float] | None = None,
    density: float | str | None = None,
    friction: float | None = None,
    walls: str | Sequence[str] = (),
    periodic: Mapping[str, tuple[float, float]] | Sequence[tuple[str, Any]] | None = None,
    fixed: str = "",
    steps: Any = None,
    time_step: float | str | None = None,
    group: str = "",
    load: tuple[int, Sequence[float]] | None = None,
    ids: str | os.PathLike | None = None,
    without_contacts: bool = False,
    flip_forces: bool | str = False,
    leave_out_distant: bool = False,
) -> Packing | Collection:
    """The packing in files of another program, or a Collection of several steps (docs/import.md), as
    `grainfield import`, which it runs.

    format: lammps, liggghts, yade, csv, mercury or vtk. files: grains, contacts and walls in any order.
    columns: {"i,j": "c_ids[1..2]", "radius": "c_r", "mass": 0.1}. gravity: m/s2; default 9.81 down.
    density: kg/m3 (2D: kg/m2) or "2.5 g/cm3". walls: "floor:y=0:fix=f_floor", one or more. periodic:
    {"x": (0, 0.1)}, m. fixed: "type=2". steps: a number, several, {number: name} or "all"; default the
    last. time_step: s, of a dump. load: (id, force, N). ids: table of `export --to lammps`. flip_forces:
    True turns all forces, "pairs" those between grains, "walls" those with walls.

    .report of what is returned holds what the command prints; its warnings are Python warnings. gf.write
    keeps the packings. Raises ValueError with the command's line.
    """
    words: list[Any] = ["import", "--from", format, *(os.fspath(file) for file in files)]

    def option(name: str, value: Any) -> None:
        if value is not None and value != "":
            words.extend([f"--{name}", value])

    option("units", units)
    if isinstance(columns, Mapping):
        columns = [f"{ours}={theirs}" for ours, theirs in columns.items()]
    for text in _given.a_list(columns):
        option("column", text)
    option("dim", dim)
    option("gravity", None if gravity is None else _vector(gravity))
    option("density", None if density is None else _number(density))
    option("friction", None if friction is None else _number(friction))
    for text in [walls] if isinstance(walls, str) and walls else walls:
        option("wall", text)
    for text in _periods(periodic):
        option("periodic", text.replace(":", " m:") + " m")  # whatever the units of the files
    option("fixed", fixed)
    for step in steps.items() if isinstance(steps, Mapping) else _given.a_list(steps):
        option("step", "=".join(map(str, step)) if isinstance(step, tuple) else step)
    option("time-step", None if time_step is None else _number(time_step))
    option("group", group)
    option("load", None if load is None else f"{load[0]}={_vector(load[1])}")
    option("ids", None if ids is None else os.fspath(ids))
    for name, wanted in (("without-contacts", without_contacts), ("leave-out-distant", leave_out_distant)):
        words += [f"--{name}"] if wanted else []
    if flip_forces:
        words.append("--flip-forces" if flip_forces is True else f"--flip-forces={flip_forces}")
    with tempfile.TemporaryDirectory(prefix="grainfield-") as folder:
        file = os.path.join(folder, "packing.h5")
        report = _program.call(*words, "-o", file)
        packings = dict(packings_of(file))
    made: Any = next(iter(packings.values()))
    if len(packings) > 1:
        made = Collection(format, list(packings), packings.__getitem__)
    made.report = report
    return made


def export(
    value: Packing | Field | Mapping[str, Any] | str | os.PathLike,
    to: str,
    folder: str | os.PathLike,
    *,
    group: str = "",
    column: str = "",
    case: str | os.PathLike | None = None,
    set: Mapping[str, Any] | Sequence[str] | None = None,
    quick: bool = False,
    copies: tuple[int, int] | None = None,
) -> list[str]:
    """Writes a packing or a field for another program into a folder, as `grainfield export`, which it
    runs, and returns the paths of the files.

    value: a Packing, a Field, several by name, or "FILE.h5" or "FILE.h5:NAME". to: lammps (packing and
    input deck), vtu (ParaView), csv, html, svg or png. column: of a field's picture. For lammps: case, a
    case file or a shipped one whose law, damping and time step the deck takes, with set and quick as of
    run(); without it the deck asks for the law. copies: (nx, ny), the packing so many times along x and
    y. Raises ValueError, OSError with the command's line.
    """
    words: list[Any] = ["export", "--to", to, "-o", os.fspath(folder)]
    words += ["--group", group] if group else []
    words += ["--column", column] if column else []
    words += ["--quick"] if quick else []
    words += ["--copies", *copies] if copies is not None else []
    for text in _overrides(set):
        words += ["--set", text]
    if case is not None:
        words.append(os.fspath(case))
    before = _entries(folder)
    if isinstance(value, (str, os.PathLike)):
        _program.call(*words, os.fspath(value))
    elif not isinstance(value, (Packing, Field, Mapping)):
        raise TypeError(f'value: found {_given.found(value)}, allowed: a packing, a field, several by name, or "FILE.h5"')
    else:
        with tempfile.TemporaryDirectory(prefix="grainfield-") as place:
            file = os.path.join(place, getattr(value, "name", "packing") + ".h5")
            write(file, value)
            _program.call(*words, file)
    return [path for path, state in _entries(folder).items() if before.get(path) != state]


def _entries(folder: str | os.PathLike) -> dict[str, tuple[int, int]]:
    """What tells whether a file was written anew, of every file of a folder."""
    place = os.fspath(folder)
    if not os.path.isdir(place):
        return {}
    return {entry.path: (entry.inode(), entry.stat().st_mtime_ns)
            for entry in sorted(os.scandir(place), key=lambda one: one.name)
            if entry.is_file() and not entry.name.startswith(".")}

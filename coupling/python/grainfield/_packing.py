"""Packings from arrays."""

from __future__ import annotations

import difflib
import warnings
from typing import Any, Mapping, Sequence

import numpy as np

from . import _core, _given
from ._data import Packing
from ._arrays import whole

_ARGUMENTS = ("contacts", "walls", "ids", "density", "velocities", "fixed", "outlines", "friction", "gravity",
              "periodic")
_SHORT = {"velocities": ("vx", "vy", "vz"), "forces": ("fx", "fy", "fz"), "points": ("px", "py", "pz"),
          "normals": ("nx", "ny", "nz")}


_IDS = ("id", "i", "j")
#: What is named otherwise among the arguments than among the columns.
_ARGUMENT = {("grains", "id"): "ids", ("grains", "outline"): "outlines"}


def _ids(where: str, array: np.ndarray) -> np.ndarray:
    """Whole numbers to their last digit, or as they are."""
    if array.dtype.kind == "f":
        bits = min(np.finfo(array.dtype).nmant, 52) + 1
        if (np.abs(array) >= 2.0**bits).any():
            raise ValueError(f"{where}: found numbers of {array.dtype} from 2^{bits} on, where ids are rounded, "
                             "allowed: whole numbers (dtype int64)")
    if array.dtype.kind == "u" and (array > np.iinfo(np.int64).max).any():
        raise ValueError(f"{where}: found an id beyond 2^63, allowed: below")
    return array.astype(np.int64) if array.dtype.kind in "iu" else array.astype(float)


def _is_table(value: Any) -> bool:
    return isinstance(value, Mapping) or hasattr(value, "columns") or _names(value) is not None


def _names(value: Any) -> tuple[str, ...] | None:
    """The columns of a structured array, or of a compound dataset of HDF5."""
    return getattr(getattr(value, "dtype", None), "names", None)


def _table(name: str, value: Any) -> dict[str, Any]:
    """Columns by their names, of a mapping, a structured array or a DataFrame."""
    if value is None:
        return {}
    if isinstance(value, Mapping):
        return dict(value)
    if hasattr(value, "columns"):
        return {str(column): value[column] for column in value.columns}
    if (names := _names(value)) is not None:
        rows = value if isinstance(value, np.ndarray) else np.asarray(value)
        return {column: rows[column] for column in names}
    raise ValueError(f"{name}: found {type(value).__name__}, allowed: columns by their names, as a dict, a structured "
                     "array or a DataFrame")


def _periods(periodic: Mapping[str, tuple[float, float]] | Sequence[tuple[str, Any]] | None) -> list[str]:
    """"x=0.0:0.1" of {"x": (0, 0.1)}, or of [("x", (0, 0.1))]."""
    out = []
    try:
        axes: dict[str, Any] = {} if periodic is None else dict(periodic)
    except (TypeError, ValueError):
        raise ValueError(f"periodic: found {periodic!r}, allowed: (low, high) of each axis in m, such as "
                         '{"x": (0, 0.1)}') from None
    for axis, ends in axes.items():
        if np.ndim(ends) != 1 or len(ends) != 2:
            raise ValueError(f"periodic: found {ends!r} for {axis}, allowed: (low, high) in m, such as "
                             f'{{"{axis}": (0, 0.1)}}')
        out.append(f"{axis}={float(ends[0])!r}:{float(ends[1])!r}")
    return out


def _columns(table: str, given: Mapping[str, Any], dim: int, vectors: Mapping[str, Sequence[str]]):
    """Vectors (n, dim) by their components, lists of words as lists, all else as numbers."""
    out: dict[str, Any] = {}
    first = None  # column and its rows
    for column, value in given.items():
        if value is None:
            continue
        name = _ARGUMENT.get((table, column), column)
        array = _array(f"{table}.{name}", value)
        if column in vectors:
            if array.ndim != 2 or array.shape[1] != dim:
                raise ValueError(f"{table}.{name}: found an array of shape {array.shape}, "
                                 f"allowed: (n, {dim})")
        elif column == "pairs" and array.ndim == 2:
            raise ValueError(f'{table}.pairs: found an array of shape {array.shape}, allowed: columns i and j, ids of the '
                             'grains, and forces (n, dim); did you mean {"i": pairs[:, 0], "j": pairs[:, 1], "forces": ...}?')
        elif array.ndim != 1:
            near = difflib.get_close_matches(name, vectors, 1) if array.shape[1:] == (dim,) else []
            raise ValueError(f"{table}.{name}: found an array of shape {array.shape}, allowed: (n,)"
                             + "".join(f"; did you mean {other}, which takes (n, {dim})?" for other in near))
        first = first or (name, len(array))
        if len(array) != first[1]:
            raise ValueError(f"{table}: found {len(array)} values of {name} and {first[1]} of {first[0]}, allowed: as many")
        if column in vectors:
            numbers = _given.array(f"{table}.{name}", array)
            out.update({part: numbers[:, k] for k, part in enumerate(vectors[column][:dim])})
        elif array.dtype.kind in "US" or array.dtype == object:
            out[column] = [str(word) for word in value]
        elif column in _IDS:
            out[column] = _ids(f"{table}.{name}", array)
        else:
            out[column] = _given.array(f"{table}.{name}", array)
    return out


def _array(where: str, value: Any) -> np.ndarray:
    try:
        return np.asarray(whole(where, value))
    except ValueError as error:
        if "inhomogeneous" not in str(error):
            raise
        raise ValueError(f"{where}: found rows of different lengths, allowed: as many values in each") from None


def _wall_columns(walls: Any) -> dict[str, Any]:
    """Columns of walls; texts by names are refused, because they are no columns."""
    columns = _table("walls", walls)
    for name, value in columns.items():
        if np.ndim(value) == 0:
            text = f"{name}:{value}" if isinstance(value, str) else f"{name}:y=0"
            raise ValueError(f'walls.{name}: found {_given.found(value)}, allowed: columns name, x, y, nx, ny, ..., each (n,), '
                             f'or texts; did you mean walls="{text}"?')
    return columns


def _load(load: Any) -> tuple[int, list[float]]:
    if not isinstance(load, (tuple, list)) or len(load) != 2:
        raise TypeError(f"load: found {_given.found(load)}, allowed: (id, force), such as (12, (0, -300))")
    return int(load[0]), _given.floats("load", load[1])


def packing(
    x: Any,
    y: Any,
    radius: Any,
    z: Any = None,
    *,
    contacts: Any = None,
    walls: Any = None,
    ids: Any = None,
    mass: Any = None,
    density: float = 0,
    velocities: Any = None,
    fixed: Any = None,
    outlines: Sequence[Any] | None = None,
    friction: float | None = None,
    gravity: Sequence[float] | None = None,
    periodic: Mapping[str, tuple[float, float]] | Sequence[tuple[str, Any]] | None = None,
    load: tuple[int, Sequence[float]] | None = None,
    time: float = 0,
    flip_forces: bool | str = False,
    **columns: Any,
) -> Packing:
    """A packing of disks, convex polygons (2D) or, with z, spheres (3D) from arrays, in SI units.

    x, y, z, radius: (n) m; radius may be one number. mass (n), kg, or density, kg/m3 (2D: kg/m2).
    ids (n): whole numbers, each once; default 0, 1, 2, ... velocities (n, dim), m/s. fixed (n):
    part of the apparatus. outlines: for each grain corners (k, 2) about (x, y), m, or None.
    gravity: m/s2; default 9.81 down. periodic: {"x": (0, 0.1)}. load: (id, force) on that grain, N.

    contacts: columns of n contacts, as a dict, a structured array or a DataFrame. i, j (ids; j may be a wall's name), forces (n, dim), N, on i;
    optional points and normals (n, dim), friction, spring, sliding; or any of the names of
    docs/import.md. walls: their columns (name, x, y, nx, ny, ...), or texts such as "floor:y=0".
    friction: of contacts and walls that have no column of it.

    Other keywords are further columns of the grains under the names of docs/import.md (angle, spin,
    material, ...). The checks are those of `grainfield import`: grains:12 in a message is row 12,
    from 0. flip_forces: True turns all forces, "pairs" those between grains, "walls" those with
    walls. What `.check()` finds, and what the command `import` warns of, is given as Python
    warnings. Raises ValueError.
    """
    dim = 2 if z is None else 3
    for name, value in (("y", y), ("z", z), ("radius", radius)):
        whole(f"grains.{name}", value)
    x = np.atleast_1d(_given.array("grains.x", x))
    n = len(x)
    given: dict[str, Any] = {"x": x, "id": np.arange(n) if ids is None else ids}

    for name in columns:
        near = difflib.get_close_matches(name, _ARGUMENTS, 1, 0.85)
        if near:
            raise ValueError(f"packing: unknown argument {name}; did you mean {near[0]}?")
    def each(value: Any) -> Any:
        return np.full(n, value) if np.ndim(value) == 0 else value

    given["y"] = each(y)
    if z is not None:
        given["z"] = each(z)
    given["radius"] = each(radius)
    if mass is not None:
        given["mass"] = each(mass)
    if velocities is not None:
        given["velocities"] = velocities
    if fixed is not None:
        given["fixed"] = each(fixed)
    if outlines is not None:
        given["outline"] = [
            "" if corners is None else ";".join(f"{a!r} {b!r}" for a, b in np.asarray(corners).tolist())
            for corners in outlines
        ]
    given.update({name: each(value) for name, value in columns.items()})
    texts = [walls] if isinstance(walls, str) else [] if walls is None or _is_table(walls) else walls
    core = _core.packing(
        _columns("grains", given, dim, _SHORT),
        _columns("contacts", _table("contacts", contacts), dim, _SHORT),
        _columns("walls", _wall_columns(walls) if _is_table(walls) else {}, dim, {}),
        {
            "dim": dim,
            "gravity": None if gravity is None else _given.floats("gravity", gravity),
            "density": _given.number("density", density, "kg/m2" if dim == 2 else "kg/m3"),
            "friction": friction,
            "walls": list(texts),
            "periodic": _periods(periodic),
            "load": None if load is None else _load(load),
            "time": float(time),
            "flip_forces": flip_forces,
        },
    )
    made = Packing(core)
    for line in [*core.doubts, *made.check()["warnings"]]:
        warnings.warn(line, stacklevel=2)
    return made

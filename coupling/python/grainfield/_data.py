"""Packings, fields, tables and summaries: objects whose members are arrays, with their units."""

from __future__ import annotations

import csv
import os
import re
from typing import Any, Iterator, Mapping, Sequence

import numpy as np

from . import _arrays, _core, _show

PLANE_STRESS = ("sigma_xx", "sigma_yy", "sigma_xy")
SPACE_STRESS = ("sigma_xx", "sigma_yy", "sigma_zz", "sigma_yz", "sigma_xz", "sigma_xy")


class _Rows:
    """A table of a packing. Arrays are read-only views into the state, without copies."""

    _table = ""
    _names: Mapping[str, str] = {}  # member: column of the file

    def __init__(self, core: Any):
        self._core = core

    def _column(self, name: str) -> Any:
        return self._core.column(self._table, name)

    @property
    def units(self) -> dict[str, str]:
        """Unit of every member that is an array, by the member's name."""
        known = self._core.units(self._table)
        units = {member: known[column] for member, column in self._names.items() if column in known}
        return units | self._more_units()

    def _more_units(self) -> dict[str, str]:
        return {}

    def __getattr__(self, name: str) -> np.ndarray:
        names = type(self)._names
        if name not in names:
            raise AttributeError(f"{type(self).__name__} has no {name}; there are: {', '.join(names)}")
        try:
            return self._column(names[name])
        except KeyError:
            raise AttributeError(f"{name}: not in {self._core.about()['dim']}D") from None

    def __dir__(self) -> list[str]:
        return sorted(set(super().__dir__()) | set(self._names))

    def to_pandas(self) -> Any:
        """A DataFrame, a row each; vectors as NAME_x, NAME_y, NAME_z; .attrs["units"]."""
        return _show.rows_frame(self)


class Contacts(_Rows):
    """The contacts of a packing that carry force, n of them.

    pairs (n, 2): indices of the grains i and j into the packing's arrays; j = -1 - w: wall w.
    forces (n, dim), N, on grain i. normals (n, dim), unit, from i to j. points (n, dim), m.
    normal_forces (n), N, repulsion above 0; tangential_forces (n), N; springs (n), N; friction (n);
    sliding (n, bool). branches (n, dim), m: from centroid to centroid, at a wall to the contact
    point. images (n, 3): the periodic image of j that touches. pairs and branches are copies, the
    others views.
    """

    _table = "contacts"
    _shown = ("pairs", "points", "forces", "normal_forces", "tangential_forces", "friction", "sliding")
    _names = {
        "points": "point",
        "normals": "normal",
        "forces": "force",
        "normal_forces": "normal_force",
        "tangential_forces": "tangential_force",
        "springs": "spring",
        "friction": "friction",
        "sliding": "sliding",
        "spring_vectors": "spring_vector",
        "images": "image",
    }

    def __len__(self) -> int:
        return self._core.counts()[1]

    def _repr_html_(self) -> str:
        return _show.table_of_packing(self)

    def __repr__(self) -> str:
        return f"<Contacts: {len(self)}, with {', '.join(self.units)}>"

    def _more_units(self) -> dict[str, str]:
        return {"pairs": "1", "branches": "m"}

    @property
    def pairs(self) -> np.ndarray:
        return np.stack([self._column("i"), self._column("j")], axis=1)

    @property
    def branches(self) -> np.ndarray:
        return self._core.branches()


class Walls(_Rows):
    """The walls of a packing: names, and arrays as of contacts.

    points (w, dim), m; normals (w, dim), into the grains; friction (w); velocities (w, dim), m/s;
    forces (w, dim), N, of the grains on the wall; shapes: plane, cylinder, cone or mesh.
    """

    _table = "walls"
    _shown = ("shapes", "points", "normals", "forces", "velocities", "friction")
    _names = {
        "points": "point",
        "normals": "normal",
        "friction": "friction",
        "shapes": "shape",
        "radii": "radius",
        "lengths": "length",
        "materials": "material",
        "velocities": "velocity",
        "angular_velocities": "angular_velocity",
        "forces": "force",
        "torques": "torque",
    }

    def __len__(self) -> int:
        return self._core.counts()[2]

    def __repr__(self) -> str:
        return f"<Walls: {', '.join(self.names) or 'none'}>"

    def _repr_html_(self) -> str:
        return _show.table_of_packing(self)

    @property
    def names(self) -> list[str]:
        return self._core.about()["walls"]


class Packing(_Rows):
    """A packing at one instant, n grains in dim = 2 or 3 dimensions. It never changes.

    ids (n); positions, velocities (n, dim), m and m/s; radii, masses, volumes (2D: areas), inertias
    (n), m, kg, m3 (m2), kg m2; angles, spins (n), rad and rad/s; fixed (n, bool): part of the
    apparatus; orientations (n, 4), quaternions w, x, y, z, in 3D; images (n, 3). All are read-only
    views into the state: they cost nothing and keep it alive; their `.copy()` may be changed.
    contacts and walls are tables of the same kind; units tells each member's unit.
    """

    _table = "grains"
    _names = {
        "ids": "id",
        "positions": "position",
        "velocities": "velocity",
        "angles": "angle",
        "spins": "spin",
        "radii": "radius",
        "masses": "mass",
        "inertias": "inertia",
        "volumes": "volume",
        "fixed": "fixed",
        "orientations": "orientation",
        "angular_velocities": "angular_velocity",
        "moments": "moments",
        "materials": "material",
        "images": "image",
        "axes": "axes",
        "exponents": "exponents",
    }

    def __init__(self, core: Any):
        super().__init__(core)
        self.report = ""  #: what `grainfield import` prints of it
        about = core.about()
        self.dim: int = about["dim"]
        self.time: float = about["time"]  #: s
        self.gravity = np.array(about["gravity"])  #: m/s2
        self.loaded_grain: int | None = about["loaded_grain"] if about["loaded_grain"] >= 0 else None
        self.also_loaded: list[int] = about["also_loaded"]
        self.applied_force = np.array(about["applied_force"])  #: N, on each loaded grain
        self.attributes: dict[str, str] = about["attributes"]
        #: what a study recorded on the way to this state, e.g. tables["pair"]["depth"]; pandas.DataFrame takes each
        self.tables: dict[str, dict[str, np.ndarray]] = about["tables"]
        #: periodic (dim, bool), low (dim), m, edges (dim, dim), m, one a row, velocity_gradient, 1/s
        self.cell = {name: np.array(value) for name, value in about["cell"].items()}
        self.contacts = Contacts(core)
        self.walls = Walls(core)

    def __len__(self) -> int:
        return self._core.counts()[0]

    def __repr__(self) -> str:
        grains, contacts, walls = self._core.counts()
        return f"<Packing: {self.dim}D, {grains} grains, {contacts} contacts, {walls} walls>"

    def _repr_html_(self) -> str:
        return _show.packing(self)

    def to_meshio(self) -> Any:
        """A meshio.Mesh: grains as vertices with ids, radii, masses, fixed and velocities, contacts between
        grains as lines with forces and normal_forces (nan on the vertices). .write("FILE.vtu") saves it."""
        return _show.packing_mesh(self)

    @property
    def outlines(self) -> list[np.ndarray]:
        """Corners (k, 2) of polygons about their centroids before they are turned, m; empty: round."""
        return [np.array(outline).reshape(-1, 2) for outline in self._core.outlines()]

    def check(self) -> dict[str, Any]:
        """What `grainfield import` prints: unbalanced_force_ratio, support_ratio and warnings."""
        return self._core.checked()

    def plot(self, ax: Any = None, *, forces: bool = True, change: Packing | None = None) -> Any:
        """Draws grains, walls and the network of forces; returns the axes. In 3D seen along y.

        `change`: another state; drawn is then what the normal forces of this one have more (red) or
        less (blue) than there.
        """
        from ._plots import plot_packing

        return plot_packing(self, ax, forces=forces, change=change)


def _attribute(value: Any) -> str | float | list[float]:
    if isinstance(value, str):
        return value
    try:
        return np.asarray(value, float).tolist()
    except (TypeError, ValueError):
        return str(value)


class Field:
    """Values on points, with their spread over realizations.

    points (n, dim), m, in frame "heap" shares of the height; field["sigma_yy"] or field.sigma_yy (n): means;
    field.error("sigma_yy") (n): standard errors, nan with one realization; field.samples("sigma_yy")
    (n, realizations) or None. shape: (nx, ny) or (nx, ny, nz) of a grid, x fastest, else None.
    Arrays are read-only views. units: of every column. attributes: what is known of
    it: texts, numbers, or lists with one number per realization.
    """

    def __init__(
        self,
        points: Any,
        columns: Mapping[str, Any] | None = None,
        *,
        units: Mapping[str, str] | None = None,
        errors: Mapping[str, Any] | None = None,
        samples: Mapping[str, Any] | None = None,
        shape: Sequence[int] | None = None,
        realizations: int = 1,
        attributes: Mapping[str, Any] | None = None,
        name: str = "field",
    ):
        if isinstance(points, _core.Field):
            self._core = points
        else:
            units, errors, samples = units or {}, errors or {}, samples or {}
            given: list[tuple[Any, ...]] = [
                (
                    column,
                    units.get(column, "1"),
                    _arrays.array(column, values),
                    _arrays.array(column, errors[column]) if column in errors else None,
                    _arrays.array(column, samples[column]) if column in samples else None,
                )
                for column, values in (columns or {}).items()
            ]
            known = {key: _attribute(value) for key, value in (attributes or {}).items()}
            sizes = ([int(n) for n in _arrays.floats("shape", shape)] if shape is not None else []) + [0, 0, 0]
            self._core = _core.Field(_arrays.array("points", points), given, sizes[:3], realizations, known)
        self.name = name
        #: other fields of the same average: "base_response" of a response
        self.beside: dict[str, Field] = {}
        #: what makes the values doubtful, a line each
        self.warnings: list[str] = []
        #: where it is nan and why, a line each: of an average, points with too few grains
        self.gaps: list[str] = []
        self.seconds = 0.0  #: wall time that averaging it took, without Python's part

    @property
    def points(self) -> np.ndarray:
        return self._core.points()

    @property
    def shape(self) -> tuple[int, ...] | None:
        nx, ny, nz = self._core.shape()
        return None if nx == 0 else (nx, ny) if nz == 0 else (nx, ny, nz)

    @property
    def realizations(self) -> int:
        return self._core.realizations()

    @property
    def attributes(self) -> dict[str, str | float | list[float]]:
        return self._core.attributes()

    @property
    def is_over_height(self) -> bool:
        """Whether lengths are shares of the heaps' height."""
        return self._core.is_over_height()

    @property
    def units(self) -> dict[str, str]:
        return self._core.units()

    @property
    def columns(self) -> list[str]:
        return list(self._core.units())

    def _named(self, read: Any, name: str) -> Any:
        try:
            return read(name)
        except KeyError:
            raise KeyError(f"no column {name}; there are: {', '.join(self.columns)}") from None

    def __getitem__(self, name: str) -> np.ndarray:
        return self._named(self._core.value, name)

    def __getattr__(self, name: str) -> np.ndarray:
        if name.startswith("_"):
            raise AttributeError(name)
        try:
            return self[name]
        except KeyError as error:
            raise AttributeError(error.args[0]) from None

    def __contains__(self, name: str) -> bool:
        return name in self._core.units()

    def __len__(self) -> int:
        return len(self.points)

    def __repr__(self) -> str:
        return f"<Field {self.name}: {len(self)} points, {', '.join(self.columns[:4])}, ...>"

    def _repr_html_(self) -> str:
        return _show.field(self)

    def error(self, name: str) -> np.ndarray | None:
        """Standard error of the mean over realizations (n); None where there is none."""
        return self._named(self._core.error, name)

    def samples(self, name: str) -> np.ndarray | None:
        """The single values, (n, realizations); None where they are not kept."""
        return self._named(self._core.samples, name)

    @property
    def stress(self) -> np.ndarray:
        """A copy: xx, yy, xy (n, 3); in space xx, yy, zz, yz, xz, xy (n, 6)."""
        names = SPACE_STRESS if "sigma_zz" in self else PLANE_STRESS
        return np.stack([self[name] for name in names], axis=1)

    def grid(self, name: str) -> np.ndarray:
        """A column as an array of the grid: [iy, ix], in space [iz, iy, ix]. A view."""
        if self.shape is None:
            raise ValueError("the points are no grid")
        return self[name].reshape(self.shape[::-1])

    def to_pandas(self) -> Any:
        """A DataFrame, a row for each point: its coordinates, the columns, COLUMN_error; .attrs has
        units and attributes."""
        return _show.field_frame(self)

    def to_xarray(self) -> Any:
        """A Dataset: a grid's coordinates, or points; the columns, COLUMN_error, and COLUMN_samples with
        the coordinate realization, 0, 1, ... Units are in the attributes of each."""
        return _show.field_dataset(self)

    def to_meshio(self) -> Any:
        """A meshio.Mesh: a grid as quadrilaterals or hexahedra, other points as vertices; the columns and
        COLUMN_error at the points, in space with z = 0 for a field of the plane. .write("FILE.vtu") saves it."""
        return _show.field_mesh(self)

    def plot(self, column: str | None = None, ax: Any = None) -> Any:
        """Draws a grid as a map, lines as profiles with bands of one error; returns the axes.
        By default the vertical stress: sigma_yy in the plane, sigma_zz in space. Normal stresses
        are drawn as pressures, -sigma_yy."""
        from ._plots import plot_field

        if column is None:
            column = "sigma_yy" if self.points.shape[1] == 2 else "sigma_zz"
        return plot_field(self, column, ax)


class Summary(dict):
    """summary.json: figures by their dotted names, with `.units`; docs/summary-keys.md has all."""

    @property
    def units(self) -> dict[str, str]:
        """Unit of every key; "-" for pure numbers, "text" for words."""
        return {key: _core.summary_unit(key) or "-" for key in self}

    def under(self, start: str) -> dict[str, Any]:
        """Those whose name begins so, without that: summary.under("fit.osl.")."""
        return {key[len(start):]: value for key, value in self.items() if key.startswith(start)}

    def to_pandas(self) -> Any:
        """A DataFrame with the columns value and unit, a row for each key."""
        return _show.summary_frame(self)

    def _repr_html_(self) -> str:
        return _show.summary(self)


class Table(dict):
    """A table of text as arrays by column: numbers, or words where some cell is none. `.units`."""

    def __init__(self, columns: Mapping[str, np.ndarray], units: Mapping[str, str], notes: list[str]):
        super().__init__(columns)
        self.units = dict(units)
        self.notes = notes  #: the comment lines

    def __missing__(self, name: str) -> Any:
        hint = f"; {name} is a profile: plot(profile={name!r})" if name in self.get("profile", ()) else ""
        raise KeyError(f"no column {name}; there are: {', '.join(self)}{hint}")

    def to_pandas(self) -> Any:
        """A DataFrame with .attrs["units"] and .attrs["notes"]."""
        return _show.frame(dict(self), self.units, notes=self.notes)

    def _repr_html_(self) -> str:
        return _show.columns(self)

    def rows(self) -> Iterator[dict[str, Any]]:
        """One dictionary per row."""
        for values in zip(*self.values()):
            yield dict(zip(self, values))


#: "sigma_xx_N/m_error": a name, its unit and what of it the column holds.
_HEADER = re.compile(r"(.+?)_(N/m2|N/m|Pa|m_per_s|m2|m|s|N|Nm|J|rad)(_error|_error_bar)?")


def _header(text: str) -> tuple[str, str]:
    """The name and the unit in a column's header: "x_m", "x (m)", "friction_angle_deg" (as it is)."""
    start, bracket, unit = text.rpartition(" (")
    if bracket and unit.endswith(")"):
        return start, unit[:-1]
    if found := _HEADER.fullmatch(text):
        return found[1] + (found[3] or ""), found[2].replace("_per_", "/")
    return text, "deg" if text.endswith("_deg") else "1"


def _number(text: str) -> float | None:
    try:
        return float(text)
    except ValueError:
        return None


def read_table(path: str | os.PathLike) -> Table:
    """A CSV file with '#' comments and a header whose names may end with a unit: "x_m", "x (m)"."""
    notes, lines = [], []
    with open(path, newline="", encoding="utf-8") as file:
        for line in file:
            if line.startswith("#"):
                notes.append(line[1:].strip())
            elif line.strip():
                lines.append(line)
    first = lines[0] if lines else ""
    rows = csv.reader(lines, delimiter=";" if first.count(";") > first.count(",") else ",")
    columns, units = {}, {}
    for text, *cells in zip(*rows):
        name, unit = _header(text)
        if name in columns:
            name = text
        numbers = [_number(cell) for cell in cells]
        columns[name] = np.array(cells if None in numbers else numbers)
        units[name] = unit
    return Table(columns, units, notes)

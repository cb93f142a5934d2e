"""How packings, fields, tables and judgements show themselves in a notebook, and travel to pandas and xarray."""

from __future__ import annotations

import html
from typing import Any, Iterable, Mapping, Sequence

import numpy as np

_MOST_ROWS = 12  # of a table in a notebook: the first and the last half of them
_MOST_FIGURES = 60  # of a summary
_AXES = ("x", "y", "z")
_ADDED = ("added_forces", "former_added_forces")  # names of forces that a Python function adds or added


def number(value: Any) -> str:
    """A cell: six digits of a number, anything else as it is."""
    if isinstance(value, (float, np.floating)):
        return "-" if np.isnan(value) else f"{value:.6g}"
    return str(value)


def table(header: Sequence[Any], rows: Iterable[Sequence[Any]]) -> str:
    def line(cells: Iterable[Any], tag: str) -> str:
        return "<tr>" + "".join(f"<{tag}>{html.escape(number(cell))}</{tag}>" for cell in cells) + "</tr>"

    body = "".join(line(row, "td") for row in rows)
    return f"<table><thead>{line(header, 'th')}</thead><tbody>{body}</tbody></table>"


def paragraph(text: str, tag: str = "p") -> str:
    return f"<{tag}>{html.escape(text)}</{tag}>"


def packing(state: Any) -> str:
    radii = state.radii
    across = f"{radii.min():.4g} to {radii.max():.4g} m" if len(radii) else "-"
    rows = [("grains", len(state)), ("contacts", len(state.contacts)), ("walls", ", ".join(state.walls.names) or "none"),
            ("radii", across), ("gravity", f"{np.round(state.gravity, 6).tolist()} m/s2"), ("time", f"{state.time:.6g} s")]
    rows += [(name.replace("_", " "), state.attributes[name]) for name in _ADDED if name in state.attributes]
    return table([f"Packing, {state.dim}D", ""], rows)


def field(of: Any) -> str:
    def extent(values: np.ndarray) -> tuple[str, str]:
        known = values[np.isfinite(values)]
        return (number(known.min()), number(known.max())) if len(known) else ("-", "-")

    shape = "" if of.shape is None else f" ({' x '.join(map(str, of.shape))})"
    title = f"Field {of.name}: {len(of)} points{shape}, {of.realizations} realization{'s' * (of.realizations != 1)}"
    rows = [(name, of.units[name], *extent(of[name]), "yes" if of.error(name) is not None else "no")
            for name in of.columns]
    shown = paragraph(title) + table(["column", "unit", "least", "largest", "errors"], rows)
    shown += "".join(paragraph(f"{name.replace('_', ' ')}: {of.attributes[name]}")
                     for name in _ADDED if name in of.attributes)
    return shown + "".join(paragraph(line) for line in of.gaps)


def columns(of: Any) -> str:
    """The rows of a table, of many the first and the last."""
    return rows_of(dict(of), of.units)


def rows_of(values: Mapping[str, Any], units: Mapping[str, str], most: int = _MOST_ROWS) -> str:
    count = len(next(iter(values.values()), ()))
    picked = list(range(count))
    if count > most:
        picked = picked[: most // 2] + picked[-most // 2 :]
    header = [name if units.get(name) in (None, "1", "text") else f"{name} ({units[name]})" for name in values]
    rows: list[Sequence[Any]] = [[column[k] for column in values.values()] for k in picked]
    if count > most:
        rows.insert(most // 2, ["..."] * len(header))
    return table(header, rows) + paragraph(f"{count} rows")


def table_of_packing(of: Any) -> str:
    """What matters most of contacts or walls: vectors by their components."""
    values, units = _by_components(of, of._shown)
    return rows_of(values, units)


def _of_summary(of: Any) -> dict[str, list]:
    return {"key": list(of), "value": list(of.values()), "unit": list(of.units.values())}


def summary(of: Any) -> str:
    return rows_of(_of_summary(of), {}, _MOST_FIGURES)


def summary_frame(of: Any) -> Any:
    rows = _of_summary(of)
    pandas = _package("pandas")
    return pandas.DataFrame({name: rows[name] for name in ("value", "unit")}, index=pandas.Index(rows["key"], name="key"))


def result(of: Any) -> str:
    """What a run left: its verdict, and what of each kind there is to ask for."""
    there = [("summary", f"{len(of.summary)} figures")]
    there += [(name, ", ".join(getattr(of, name))) for name in ("tables", "fields", "snapshots", "members") if getattr(of, name)]
    there += [("report", of.report)] if of.report else []
    shown = paragraph(of.verdict, "h4") if of.verdict else ""
    shown += table([f"Result {of.folder}", ""], [(f".{name}", text if len(text) < 300 else text[:300] + " ...") for name, text in there])
    return shown + ("<ul>" + "".join(paragraph(line, "li") for line in of.warnings) + "</ul>" if of.warnings else "")


def structure(of: Any) -> str:
    rows = [("grains counted", of.grains_counted), ("rattlers", of.rattlers), ("coordination", of.coordination),
            ("coordination without rattlers", of.coordination_bearing), ("force chains", len(of.chains))]
    rows += [("mean force on the base (N)", of.base["mean"])] if of.base else []
    return table(["Structure", ""], rows)


def judgement(of: Any) -> str:
    shown = of._core.table()
    out = "".join(paragraph(line, "h4") for line in of.headlines)
    out += "".join(paragraph(line) for line in ([of.agreement] if of.agreement else []))
    if shown.rows:
        out += table(shown.header, shown.rows) + paragraph(shown.note)
    out += "".join(paragraph(line) for line in of.notes)
    if of.doubts:
        out += "<ul>" + "".join(paragraph(line, "li") for line in of.doubts) + "</ul>"
    return out


def _package(name: str) -> Any:
    try:
        return __import__(name)
    except ImportError as error:
        raise ImportError(f"this needs {name}, which is not installed (Debian: python3-{name})") from error


def frame(values: dict[str, np.ndarray], units: dict[str, str], **more: Any) -> Any:
    """A DataFrame with .attrs["units"]."""
    out = _package("pandas").DataFrame(values)
    out.attrs = {"units": {name: units.get(name, "1") for name in values}} | more
    return out


def rows_frame(of: Any) -> Any:
    return frame(*_by_components(of))


def _by_components(of: Any, names: Sequence[str] = ()) -> tuple[dict[str, Any], dict[str, str]]:
    """A table of a packing: arrays of several numbers a row become columns NAME_x, NAME_y or NAME_0, ..."""
    values: dict[str, Any] = {"name": np.array(of.names, object)} if hasattr(of, "names") else {}
    units = dict.fromkeys(values, "text")
    for name in names or of.units:
        array, unit = np.asarray(getattr(of, name)), of.units[name]
        if array.ndim == 1:
            parts = {name: array}
        else:
            ends = _AXES if array.shape[1] <= 3 and name != "pairs" else range(array.shape[1])
            parts = {f"{name}_{end}": array[:, k] for k, end in zip(range(array.shape[1]), ends)}
        values |= parts
        units |= dict.fromkeys(parts, unit)
    return values, units


def axes_of_field(of: Any) -> tuple[str, ...]:
    """Names of the coordinates of a field's points."""
    return ("r", "z") if "sigma_rr" in of else _AXES[: of.points.shape[1]]


def _units_of_points(of: Any) -> str:
    return "1" if of.is_over_height else "m"


def field_frame(of: Any) -> Any:
    axes = axes_of_field(of)
    values = {axis: of.points[:, k] for k, axis in enumerate(axes)}
    units = dict.fromkeys(axes, _units_of_points(of))
    for name in of.columns:
        values[name], units[name] = of[name], of.units[name]
        if of.error(name) is not None:
            values[f"{name}_error"], units[f"{name}_error"] = of.error(name), of.units[name]
    return frame(values, units, attributes=dict(of.attributes))


def field_dataset(of: Any) -> Any:
    xarray = _package("xarray")
    axes, unit = axes_of_field(of), _units_of_points(of)
    if of.shape is None:
        dims: tuple[str, ...] = ("point",)
        shape: tuple[int, ...] = (len(of),)
        coords: dict[str, Any] = {axis: (dims, of.points[:, k], {"units": unit}) for k, axis in enumerate(axes)}
    else:  # x fastest
        dims, shape = axes[::-1], of.shape[::-1]
        grids = [of.points[:, k].reshape(shape) for k in range(len(axes))]
        coords = {axis: (axis, np.moveaxis(grid, len(axes) - 1 - k, 0).reshape(shape[len(axes) - 1 - k], -1)[:, 0],
                         {"units": unit}) for k, (axis, grid) in enumerate(zip(axes, grids))}
    values = {}
    for name in of.columns:
        attrs = {"units": of.units[name]}
        values[name] = (dims, of[name].reshape(shape), attrs)
        if of.error(name) is not None:
            values[f"{name}_error"] = (dims, of.error(name).reshape(shape), attrs)
        if of.samples(name) is not None:
            samples = of.samples(name)
            values[f"{name}_samples"] = ((*dims, "realization"), samples.reshape(*shape, samples.shape[1]), attrs)
            coords.setdefault("realization", np.arange(samples.shape[1]))
    return xarray.Dataset(values, coords, dict(of.attributes))


def _in_space(vectors: np.ndarray) -> np.ndarray:
    """Rows of three numbers, as ParaView has points and vectors."""
    return np.pad(vectors, ((0, 0), (0, 3 - vectors.shape[1])))


def field_mesh(of: Any) -> Any:
    """A grid as quadrilaterals or hexahedra, other points as vertices."""
    meshio = _package("meshio")
    if of.shape is None:
        cells = {"vertex": np.arange(len(of))[:, None]}
    else:
        at = np.arange(len(of)).reshape(of.shape[::-1])  # [(iz,) iy, ix]
        face = [at[..., :-1, :-1], at[..., :-1, 1:], at[..., 1:, 1:], at[..., 1:, :-1]]
        corners = face if at.ndim == 2 else [c[:-1] for c in face] + [c[1:] for c in face]
        cells = {"quad" if at.ndim == 2 else "hexahedron": np.stack([c.ravel() for c in corners], axis=1)}
    data = {name: np.array(of[name]) for name in of.columns}
    data |= {f"{name}_error": np.array(of.error(name)) for name in of.columns if of.error(name) is not None}
    return meshio.Mesh(_in_space(of.points), cells, point_data=data)


def packing_mesh(state: Any) -> Any:
    """Grains as vertices and contacts between grains as lines; forces of contacts belong to the lines."""
    meshio = _package("meshio")
    names = ("ids", "radii", "masses", "fixed", "velocities")
    grains = {name: np.asarray(getattr(state, name)) for name in names}
    grains["fixed"] = grains["fixed"].astype(np.int64)
    grains["velocities"] = _in_space(grains["velocities"])
    contacts = state.contacts
    pair = contacts.pairs[:, 1] >= 0
    cells = [("vertex", np.arange(len(state))[:, None]), ("line", contacts.pairs[pair])]
    of_lines = {"forces": _in_space(contacts.forces)[pair], "normal_forces": contacts.normal_forces[pair]}
    data = {name: [np.full((len(state), *values.shape[1:]), np.nan), values] for name, values in of_lines.items()}
    return meshio.Mesh(_in_space(state.positions), cells, point_data=grains, cell_data=data)

"""average, strain, structure, model, fit, compare, run: what the commands of these names do."""

from __future__ import annotations

import atexit
import os
import warnings as _warnings
from typing import Any, Callable, Iterable, Mapping, Sequence

import numpy as np

from . import _core, _given
from ._data import PLANE_STRESS, SPACE_STRESS, Field, Packing
from ._model import Model
from ._progress import Progress
from ._results import CompareResult, FitResult, Result, Structure

atexit.register(_core.finish_ranks)


def _warn(lines: Iterable[str]) -> None:
    for line in lines:
        if line:
            _warnings.warn(line, stacklevel=3)


def _toml(value: Any) -> str:
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, (list, tuple, np.ndarray)):
        return "[" + ", ".join(_toml(one) for one in value) + "]"
    if isinstance(value, str):
        return '"' + value.replace("\\", "\\\\").replace('"', '\\"') + '"'
    return repr(value.item() if isinstance(value, np.generic) else value)


def _overrides(sets: Mapping[str, Any] | Sequence[str] | None) -> list[str]:
    """{"material.friction": 0.3} as ["material.friction=0.3"]."""
    if isinstance(sets, Mapping):
        return [f"{key}={_toml(value)}" for key, value in sets.items()]
    return _given.a_list(sets)


def average(
    snapshots: Any,
    *,
    unloaded: Any = None,
    points: Any = None,
    grid: Any = None,
    cuts: Sequence[float] = (),
    frame: str = "layer",
    up: str = "",
    method: str = "coarse_graining",
    kernel: str | None = None,
    width: float | None = None,
    free_surface: str = "open",
    least_grains: int = 3,
    quantities: Sequence[str] = (),
    response: bool = False,
    rings: bool = False,
    axis: Sequence[float] = (),
    end_at_walls: bool = False,
    threads: int = 1,
) -> Field:
    """Averages packings into a field on points (docs/averaging.md), as `grainfield average`.

    snapshots: a packing, "FILE.h5" (all in it) or "FILE.h5:group", or a list of these: realizations
    of one, whose mean and standard error the field holds. unloaded: states before the load, one for
    each; the field then is the response, loaded - unloaded; so is it with response=True of files
    that hold both under these names. points (k, dim) in the frame (layer, packing: m; heap: shares of
    the height, from the apex), or a grid (81, 31), or cuts, shares of the height. frame: layer, heap
    or packing. up: "y", "-z" and so on, in the packing's axes; by default against its gravity, or its
    load. width: m in every frame; default one mean diameter (particle_centre, area_exact: 2.5).
    rings: in 3D, points are radius and height.

    Places with too few grains are nan: .gaps of the field says which and why, a line each. The field's
    warnings are also given as Python warnings; so are the gaps among points that are given, and where
    nothing but nan is left. Raises ValueError.
    """
    out = _given.call(
        _core.average,
        sources=_given.packings("snapshots", snapshots),
        unloaded=_given.packings("unloaded", unloaded),
        points=_given.points(points),
        grid=_given.grid(grid),
        cuts=_given.floats("cuts", cuts),
        frame=frame,
        up=up,
        method=method,
        kernel=kernel,
        width=width,
        free_surface=free_surface,
        least_grains=least_grains,
        quantities=_given.a_list(quantities),
        response=response,
        rings=rings,
        axis=_given.floats("axis", axis),
        end_at_walls=end_at_walls,
        threads=threads,
    )
    named = {name: Field(core, name=name) for name, core in out.fields}
    field = named.pop(next(iter(named)))
    field.beside = named
    field.seconds = out.seconds
    _tell(field, out.warnings, out.gaps.splitlines(), points is not None)
    return field


def _tell(field: Field, lines: list[str], gaps: list[str], given: bool) -> None:
    """Gaps of a grid are no news; those at points that are given, and a field of nan alone, are."""
    field.gaps = gaps
    field.warnings = list(lines)
    if given or not np.isfinite(field[field.columns[0]]).any():
        field.warnings += gaps
    for line in field.warnings:
        _warnings.warn(line, stacklevel=3)


def strain(
    before: Any,
    after: Any,
    *,
    points: Any = None,
    grid: Any = None,
    frame: str = "layer",
    up: str = "",
    measure: str = "cambou",
    support: str | None = None,
    width: float | None = None,
    least_grains: int = 6,
    threads: int = 1,
) -> Field:
    """Displacement gradient and strain between two states of the same grains (docs/strain.md).

    before, after: packings or "FILE.h5:group". measure: cambou, cundall, liao, derivative or kernel.
    width: m; default three mean diameters. .gaps, .warnings: as of average(). Raises ValueError.
    """
    core, lines = _given.call(
        _core.strain,
        before=_given.packing("before", before),
        after=_given.packing("after", after),
        points=_given.points(points),
        grid=_given.grid(grid),
        frame=frame,
        up=up,
        measure=measure,
        support=support,
        width=width,
        least_grains=least_grains,
        threads=threads,
    )
    field = Field(core, name="strain")
    gaps = [line for line in lines if " points have no strain:" in line]
    _tell(field, [line for line in lines if line not in gaps], gaps, points is not None)
    return field


def structure(snapshot: Any) -> Structure:
    """Contacts, base forces, force chains and orientation of a packing or "FILE.h5:group"."""
    return Structure(_core.structure(_given.packing("snapshot", snapshot)))


class SetModel:
    """A continuum model with its parameters set; call it with points."""

    def __init__(self, name: str, settings: Mapping[str, Any]):
        texts = {key: value if isinstance(value, str) else repr(_given.number(f"model {name}: {key}", value))
                 for key, value in settings.items()}
        self._core = _core.Model(name, texts)
        self.name = name
        self.settings = dict(settings)
        self.dim: int = self._core.dim  #: of the points

    @property
    def components(self) -> tuple[str, ...]:
        """Names of the stresses' columns."""
        return PLANE_STRESS if self.dim == 2 else SPACE_STRESS

    def __call__(self, points: Any) -> np.ndarray:
        """Stresses (k, 3), in space (k, 6), in N/m (Pa), at points (k, dim), m; nan outside the
        model. Raises RuntimeError when a solve fails."""
        return self._core.stress(_given.points(points))

    def quantities(self, points: Any) -> dict[str, np.ndarray]:
        """What the model knows besides the stress, such as displacements; of most nothing."""
        return self._core.quantities(_given.points(points))

    @property
    def figures(self) -> dict[str, float]:
        """Figures of the evaluation, such as iterations."""
        return self._core.figures()

    def __repr__(self) -> str:
        return f"<SetModel {self.name}: {', '.join(f'{k}={v}' for k, v in self.settings.items())}>"


def model(name: str, **settings: Any) -> SetModel:
    """The model of this name: gf.model("layer", F=300, h=0.15)(points). models() lists them.

    Raises ValueError for an unknown name or parameter, or a value out of range.
    """
    return SetModel(name, settings)


def models() -> dict[str, dict[str, Any]]:
    """Every model: summary, dim and parameters with default, unit, allowed, meaning and source."""
    return {one.pop("name"): one for one in _core.models()}


_MODELS = '"NAME", "NAME:p=v,...", (name, {p: v}), a model, or a list of these; gf.models() has the names'


def _several(models: Any) -> list:
    if isinstance(models, (str, SetModel, Model)):
        return [models]
    if not isinstance(models, Iterable):
        raise TypeError(f"models: found {_given.found(models)}, allowed: {_MODELS}")
    return list(models)


def _choices(models: Any) -> list[str]:
    """Texts as of --model; of a mapping {label: "NAME:p=v" or (name, {p: v}) or SetModel or Model}."""
    if isinstance(models, Mapping):
        return [f"{label}={_choice(value)}" for label, value in models.items()]
    return [_choice(value) for value in _several(models)]


def _choice(value: Any) -> str:
    if isinstance(value, str):
        return value
    if isinstance(value, (SetModel, Model)):
        name, settings = value.name, getattr(value, "settings", {})
    elif isinstance(value, tuple) and len(value) == 2 and isinstance(value[1], Mapping):
        name, settings = value
    else:
        raise TypeError(f"models: found {_given.found(value)}, allowed: {_MODELS}")
    return name + (":" if settings else "") + ",".join(f"{k}={v}" for k, v in settings.items())


def _free_choice(value: Any) -> str:
    """As of `fit --model`: the parameters of a model of one's own are free."""
    return _choice((value.name, dict.fromkeys(value.parameters, "free")) if isinstance(value, Model) else value)


def import_field(
    file: str | os.PathLike,
    *,
    height: float,
    geometry: str = "heap",
    slope: float | tuple[float, float] | None = None,
    rho_g: float | None = None,
    load: float | None = None,
    width: float = 0,
    dim: int | None = None,
) -> Field:
    """Stresses measured in a laboratory as a field (docs/import.md), as `grainfield import-field`.

    file: CSV with columns x, component, value, error (and y, in 3D z, off the base), each number
    with its unit in brackets. height: m, of the heap or layer. Of heaps slope, degrees, one or (left,
    right), and rho_g, N/m3 (2D: N/m2); of layers load, N. dim: 2 or 3; by default 3 where the file has a
    column z or r. width: radius of the cells, m. What the
    command warns of is given as Python warnings. Raises ValueError.
    """
    nan = float("nan")
    left, right = slope if isinstance(slope, tuple) else (slope, slope)
    left, right, weight, force = (nan if value is None else float(value) for value in (left, right, rho_g, load))
    core, _ = _core.import_field(os.fspath(file), geometry, dim or 0, float(height), left, right, weight, force, float(width))
    name = _core.name_of_measured(core)
    for line in _core.measured_doubts(core):
        _warnings.warn(f"{name}: {line}", stacklevel=2)
    return Field(core, name=name)


def _field(value: Any) -> Field:
    if isinstance(value, Packing):
        raise TypeError("field: found a packing, allowed: a field; gf.average(packing, frame=...) makes one, gf.fit takes packings")
    if not isinstance(value, Field):
        raise TypeError(f'field: found {_given.found(value)}, allowed: a field, several by name, or "FIELD.h5"; gf.average '
                        "makes one of packings, gf.Field of arrays, gf.import_field of a table")
    return value


def compare(
    field: Any,
    models: Any,
    *,
    fields: Sequence[str] = (),
    components: Sequence[str] = (),
    heights: Sequence[float] = (),
    origin: Sequence[float] = (),
    folder: str | os.PathLike | None = None,
) -> CompareResult:
    """Compares a field with continuum models (docs/comparison.md), as `grainfield compare`.

    field: a Field (with its base response, if it has one), several by name, or "FIELD.h5". models:
    "NAME", "NAME:p=v,...", "LABEL=NAME:p=v,...", a Model of one's own (with its defaults, or
    called with values), a list of these, or {label: model}. fields: only
    these. folder: where profiles.*, summary.json and report.html go; without it nothing is written.
    Raises ValueError.
    """
    held: list = []
    if isinstance(field, Field):
        field = {field.name: field} | field.beside
    if isinstance(field, Mapping):
        held = [(name, _field(one)._core) for name, one in field.items()]
        field = "field"
    elif not isinstance(field, (str, os.PathLike)):
        _field(field)
    place = None if folder is None else os.fspath(folder)
    outcome = _given.call(
        _core.compare,
        file=os.fspath(field),
        held=held,
        models=_choices(models),
        fields=_given.a_list(fields),
        components=_given.a_list(components),
        heights=_given.floats("heights", heights),
        origin=_given.floats("origin", origin),
        folder=place or "",
    )
    _warn([outcome.lacks, *outcome.doubts])
    return CompareResult(outcome, place)


def fit(
    inputs: Any,
    models: Any = None,
    *,
    heights: Sequence[float] = (),
    components: Sequence[str] = (),
    width_diameters: float | None = None,
    case: str = "",
    set: Mapping[str, Any] | Sequence[str] | None = None,
    coverage: Sequence[int] = (),
    draws: int = 100,
    folder: str | os.PathLike | None = None,
    threads: int = 1,
) -> FitResult:
    """Fits stress models to heaps and ranks them (docs/fits.md), as `grainfield fit`.

    inputs: packings, one Field of frame heap, or names as of the command, or a list. models: names,
    also "NAME:p=free,q=0.3", and a Model of one's own; default all for symmetric heaps. heights: shares of the heap's height.
    set: {"fit.huber": 3}. folder: as of compare(). Raises ValueError, RuntimeError.
    """
    if isinstance(inputs, Mapping):
        inputs = list(inputs.values())
    given = list(inputs) if isinstance(inputs, (list, tuple)) else [inputs]
    fields = [one._core for one in given if isinstance(one, Field)]
    packings = [one._core for one in given if isinstance(one, Packing)]
    files = [_given.packing("inputs", one, ", a field, or a list of these") for one in given
             if not isinstance(one, (Field, Packing))]
    if len(fields) > 1:
        raise ValueError("fit: a field is fitted alone; average all packings into one (frame=\"heap\")")
    place = None if folder is None else os.fspath(folder)
    outcome = _given.call(
        _core.fit,
        files=files,
        packings=packings,
        field=fields[0] if fields else None,
        models=[] if models is None else [_free_choice(one) for one in _several(models)],
        heights=_given.floats("heights", heights),
        components=_given.a_list(components),
        width_diameters=width_diameters,
        case=case,
        sets=_overrides(set),
        coverage=_given.a_list(coverage),
        draws=draws,
        folder=place or "",
        threads=threads,
    )
    _warn([outcome.lacks, *outcome.warnings])
    return FitResult(outcome, place)


def run(
    case: str | os.PathLike,
    folder: str | os.PathLike | None = None,
    *,
    quick: bool = False,
    set: Mapping[str, Any] | Sequence[str] | None = None,
    resume: bool = False,
    threads: int = 0,
    checkpoint_seconds: float = 30,
    progress: bool | Callable[[Mapping[str, Any]], Any] = True,
    note: Callable[[str], Any] | None = None,
    stop_after_steps: int = 0,
) -> Result | None:
    """Runs a case, as `grainfield run`, and returns what it left in the folder.

    case: a case file or the name of a shipped one. folder: default results/CASE (CASE-quick). set:
    {"material.friction": 0.3} or ["material.friction=0.3"]. threads: 0 is all cores; the results do
    not depend on it. progress: True shows a line on a terminal and, where tqdm is installed, a bar in a
    notebook; a function is called about five times
    a second with phase, done, total, fraction, simulated_time (s), grains, awake, kinetic_energy (J),
    unbalanced_force_ratio, seconds_left and text. note: called with lines about what begins.

    Ctrl-C, and any exception out of progress or note, writes a checkpoint and stops; resume=True goes
    on to the same bits. One run at a time in a process; under mpirun ranks other than the first get
    None. Raises ValueError, RuntimeError, OSError, KeyboardInterrupt.
    """
    line = Progress()
    show = progress or None
    if progress is True:
        show = lambda now: line.show(now["text"], now["fraction"])  # noqa: E731
    try:
        found = _given.call(
            _core.run,
            case=os.fspath(case),
            folder="" if folder is None else os.fspath(folder),
            sets=_overrides(set),
            quick=quick,
            resume=resume,
            threads=threads,
            checkpoint_seconds=checkpoint_seconds,
            stop_after_steps=stop_after_steps,
            progress=show,
            note=note,
        )
    finally:
        line.end()
    _warn(found["warnings"])
    return Result(found["folder"], found["warnings"]) if found["first"] else None

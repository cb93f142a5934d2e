"""sweep: a case for every combination of values, side by side."""

from __future__ import annotations

import concurrent.futures
import hashlib
import itertools
import json
import os
import re
import signal
import threading
import warnings
from collections.abc import Mapping as MappingBase
from typing import Any, Iterator, Mapping, Sequence

import numpy as np

from . import _core, _program, _show
from ._cases import cases, check, keys
from ._commands import _overrides
from ._data import Table
from ._progress import Progress
from ._results import Result

_RECORD = "sweep.json"
_SHOWN = 6  # figures in a notebook

_lock = threading.Lock()
_running: set = set()  # programs at work in this process


class Sweep(MappingBase):
    """The results of a sweep by the names of its members, such as sweep["friction_0.3"]; settings has the
    values of each, folder is where they are.

    table("repose.mean_deg", ...) has a row for every member: its values, each figure of summary.json and
    FIGURE_error, its standard error over the realizations, nan where none is known. figures lists what has
    such an error in every member; table() without names takes these. to_pandas() is the same as a
    DataFrame. plot("repose.mean_deg") draws a figure with its errors.
    """

    def __init__(self, folder: str, values: Mapping[str, Mapping[str, Any]]):
        self.folder = folder
        self.settings = {name: dict(one) for name, one in values.items()}
        self._results: dict[str, Result] = {}

    def __getitem__(self, name: str) -> Result:
        if name not in self.settings:
            raise KeyError(f"no member {name}; there are: {', '.join(self.settings)}")
        if name not in self._results:
            self._results[name] = Result(os.path.join(self.folder, name))
        return self._results[name]

    def __iter__(self) -> Iterator[str]:
        return iter(self.settings)

    def __len__(self) -> int:
        return len(self.settings)

    def __repr__(self) -> str:
        return f"<Sweep {self.folder}: {', '.join(list(self)[:4])}{', ...' * (len(self) > 4)}>"

    def _repr_html_(self) -> str:
        return _show.columns(self.table(*self.figures[:_SHOWN]))

    @property
    def figures(self) -> list[str]:
        """Numbers of summary.json that have a standard error in every member."""
        summaries = [one.summary for one in self._in_order()]
        return [key for key in summaries[0]
                if all(isinstance(one.get(key), (int, float)) and _error_key(one, key) for one in summaries)]

    def _in_order(self) -> list[Result]:
        return [self[name] for name in self]

    def table(self, *figures: str) -> Table:
        """A row for every member; raises ValueError for a figure that no member has."""
        columns: dict[str, Any] = {}
        units: dict[str, str] = {}
        for key in dict.fromkeys(key for one in self.settings.values() for key in one):
            columns[key] = _array([one.get(key) for one in self.settings.values()])
            units[key] = _unit_of_key(key)
        summaries = [one.summary for one in self._in_order()]
        for figure in figures or self.figures:
            if not any(figure in one for one in summaries):
                near = [key for key in summaries[0] if figure.split(".")[-1] in key][:5]
                raise ValueError(f"table: no member has the figure {figure}; alike: {', '.join(near) or 'none'}")
            unit = _core.summary_unit(figure) or "1"
            columns[figure] = _array([one.get(figure, np.nan) for one in summaries])
            units[figure] = "1" if unit == "-" else unit
            if columns[figure].dtype.kind == "f":
                errors = [one.get(_error_key(one, figure), np.nan) for one in summaries]
                columns[f"{figure}_error"], units[f"{figure}_error"] = np.array(errors, float), units[figure]
        return Table(columns, units, [])

    def to_pandas(self) -> Any:
        """table() as a DataFrame."""
        return self.table().to_pandas()

    def plot(self, figure: str, ax: Any = None) -> Any:
        """Draws a figure of summary.json against the first value, with bars of one standard error and a
        line for every combination of the others; returns the axes."""
        from ._plots import axes_of

        table = self.table(figure)
        first, *others = [key for key in table if key not in (figure, f"{figure}_error")]
        ax = axes_of(ax)
        groups: dict[tuple, list[int]] = {}
        for k, row in enumerate(table.rows()):
            groups.setdefault(tuple(row[key] for key in others), []).append(k)
        for group, rows in groups.items():
            ax.errorbar(table[first][rows], table[figure][rows], table[f"{figure}_error"][rows], marker="o", capsize=3,
                        label=", ".join(f"{key.split('.')[-1]} {_text(value)}" for key, value in zip(others, group)))
        for write, name in ((ax.set_xlabel, first), (ax.set_ylabel, figure)):
            unit = table.units[name]  # some are "N/m (3D: Pa)"
            write(name if unit == "1" else f"{name}, {unit}" if "(" in unit else f"{name} ({unit})")
        if others:
            ax.legend()
        return ax


def _array(values: Sequence[Any]) -> np.ndarray:
    """Numbers, or else words."""
    if all(isinstance(value, (int, float, np.number)) and not isinstance(value, bool) for value in values):
        return np.array(values, float)
    return np.array([str(value) for value in values])


def _error_key(summary: Mapping[str, Any], figure: str) -> str:
    """The key of a figure's standard error; "" without one."""
    for ending in (".standard_error", ".error", "_error"):
        if isinstance(summary.get(figure + ending), (int, float)):
            return figure + ending
    return ""


def _unit_of_key(key: str) -> str:
    try:
        row = next(row for row in keys(key).rows() if row["key"] == key)
    except (ValueError, StopIteration):
        return "1"
    return "1" if row["unit"] == "-" else row["unit"]


def _text(value: Any) -> str:
    return f"{value:.6g}" if isinstance(value, float) else str(value)


def _combinations(values: Mapping[str, Sequence[Any]] | Sequence[Mapping[str, Any]]) -> list[dict[str, Any]]:
    if isinstance(values, Mapping):
        lists = []
        for key, several in values.items():
            if isinstance(several, str) or np.ndim(several) == 0:
                raise ValueError(f"sweep: found {several!r} for {key}, allowed: a list of values, such as [{several!r}]")
            lists.append(np.asarray(several).tolist() if isinstance(several, np.ndarray) else list(several))
        out = [dict(zip(values, one)) for one in itertools.product(*lists)]
    else:
        out = [dict(one) for one in values]
    if not out or not out[0]:
        raise ValueError("sweep: found no values, allowed: {key: [value, ...]} or a list of {key: value}")
    return out


def _named(combinations: Sequence[Mapping[str, Any]]) -> dict[str, dict[str, Any]]:
    """Members by the names of their folders: friction_0.3, or of several values friction_0.3,grains_200."""
    every = list(dict.fromkeys(key for one in combinations for key in one))
    short = {key: key.split(".")[-1] for key in every}
    if len(set(short.values())) < len(every):
        short = {key: key for key in every}
    out: dict[str, dict[str, Any]] = {}
    for one in combinations:
        name = ",".join(re.sub(r"[^A-Za-z0-9_.+-]", "_", f"{short[key]}_{value}") for key, value in one.items())
        if name in out:
            raise ValueError(f"sweep: found the member {name} twice, allowed: every combination of values once")
        out[name] = dict(one)
    return out


def _run_member(words: list[str]) -> list[str]:
    """Runs the program and returns its warnings. A function of the module, so that other processes can."""
    process = _program.start(words)
    with _lock:
        _running.add(process)
    try:
        _, lines = _program.result(process)
    finally:
        with _lock:
            _running.discard(process)
    return [line.removeprefix("warning: ") for line in lines if line.startswith("warning: ")]


def _stop(futures: Sequence[concurrent.futures.Future]) -> None:
    """Ctrl-C for the members at work, which write their checkpoints; the others do not begin."""
    for future in futures:
        future.cancel()
    told: list = []  # once each: a second Ctrl-C ends a program without a checkpoint
    while concurrent.futures.wait(futures, timeout=0.1).not_done:
        with _lock:
            late = [process for process in _running if process not in told]
        for process in late:
            process.send_signal(signal.SIGINT)
        told += late


def _record(folder: str, about: dict[str, Any], members: Mapping[str, list[str]]) -> None:
    """Writes down what is swept, or refuses a folder that holds something else."""
    path = os.path.join(folder, _RECORD)
    if os.path.exists(path):
        with open(path, encoding="utf-8") as file:
            there = json.load(file)
        differ = [key for key in about if there.get(key) != about[key]]
        differ += [name for name in members if there["members"].get(name, members[name]) != members[name]]
        if differ:
            raise ValueError(f"{folder}: holds a sweep with another {differ[0]}, allowed: the same, or another folder")
        members = there["members"] | dict(members)
    elif os.path.isdir(folder) and os.listdir(folder):
        raise ValueError(f"{folder}: holds files and no {_RECORD}, allowed: a new folder, or that of this sweep")
    os.makedirs(folder, exist_ok=True)
    with open(path + ".part", "w", encoding="utf-8") as file:
        json.dump(about | {"members": dict(members)}, file, indent=1)
    os.replace(path + ".part", path)


def sweep(
    case: str | os.PathLike,
    values: Mapping[str, Sequence[Any]] | Sequence[Mapping[str, Any]],
    *,
    realizations: int | None = None,
    workers: int | concurrent.futures.Executor = 1,
    folder: str | os.PathLike | None = None,
    quick: bool = False,
    set: Mapping[str, Any] | Sequence[str] | None = None,
    threads: int = 0,
    progress: bool = True,
) -> Sweep:
    """Runs a case for every combination of values and returns the results as a table with errors.

    values: {"material.friction": [0.2, 0.4], "source.grains": [200, 400]}, or a list of {key: value}.
    realizations: of each (ensemble.realizations). workers: programs side by side, or an executor with
    submit() as of concurrent.futures, mpi4py.futures or dask (Client.get_executor()). threads: of each
    program; 0: the cores over the workers. folder: default results/CASE-sweep. quick, set: as of run().

    The same call goes on where another was stopped: members that are finished are taken as they are,
    those that have begun continue from their checkpoints, with the same bits. More values may be added;
    another case or setting is refused. A member that fails lets the others finish; then its exception is
    raised. Ctrl-C writes checkpoints. Raises ValueError, RuntimeError, OSError, KeyboardInterrupt.
    """
    own = workers if isinstance(workers, int) else None  # programs at a time; None: of an executor
    if own is not None and own < 1:
        raise ValueError(f"workers: found {workers}, allowed: 1 or more")
    file = cases().get(os.fspath(case), os.fspath(case))
    name = os.path.basename(file).removesuffix(".toml")
    place = os.path.join("results", name + "-sweep") if folder is None else os.fspath(folder)
    shared = _overrides(set)
    if realizations is not None:
        shared.append(f"ensemble.realizations={realizations}")
    members = _named(_combinations(values))
    sets = {member: shared + _overrides(one) for member, one in members.items()}
    for one in sets.values():
        check(file, set=one, quick=quick)
    with open(file, "rb") as text:
        about = {"case": name, "text of the case": hashlib.sha256(text.read()).hexdigest(), "quick": quick}
    _record(place, about, sets)
    threads = threads or (1 if own is None else max(1, (os.cpu_count() or 1) // own))
    waiting = {}
    for member, one in sets.items():
        at = os.path.join(place, member)
        if not os.path.exists(os.path.join(at, "summary.json")):
            words = ["run", file, "-o", at, "--threads", threads, *(["--quick"] if quick else [])]
            words += ["--resume"] if os.path.isdir(os.path.join(at, "checkpoint")) else []
            waiting[member] = words + [word for text in one for word in ("--set", text)]
    _finish(waiting, workers, len(members), progress)
    return Sweep(place, members)


def _finish(waiting: Mapping[str, list], workers: Any, count: int, progress: bool) -> None:
    """Runs what is waiting; raises the first exception, with the member's name, when all have ended."""
    own = isinstance(workers, int)
    pool = concurrent.futures.ThreadPoolExecutor(workers) if own else workers
    line = Progress() if progress else None
    futures = {pool.submit(_run_member, words): member for member, words in waiting.items()}
    failed: list[tuple[str, BaseException]] = []
    try:
        done = count - len(futures)
        for future in concurrent.futures.as_completed(futures):
            done += 1
            if line:
                line.show(f"{done} of {count} members", done / count)
            if error := future.exception():
                failed.append((futures[future], error))
                continue
            for text in future.result():
                warnings.warn(f"{futures[future]}: {text}", stacklevel=3)
    except BaseException:
        _stop(list(futures))
        raise
    finally:
        if line:
            line.end()
        if own:
            pool.shutdown()
    if failed:
        member, error = failed[0]
        raise type(error)(f"{member}: {error}") from error

"""What compare, fit, run and structure give."""

from __future__ import annotations

import json
import os
import tempfile
from typing import Any, Callable, Mapping, Sequence

import numpy as np

from . import _core
from ._data import Summary, Table, read_table
from ._files import Collection, fields_of, packings_of


class Folder:
    """The folder of a result: the one asked for, or one that goes when it has been read."""

    def __init__(self, folder: str | os.PathLike | None):
        self.kept = None if folder is None else os.fspath(folder)

    def __enter__(self) -> str:
        self._own = tempfile.TemporaryDirectory(prefix="grainfield-") if self.kept is None else None
        return self.kept if self._own is None else os.path.join(self._own.name, "result")

    def __exit__(self, *_: Any) -> None:
        if self._own is not None:
            self._own.cleanup()


class Structure:
    """What a packing is made of (docs/structure.md).

    coordination, coordination_bearing (without rattlers), rattlers, grains_counted;
    grains_with_contacts[k]: how many grains have k contacts; size_factor and size_factor_theory (g2);
    chains: indices of the grains of each force chain; order, director_deg of the long axes (2D).
    grains: arrays by grain: contacts, rattler, stress_trace, stress_deviator (N/m, 3D Pa),
    compression_angle, fabric_angle, long_angle (deg), chain (-1: none). base: ids, x (m), force (N)
    of the grains on the floor, mean (N), tail_rate of P(n) with tail_low, tail_high, tail_p_value;
    None without a floor.
    """

    coordination: float
    coordination_bearing: float
    rattlers: int
    grains_counted: int
    grains: dict[str, np.ndarray]
    chains: list[np.ndarray]
    base: dict[str, Any] | None

    def __init__(self, found: Mapping[str, Any]):
        self.__dict__.update(found)


class _Profiles:
    profiles: Table | None
    _of = "grains"  # or "measured"

    def plot(self, ax: Any = None, profile: str | None = None) -> Any:
        """Draws a profile of the grains, or of what was measured, with a band of one standard error,
        and the models beside; by default the first. Returns the axes."""
        from ._plots import plot_profiles

        if self.profiles is None:
            members = getattr(self, "members", None)
            where = "; those of its members: .members[...].plot()" if members else ""
            raise ValueError("there are no profiles to draw" + where)
        return plot_profiles(self.profiles, ax, profile, self._of)


class CompareResult(_Profiles):
    """verdict (a sentence), judgement (verdict.json as a dict), summary, profiles (a Table of profiles.csv), and measures: of each
    model by its label rel_l2, max, chi2_per_dof, dof. folder: of the report, None if not kept."""

    def __init__(self, found: Mapping[str, Any], folder: str, kept: str | None):
        self.verdict: str = found["verdict"]
        self.judgement: dict[str, Any] = json.loads(found["judgement"])
        self.folder = kept
        self.summary = Summary(_core.read_summary(os.path.join(folder, "summary.json")))
        self.profiles = read_table(os.path.join(folder, "profiles.csv"))
        self._of = "measured" if found["measured"] else "grains"
        self.measures: dict[str, dict[str, float]] = {}
        for key, value in self.summary.under("compare.").items():
            label, _, name = key.partition(".")
            if "." not in name:
                self.measures.setdefault(label, {})[name] = value

    def __repr__(self) -> str:
        return f"<CompareResult: {self.verdict}>"


class FitResult(_Profiles):
    """verdict, judgement (verdict.json as a dict), note, warnings, packings (their names), coverage (a text), summary, profiles, and
    constants: {model: {constant: (value, standard error)}}, the error nan where none is known.
    folder: of the report, None if not kept."""

    def __init__(self, found: Mapping[str, Any], folder: str, kept: str | None):
        self.verdict: str = found["verdict"]
        self.judgement: dict[str, Any] = json.loads(found["judgement"])
        self.note: str = found["note"]
        self.warnings: list[str] = found["warnings"]
        self.packings: list[str] = found["packings"]
        self.coverage: str = found["coverage"]
        self.folder = kept
        self.summary = Summary(_core.read_summary(os.path.join(folder, "summary.json")))
        self.profiles = read_table(os.path.join(folder, "profiles.csv"))
        self._of = "measured" if found["measured"] else "grains"
        fits = self.summary.under("fit.")
        self.constants: dict[str, dict[str, tuple[float, float]]] = {}
        for key, error in fits.items():
            if key.endswith(".error") and key.count(".") == 2:
                name, constant, _ = key.split(".")
                value = fits[f"{name}.{constant}"]
                self.constants.setdefault(name, {})[constant] = (value, error)

    def __repr__(self) -> str:
        return f"<FitResult: {self.verdict}>"


class Result(_Profiles):
    """The folder of a run: summary, fields and snapshots (Collections by name, read when asked for),
    profiles (a Table), members ({name: Result} of a sweep), warnings, and the path of report.html.
    What the run did not leave is None."""

    def __init__(self, folder: str | os.PathLike, warnings: Sequence[str] = ()):
        self.folder = os.fspath(folder)
        self.warnings = list(warnings)
        if not os.path.exists(self._path("summary.json")):
            raise ValueError(f"{self.folder}: holds no summary.json, so no results of a run")
        self.summary = Summary(_core.read_summary(self._path("summary.json")))
        self.profiles = self._if_there("profiles.csv", read_table)
        self.fields: Collection | None = self._if_there("fields.h5", fields_of)
        self.snapshots: Collection | None = self._if_there("snapshots.h5", packings_of)
        self.report = self._if_there("report.html", lambda path: path)
        self.members = {
            name: Result(self._path(name))
            for name in sorted(os.listdir(self.folder))
            if os.path.exists(self._path(os.path.join(name, "summary.json")))
        }

    def _path(self, name: str) -> str:
        return os.path.join(self.folder, name)

    def _if_there(self, name: str, load: Callable[[str], Any]) -> Any:
        return load(self._path(name)) if os.path.exists(self._path(name)) else None

    @property
    def verdict(self) -> str | None:
        return self.summary.get("verdict.sentence")

    @property
    def judgement(self) -> dict[str, Any] | None:
        """verdict.json: headlines, agreement, models, position, power, notes and doubts."""
        if not os.path.exists(self._path("verdict.json")):
            return None
        with open(self._path("verdict.json"), encoding="utf-8") as file:
            return json.load(file)

    def __repr__(self) -> str:
        return f"<Result {self.folder}: {len(self.summary)} figures>"

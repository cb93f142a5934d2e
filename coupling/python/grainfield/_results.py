"""What compare, fit, run and structure give."""

from __future__ import annotations

import functools
import json
import os
from collections.abc import Mapping as MappingBase
from typing import Any, Callable, Iterator, Mapping, Sequence

import numpy as np

from . import _core, _show
from ._data import Summary, Table, read_table
from ._files import Collection, fields_of, packings_of


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

    def __repr__(self) -> str:
        return f"<Structure: {self.grains_counted} grains, coordination {self.coordination:.3g}, {len(self.chains)} force chains>"

    def _repr_html_(self) -> str:
        return _show.structure(self)


def _profiles(outcome: Any) -> Table:
    notes, profile, columns = outcome.profiles()
    arrays = {"profile": np.array(profile)} | {name: values for name, _, values in columns}
    return Table(arrays, {"profile": "1"} | {name: unit for name, unit, _ in columns}, notes)


class Judgement(MappingBase):
    """Which models the grains support (docs/verdict.md): what terminal and report show, as an object.

    models: nearest first, each with name, label, family, equations, free, misfit, chance, relative_l2,
    behind, behind_error, heights_behind, heights_error, distinguishable, agrees, supported ("yes",
    "no", "unknown"; distinguishable of the nearest: "reference"), realizations_needed and so on; nan where nothing is known. best: the name of the
    best; distinguishable; equations; position (value, standard error) between two families; rival;
    realizations; headlines, agreement, notes, doubts: its sentences; table, power: what it prints.
    str(judgement) is the terminal's text, judgement.latex() verdict.tex. As a mapping it is
    verdict.json: judgement["best_model"].
    """

    def __init__(self, core: Any):
        self._core = core
        self.models: list[Any] = core.models
        self.best: str = core.best
        self.distinguishable: str = core.distinguishable
        self.equations: str = core.equations
        self.position: tuple[float, float] = core.position
        self.families: tuple[str, str] = core.families  #: at positions 0 and 1
        self.rival: str = core.rival
        self.realizations: int = core.realizations
        self.headlines: list[str] = core.headlines()
        self.agreement: str = core.agreement()
        self.notes: list[str] = core.notes()
        self.doubts: list[str] = core.doubts
        self._json: dict[str, Any] = json.loads(core.json())

    @staticmethod
    def _columns(table: Any) -> Table:
        columns = {name: np.array([row[k] for row in table.rows]) for k, name in enumerate(table.header)}
        return Table(columns, {name: "text" for name in columns}, [table.note] if table.note else [])

    @property
    def table(self) -> Table:
        """The models as they are shown, in words."""
        return self._columns(self._core.table())

    @property
    def power(self) -> Table:
        """How many realizations would distinguish each model from the best, in words."""
        return self._columns(self._core.power())

    def latex(self) -> str:
        return self._core.latex()

    def to_dict(self) -> dict[str, Any]:
        """verdict.json."""
        return json.loads(self._core.json())

    def __getitem__(self, key: str) -> Any:
        return self._json[key]

    def __iter__(self) -> Iterator[str]:
        return iter(self._json)

    def __len__(self) -> int:
        return len(self._json)

    def __str__(self) -> str:
        return self._core.text()

    def __repr__(self) -> str:
        return f"<Judgement: {self._core.sentence()}>"

    def _repr_html_(self) -> str:
        return _show.judgement(self)


class _Judged:
    """What the results of compare and fit share."""

    def plot(self, ax: Any = None, profile: str | None = None) -> Any:
        """Draws a profile of the grains, or of what was measured, with a band of one standard error,
        and the models; by default of the vertical stress at the lowest height. Returns the axes.
        profiles["profile"] has the names of all."""
        from ._plots import plot_profiles

        return plot_profiles(self.profiles, ax, profile, self._of)

    def __init__(self, outcome: Any, folder: str | None):
        self._core = outcome
        self.judgement = Judgement(outcome.judgement)
        self.verdict: str = outcome.judgement.sentence()
        self.folder = folder
        self.summary = Summary(outcome.summary)
        self.profiles = _profiles(outcome)
        self._of = "measured" if outcome.measured else "grains"

    def __repr__(self) -> str:
        return f"<{type(self).__name__}: {self.verdict}>"

    def _repr_html_(self) -> str:
        return _show.judgement(self.judgement)


class CompareResult(_Judged):
    """verdict (a sentence), judgement (a Judgement), summary, profiles (a Table: the rows of
    profiles.csv), and measures: of each model by its label rel_l2, max, chi2_per_dof, chance, dof.
    folder: of the files and the report; None: none were written."""

    def __init__(self, outcome: Any, folder: str | None):
        super().__init__(outcome, folder)
        self.measures: dict[str, dict[str, float]] = outcome.measures()


class FitResult(_Judged):
    """verdict, judgement (a Judgement), note, warnings, packings (their names), coverage (a text),
    summary, profiles (a Table: the rows of profiles.csv); constants: {model: {constant: (value,
    standard error)}}, the error nan where none is known; and fits: of each model by its name the fit,
    with parameters (name, unit, meaning, value, error, low, high, covariance_error, bootstrap_error,
    jackknife_error, at_bound, determined), correlation, chi2_per_dof, chance, rel_l2, note and so on.
    folder: of the files and the report; None: none were written."""

    def __init__(self, outcome: Any, folder: str | None):
        super().__init__(outcome, folder)
        self.note: str = outcome.note
        self.warnings: list[str] = outcome.warnings
        self.packings: list[str] = outcome.packings
        self.coverage: str = outcome.coverage
        self.fits: dict[str, Any] = {one.name: one for one in outcome.fits}
        self.constants: dict[str, dict[str, tuple[float, float]]] = {
            name: {p.name: (p.value, p.error) for p in one.parameters}
            for name, one in self.fits.items()
            if one.parameters
        }


class Result:
    """The folder of a run: summary, fields and snapshots (Collections by name, read when asked for),
    tables (a Collection: every CSV file), profiles and, of a sample, states (Tables), members ({name:
    Result} of a sweep), warnings, and the path of report.html. What the run did not leave is None."""

    def __init__(self, folder: str | os.PathLike, warnings: Sequence[str] = ()):
        self.folder = os.fspath(folder)
        self.warnings = list(warnings)
        if not os.path.exists(self._path("summary.json")):
            raise ValueError(f"{self.folder}: holds no summary.json, so no results of a run")
        self.summary = Summary(_core.read_summary(self._path("summary.json")))
        tables = [name[: -len(".csv")] for name in sorted(os.listdir(self.folder)) if name.endswith(".csv")]
        self.tables = Collection(self.folder, tables, lambda name: read_table(self._path(name + ".csv")))
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

    @functools.cached_property
    def profiles(self) -> Table | None:
        return self.tables.get("profiles")

    @functools.cached_property
    def states(self) -> Table | None:
        """The recorded states of a sample: strain, stress, fabric and so on, COLUMN_error the standard
        error over realizations. tables["states_of_realizations"] has the single values."""
        return self.tables.get("states")

    def plot(self, ax: Any = None, profile: str | None = None) -> Any:
        """Draws what the study is about and returns the axes: a profile of the grains with a band of one
        standard error and the models, the stress ratio of a sample against its strain, impacts of a pair,
        the pressure or the temperature of a gas, forces on the base; of a sweep that of every member.

        profile: another profile by its name, or the column of a table, such as "void_ratio". A wrong one
        is a ValueError that lists them.
        """
        from ._result_plots import plot_result

        return plot_result(self, ax, profile)

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

    def _repr_html_(self) -> str:
        return _show.result(self)

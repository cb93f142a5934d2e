"""The stored summaries (results/CASE.json) and what the page reads out of them."""
from __future__ import annotations

import json
import math
import pathlib
from dataclasses import dataclass

from scipy import stats

NAN = math.nan


class Refused(Exception):
    """What the user gave cannot be used; the text says why."""


@dataclass(frozen=True)
class Measured:
    """A number of ours. error: standard error over realizations; nan with one realization.

    freedom: degrees of freedom of the error; infinite where the realizations were not counted.
    """

    value: float
    error: float
    freedom: float = math.inf

    @property
    def half(self) -> float:
        """Half of the 95 % interval (Student's t)."""
        return float(stats.t.ppf(0.975, self.freedom)) * self.error

    def less(self, other: Measured, times: float = 1.0) -> Measured:
        """This less TIMES the other, an independent one; degrees of freedom by Welch and Satterthwaite."""
        parts = [(self.error**2, self.freedom), ((times * other.error) ** 2, other.freedom)]
        total = sum(part for part, _ in parts)
        sure = sum(part**2 / freedom for part, freedom in parts)
        return Measured(self.value - times * other.value, math.sqrt(total),
                        total**2 / sure if sure > 0 else math.inf)


#: Members of studies that are pours of their own. pours.py measures those of "pours".
POUR_MEMBERS = (
    ("liffman-dropped", "implicit"), ("liffman-dropped", "implicit_coulomb"),
    *(("liffman-dropped-grains", member) for member in (
        "equal", "unlike", "coulomb", "pentagons", "equal_968", "unlike_968", "coulomb_968", "coulomb_unlike_968",
        "coulomb_free_968", "pentagons_968")),
    ("pile-line-source", "grains_300"), ("pile-line-source", "asked"),
    *(("pours", member) for member in (
        "point_300", "point_800", "point_2000", "point_6500", "elliptic_800", "disks_2000", "lammps_disks_2000")))


@dataclass(frozen=True)
class Dip:
    """Mean pressure beside the apex minus that under it, over rho g h of each pile.

    p: two-sided chance if there were none, by Student's t over realizations. p_holm: the same,
    corrected for all pours in the record. word: dip, peak or neither at 5 % of p_holm; undecided with
    too few realizations.
    """

    study: str
    member: str
    difference: Measured
    p: float
    p_holm: float
    word: str


def two_sided(one: Measured) -> float:
    """The chance of a mean this far from 0, of either sign, if it were 0 (Student's t); nan without an error."""
    return float(2 * stats.t.sf(abs(one.value) / one.error, one.freedom)) if one.error > 0 else NAN


def holm(p_values: list[float]) -> list[float]:
    """p values corrected for all of them (Holm's step-down, Scand. J. Statist. 6 (1979) 65).

    The k-th smallest of m, k from 0, is multiplied by m - k; none is below a smaller one's, none
    above 1. nan stays nan and is not counted.
    """
    order = sorted((k for k, p in enumerate(p_values) if not math.isnan(p)), key=p_values.__getitem__)
    out, least = list(p_values), 0.0
    for k, at in enumerate(order):
        least = max(least, min(1.0, (len(order) - k) * p_values[at]))
        out[at] = least
    return out


def read_summary(file: pathlib.Path) -> dict[str, float | str]:
    """A summary.json: numbers and texts by key; null, and the words "nan", "inf" and "-inf" of older files, are numbers."""
    try:
        found = json.loads(file.read_text(encoding="utf-8"))
    except (OSError, ValueError) as error:
        raise Refused(f"{file}: {error}") from error
    if not isinstance(found, dict):
        raise Refused(f"{file}: not a JSON object")
    for key, value in found.items():
        if value is None:
            found[key] = value = math.nan
        if isinstance(value, bool) or not isinstance(value, (int, float, str)):
            raise Refused(f"{file}: {key}: found {value!r}; allowed: numbers and texts")
        if value in ("nan", "inf", "-inf"):
            found[key] = float(value)
    return found


class Results:
    """Every CASE.json of a folder, and the names of the files beside them."""

    def __init__(self, folder: pathlib.Path):
        if not folder.is_dir():
            raise Refused(f"{folder}: no such folder; it holds the summaries (CASE.json)")
        files = sorted(folder.iterdir())
        summaries = {file.stem: read_summary(file) for file in files if file.suffix == ".json"}
        self.all = dict(sorted(summaries.items()))
        self._others = [file.name for file in files if file.suffix != ".json"]

    def has(self, study: str) -> bool:
        return study in self.all

    def plain(self, study: str, key: str) -> float | None:
        """A number without an error; None where there is none."""
        value = self.all.get(study, {}).get(key)
        return None if isinstance(value, str) else value

    def text(self, study: str, key: str) -> str | None:
        value = self.all.get(study, {}).get(key)
        return value if isinstance(value, str) else None

    def number(self, study: str, key: str, member: str = "") -> Measured | None:
        """A number with its standard error; None where there is none.

        Of a sweep's member the key is KEY.MEMBER. The error of a fitted constant (fit.*) is the
        larger of the fit's own and the bootstrap's over piles.
        """
        dot = f".{member}" if member else ""
        value = self.plain(study, key + dot)
        if value is None or math.isnan(value):
            return None
        count = self.plain(study, f"ensemble.pieces{dot}") or self.realizations(study, member)
        freedom = count - 1 if count is not None and count > 1 else math.inf
        if key.startswith("fit."):
            kinds = [self.plain(study, f"{key}.{kind}{dot}") for kind in ("error", "bootstrap_error")]
            return Measured(value, max((e for e in kinds if e is not None and math.isfinite(e)), default=NAN), freedom)
        error = self.plain(study, f"{key}.standard_error{dot}")
        if error is None and key == "dip.difference":
            error = self.plain(study, f"dip.standard_error{dot}")
        return Measured(value, NAN if error is None else error, freedom)

    def realizations(self, study: str, member: str = "") -> float | None:
        """How many a study has, or its member where that was counted."""
        own = self.plain(study, f"ensemble.realizations.{member}") if member else None
        return self.plain(study, "ensemble.realizations") if own is None else own

    def beside(self, study: str) -> list[str]:
        """Names of the profiles and pictures of a study."""
        return [name for name in self._others if name.startswith(study + ".")]

    def dips(self) -> list[Dip]:
        """The dips of all pours of the record, judged together, by the studies' names; then those of POUR_MEMBERS.

        Studies fit-* fit models to the piles of another one: they are no pours of their own.
        """
        found = []
        for study, member in (*((study, "") for study in self.all if not study.startswith("fit-")), *POUR_MEMBERS):
            difference = self.number(study, "dip.difference", member)
            # of no dip, whatever the recorded word's rule
            one_sided = self.plain(study, "dip.p_value" + (f".{member}" if member else ""))
            if difference is not None:
                p = two_sided(difference) if one_sided is None else 2 * min(one_sided, 1 - one_sided)
                found.append((study, member, difference, p))
        out = []
        for (study, member, difference, p), p_holm in zip(found, holm([p for *_, p in found])):
            word = "dip" if difference.value > 0 else "peak"
            if math.isnan(p_holm):
                word = "undecided"
            elif p_holm >= 0.05:
                word = "neither"
            out.append(Dip(study, member, difference, p, p_holm, word))
        return out

    def dip(self, study: str, member: str = "") -> Dip | None:
        return next((dip for dip in self.dips() if (dip.study, dip.member) == (study, member)), None)

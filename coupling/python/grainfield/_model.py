"""Model: a stress model of one's own, beside the registry's in fit and compare."""

from __future__ import annotations

import keyword
import threading
from dataclasses import dataclass
from typing import Any, Callable, Mapping, Sequence

import numpy as np

from . import _core
from ._arrays import whole

_NONE = float("nan")
_MOST = 1e60  # of the numbers of a specimen
#: What fit and compare fill in: name, unit, meaning, of each kind of specimen.
_KNOWN = {
    "heap": (("h", "m", "height"), ("rho_g", "N/m2", "weight per volume"), ("phi_deg", "deg", "mean slope"),
             ("left_deg", "deg", "slope of the left flank"), ("right_deg", "deg", "slope of the right flank")),
    "layer": (("h", "m", "depth"), ("F", "N", "load at (0, 0)")),
}
_RESERVED = {name for known in _KNOWN.values() for name, *_ in known} | {"dim", "points", "facts"}
_EDGE = 1e-9  # of the height: points on a flank or on the base are inside


@dataclass(frozen=True)
class Facts:
    """A specimen: h, m; of a heap slope, left and right, degrees, and rho_g, N/m2 (3D: N/m3); of a layer
    F, N. The others are nan."""

    h: float
    slope: float = _NONE
    left: float = _NONE
    right: float = _NONE
    rho_g: float = _NONE
    F: float = _NONE


class Model:
    """A stress model of one's own for fit and compare, with kernel, errors, verdict and power.

        def wedge(points, facts, k):
            y = points[:, 1]
            return np.stack([k * y, y, 0 * y], axis=1)
        mine = gf.Model(wedge, parameters={"k": (0.1, 2.0)}, subject="heap", name="mine")
        gf.fit(heaps, ["osl", mine])            # k is free
        gf.compare(field, ["bcc", mine(k=0.5)])

    function(points, facts, **parameters) returns stresses (n, 3): xx, yy, xy, in space (n, 6): xx, yy, zz,
    yz, xz, xy, tension positive, in the specimen's own scale and axes. subject "heap": points over h, apex
    at (0, 0), the inside below it, stresses over rho_g h. "layer": points over h, load at (0, 0), base at -1,
    stresses over F/h, in space over F/h^2. It gets points inside alone, n of them; facts: a Facts. It returns
    None for parameters that are impossible together: a fit keeps away from these.

    parameters: {name: (least, most)} or (least, most, default). dim: 2 or 3; fits are of the plane.
    calls: how often it was called, a few hundred to some thousands of times in a fit, each for all points.
    The same name again replaces the model; at most 64 names.

    In fit and compare an exception of the function, a wrong shape, and a stress that is not finite are
    RuntimeErrors that tell the point.
    """

    def __init__(
        self,
        function: Callable[..., Any],
        parameters: Mapping[str, Sequence[float]] | None = None,
        subject: str = "heap",
        name: str = "mine",
        dim: int = 2,
    ):
        if subject not in _KNOWN:
            raise ValueError(f"subject: found {subject!r}, allowed: heap or layer")
        if dim not in (2, 3):
            raise ValueError(f"dim: found {dim}, allowed: 2 or 3")
        if not callable(function):
            raise ValueError(f"function: found {function!r}, allowed: a function of points, facts and the parameters")
        self.function = function
        self.name, self.subject, self.dim, self.calls = name, subject, dim, 0
        self._lock = threading.Lock()
        self.parameters = {key: _range(key, given) for key, given in (parameters or {}).items()}
        rows = [dict(name=key, unit=unit, meaning=meaning, least=-_MOST, most=_MOST, default=_NONE, free=False)
                for key, unit, meaning in _KNOWN[subject]]
        rows += [dict(name=key, unit="-", meaning="of the function", least=least, most=most, default=default, free=True)
                 for key, (least, most, default) in self.parameters.items()]
        summary = (function.__doc__ or "a model of one's own").strip().splitlines()[0]
        _core.add_own_model(name=name, summary=summary, dim=dim, parameters=rows, stress=self._stress)

    def __repr__(self) -> str:
        return f"<Model {self.name} of a {self.subject}: {', '.join(self.parameters) or 'no parameters'}>"

    def __call__(self, **settings: Any) -> Any:
        """The model with these values: for compare, and with h and so on to be called with points."""
        from ._commands import model

        return model(self.name, **settings)

    def _stress(self, points: np.ndarray, settings: Mapping[str, str]) -> np.ndarray:
        """Stresses in N/m (Pa) at points in m, nan outside of the specimen and where there are none."""
        numbers = {key: float(text) for key, text in settings.items()}
        optional = () if self.subject == "layer" else ("left_deg", "right_deg")
        missing = [key for key, value in numbers.items() if np.isnan(value) and key not in optional]
        if missing:
            raise RuntimeError(f"model {self.name}: {missing[0]} has no value; {self.name}({missing[0]}=...) gives one")
        h = numbers["h"]
        if self.subject == "heap":
            slope, unit = numbers["phi_deg"], numbers["rho_g"] * h
            left, right = (slope if np.isnan(numbers[key]) else numbers[key] for key in optional)
            facts = Facts(h, slope=slope, left=left, right=right, rho_g=numbers["rho_g"])
        else:
            facts, unit = Facts(h, F=numbers["F"]), numbers["F"] / h ** (self.dim - 1)
        scaled = points / h
        inside = self._inside(scaled, facts)
        out = np.full((len(points), 3 if self.dim == 2 else 6), np.nan)
        if inside.any():
            made = self._asked(scaled[inside], facts, {key: numbers[key] for key in self.parameters})
            if made is not None:
                out[inside] = unit * made
        return out

    def _inside(self, points: np.ndarray, facts: Facts) -> np.ndarray:
        up = points[:, -1]
        if self.subject == "layer":
            return (up <= _EDGE) & (up >= -1 - _EDGE)
        if self.dim == 3:
            return np.hypot(points[:, 0], points[:, 1]) <= -up / np.tan(np.radians(facts.slope)) + _EDGE
        reach = {side: -up / np.tan(np.radians(slope)) + _EDGE for side, slope in (("left", facts.left), ("right", facts.right))}
        return (points[:, 0] >= -reach["left"]) & (points[:, 0] <= reach["right"])

    def _asked(self, points: np.ndarray, facts: Facts, values: Mapping[str, float]) -> np.ndarray | None:
        with self._lock:
            self.calls += 1
        shape = (len(points), 3 if self.dim == 2 else 6)
        told = "".join(f", {key} = {value:g}" for key, value in values.items())
        try:
            made = self.function(points.copy(), facts, **values)
            if made is None:
                return None
            if np.iscomplexobj(made):
                raise ValueError("found complex stresses, allowed: real ones")
            made = np.asarray(whole("stresses", made), float)
        except Exception as error:
            where = self._first_failure(points, facts, values)
            raise RuntimeError(f"model {self.name}: {type(error).__name__}: {error}{where}{told}") from error
        if made.shape != shape:
            raise RuntimeError(f"model {self.name}: found stresses of shape {made.shape} for {len(points)} points from "
                               f"{_place(points[0])} on{told}, allowed: {shape}")
        wrong = np.flatnonzero(~np.isfinite(made).all(axis=1))
        if len(wrong):
            raise RuntimeError(f"model {self.name}: found the stress {made[wrong[0]].tolist()} at "
                               f"{_place(points[wrong[0]])}{told}, allowed: finite numbers inside the {self.subject}")
        return made

    def _first_failure(self, points: np.ndarray, facts: Facts, values: Mapping[str, float]) -> str:
        """" at (0.1, -0.2)": the first point that fails alone; "" where none does."""
        for point in points:
            try:
                self.function(point[None].copy(), facts, **values)
            except Exception:
                return f" at {_place(point)}"
        return ""


def _place(point: np.ndarray) -> str:
    return f"({', '.join(f'{x:.6g}' for x in point)})"


def _range(name: str, given: Any) -> tuple[float, float, float]:
    if not name.isidentifier() or keyword.iskeyword(name) or name in _RESERVED:
        raise ValueError(f"parameters: found the name {name!r}, allowed: a name of Python but {', '.join(sorted(_RESERVED))}")
    try:
        least, most, default = (*map(float, given), _NONE)[:3]
    except (TypeError, ValueError):
        least = most = default = _NONE
    if not least < most or not (np.isnan(default) or least <= default <= most):
        raise ValueError(f"parameters: found {given!r} for {name}, allowed: (least, most) or (least, most, default)")
    return least, most, default

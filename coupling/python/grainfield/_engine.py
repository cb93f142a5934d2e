"""The discrete-element engine in a loop of Python."""

from __future__ import annotations

import contextlib
import numbers
import signal
import threading
from dataclasses import dataclass, field
from typing import Any, Callable, Iterator, Mapping, Sequence

import numpy as np

from . import _core, _given
from ._commands import _overrides
from ._data import Contacts, Packing


def _finite(name: str, value: Any, unit: str) -> list[float]:
    """A number or several, each finite."""
    values = _given.floats(name, value)
    for one in values:
        if not np.isfinite(one):
            raise ValueError(f"{name}: found {one:g}, allowed: finite numbers, {unit}")
    return values


@dataclass(frozen=True)
class GrainsNow:
    """What a function of Engine.add_force gets of the grains, fixed ones too; row k is the grain with id k.

    positions, velocities (n, dim), m, m/s; spins (n), in 3D (n, 3), rad/s; radii, masses (n), m, kg. All
    are read-only views, made anew by each call. With verlet velocities are those of the half step, which
    contact forces see too.
    """

    time: float  #: s
    positions: np.ndarray = field(repr=False)
    velocities: np.ndarray = field(repr=False)
    spins: np.ndarray = field(repr=False)
    radii: np.ndarray = field(repr=False)
    masses: np.ndarray = field(repr=False)

    def __len__(self) -> int:
        return len(self.radii)


@dataclass(frozen=True)
class ContactsNow:
    """What a function of Engine.add_contact_force gets: m contacts, of grains (and walls) that overlap.

    i, j (m): ids, i < j; at wall number w j = -1 - w. normals (m, dim): unit, from i to j. overlaps (m), m.
    velocities (m, dim): of i against j at the contact point, m/s; (velocities * normals).sum(1) > 0 is an
    approach. points (m, dim), m. radii (m): r_i r_j/(r_i + r_j), at a wall r_i, m. grains: a GrainsNow, so
    that grains.masses[i] are the first grains' masses. All are read-only views, made anew by each call.
    """

    i: np.ndarray = field(repr=False)
    j: np.ndarray = field(repr=False)
    points: np.ndarray = field(repr=False)
    normals: np.ndarray = field(repr=False)
    velocities: np.ndarray = field(repr=False)
    overlaps: np.ndarray = field(repr=False)
    radii: np.ndarray = field(repr=False)
    grains: GrainsNow

    def __len__(self) -> int:
        return len(self.i)


class Engine:
    """Grains, walls, contacts and time, from a packing on (docs/theory-dem.md).

        engine = gf.Engine(packing, material=dict(law="linear", normal_stiffness=1e6, friction=0.3))
        engine.set_damping(20)
        engine.step(20000)                                     # falls
        while engine.measure()["unbalanced_force_ratio"] > 1e-3:
            engine.step(1000)                                  # settles
        gf.average(engine.packing(), frame="packing").plot()

    start: the grains (disks, polygons or spheres, numbered 0, 1, 2, ...) with their velocities, walls
    with their friction, contacts (their springs; without any the first step finds them), gravity,
    cell, and load. material, motion: keys of these sections of a case (`grainfield keys material
    motion`), such as dict(law="linear", normal_stiffness=1e6, friction=0.3); friction of walls is the
    packing's. time_step: s; default 0.8 of the stable limit. threads: the bits do not depend on it.

    positions, velocities (n, dim), spins (n), in 3D (n, 3), radii, ids (n) are read-only views into
    the engine's memory: they follow every step without a copy, and keep the engine alive. Their order
    is the engine's and changes as it sorts its grains: ids[k] is who stands at k; in_order() gives a
    copy by id. While such arrays are alive, add() refuses (BufferError), because it may move them.

    Ctrl-C stops step() within about a tenth of a second, after a whole step. Other threads of Python
    run meanwhile. Raises ValueError for what cannot be set up, RuntimeError when it diverges.

    add_force and add_contact_force try a force, or a contact law, that a function of Python states.
    """

    def __init__(
        self,
        start: Packing,
        *,
        material: Mapping[str, Any] | None = None,
        motion: Mapping[str, Any] | None = None,
        time_step: float | None = None,
        threads: int = 1,
    ):
        motion = dict(motion or {})
        if time_step is not None:
            motion["time_step"] = float(time_step)
        keys = {f"material.{key}": value for key, value in (material or {}).items()}
        keys |= {f"motion.{key}": value for key, value in motion.items()}
        self._core = _core.Engine(_given.state("start", start), _overrides(keys), threads)

    @property
    def dim(self) -> int:
        return self._core.dim

    @property
    def time(self) -> float:
        """s"""
        return self._core.time

    @property
    def time_step(self) -> float:
        """s"""
        return self._core.time_step

    @property
    def steps(self) -> int:
        return self._core.steps

    @property
    def seconds(self) -> float:
        """Wall time of all steps, without Python's part, s"""
        return self._core.seconds

    def __len__(self) -> int:
        return self._core.grains

    def __repr__(self) -> str:
        return f"<Engine: {self.dim}D, {len(self)} grains, {self.steps} steps of {self.time_step:.3g} s>"

    @property
    def ids(self) -> np.ndarray:
        return self._core.array("ids")

    @property
    def positions(self) -> np.ndarray:
        """m"""
        return self._core.array("position")

    @property
    def velocities(self) -> np.ndarray:
        """m/s; of fixed grains 0"""
        return self._core.array("velocity")

    @property
    def spins(self) -> np.ndarray:
        """rad/s"""
        return self._core.array("spin")

    @property
    def radii(self) -> np.ndarray:
        """m"""
        return self._core.array("radius")

    def in_order(self, values: np.ndarray) -> np.ndarray:
        """A copy of one of these arrays, by id."""
        out = np.empty_like(values)
        out[self.ids] = values
        return out

    def step(self, n: int = 1) -> None:
        """Makes n steps. Calls of any length end in the same bits."""
        if isinstance(n, bool) or n != int(n) or n < 0:
            raise ValueError(f"n: found {n}, allowed: a whole number, 0 or more")
        with _late_ctrl_c(self._core) if self._core.forces() else contextlib.nullcontext():
            self._core.step(int(n))

    def add_force(self, function: Callable[[float, GrainsNow], Any], *, every: int = 1, name: str | None = None) -> None:
        """Adds forces on grains that function(t, grains) gives, from the next step on.

            def well(t, grains):
                return -0.5 * grains.positions              # N, a spring to the origin
            engine.add_force(well)

        It gets the time, s, and a GrainsNow, and returns forces (n, dim), N, row k on grain k, or a pair of
        these and torques (n), in 3D (n, 3), N m. It is called once in `every` steps, after the grains have
        moved and before contact forces; what it returns acts until the next call. name: default the
        function's; the same name again replaces it. On fixed grains its forces have no effect. No grain
        sleeps. Bits do not depend on threads or on the length of step()'s calls.

        Its exceptions come out of step() as they are, a wrong shape or a number that is not finite as a
        ValueError. The last step is whole then, made with the forces of the call before.

        Packings of the engine have the attribute added_forces with the names. gf.Engine(packing) goes on
        from such a packing only after add_force with the same names.
        """
        self._add(_OnGrains(function, self), name or _name_of(function), every, False)

    def add_contact_force(self, function: Callable[[float, ContactsNow], Any], *, every: int = 1,
                          name: str | None = None) -> None:
        """Adds forces in contacts that function(t, contacts) gives, beside those of the material's law.

            def cohesion(t, contacts):
                return 0.1 * contacts.normals               # N, pulls i to j and j to i
            engine.add_contact_force(cohesion)

        It gets the time, s, and a ContactsNow: all contacts at once. It returns forces (m, dim), N, on the
        grains i at the contact points; on the grains j act the opposite ones. Forces of engine.contacts, of
        walls and of stresses contain them. For a law of one's own from scratch, give the material a
        stiffness that does next to nothing, friction 0, and a time_step. All else is as in add_force.
        """
        self._add(_InContacts(function, self), name or _name_of(function), every, True)

    def remove_force(self, name: str) -> None:
        """Ends what add_force or add_contact_force has begun; packings name it in former_added_forces."""
        self._core.remove_force(name)

    @property
    def added_forces(self) -> list[str]:
        """Names of the forces that functions of Python add."""
        return self._core.forces()

    def _add(self, function: Any, name: str, every: int, in_contacts: bool) -> None:
        if not callable(function.function):
            raise ValueError(f"function: found {function.function!r}, allowed: a function of t and "
                             f"{'contacts' if in_contacts else 'grains'}")
        if isinstance(every, bool) or every != int(every):
            raise ValueError(f"every: found {every}, allowed: a whole number of steps, 1 or more")
        function.name = name
        self._core.add_force(function, name, int(every), in_contacts)

    def apply(
        self,
        grain: int,
        force: Sequence[float],
        *,
        beside: Sequence[int] = (),
        start: float | None = None,
        ramp: float = 0,
    ) -> None:
        """From now on, instead of any earlier one: this force (dim), N, on the grain, and the same on
        each of those beside; it rises smoothly within ramp, s, from start, s (default: now)."""
        for name, one in (("grain", grain), *(("beside", one) for one in beside)):
            if not isinstance(one, numbers.Integral) or isinstance(one, bool):
                raise TypeError(f"{name}: found {one!r}, allowed: the id of a grain, a whole number")
        if not 0 <= _given.number("ramp", ramp, "s") < np.inf:
            raise ValueError(f"ramp: found {ramp}, allowed: a finite time, s, 0 or more")
        self._core.apply(int(grain), _finite("force", force, "N"), [int(k) for k in beside],
                         self.time if start is None else _finite("start", start, "s")[0], float(ramp))

    def move_wall(
        self,
        name: str,
        velocity: Sequence[float] | None = None,
        *,
        angular_velocity: Any = None,
        centre: Sequence[float] | None = None,
        ramp: float = 0,
        servo: Mapping[str, Any] | None = None,
    ) -> None:
        """From now on: velocity (dim), m/s, and angular velocity (3D: 3), rad/s, about the centre, m
        (default: the wall's point), reached within ramp, s. servo: instead, led to a target: force, N,
        or stress, Pa (2D: N/m), with area, m2 (m), or between (pairs of walls); max_speed, m/s; gain;
        direction."""
        none = 1 if self.dim == 2 else 3
        self._core.move_wall(
            name,
            [0.0] * self.dim if velocity is None else [float(v) for v in velocity],
            [0.0] * none if angular_velocity is None else np.ravel(angular_velocity).astype(float).tolist(),
            None if centre is None else [float(x) for x in centre],
            float(ramp),
            None if servo is None else dict(servo),
        )

    def set_gravity(self, gravity: Sequence[float]) -> None:
        """m/s2 (dim); every grain wakes."""
        self._core.set_gravity(_finite("gravity", gravity, "m/s2"))

    def set_damping(self, rate: float) -> None:
        """Background damping: acceleration -= rate * velocity, 1/s."""
        self._core.set_damping(float(rate))

    def add(
        self,
        position: Sequence[float],
        radius: float,
        *,
        velocity: Sequence[float] = (),
        density: float | None = None,
        fixed: bool = False,
    ) -> int:
        """Adds a disk or sphere and returns its id. density: kg/m3 (2D: kg/m2), default the material's.
        Raises BufferError while arrays on the engine's memory are alive."""
        return self._core.add([float(x) for x in position], float(radius), [float(v) for v in velocity],
                              density, fixed)

    def measure(self) -> dict[str, float]:
        """kinetic_energy, elastic_energy, potential_energy (J), unbalanced_force_ratio, contacts, ..."""
        return self._core.measure()

    def walls(self) -> dict[str, dict[str, np.ndarray]]:
        """By name copies of point (m), normal, velocity (m/s) and force (N, of the grains on it)."""
        return self._core.walls()

    def packing(self) -> Packing:
        """The state now, a copy: what average() and the others take."""
        return Packing(self._core.snapshot())

    @property
    def contacts(self) -> Contacts:
        """The contacts now, a copy; pairs are ids, because grains are numbered 0, 1, 2, ..."""
        return self.packing().contacts


class _OnGrains:
    """What the core calls for a force: dictionaries of arrays in, (forces, torques or None) out."""

    def __init__(self, function: Any, engine: Engine):
        self.function, self.name, self.dim = function, "", engine.dim

    def __call__(self, grains: Mapping[str, Any], contacts: None) -> tuple[np.ndarray, np.ndarray | None]:
        now = GrainsNow(**grains)
        made = self.function(now.time, now)
        forces, torques = made if isinstance(made, tuple) and len(made) == 2 else (made, None)
        if torques is not None:
            turns = (len(now),) if self.dim == 2 else (len(now), 3)
            torques = _numbers(torques, turns, f"{self.name}: torques").reshape(len(now), -1)
        return _numbers(forces, (len(now), self.dim), f"{self.name}: forces"), torques


class _InContacts(_OnGrains):
    def __call__(self, grains: Mapping[str, Any], contacts: Mapping[str, Any]) -> tuple[np.ndarray, None]:  # type: ignore[override]
        now = ContactsNow(**contacts, grains=GrainsNow(**grains))
        made = self.function(now.grains.time, now)
        return _numbers(made, (len(now), self.dim), f"{self.name}: forces"), None


def _numbers(values: Any, shape: tuple[int, ...], what: str) -> np.ndarray:
    if values is None:
        raise ValueError(f"{what}: found None, allowed: an array of shape {shape}; does the function return it?")
    if isinstance(values, np.ma.MaskedArray):
        raise ValueError(f"{what}: found a masked array, allowed: an array of shape {shape}; fill it first")
    made = np.asarray(values)
    if made.dtype.kind not in "fiu":
        raise ValueError(f"{what}: found {made.dtype}, allowed: real numbers")
    if made.shape != shape:
        raise ValueError(f"{what}: found shape {made.shape}, allowed: {shape}")
    return made


def _name_of(function: Any) -> str:
    return getattr(function, "__name__", type(function).__name__).strip("<>")


@contextlib.contextmanager
def _late_ctrl_c(core: Any) -> Iterator[None]:
    """Ctrl-C within a function of add_force takes effect after its step, so that the step is whole; a
    second one at once."""
    default = signal.default_int_handler
    if threading.current_thread() is not threading.main_thread() or signal.getsignal(signal.SIGINT) is not default:
        yield
        return

    def interrupt(number: int, frame: Any) -> None:
        if core.interrupt():
            raise KeyboardInterrupt

    signal.signal(signal.SIGINT, interrupt)
    try:
        yield
    finally:
        signal.signal(signal.SIGINT, default)

"""The discrete-element engine in a loop of Python."""

from __future__ import annotations

from typing import Any, Mapping, Sequence

import numpy as np

from . import _core
from ._commands import _overrides
from ._data import Contacts, Packing


class Engine:
    """Grains, walls, contacts and time, from a packing on (docs/theory-dem.md).

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
        self._core = _core.Engine(start._core, _overrides(keys), threads)

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
        self._core.step(int(n))

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
        self._core.apply(int(grain), [float(f) for f in force], [int(k) for k in beside],
                         self.time if start is None else float(start), float(ramp))

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
        self._core.set_gravity([float(g) for g in gravity])

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

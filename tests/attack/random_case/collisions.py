"""Checks of gases of hard grains and of pairs."""
import csv
import itertools
import math
import os

import numpy as np


def table(folder, name):
    file = os.path.join(folder, name)
    if not os.path.exists(file):
        return []
    with open(file) as text:
        return [{k: float(v) for k, v in row.items()}
                for row in csv.DictReader(line for line in text if not line.startswith("#"))]


def check_gas(run):
    v, complain = run.values, run.complain
    cooling = v["gas.kind"] == "cooling"
    for realization, states in run.groups.items():
        for name, p in states.items():
            momentum = np.linalg.norm((p.mass[:, None] * p.velocity).sum(axis=0))
            scale = (p.mass * np.linalg.norm(p.velocity, axis=1)).sum()
            start = p.mass.sum() * v["gas.speed"]
            if momentum > 1e-9 * start:
                complain("momentum", f"{p.name}: {momentum:.4g} kg m/s of {scale:.4g}")
            # The speed is the root of the sum of squares of each component at the start
            energy = 0.5 * (p.mass[:, None] * p.velocity**2).sum()
            turning = 0.5 * (p.moments[:, -1] * (p.spin**2).sum(axis=1)).sum()
            # over N - 1, for the gas as a whole is at rest.
            first = 0.5 * p.dim * p.mass.sum() * (1 - 1 / p.size) * v["gas.speed"]**2
            if not cooling and abs(energy + turning - first) > 1e-9 * first:
                complain("energy", f"{p.name}: {energy + turning:.9g} J, at the start {first:.9g}")
            if cooling and energy + turning > first * (1 + 1e-9):
                complain("energy", f"{p.name}: a cooling gas has {energy + turning:.9g} J, at the start {first:.9g}")
            if cooling and not run.many:
                told = run.summary.get(f"gas.{name}.temperature")
                if isinstance(told, float) and abs(told - energy / first) > 1e-6:
                    complain("energy", f"{p.name}: temperature {told:.9g}, of the grains {energy / first:.9g}")
            check_hard(p, complain)
            volume = p.volume_of_sample()
            fraction = v["gas.fractions"][0] if len(v["gas.fractions"]) == 1 else None
            if fraction and abs(p.volume.sum() / volume / fraction - 1) > 1e-9:
                complain("solid fraction", f"{p.name}: {p.volume.sum() / volume:.9g}, asked for {fraction}")
    for key, value in run.summary.items():
        if key.endswith("energy_drift") and isinstance(value, float) and abs(value) > 1e-9:
            complain("energy", f"{key} {value:.4g}")
        if key.endswith("overlap") and isinstance(value, float) and value > 1e-9:
            complain("overlap", f"{key} {value:.4g}")
        # Few grains scatter; a wrong virial is off by its own size.
        few = 1 / math.sqrt(v["gas.grains"] * v["gas.collisions"]) if not cooling else 0
        if key.endswith("compressibility_over_theory") and isinstance(value, float):
            if not abs(value - 1) < 0.15 + 6 * few:
                complain("pressure", f"{key} {value:.4g}")


def check_hard(p, complain):
    """Hard grains share nothing."""
    axes = [(-1, 0, 1) if p.periodic[a] else (0,) for a in range(3)]
    for image in itertools.product(*axes):
        for i in range(p.size):
            way = np.linalg.norm(p.position + p.shift(image) - p.position[i], axis=1)
            deep = p.radius + p.radius[i] - way
            deep[:i + 1] = 0
            if deep.max() > 1e-9 * p.radius[i]:
                complain("overlap", f"{p.name}: grains {i} and {deep.argmax()}: {deep.max():.4g} m deep")
                return


# ----------------------------------------------------------------------- pairs

def conservative(v):
    return (v["material.friction"] == 0 and v.get("material.damping", 0) == 0
            and v.get("material.normal_damping", 0) == 0
            and v.get("material.rolling_friction", 0) == 0
            and v.get("material.twisting_friction", 0) == 0
            and v["material.law"] in ("linear", "penalty", "energy", "hertz"))


def check_pair(run):
    v, complain = run.values, run.complain
    rows = table(run.folder, "profiles.csv")
    if v["pair.kind"] == "path":
        for row in rows:
            if not all(map(math.isfinite, (row["normal_force_N"], row["stored_J"]))):
                complain("nan", f"profiles.csv at {row['time_s']}")
        if v["pair.path"] == "random" and v["material.law"] == "energy":
            worst = max((abs(r["work_over_stored"]) for r in table(run.folder, "loops.csv")
                         if "work_over_stored" in r), default=0)
            if worst > 1e-4:
                complain("energy", f"a closed loop of the energy law works {worst:.3g} of what it stores")
        return
    damped = v.get("motion.local_damping", 0) > 0
    check_blow(v, rows, damped, complain)
    if v["pair.partner"] == "grain" and not damped:
        for states in run.groups.values():
            check_momenta(v, states, complain)
    for row in table(run.folder, "impacts.csv"):
        e, closed = row["restitution_normal"], row["closed_form_restitution_normal"]
        lost = row["energy_lost"]
        if not -1e-3 <= lost <= 1 + 1e-9 and not damped:
            complain("energy", f"impact at {row['speed_m_per_s']} m/s loses {lost:.6g} of its energy")
        if math.isfinite(e) and math.isfinite(closed) and not damped:
            # Steps of a share of the stable limit.
            allowed = 2e-3 + 0.5 * v["motion.time_step_fraction"]
            # The closed form is of a blow whose line of centres does not turn meanwhile.
            slope = abs(math.tan(math.radians(row["angle_deg"])))
            along = row["speed_m_per_s"] * abs(math.sin(math.radians(row["angle_deg"])))
            allowed += slope * along * row["duration_s"] / v["pair.radius"]
            if abs(e - closed) > allowed:
                complain("restitution", f"e {e:.6g}, closed form {closed:.6g} at {row['speed_m_per_s']} m/s")
        if conservative(v) and abs(lost) > 2e-3 and not damped:
            complain("energy", f"without loss, and {lost:.4g} of the energy is gone")


def check_blow(v, rows, damped, complain):
    if not rows or damped or v["material.law"] in ("overlap_area", "hertz_elliptic"):
        return
    if v["material.law"] == "hertz" and v["material.friction"] > 0:
        return  # a spring whose stiffness changes does work of its own
    by_realization = {}
    for row in rows:
        by_realization.setdefault(row["realization"], []).append(
            row["kinetic_J"] + row["stored_J"] + row["dissipated_J"])
    for energies in by_realization.values():
        off = max(abs(e - energies[0]) for e in energies)
        allowed = 2e-3 + 3 * v["motion.time_step_fraction"]**2
        if off > allowed * energies[0]:
            complain("energy", f"kinetic, stored and dissipated change by {off / energies[0]:.3g} of the first")


def check_momenta(v, states, complain):
    first = None
    for name in sorted(states):
        p = states[name]
        momentum = (p.mass[:, None] * p.velocity).sum(axis=0)
        spin = p.spin * p.moments
        angular = (p.mass[:, None] * np.cross(p.position, p.velocity) + spin).sum(axis=0)
        if first is None:
            first = momentum, angular
            continue
        size = (p.mass * np.linalg.norm(p.velocity, axis=1)).sum()
        turn = size * np.abs(p.position).max() + np.abs(spin).sum()
        if np.linalg.norm(momentum - first[0]) > 1e-9 * size:
            complain("momentum", f"{p.name}: changes by {np.linalg.norm(momentum - first[0]) / size:.3g}")
        # Verlet keeps it where both see one contact point; the resistance against rolling too.
        if np.linalg.norm(angular - first[1]) > 1e-6 * turn:
            complain("angular momentum", f"{p.name}: changes by {np.linalg.norm(angular - first[1]) / turn:.3g}")


# ----------------------------------------------------------------------- soft disks of implicit motion

def check_soft(run):
    """Normal forces are K times the overlap, K by the softness of a mean disk; friction within its
    limit; hard grains share nothing."""
    v, complain = run.values, run.complain
    settles = run.study == "implicit-settling"
    part = "settling" if settles else "switch"
    r = v["lattice.radius" if settles else "switch.radius"]
    weight = v[f"{part}.density"] * math.pi * r**2 * v[f"{part}.gravity"]
    stiffness = weight / (v[f"{part}.softness"] * 2 * r)
    for states in run.groups.values():
        for p in states.values():
            soft = p.tables["soft"]["grains"].astype(int) if "soft" in p.tables else np.ones(p.size, int)
            for k in range(len(p.i)):
                i, j = p.i[k], p.j[k]
                what = f"{p.name} contact {i} {j}"
                if j >= 0:
                    depth = p.radius[i] + p.radius[j] - np.linalg.norm(p.position[j] - p.position[i])
                else:
                    w = p.wall_of(k)
                    depth = p.radius[i] - (p.position[i] - p.wall_point[w]) @ p.wall_normal[w]
                rounding = stiffness * 4e-16 * np.abs(p.position).max() * 4
                if abs(p.normal_force[k] - stiffness * depth) > 1e-9 * stiffness * depth + rounding:
                    complain("law", f"{what}: normal force {p.normal_force[k]:.9g}, by the law {stiffness * depth:.9g}")
                if not soft[i] or (j >= 0 and not soft[j]):
                    complain("unlisted contact", f"{what}: a force on a hard grain")
                # The snapshot has the elastic force, a step's limit its mean with the dashpot.
                rests = run.goal(p.name.rsplit("/", 1)[1]) is not None
                held = not settles or v["settling.friction"] == "coulomb"
                if rests and held and abs(p.tangential_force[k]) > p.friction[k] * p.normal_force[k] * (1 + 10 * v[f"{part}.rest"]) + v[f"{part}.rest"] * weight:
                    complain("friction", f"{what}: {p.tangential_force[k]:.9g} above {p.friction[k] * p.normal_force[k]:.9g}")
            hard = np.flatnonzero(soft == 0)
            for a in range(len(hard)):
                for b in range(a + 1, len(hard)):
                    i, j = hard[a], hard[b]
                    deep = p.radius[i] + p.radius[j] - np.linalg.norm(p.position[j] - p.position[i])
                    if deep > 1e-9 * r:
                        complain("overlap", f"{p.name}: hard grains {i} and {j}: {deep:.4g} m deep")

"""Checks of whole states: forces and moments, weight and walls, momentum, energy, stress."""
import csv
import math
import os

import numpy as np

from .contacts import Bodies
from .packing import Packing


def ratio_of_forces(p):
    force, _ = p.resultants()
    free = p.free()
    mean = np.linalg.norm(p.force, axis=1).mean() if len(p.i) else 0.0
    if mean == 0 or not free.any():
        return math.inf
    return np.linalg.norm(force[free], axis=1).mean() / mean


def ratio_of_moments(p):
    _, moment = p.resultants()
    turn = p.free() & p.rotates
    mean = np.linalg.norm(p.force, axis=1).mean() if len(p.i) else 0.0
    if mean == 0:
        return math.inf
    return (np.linalg.norm(moment[turn], axis=1) / p.radius[turn]).sum() / max(turn.sum(), 1) / mean


def near(a, b, relative, absolute=0.0):
    return abs(a - b) <= relative * max(abs(a), abs(b)) + absolute


class Run:
    """What a run left, against what it says of itself."""

    def __init__(self, values, folder, groups, summary, complain):
        self.values, self.folder, self.summary, self.complain = values, folder, summary, complain
        self.study = values["study"]
        self.many = values["ensemble.realizations"] > 1
        self.groups = groups  # realization -> name -> Packing

    def value(self, path, default=None):
        return self.values.get(path, default)

    def goal(self, name):
        """Unbalanced force ratio that the state was brought to; None: it need not rest."""
        v = self.value
        rest = v("rest.unbalanced_force_ratio")
        if self.study == "point-load":
            newton = name == "loaded" and v("load.method") == "newton"
            return v("load.unbalanced_force_ratio") if newton else rest
        if self.study == "pile":
            newton = name != "pile" and v("change.method") == "newton"
            return v("change.unbalanced_force_ratio") if newton else rest
        if self.study in ("cone", "lattice-pile"):
            return rest
        if self.study == "sample":
            return rest if name == "state_000" else None
        if self.study == "implicit-settling":
            return v("settling.rest") if self.summary.get("settling.at_rest") == 1 else None
        if self.study == "hard-to-soft":
            at_rest = name == "pile" and self.summary.get("switch.at_rest") == 1
            return v("switch.rest") if at_rest else None
        return None

    def check(self):
        for realization, states in self.groups.items():
            for name, p in states.items():
                self.check_state(realization, name, p)
            if self.study == "sample":
                self.check_sample(realization, states)
        self.check_figures()

    def check_state(self, realization, name, p):
        for column, values in p.columns.items():
            # Springs of pairs are not told (docs/file-formats.md).
            told = not (self.study == "pair" and "spring" in column)
            if told and not np.isfinite(values).all():
                self.complain("nan", f"{p.name}: {column}")
        goal = self.goal(name)
        if self.study in ("point-load", "pile", "cone", "lattice-pile", "sample", "pair"):
            bodies = Bodies(p, self.values, self.complain)
            led = self.study == "pair" and self.value("pair.kind") == "path"
            if not led:
                bodies.check_listed(goal is not None)
                bodies.check_unlisted(goal is not None)
        if goal is not None:
            self.check_rest(p, goal)
            self.check_weight(p)
        self.check_wall_forces(p)
        self.check_momentum(p)

    def check_rest(self, p, goal):
        forces = ratio_of_forces(p)
        if not forces <= goal * (1 + 1e-6) + 1e-12:
            self.complain("balance of forces", f"{p.name}: unbalanced force ratio {forces:.4g} above {goal:.4g}")
        moments = ratio_of_moments(p)
        rolls = self.value("material.rolling_damping", 0) or self.value("material.twisting_damping", 0)
        # Dashpots of rolling are not in the snapshot; at rest they are small.
        if self.study not in ("implicit-settling", "hard-to-soft"):
            if not moments <= goal * (1 + 1e-6) * (20 if rolls else 1) + 1e-12:
                self.complain("balance of moments", f"{p.name}: unbalanced moment ratio {moments:.4g} above {goal:.4g}")

    def check_weight(self, p):
        """What walls and fixed grains carry is the weight and the load."""
        free = p.free()
        weight = (p.weight() + p.load)[free].sum(axis=0)
        if not weight.any():
            return
        carried = np.zeros(3)
        for k in range(len(p.i)):
            i, j = p.i[k], p.j[k]
            if j < 0 and not p.fixed[i]:
                carried -= p.force[k]
            elif j >= 0 and p.fixed[i] != p.fixed[j]:
                carried += p.force[k] if p.fixed[i] else -p.force[k]
        force, _ = p.resultants()
        allowed = np.linalg.norm(force[free], axis=1).sum() + 1e-9 * np.linalg.norm(weight)
        if np.linalg.norm(carried - weight) > allowed:
            self.complain("weight", f"{p.name}: walls carry {carried}, weight and load {weight}")

    def check_wall_forces(self, p):
        if p.wall_force is None or not len(p.wall_names):
            return
        total = np.zeros_like(p.wall_force)
        for k in np.flatnonzero(p.j < 0):
            total[p.wall_of(k)] -= p.force[k]
        size = np.abs(p.force).sum() + 1e-300
        if np.abs(total - p.wall_force).max() > 1e-9 * size:
            self.complain("wall forces", f"{p.name}: of the contacts {total.tolist()}, listed {p.wall_force.tolist()}")

    def check_momentum(self, p):
        """Nothing outside pushes grains of a cell that repeats everywhere."""
        if not p.periodic[:p.dim].all() or p.gravity.any():
            return
        u = p.fluctuation()
        momentum = np.linalg.norm((p.mass[:, None] * u).sum(axis=0))
        # Of the velocities that there have been.
        scale = (p.mass * np.linalg.norm(p.velocity, axis=1)).sum()
        rate = self.value("sample.compression_rate", 0) + self.value("sample.strain_rate", 0)
        scale += (p.mass * rate * p.radius).sum()
        if self.value("motion.local_damping", 0) == 0 and momentum > 1e-9 * scale:
            self.complain("momentum", f"{p.name}: {momentum:.4g} kg m/s of {scale:.4g}")

    # ------------------------------------------------------------- samples

    def check_sample(self, realization, states):
        rows = self.rows("states_of_realizations.csv")
        of_this = [r for r in rows if int(float(r["realization"])) == realization]
        names = sorted(states)
        if len(of_this) != len(names):
            self.complain("states", f"{len(of_this)} rows of states, {len(names)} snapshots")
            return
        for name, row in zip(names, of_this):
            p = states[name]
            self.check_stress(p, row)
            self.check_state_figures(p)
        self.check_servo(states[names[0]])

    def rows(self, name):
        file = os.path.join(self.folder, name)
        if not os.path.exists(file):
            return []
        with open(file) as text:
            return list(csv.DictReader(line for line in text if not line.startswith("#")))

    def check_stress(self, p, row):
        stress = p.stress()
        if not np.isfinite(stress).all():
            self.complain("stress", f"{p.name}: no volume")
            return
        d = p.dim
        size = np.abs(stress).max()
        for a in range(d):
            for b in range(d):
                name = f"sigma_{'xyz'[a]}{'xyz'[b]}"
                told = next((float(v) for k, v in row.items() if k.split("_N")[0].split("_Pa")[0] == name), None)
                if told is not None and abs(told - stress[a, b]) > 1e-6 * size + 1e-12:
                    self.complain("stress", f"{p.name}: {name} {told:.9g}, of the contacts {stress[a, b]:.9g}")
        volume = p.volume_of_sample()
        fraction = p.volume[p.free()].sum() / volume
        if "solid_fraction" in row and not near(float(row["solid_fraction"]), fraction, 1e-6):
            self.complain("solid fraction", f"{p.name}: {row['solid_fraction']}, {fraction:.9g} of the grains")
        if p.wall_names:
            # Sum over walls of force and place: equal where each grain is in balance.
            at = p.j < 0
            middle = p.position.mean(axis=0)
            outside = p.force[at].T @ (p.point[at] - middle)
            force, _ = p.resultants()
            unbalanced = force.T @ (p.position - middle)
            off = np.abs(outside - unbalanced - stress * volume).max()
            allowed = 1e-7 * np.abs(stress * volume).max() + 1e-13 * np.abs(p.force).sum()
            if off > allowed:
                self.complain("stress of walls", f"{p.name}: differs by {off:.4g} N m of {size * volume:.4g}")

    def check_state_figures(self, p):
        """What a recorded state tells of itself."""
        a = p.attributes
        told = float(a.get("run_unbalanced_force_ratio", "nan"))
        own = ratio_of_forces(p)
        if math.isfinite(told) and math.isfinite(own) and len(p.i) and not near(told, own, 1e-6, 1e-12):
            self.complain("balance of forces", f"{p.name}: unbalanced force ratio {own:.9g}, told {told:.9g}")
        self.check_energies(p, float(a.get("run_kinetic_energy", "nan")),
                            float(a.get("run_elastic_energy", "nan")))

    def check_energies(self, p, kinetic, elastic):
        own = p.kinetic_energy()
        if math.isfinite(kinetic) and not near(own, kinetic, 1e-6, 1e-25):
            self.complain("kinetic energy", f"{p.name}: {own:.9g} J of the grains, told {kinetic:.9g}")
        stored = Bodies(p, self.values, lambda *_: None).stored()
        if not (math.isfinite(elastic) and math.isfinite(stored)):
            return
        # With the balance springs of contacts that have just opened count too.
        follows = self.value("motion.energy_balance", False)
        wrong = stored > elastic * (1 + 1e-4) if follows else not near(stored, elastic, 1e-4)
        if wrong and abs(stored - elastic) > 1e-20:
            self.complain("elastic energy", f"{p.name}: {stored:.9g} J of the contacts, told {elastic:.9g}")

    def check_servo(self, p):
        """What the servos hold at the first rest."""
        if self.value("sample.compress_to") != "pressure" or self.value("sample.precompression", 0) > 0:
            return
        d, pressure = p.dim, self.value("sample.pressure")
        if pressure == 0:
            return
        stress = p.stress()
        axes = range(d) if self.value("sample.compression") != "uniaxial" else [d - 1]
        held = [-stress[a, a] for a in axes]
        if self.value("sample.boundary") == "walls":
            return  # walls hold the force on themselves: check_stress compares
        worst = max(abs(h / pressure - 1) for h in held)
        if worst > 0.02:
            self.complain("servo", f"{p.name}: off the pressure by {worst:.3g}")

    # ------------------------------------------------------------- figures of the run

    def last_state(self):
        name = {"point-load": "loaded", "pile": "pile", "cone": "pile", "lattice-pile": "pile",
                "implicit-settling": "pile", "hard-to-soft": "pile"}.get(self.study)
        states = self.groups.get(0, {})
        if self.study == "sample" and states:
            name = max(states)
        return states.get(name)

    def check_figures(self):
        s = self.summary
        p = self.last_state()
        if p is not None and not self.many:
            told = s.get("dem.unbalanced_force_ratio")
            own = ratio_of_forces(p)
            solver = self.value("load.method") == "newton"
            if isinstance(told, float) and self.study != "hard-to-soft" and not solver:
                if not near(told, own, 1e-5, 1e-12):
                    self.complain("balance of forces", f"unbalanced force ratio {own:.9g}, summary {told:.9g}")
            ratio = s.get("dem.kinetic_to_elastic_energy")
            if isinstance(ratio, float) and self.study != "sample" and not solver:
                stored = Bodies(p, self.values, lambda *_: None).stored()
                own = p.kinetic_energy() / stored if stored > 0 else math.nan
                if math.isfinite(own) and not near(own, ratio, 1e-4, 1e-25):
                    self.complain("energies", f"kinetic over elastic {own:.9g}, summary {ratio:.9g}")
            overlap = s.get("dem.max_overlap_ratio")
            if isinstance(overlap, float) and overlap > 1:
                self.complain("overlap", f"{overlap:.3g} radii")
        weight = s.get("base.weight_ratio")
        rests = self.study not in ("implicit-settling", "hard-to-soft") or s.get("settling.at_rest", s.get("switch.at_rest")) == 1
        if isinstance(weight, float) and rests and self.value("material.wall_friction", 0) == 0:
            allowed = 1e-2 if self.study in ("hard-to-soft",) else 2e-2
            if abs(weight - 1) > allowed:
                self.complain("weight", f"base.weight_ratio {weight:.6g}")
        self.check_energy_balance()
        for key in ("settling.balance_error", "switch.balance_error"):
            if isinstance(s.get(key), float) and abs(s[key]) > 1e-6:
                self.complain("energy", f"{key} {s[key]:.4g}")

    def check_energy_balance(self):
        s = self.summary
        if "energy.balance_error" not in s:
            return
        e = {k.split(".", 1)[1]: v for k, v in s.items() if k.startswith("energy.") and k.count(".") == 1}
        if any(isinstance(v, str) for v in e.values()):
            return  # not a number: told already
        there = e["kinetic"] + e["elastic"] + sum(v for k, v in e.items() if k.startswith("lost_"))
        works = e["brought"] + sum(v for k, v in e.items() if k.startswith("work_"))
        size = sum(abs(v) for k, v in e.items()
                   if k.startswith("work_") and k != "work_of_law" or k == "brought")
        if size == 0:
            return
        error = (there - works) / size
        if not self.many and not near(error, e["balance_error"], 1e-3, 1e-9):
            self.complain("energy", f"balance_error {e['balance_error']:.4g}, of the columns {error:.4g}")
        if abs(error) > 0.02:
            self.complain("energy", f"energy is missing: {error:.4g} of what went through")
        for name in ("lost_in_dashpots", "lost_to_friction", "lost_to_rolling", "lost_to_damping",
                     "lost_to_sleep"):
            if e.get(name, 0) < -1e-4 * size:
                self.complain("energy", f"{name} {e[name]:.4g} J: made, not lost (of {size:.4g} J)")

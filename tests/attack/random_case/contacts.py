"""Checks of a snapshot's contacts: geometry, law, friction, and what is missing from the list.

Forces of a step are of its places and of the velocities of the half step before them, which follow
from those at its end and the forces: v - dt a/2.
"""
import itertools
import math

import numpy as np

from . import overlaps
from .laws import Law, equal_radius

# Of a length or force: round-off of places far from the origin against overlaps of a millionth.
CLOSE = 1e-6
LEAPS = ("verlet", "runge_kutta")


class Bodies:
    """A packing with the case's law, and what has to be allowed for."""

    def __init__(self, packing, values, complain):
        self.p, self.complain = packing, complain
        self.material = {k.split(".")[1]: v for k, v in values.items() if k.startswith("material.")}
        self.law = Law(self.material)
        p = packing
        other = values.get("sample.prepared_with") == "other_friction"
        first = packing.name.endswith("/state_000")
        self.prepared = values["sample.prepared_friction"] if other and first else 0.0
        self.changed = other and first
        self.integrator = p.attributes.get("run_integrator", "")
        self.step = float(p.attributes.get("run_time_step", 0))
        self.leaps = self.integrator in LEAPS
        force, moment = p.resultants()
        free = p.free()
        acceleration = np.where(free[:, None], force / p.mass[:, None], 0)
        acceleration += (p.position - p.low) @ (p.flow @ p.flow).T
        # Newton's method moves nothing: its forces are those of grains that stand.
        stands = not p.velocity.any() and not p.spin.any()
        half = 0.5 * self.step if self.leaps and not stands else 0.0
        self.velocity = p.velocity - half * acceleration
        # Dashpots of rolling and twisting are of the spins looked for: they are found together.
        spin = self.turning(moment, free)
        self.spin = p.spin - half * spin
        unsure = np.zeros(p.size)
        if any(self.material.get(k, 0) > 0 for k in ("rolling_damping", "twisting_damping")):
            for _ in range(20):
                before = self.spin
                spin = self.turning(moment + self.rolling_dashpots(before), free)
                self.spin = p.spin - half * spin
                unsure = np.linalg.norm(self.spin - before, axis=1)
        # What damping of the motion changes of it, m/s.
        rate = values.get("rest.background_damping", 0.0)
        share = values.get("motion.local_damping", 0.0)
        self.slack = half * (rate * np.linalg.norm(self.velocity, axis=1)
                             + share * np.linalg.norm(acceleration, axis=1)
                             + p.radius * (rate * np.linalg.norm(self.spin, axis=1)
                                           + share * np.linalg.norm(spin, axis=1)))
        self.slack += p.radius * unsure
        # A corrector moves the grains once more after the forces, by 3/16 of what the predictor's
        # acceleration was wrong by: where a contact has just closed or opened as much as the largest
        # that the forces give. m
        pushed = np.zeros(p.size)
        for ends in (p.i, p.j):
            np.add.at(pushed, ends[ends >= 0], np.linalg.norm(p.force[ends >= 0], axis=1))
        self.corrected = np.zeros(p.size)
        if self.integrator == "gear":
            self.corrected = np.where(free, 3 / 32 * self.step**2 * (pushed / p.mass).max(), 0)
        # Rounding: of a place against the sizes of things.
        self.grain = 4e-16 * (np.abs(p.position).max() + np.abs(p.edges).max())
        self.equal = equal_radius(p.volume, p.dim)

    def turning(self, moment, free):
        """Angular acceleration, 1/s2."""
        p = self.p
        if p.dim == 2:
            return np.where((free & p.rotates)[:, None], moment / p.moments, 0)
        in_body = np.einsum("kba,kb->ka", p.turn, moment)
        turned = np.einsum("kba,kb->ka", p.turn, p.spin)
        in_body -= np.cross(turned, p.moments * turned)
        return np.where((free & p.rotates)[:, None],
                        np.einsum("kab,kb->ka", p.turn, in_body / p.moments), 0)

    def rolling_dashpots(self, spin):
        """Moments of the dashpots against rolling and twisting at these spins, N m: what the caps
        leave of spring and dashpot, less the spring."""
        p, m = self.p, self.material
        out = np.zeros((p.size, 3))
        for k in range(len(p.i)):
            i, j, n = p.i[k], p.j[k], p.normal[k]
            turning = spin[i] - (spin[j] if j >= 0 else p.wall_spin[p.wall_of(k)])
            near = p.radius[i] * (p.radius[j] / (p.radius[i] + p.radius[j]) if j >= 0 else 1)
            force = p.rolling[k] - m.get("rolling_damping", 0) * near * np.cross(turning, n)
            limit, size = m.get("rolling_friction", 0) * p.normal_force[k], np.linalg.norm(force)
            force *= min(1, limit / size) if size > 0 else 0
            twist = p.twisting[k] - m.get("twisting_damping", 0) * (turning @ n)
            limit = m.get("twisting_friction", 0) * p.normal_force[k]
            held = near * np.cross(n, force - p.rolling[k])
            held = held + (min(max(twist, -limit), limit) - p.twisting[k]) * n
            out[i] += held
            if j >= 0:
                out[j] -= held
        return out

    # ------------------------------------------------------------- overlap of what touches

    def of_pair(self, i, j, shift, point=None):
        p = self.p
        if p.axes is not None:
            ball = p.axes[[i, j]].min(axis=1) <= 0
            if not ball.any():
                return None
        way = p.position[j] + shift - p.position[i]
        if p.outlines[i] is not None or p.outlines[j] is not None:
            if p.outlines[i] is None or p.outlines[j] is None:
                return None
            a = p.outlines[i]
            b = p.outlines[j] + way[:2]
            arms = (math.nan, math.nan)
            if point is not None:
                arms = (np.linalg.norm(point - p.position[i]),
                        np.linalg.norm(point - p.position[j] - shift))
            return overlaps.polygon_pair(a, b, *arms)
        return overlaps.round_pair(p.radius[i], p.radius[j], np.linalg.norm(way))

    def on_wall(self, i, w, point=None):
        p = self.p
        if not p.plane[w] or (p.axes is not None and p.axes[i].min() > 0):
            return None
        normal = p.wall_normal[w]
        if p.outlines[i] is not None:
            arm = np.linalg.norm(point - p.position[i]) if point is not None else math.nan
            return overlaps.polygon_on_plane(p.outlines[i], (p.wall_point[w] - p.position[i])[:2],
                                             normal[:2], arm)
        return overlaps.round_pair(p.radius[i], math.inf,
                                   (p.position[i] - p.wall_point[w]) @ normal)

    def masses(self, i, j):
        p = self.p
        heavy = [math.inf if g < 0 or p.fixed[g] else p.mass[g] for g in (i, j)]
        light = [math.inf if g < 0 or p.fixed[g] or not p.rotates[g] else p.moments[g].mean()
                 for g in (i, j)]
        return heavy, light

    def radii(self, i, j):
        r = self.equal if self.law.name == "energy" else self.p.radius
        return r[i], math.inf if j < 0 else r[j]

    def motion(self, i, j, point, shift):
        """Velocity of i against j at a point as i sees it, and what is unsure of it."""
        p = self.p
        v = self.velocity[i] + np.cross(self.spin[i], point - p.position[i])
        slack = self.slack[i]
        if j >= 0:
            other = self.velocity[j] + p.flow @ shift
            v -= other + np.cross(self.spin[j], point - p.position[j] - shift)
            slack += self.slack[j]
        else:
            w = -1 - j
            v -= p.wall_velocity[w] + np.cross(p.wall_spin[w], point - p.wall_point[w])
        return v, slack

    def correction(self, i, j):
        """How far a corrector may have moved two grains against each other, m."""
        return self.corrected[i] + (self.corrected[j] if j >= 0 else 0)

    # ------------------------------------------------------------- checks

    def check_listed(self, rest):
        p = self.p
        for k in range(len(p.i)):
            i, j = p.i[k], p.j[k]
            what = f"{p.name} contact {i} {j}"
            n, f = p.normal[k], p.force[k]
            size = np.linalg.norm(f)
            along = f + p.normal_force[k] * n
            friction = np.linalg.norm(along)
            if abs(n @ n - 1) > 1e-9:
                self.complain("contact normal", f"{what}: of length {np.linalg.norm(n):.12g}")
            if abs(f @ n + p.normal_force[k]) > 1e-9 * size:
                self.complain("contact force", f"{what}: {-f @ n:.12g} along the normal, listed {p.normal_force[k]:.12g}")
            if p.dim == 2 and np.abs(along - p.tangential_force[k] * p.tangent[k]).max() > 1e-9 * size:
                self.complain("contact force", f"{what}: tangential force {p.tangential_force[k]:.12g} is not along the tangent")
            if p.dim == 3 and abs(friction - abs(p.tangential_force[k])) > 1e-9 * size:
                self.complain("contact force", f"{what}: tangential {friction:.12g}, listed {p.tangential_force[k]:.12g}")
            if p.normal_force[k] < 0:
                self.complain("tension", f"{what}: normal force {p.normal_force[k]:.6g}")
            limit = p.friction[k] * p.normal_force[k]
            # Of superellipsoids the normal is found anew for the snapshot, to about 1e-8.
            loose = 1e-9 if p.axes is None else 1e-6
            # A first state's forces are of the preparation, its friction is what comes then.
            before = self.prepared * p.normal_force[k] if j >= 0 else 0.0
            # The listed normal is that of the corrected places: the force's parts turn with it.
            turned = size * (1 + p.friction[k]) * self.correction(i, j) / p.radius[i]
            if friction > max(limit, before) * (1 + loose) + (1e-13 if p.axes is None else 1e-6) * size + turned:
                self.complain("friction", f"{what}: {friction:.9g} above {limit:.9g}")
            if limit > 0 and p.sliding[k] != (friction >= limit * (1 - 1e-6)):
                if abs(friction / limit - 1 + 1e-6) > (1e-8 if p.axes is None else 1e-6) + turned / limit:
                    self.complain("sliding", f"{what}: {friction / limit:.9g} of the limit, sliding {p.sliding[k]}")
            self.check_law(k, what, rest, limit, along, friction)

    def expected_friction(self, k):
        m, p = self.material, self.p
        if p.j[k] >= 0:
            return [m["friction"]]
        return [m[name] for name in ("friction", "floor_friction", "wall_friction") if name in m]

    def check_law(self, k, what, rest, limit, along, friction):
        p = self.p
        i, j = p.i[k], p.j[k]
        shift = p.shift(p.image[k])
        o = (self.on_wall(i, p.wall_of(k), p.point[k]) if j < 0 else
             self.of_pair(i, j, shift, p.point[k]))
        n = p.normal[k]
        depth = self.depth_along(k) if o is None else o.depth
        if not math.isnan(depth) and depth < -self.grain * 4 - 1e-12 * p.radius[i]:
            self.complain("contact apart", f"{what}: a force over a gap of {-depth:.4g} m")
        if p.axes is None and all(p.outlines[g] is None for g in (i, j) if g >= 0):
            way = (p.other_centre(k) - p.position[i]) if j >= 0 else -p.wall_normal[p.wall_of(k)]
            if j >= 0 or p.plane[p.wall_of(k)]:
                away = np.linalg.norm(np.cross(n, way)) / np.linalg.norm(way)
                if away > 1e-7:
                    self.complain("contact normal", f"{what}: {away:.3g} off the line of centres")
            if o is not None:
                # Middle of the lens' edge, or of the chord on the plane.
                off = np.linalg.norm(p.point[k] - p.position[i] - o.arm_i * n)
                if off > 1e-7 * p.radius[i] + 4 * self.grain:
                    self.complain("contact point", f"{what}: {off:.3g} m from where the two meet")
        if not (self.leaps or rest):
            return
        if depth < 20 * self.grain:
            return  # a lattice's grains touch to rounding: no digit of the depth is known
        if o is None:
            if math.isnan(depth) or self.law.name not in ("linear", "penalty"):
                return
            o = overlaps.Overlap(depth=depth)
        if o.swallowed:
            return
        heavy, light = self.masses(i, j)
        elastic, across, along_c, kt, _ = self.law.terms(o, heavy, light, self.radii(i, j))
        if math.isnan(elastic):
            # No dashpot along it.
            if self.law.name == "hertz_elliptic" and friction < limit * (1 - 1e-6):
                if np.linalg.norm(along - p.spring[k]) > 1e-9 * limit:
                    self.complain("law of friction", f"{what}: force and spring differ")
            return
        v, slack = self.motion(i, j, p.point[k], shift)
        approach = v @ n
        expected = max(elastic + across * approach, 0)
        # A length rounded is a force by the stiffness, at most 2.5 R/depth.
        deep = o.depth if not math.isnan(o.depth) else o.area / max(o.chord, 1e-300)
        rounding = 10 * elastic / deep * self.grain if deep > 0 else 0
        allowed = CLOSE * (elastic + across * abs(approach)) + across * slack + rounding
        if self.law.name in ("overlap_area", "energy"):
            allowed += 1e-5 * elastic  # areas of deep lenses, differences of nearly equal sums
        if not self.leaps:
            allowed += across * np.linalg.norm(v) + 1e-4 * elastic
        # A servo has given its wall, or the cell, the velocity of the step to come.
        changed = np.linalg.norm(p.flow) * np.linalg.norm(p.other_centre(k) - p.position[i]) if rest and j >= 0 else 0.0
        allowed += across * changed
        if j < 0:
            allowed += across * np.linalg.norm(p.wall_velocity[p.wall_of(k)])
        if abs(p.normal_force[k] - expected) > allowed:
            self.complain("law", f"{what}: normal force {p.normal_force[k]:.9g}, by the law {expected:.9g} (elastic {elastic:.9g}, allowed {allowed:.2g})")
        # Where the spring alone is at the limit it has been cut, and the dashpot acts beside it.
        cut = np.linalg.norm(p.spring[k]) >= limit * (1 - 1e-9)
        if friction < limit * (1 - 1e-6) and not cut and not self.changed:
            slip = v - approach * n
            expected_t = p.spring[k] - along_c * slip
            off = np.linalg.norm(along - expected_t)
            allowed_t = CLOSE * (np.linalg.norm(p.spring[k]) + along_c * np.linalg.norm(slip)) + along_c * slack + 1e-9 * limit
            allowed_t += along_c * changed
            if not self.leaps:
                allowed_t += along_c * np.linalg.norm(v) + 1e-4 * limit
            if p.axes is not None:  # the normal's part of the force turns with the normal found anew
                allowed_t += 1e-6 * p.normal_force[k]
            if off > allowed_t:
                self.complain("law of friction", f"{what}: off by {off:.3g} of {limit:.3g} N, allowed {allowed_t:.2g}")

    def depth_along(self, k):
        """Of superellipsoids: thickness of what they share, across the contact's normal; it is the
        least there."""
        p = self.p
        if p.axes is None:
            return math.nan
        i, j, n = p.i[k], p.j[k], p.normal[k]

        def reach(g, normals):
            if p.axes[g].min() <= 0:
                return np.full(len(normals), p.radius[g])
            return overlaps.support(p.axes[g], p.exponents[g], p.turn[g], normals)

        if j < 0:
            w = p.wall_of(k)
            if not p.plane[w]:
                return math.nan
            return float(reach(i, n[None])[0] - (p.position[i] - p.wall_point[w]) @ p.wall_normal[w])
        way = p.other_centre(k) - p.position[i]
        nearby = n + 1e-3 * np.array(list(itertools.product((-1, 0, 1), repeat=3)))
        nearby /= np.linalg.norm(nearby, axis=1)[:, None]
        thick = reach(i, nearby) + reach(j, nearby) - nearby @ way
        own = float((reach(i, n[None]) + reach(j, n[None]) - n @ way)[0])
        if thick.min() < own - 1e-6 * p.radius[i] and own < 0.02 * min(p.radius[i], p.radius[j]):
            self.complain("common normal", f"{p.name} contact {i} {j}: depth {own:.6g}, beside it {thick.min():.6g}")
        return own

    def parts(self, i, j, o, shift):
        """Whether a pair that shares something may be without a force: it parts fast enough."""
        p = self.p
        way = p.position[j] + shift - p.position[i] if j >= 0 else -p.wall_normal[-1 - j]
        n = way / np.linalg.norm(way) if o.normal is None else o.normal
        point = p.position[i] + (n * o.arm_i if o.point is None and math.isfinite(o.arm_i) else
                                 0.5 * way if o.point is None else o.point)
        v, slack = self.motion(i, j, point, shift)
        slack += 4 * self.correction(i, j) / self.step  # 251/360 of the same error, over the step
        heavy, light = self.masses(i, j)
        elastic, across, *_ = self.law.terms(o, heavy, light, self.radii(i, j))
        if math.isnan(elastic):
            return v @ n < 0
        return elastic + across * (v @ n) <= CLOSE * elastic + across * slack

    def check_unlisted(self, rest):
        """No two grains, and no grain and a wall, share something without a contact."""
        p = self.p
        listed = {(int(i), int(j), tuple(map(int, n))) for i, j, n in zip(p.i, p.j, p.image)}
        axes = [(-1, 0, 1) if p.periodic[a] else (0,) for a in range(3)]
        for image in itertools.product(*axes):
            shift = p.shift(image)
            for i in range(p.size):
                way = p.position + shift - p.position[i]
                reach = (way**2).sum(axis=1) < (p.radius + p.radius[i])**2
                for j in np.flatnonzero(reach):
                    if j <= i or (i, int(j), image) in listed or (p.fixed[i] and p.fixed[j]):
                        continue
                    self.check_gap(i, int(j), shift, rest)
        for i in np.flatnonzero(p.free()):
            for w in range(len(p.wall_names)):
                if (int(i), -1 - w, (0, 0, 0)) in listed or not p.plane[w]:
                    continue
                o = self.on_wall(i, w)
                tiny = 1e-9 * p.radius[i] + self.correction(i, -1 - w)
                if o is not None and o.depth > tiny and not self.parts(i, -1 - w, o, np.zeros(3)):
                    self.complain("unlisted contact", f"{p.name} grain {i} and {p.wall_names[w]}: {o.depth:.4g} m deep")

    def check_gap(self, i, j, shift, rest):
        p = self.p
        o = self.of_pair(i, j, shift)
        if o is None:
            if p.axes is None or (not rest and self.law.name not in ("linear", "penalty")):
                return
            way = p.position[j] + shift - p.position[i]

            def thickness(normals):
                total = -normals @ way
                for g in (i, j):
                    total = total + (overlaps.support(p.axes[g], p.exponents[g], p.turn[g], normals)
                                     if p.axes[g].min() > 0 else p.radius[g])
                return total

            depth, normal = overlaps.least_thickness(thickness, way[None] / np.linalg.norm(way))
            point = (overlaps.surface_point(p.axes[i], p.exponents[i], p.turn[i], normal)
                     if p.axes[i].min() > 0 else p.radius[i] * normal)
            o = overlaps.Overlap(depth=depth, normal=normal, point=point)
        deep = o.depth if not math.isnan(o.depth) else (o.area / o.chord if o.chord > 0 else 0)
        tiny = (1e-5 if p.axes is not None else 1e-8) * min(p.radius[i], p.radius[j])
        if math.isnan(o.depth):  # polygons: their arms are not known; by the centres' distance
            o.arm_i, o.arm_j = p.radius[i], p.radius[j]
            o.length = overlaps.reduced(o.arm_i, o.arm_j)
        tiny += self.correction(i, j)
        if deep > tiny and not self.parts(i, j, o, shift):
            self.complain("unlisted contact", f"{p.name} grains {i} and {j}: {deep:.4g} m deep")

    def stored(self):
        """Elastic energy of all contacts, J; nan where the law is not worked out here."""
        p, total = self.p, 0.0
        m = self.material
        for k in range(len(p.i)):
            i, j = p.i[k], p.j[k]
            o = (self.on_wall(i, p.wall_of(k), p.point[k]) if j < 0 else
                 self.of_pair(i, j, p.shift(p.image[k]), p.point[k]))
            if o is None:
                depth = self.depth_along(k)
                o = overlaps.Overlap(depth=depth)
            if o.depth <= 0:
                continue
            _, _, _, kt, stored = self.law.terms(o, *self.masses(i, j), self.radii(i, j))
            total += stored
            spring = p.spring[k] @ p.spring[k]
            if spring > 0 and kt > 0:
                total += 0.5 * spring / kt
            if m.get("rolling_stiffness", 0) > 0:
                total += 0.5 * (p.rolling[k] @ p.rolling[k]) / m["rolling_stiffness"]
            if m.get("twisting_stiffness", 0) > 0:
                total += 0.5 * p.twisting[k]**2 / m["twisting_stiffness"]
        return total

"""The contact laws by docs/contact-laws.md, from the overlap and the motion."""
import math

import numpy as np

from .overlaps import reduced

# Of Overlap by law: what it needs.
AREA_LAWS = ("overlap_area", "energy")


class Law:
    """material: the case's values by key."""

    def __init__(self, material):
        self.m = material
        self.name = material["law"]

    def terms(self, o, masses, inertias, radii):
        """Elastic normal force, coefficients of the dashpots across and along the contact, stiffness
        of the spring of friction, energy stored across; nan: not worked out here."""
        m = self.m
        mass = reduced(*masses)
        young = m["young"]
        if self.name in AREA_LAWS:
            length = o.length if self.name == "overlap_area" else reduced(*radii)
            elastic, stored = self.of_area(o, length)
            kt = m["tangential_ratio"] * young
            turning = 1 / mass + sum(a * a / i for a, i in zip((o.arm_i, o.arm_j), inertias)
                                     if not math.isinf(i) and not math.isinf(a))
            return (elastic, m["damping"] * o.chord / length * math.sqrt(young * mass),
                    math.sqrt(kt / turning), kt, stored)
        if self.name == "linear":
            k, kt = m["normal_stiffness"], m["tangential_stiffness"]
            return (k * o.depth, mass * m["normal_damping"], mass * m["tangential_damping"], kt,
                    0.5 * k * o.depth**2)
        if self.name == "penalty":
            k = m["normal_stiffness"]
            return (k * o.depth, 2 * m["damping"] * math.sqrt(k * mass), 0.0,
                    m["tangential_stiffness"], 0.5 * k * o.depth**2)
        if self.name == "hertz":
            nu = m["poisson"]
            a = math.sqrt(reduced(*radii) * o.depth)
            kn = young / (1 - nu * nu) * a
            kt = 2 * young / ((1 + nu) * (2 - nu)) * a
            if m["damping_model"] == "viscoelastic":
                across, along = (m[f"{w}_damping"] * a * mass for w in ("normal", "tangential"))
            else:
                across, along = (2 * m["damping"] * math.sqrt(k * mass) for k in (kn, kt))
            return kn * o.depth / 1.5, across, along, kt, kn * o.depth**2 / 3.75
        if self.name == "hertz_elliptic":
            return math.nan, math.nan, 0.0, math.nan, math.nan
        return (math.nan,) * 5

    def of_area(self, o, length):
        m, young = self.m, self.m["young"]
        if self.name == "overlap_area":
            return young * o.area / length, 0.4 * young * o.area / length * o.depth
        a = o.area / length**2
        if m["energy"] == "square":
            return young * a * o.chord, 0.5 * young * a * a * length**2
        share = m["linear_share"]

        def slope(x):
            return x**(2 / 3) / 12**(1 / 3)

        if a < share:
            rise, stored = slope(share) / share * a, 0.5 * slope(share) / share * a * a
        else:
            rise = slope(a)
            stored = 0.5 * slope(share) * share + 0.6 * (slope(a) * a - slope(share) * share)
        return young * rise * o.chord, young * stored * length**2


def equal_radius(volume, dim):
    """Of the circle or sphere of this volume."""
    return np.sqrt(volume / np.pi) if dim == 2 else np.cbrt(volume * 3 / (4 * np.pi))

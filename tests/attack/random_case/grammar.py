"""Small random cases.

A recipe sets what decides whether grains meet, come to rest and are few; every other key that the
program declares for the study, and that has an effect beside what is set, is drawn from its
declaration now and then: its words, its range about its default. A new key joins by itself.
"""
import math
import random
import tomllib
from dataclasses import dataclass

# Neither physics nor cheap: who runs it, files, analysis without grains.
LEAVE_SECTIONS = {"", "ensemble", "grains", "measured", "compare", "output", "sweep", "block",
                  "average", "verdict", "fit", "fields", "heap"}
# What recipes set, or leave out on purpose, because other keys forbid it.
LEAVE = {"motion.time_step", "motion.energy_balance", "motion.local_damping", "rve.along",
         "rve.radii", "change.method", "source.above", "source.opening", "source.move",
         "load.force", "load.method", "load.weights", "load.probe_strain", "load.radius",
         "sample.precompression", "sample.unload", "sample.filling", "sample.probe",
         "sample.compression", "pair.outline"}
SHARE_OF_OTHERS = 0.2
PLANE, SPACE = 2, 3


def rounded(value):
    return float(f"{value:.4g}")


class Draw:
    """A case that is being drawn: its values by path, and the numbers to come."""

    def __init__(self, keys, study, seed):
        self.keys, self.study, self.random = keys, study, random.Random(seed)
        self.values = {"study": study}
        self.dim, self.shape = PLANE, "round"

    def chance(self, share):
        return self.random.random() < share

    def pick(self, items):
        return self.random.choice(list(items))

    def uni(self, least, most):
        return rounded(self.random.uniform(least, most))

    def log(self, least, most):
        return rounded(math.exp(self.random.uniform(math.log(least), math.log(most))))

    def int(self, least, most):
        return self.random.randint(least, most)

    def set(self, **values):
        """section__name=value."""
        for name, value in values.items():
            self.values[name.replace("__", ".")] = value

    def value(self, path):
        return self.values.get(path, self.keys[path].default(self.study))

    def word(self, path, but=()):
        """One of the words that the program declares, of the grains' dimension."""
        word = self.pick(w for w in self.keys[path].words(self.dim) if w not in but)
        self.values[path] = word
        return word

    def has_effect(self, key):
        if self.study not in key.studies or (key.space and self.dim == PLANE):
            return False
        for path, values, studies in key.needs:
            other = self.keys[path]
            if self.study not in other.studies or (studies and self.study not in studies):
                continue
            if not self.has_effect(other):
                return False
            now = self.value(path)
            if not any(v in now if isinstance(now, list) else v == now for v in values):
                return False
        return True

    def other(self, key):
        """Any value that the declaration allows, numbers not far from the default."""
        default = key.default(self.study)
        if key.type == "boolean":
            return self.chance(0.5)
        if key.type == "word":
            return self.pick(key.words(self.dim))
        if key.type not in ("number", "integer"):
            return None
        if default == 0 and key.most <= 0:
            return None
        value = (default * self.log(0.6, 1.6) if default else
                 max(key.least, min(key.most, 1) * self.log(0.01, 1)))
        value = min(max(value, key.least), key.most)
        return round(value) if key.type == "integer" else rounded(value)

    def others(self):
        for path, key in self.keys.items():
            if path in self.values or path in LEAVE or key.section in LEAVE_SECTIONS:
                continue
            if key.section == "material" or not self.has_effect(key):
                continue
            if self.chance(SHARE_OF_OTHERS):
                value = self.other(key)
                if value is not None:
                    self.values[path] = value

    def without_effect(self):
        """What a recipe set in vain: it would only be warned of."""
        return [p for p in self.values
                if p != "study" and self.keys[p].section and not self.has_effect(self.keys[p])]


@dataclass
class Scale:
    radius: float
    density: float
    gravity: float
    softness: float  # m g/(k d)
    mass: float
    stiffness: float  # N/m


def scale(d, least_softness=1e-5, most_softness=3e-3):
    r = d.log(1e-3, 1e-2)
    plane = d.dim == PLANE
    density = d.log(500, 8000)
    gravity = 9.81 if d.chance(0.7) else d.log(1, 30)
    mass = density * (math.pi * r**2 if plane else 4 / 3 * math.pi * r**3)
    softness = d.log(least_softness, most_softness)
    return Scale(r, density, gravity, softness, mass, mass * gravity / (softness * 2 * r))


# Roul's law knows edges; springs on the depth alone do not (docs/contact-laws.md).
NOT_OF = {"polygon": ("linear", "penalty"), "superellipsoid": ("hertz",), "round": ()}


def material(d, s, gravity=True):
    k, m, r = s.stiffness, s.mass, s.radius
    law = d.word("material.law", but=NOT_OF[d.shape])
    plane = d.dim == PLANE
    rate = 2 * math.sqrt(2 * k / m)  # twice the frequency of a pair
    spring = 0.0 if d.chance(0.03) else k * d.uni(0.2, 1)
    d.set(material__density=s.density, material__friction=friction(d),
          material__floor_friction=friction(d), material__young=rounded(k if plane else k / r),
          material__poisson=d.uni(0, 0.45), material__normal_stiffness=rounded(k),
          material__tangential_stiffness=rounded(spring), material__damping=d.log(0.02, 0.9),
          material__tangential_ratio=d.uni(0.1, 1.2))
    if d.chance(0.4):
        d.set(material__wall_friction=friction(d))
    if gravity:
        d.set(material__gravity=s.gravity)
    for path in ("material.damping_model", "material.tangential_memory", "material.energy"):
        if d.has_effect(d.keys[path]):
            d.word(path)
    normal = rate * d.log(0.02, 0.5)
    if law == "hertz":
        normal /= math.sqrt(r * 0.01 * r)  # per radius of the contact
    d.set(material__normal_damping=rounded(normal),
          material__tangential_damping=rounded(normal * d.uni(0, 0.6)))
    if d.shape == "round" and d.chance(0.3):
        rolling(d, s)


def friction(d):
    return 0.0 if d.chance(0.15) else d.uni(0.05, 1)


def rolling(d, s):
    k, m, r = s.stiffness, s.mass, s.radius
    dashpot = 0.05 * math.sqrt(k * m)
    d.set(material__rolling_friction=d.uni(0.02, 0.5),
          material__rolling_stiffness=rounded(k * d.uni(0.05, 0.3)),
          material__rolling_damping=rounded(dashpot * d.uni(0, 1)))
    if d.dim == SPACE and d.chance(0.5):
        d.set(material__twisting_friction=rounded(r * d.uni(0.02, 0.3)),
              material__twisting_stiffness=rounded(k * r * r * d.uni(0.05, 0.3)),
              material__twisting_damping=rounded(dashpot * r * r * d.uni(0, 1)))


def motion(d, balance=True):
    but = ["gear"] if d.dim == SPACE else []
    if d.shape != "superellipsoid":
        but.append("runge_kutta")
    # Gear's step is a sixth of the others', of polygons less: seldom.
    if d.shape == "polygon" or d.chance(0.85):
        but.append("gear")
    integrator = d.word("motion.integrator", but=but)
    if integrator != "gear":
        if d.chance(0.15):
            d.set(motion__local_damping=d.uni(0.05, 0.6))
        if balance and d.chance(0.6):
            d.set(motion__energy_balance=True)
    d.set(motion__time_step_fraction=d.uni(0.4, 0.95))


def rest(d, s):
    swing = math.sqrt(s.gravity / s.radius)
    damping = rounded(swing * d.log(0.3, 3))
    d.set(rest__unbalanced_force_ratio=d.log(1e-7, 1e-3),
          rest__kinetic_to_elastic_energy=d.log(1e-12, 1e-5),
          rest__background_damping=damping, rest__max_time=rounded(40 / damping + 60 / swing))


def superellipsoid(d, section):
    a, e = sorted((d.uni(0.6, 1.5), d.uni(0.6, 1.5))), sorted((d.uni(0.5, 1.3), d.uni(0.5, 1.3)))
    for name, value in (("axis_min", a[0]), ("axis_max", a[1]), ("exponent_min", e[0]),
                        ("exponent_max", e[1])):
        d.values[f"{section}.{name}"] = value


def outline(d):
    """Corners of a convex polygon about its middle, in radii."""
    n, turn = d.int(3, 8), d.uni(0, 6)
    wide = d.uni(1, 1.8)
    out = []
    for k in range(n):
        angle = turn + 2 * math.pi * (k + 0.7 * d.random.random()) / n
        out += [rounded(wide * math.cos(angle)), rounded(math.sin(angle))]
    return out


# ----------------------------------------------------------------------- studies

def point_load(d):
    if d.chance(0.4):
        d.dim = SPACE
        d.set(packing__dim=3, compare__models=["boussinesq"])
    else:
        d.set(packing__dim=2, compare__models=["flamant"])
    s = scale(d)
    r = s.radius
    kind = d.word("packing.kind")
    lattice = kind in ("triangular", "sqrt3", "close_packed")
    if not lattice:
        shape = d.word("packing.shape")
        d.shape = {"irregular": "polygon"}.get(shape, shape if shape == "superellipsoid" else "round")
    d.set(packing__radius=r, packing__radius_small=rounded(r * d.uni(0.6, 0.95)),
          packing__radius_min=rounded(r * d.uni(0.6, 0.95)), packing__radius_max=rounded(1.2 * r),
          packing__side=rounded(1.2 * r), packing__jitter=d.pick([0.0, 0.02, 0.1]),
          packing__drop_height=rounded(r * d.uni(0.5, 3)))
    d.set(packing__sizes="mono") if lattice else d.word("packing.sizes")
    if d.dim == PLANE:
        d.set(packing__width=rounded(r * d.uni(12, 24)), packing__depth=rounded(r * d.uni(3, 9)),
              packing__columns=d.int(3, 10), packing__rows=d.int(1, 6))
    else:
        d.set(packing__width=rounded(r * d.uni(7.5, 10)), packing__depth=rounded(r * d.uni(2.5, 5)),
              packing__columns=d.int(4, 5), packing__rows=d.int(1, 3))
        if d.shape == "superellipsoid":
            superellipsoid(d, "packing")
            d.set(packing__width=rounded(r * d.uni(12, 14)), packing__depth=rounded(3 * r))
    if d.dim == SPACE and d.chance(0.7):
        d.set(load__weights=d.log(0.01, 3))
    else:
        d.set(load__weights=0.0, load__force=rounded(s.mass * s.gravity * d.log(0.05, 20)))
    d.set(load__ramp_time=rounded(d.uni(5, 30) * math.sqrt(r / s.gravity)))
    if d.dim == SPACE and d.chance(0.3):
        d.set(load__radius=rounded(r * d.uni(2, 4)))
    if d.chance(0.2) and d.shape in ("round", "superellipsoid"):
        d.set(load__method="newton")
    elif d.dim == SPACE and d.chance(0.15):
        d.set(load__probe_strain=1e-6, packing__sides="periodic")
    material(d, s)
    # What the quasi-static solver knows (docs/quasistatic.md).
    solver = d.value("load.method") == "newton" or "load.probe_strain" in d.values
    if solver:
        d.values = {p: v for p, v in d.values.items() if "rolling_" not in p and "twisting_" not in p}
    motion(d, balance=not solver)
    rest(d, s)
    if solver:
        d.set(load__radius=0.0, load__unbalanced_force_ratio=1e-8)
    d.set(average__points=11, average__map_columns=7, average__map_rows=5)


def pile(d):
    s = scale(d, 5e-5)
    r = s.radius
    shape = d.word("shape.kind")
    d.shape = "round" if shape == "disk" else "polygon"
    corners = sorted((d.int(3, 10), d.int(3, 10)))
    d.set(shape__radius=r, shape__polydispersity=d.pick([0.0, 0.1, 0.3, 0.5]),
          shape__corners_min=corners[0], shape__corners_max=corners[1],
          shape__axis_ratio=d.pick([1.0, 1.3, 2.0]), shape__side=rounded(1.1 * r))
    if shape == "outline":
        d.set(shape__outline=outline(d))
    fall = math.sqrt(2 * r / s.gravity)
    d.word("source.kind")
    d.set(source__grains=d.int(5, 60), source__height=rounded(r * d.uni(25, 60)),
          source__speed=d.uni(0, 0.3), source__interval=rounded(fall * d.uni(1.5, 4)),
          source__clearance=rounded(r * d.uni(2, 4)), source__length=rounded(r * d.uni(60, 90)))
    if d.chance(0.2):
        d.set(source__above=d.uni(2, 5))
    elif d.chance(0.15):
        d.set(source__opening=rounded(r * d.uni(8, 12)), source__height=rounded(80 * r))
    if d.chance(0.2) and "source.opening" not in d.values:
        d.set(source__move=rounded(r * d.uni(-10, 10)), source__shift=rounded(r * d.uni(-1, 1)))
    d.word("floor.kind")
    d.set(floor__length=rounded(r * d.uni(250, 400)))
    if d.chance(0.3):
        d.set(change__gravity=[rounded(s.gravity * d.uni(0.7, 0.98))])
    material(d, s)
    newton = bool(d.value("change.gravity")) and d.word("change.method") == "newton"
    if newton:
        d.values = {p: v for p, v in d.values.items() if "rolling_" not in p}
    d.set(change__ramp_time=rounded(20 * fall))
    motion(d, balance=not newton)
    rest(d, s)
    if d.chance(0.25):
        d.set(sleep__on=False)
    d.set(average__points=11, average__map_columns=7, average__map_rows=5)


def cone(d):
    d.dim = SPACE
    s = scale(d, 1e-5, 2e-4)
    r = s.radius
    if d.word("cone.shape") == "superellipsoid":
        d.shape = "superellipsoid"
        superellipsoid(d, "cone")
    # Walls of superellipsoids are planes.
    source = d.word("cone.source", but=("cylinder",) if d.shape == "superellipsoid" else ())
    fall = math.sqrt(2 * r / s.gravity)
    d.set(cone__grains=d.int(50, 80), cone__radius=r, cone__polydispersity=d.uni(0, 0.3),
          cone__mouth=rounded(r * d.uni(4, 5)), cone__rate=rounded(d.uni(1, 4) / fall),
          cone__drop=rounded(r * d.uni(2.7, 4)), cone__speed=d.uni(0.05, 0.4),
          cone__lift_speed=rounded(r / fall * d.uni(0.05, 0.3)),
          cone__floor_radius=rounded(r * (22 if source == "rain" else d.uni(24, 30))))
    d.word("cone.floor")
    if d.chance(0.6):
        d.set(cone__floor="rough")
    material(d, s)
    # Else they all leave the floor.
    d.set(material__friction=d.uni(0.3, 1), material__floor_friction=d.uni(0.3, 1))
    if d.shape == "round" and d.chance(0.7):
        rolling(d, s)
        d.set(material__rolling_friction=d.uni(0.2, 0.5))
    motion(d, balance=False)
    d.set(motion__integrator="verlet")
    rest(d, s)
    if d.shape == "round" and d.chance(0.25):
        d.set(sleep__on=False)
    d.set(average__points=11, average__map_columns=7, average__map_rows=5)


def lattice_pile(d):
    s = scale(d, 1e-6, 1e-3)
    d.set(lattice__base_grains=d.int(3, 12), lattice__slope_deg=d.pick([60.0, 45.0, 30.0]),
          lattice__radius=s.radius, lattice__gap=d.pick([0.0, 5e-4, 5e-3]))
    if d.chance(0.2):
        d.set(lattice__top_slope_deg=d.uni(30, 60), lattice__bend=d.uni(0.1, 0.45))
    material(d, s)
    if d.chance(0.8):
        d.set(material__friction=0.0, material__floor_friction=1.0)
    d.values = {p: v for p, v in d.values.items() if "rolling_" not in p}
    motion(d)
    rest(d, s)
    d.set(rest__background_damping=rounded(math.sqrt(2 * s.stiffness / s.mass) * d.log(0.05, 0.5)))


def sample(d):
    if d.chance(0.5):
        d.dim = SPACE
    d.set(sample__dim=d.dim)
    s = scale(d)
    shape = d.word("sample.shape")
    d.shape = {"rand1": "polygon", "regular": "polygon", "superellipsoid": "superellipsoid"}.get(
        shape, "round")
    corners = sorted((d.int(3, 9), d.int(3, 9)))
    walls = d.word("sample.boundary") == "walls"
    few = 65 if d.shape == "superellipsoid" else 90
    d.set(sample__grains=d.int(24, 90) if d.dim == PLANE else d.int(55, few),
          sample__radius=s.radius, sample__polydispersity=d.uni(0, 0.4),
          sample__size_ratio=d.uni(1, 1.6), sample__corners_min=corners[0],
          sample__corners_max=corners[1], sample__height_ratio=d.uni(0.8, 1.3),
          sample__start_fraction=d.uni(0.1, 0.3) if d.shape == "round" else d.uni(0.03, 0.1))
    if d.shape == "superellipsoid":
        superellipsoid(d, "sample")
    d.word("sample.sizes")
    deformation = d.word("sample.deformation")
    constant = d.word("sample.constant")
    served = deformation == "axial" or (deformation == "simple_shear" and constant == "stress")
    d.set(sample__compress_to="pressure") if served else d.word("sample.compress_to")
    if deformation == "axial":
        d.set(sample__compression="isotropic")
    elif d.chance(0.3):
        d.set(sample__compression="uniaxial")
    dense = 0.8 if d.dim == PLANE else 0.58
    if d.value("sample.compression") == "uniaxial":
        # A tall box, which becomes as high as it is wide.
        d.set(sample__height_ratio=rounded(dense / d.value("sample.start_fraction") * d.uni(0.8, 1.3)))
    share = d.value("sample.start_fraction") / dense
    if d.value("sample.compression") == "isotropic":
        share **= 1 / d.dim
    stiffness = s.stiffness if d.dim == PLANE else s.stiffness / (2 * s.radius)
    d.set(sample__pressure=rounded(stiffness * d.log(1e-4, 1e-2)),
          sample__solid_fraction=rounded(dense * d.uni(1.0, 1.1)),
          sample__compression_strain=rounded(min(max(0.0, 1 - share * d.uni(0.96, 1.02)), 0.9)))
    # A grain passes its radius in many steps.
    swing = math.sqrt(s.stiffness / s.mass)
    d.set(sample__compression_rate=rounded(swing * d.log(3e-4, 3e-3)),
          sample__strain_rate=rounded(swing * d.log(1e-4, 1e-3)),
          sample__strain=d.log(0.02, 0.3) if deformation == "simple_shear" else d.log(0.01, 0.1),
          sample__ramp_time=rounded(d.uni(10, 100) / swing), sample__records=d.int(1, 6))
    if not served and d.chance(0.2):
        d.set(sample__precompression=d.log(0.005, 0.05))
    if d.chance(0.3):
        d.word("sample.unload", but=("stress",) if deformation == "simple_shear" else ())
        d.set(sample__unload_strain=d.uni(0.2, 1.2), sample__unload_records=d.int(1, 4))
    if d.dim == SPACE and walls and d.chance(0.25):
        d.set(sample__filling="dropped", sample__base_fraction=d.uni(0.35, 0.6),
              sample__drop_gravity=s.gravity,
              sample__drop_damping=rounded(math.sqrt(s.gravity / s.radius) * d.uni(0.1, 0.5)))
    if d.dim == SPACE and d.chance(0.15):
        d.word("sample.probe")
    if d.dim == SPACE and d.shape != "superellipsoid" and d.chance(0.15):
        d.set(rve__along=2, rve__radii=[2.0, 3.0])
    material(d, s, gravity=False)
    motion(d)
    d.set(rest__background_damping=rounded(swing * d.log(0.01, 0.1)),
          rest__unbalanced_force_ratio=d.log(1e-6, 1e-2),
          rest__kinetic_to_elastic_energy=d.log(1e-9, 1e-4),
          rest__max_time=rounded(1.5e4 / swing))


def pair(d):
    shape = d.word("pair.shape")
    if d.chance(0.4):
        shape = d.pick(["disk", "sphere"])
        d.set(pair__shape=shape)
    d.dim = SPACE if shape == "sphere" else PLANE
    d.shape = "round" if shape in ("disk", "sphere") else "polygon"
    s = scale(d)
    r = s.radius
    d.word("pair.partner")
    d.set(pair__radius=r, pair__corners=d.int(3, 10), pair__axis_ratio=d.pick([1.0, 1.5, 2.0]),
          pair__offset=d.pick([0.0, 0.0, d.uni(-0.6, 0.6)]), pair__records=d.int(5, 60))
    if d.chance(0.5):
        d.set(pair__radius_second=rounded(r * d.uni(0.5, 2)))
    if shape == "outline":
        d.values["pair.outline"] = outline(d)
    if d.shape == "polygon":
        d.set(pair__turned_first=d.uni(-180, 180), pair__turned_second=d.uni(-180, 180))
    # Half the way of a blow is below a twentieth of the radius.
    fast = 0.05 * r * math.sqrt(s.stiffness / s.mass)
    if d.word("pair.kind") == "collision":
        d.set(pair__speed=rounded(fast * d.log(0.01, 1)), pair__angle=d.uni(-60, 60))
        if d.chance(0.3) and d.value("pair.angle") < 30:
            d.set(pair__speeds=[rounded(fast * d.log(0.01, 1)) for _ in range(2)])
        elif d.chance(0.3):
            count = 3 if d.dim == SPACE else 1
            d.set(pair__spin_first=[rounded(fast / r * d.uni(-1, 1)) for _ in range(count)])
    else:
        path = d.word("pair.path")
        d.set(pair__speed=0.0 if path == "random" else rounded(fast * d.log(0.01, 1)),
              pair__depth=d.log(0.002, 0.05), pair__amplitude=d.log(0.01, 0.2),
              pair__swing=d.uni(1, 30), pair__steps=d.int(100, 1000), pair__loops=d.int(1, 12),
              pair__turns=d.int(1, 3))
        if path == "waypoints":
            deep = d.uni(0.005, 0.03)
            d.set(pair__waypoints=[-0.01, 0.0, 0.0, deep, d.uni(-0.02, 0.02), d.uni(-0.05, 0.05),
                                   deep, d.uni(-0.02, 0.02), 0.0, -0.01, 0.0, 0.0])
    material(d, s, gravity=False)
    if d.chance(0.3):  # nothing that takes energy
        d.set(material__friction=0.0, material__damping=0.0, material__normal_damping=0.0,
              material__tangential_damping=0.0)
    motion(d, balance=False)
    d.set(motion__time_step_fraction=d.log(0.005, 0.1))
    d.set(pair__spin_second=[])
    if d.value("pair.kind") == "path":
        d.values.pop("motion.local_damping", None)


def hard_disks(d):
    d.dim = SPACE if d.word("gas.shape") == "sphere" else PLANE
    most = 0.6 if d.dim == PLANE else 0.4
    grains = d.int(12, 120) if d.dim == PLANE else d.int(40, 120)
    d.word("gas.kind")
    d.set(gas__grains=grains, gas__radius=d.log(1e-4, 1e-1), gas__density=d.log(100, 1e4),
          gas__speed=d.log(1e-3, 100),
          gas__fractions=sorted({d.uni(0.02, most) for _ in range(d.int(1, 2))}),
          gas__equilibration=d.uni(0, 30), gas__collisions=d.uni(5, 100),
          gas__restitution=d.uni(0.3, 0.99), gas__friction=friction(d), gas__cool_to=d.log(0.05, 0.8),
          gas__records=d.int(2, 20))
    if d.chance(0.5):
        d.set(gas__contact_time=rounded(d.log(1e-6, 1e-3) * d.value("gas.radius")
                                        / d.value("gas.speed")))


def implicit_settling(d):
    d.set(lattice__base_grains=d.int(3, 10), lattice__slope_deg=d.pick([60.0, 60.0, 45.0, 30.0]),
          lattice__radius=d.log(1e-3, 1e-2), lattice__gap=d.pick([0.0, 5e-4, 5e-3]),
          settling__density=d.log(500, 8000), settling__gravity=d.log(1, 30),
          settling__softness=d.log(1e-5, 3e-3), settling__max_time=d.uni(3, 40),
          settling__records=d.int(5, 100), settling__step=d.log(2, 20))
    d.word("settling.friction")


def hard_to_soft(d):
    d.set(switch__columns=d.int(2, 8), switch__rows=d.int(1, 6), switch__radius=d.log(1e-3, 1e-2),
          switch__density=d.log(500, 8000), switch__gravity=d.log(1, 30),
          switch__softness=d.log(1e-5, 3e-3), switch__max_time=d.uni(10, 40),
          switch__records=d.int(5, 100), switch__restitution=d.uni(0.1, 0.9),
          switch__step=d.log(1, 8))


RECIPES = {"point-load": (point_load, 22), "pile": (pile, 20), "cone": (cone, 8),
           "lattice-pile": (lattice_pile, 6), "sample": (sample, 24), "pair": (pair, 10),
           "hard-disks": (hard_disks, 6), "implicit-settling": (implicit_settling, 5),
           "hard-to-soft": (hard_to_soft, 5)}


def draw_case(keys, seed, number, attempt):
    """Case `number` of `seed`: path -> value. `attempt`: the draws before it were refused."""
    chooser = random.Random(f"{seed}/{number}")
    names = list(RECIPES)
    study = chooser.choices(names, [RECIPES[n][1] for n in names])[0]
    d = Draw(keys, study, f"{seed}/{number}/{attempt}")
    d.set(ensemble__realizations=2 if d.chance(0.1) else 1, ensemble__seed=d.int(0, 2**40))
    RECIPES[study][0](d)
    d.others()
    d.set(output__vtu=d.chance(0.05), output__report=d.chance(0.05))
    for path in d.without_effect():
        del d.values[path]
    return d.values


def from_toml(file):
    """path -> value, of a file that as_toml wrote."""
    with open(file, "rb") as text:
        tables = tomllib.load(text)
    out = {}
    for name, value in tables.items():
        if isinstance(value, dict):
            out.update({f"{name}.{key}": item for key, item in value.items()})
        else:
            out[name] = value
    return out


def text_of(value):
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, str):
        return f'"{value}"'
    if isinstance(value, list):
        return "[" + ", ".join(text_of(v) for v in value) + "]"
    return repr(value)


def as_toml(values):
    lines, section = [], ""
    for path in sorted(values, key=lambda p: ("." in p, p)):
        head, _, name = path.rpartition(".")
        if head != section:
            lines += ["", f"[{head}]"]
            section = head
        lines.append(f"{name} = {text_of(values[path])}")
    return "\n".join(lines) + "\n"

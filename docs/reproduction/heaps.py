"""Heaps by their states: their frame, circles in which grains are averaged, and what is measured in them.

Averages are Roul's (2.6): over the grains whose centroids lie in a circle, over the circle's area. The circles
have a radius of RVE heights, some 100 grains in a heap of 6,500. Lengths are in heights of the heap, stresses in
its own rho g h, tension positive, x to the right and y up, the apex at (0, 0). Needs numpy and scipy.
"""
import math
from functools import cached_property

import numpy
from scipy.spatial import cKDTree

RVE = 0.1
GRAVITY = 9.81  # m/s2, of a state that does not say
FLANK = (0.15, 0.85)  # of the height: the part of a flank that has its line, as the program's
ROUNDS = 10
ROUND = 48  # sides of a disk
BELOW = 1.5  # mean diameters below the flanks' lines, above which the density is not that of the inside
CENTRE, SHOULDER = 0.1, (0.15, 0.4)  # half bases, as heap.centre and heap.shoulder_* of a case
AXIS = (0.1, 0.6)  # heights, as heap.axis_from and heap.axis_to


def tops(edges, width):
    """The highest point of outlines in columns of this width: middles of the columns, heights.

    edges: from and to of every side, n x 2 x 2. Columns begin at whole multiples of the width.
    """
    first = math.floor(edges[..., 0].min() / width)
    found = numpy.zeros(math.ceil(edges[..., 0].max() / width) - first + 1)
    columns = numpy.floor(edges[..., 0] / width).astype(int) - first
    for end in (0, 1):
        numpy.maximum.at(found, columns[:, end], edges[:, end, 1])
    low, high = columns.min(axis=1), columns.max(axis=1)
    for step in range(1, int((high - low).max()) + 1):
        across = low + step <= high
        (x0, y0), (x1, y1) = edges[across, 0].T, edges[across, 1].T
        column = low[across] + step
        y = y0 + (y1 - y0) * ((column + first) * width - x0) / (x1 - x0)
        for side in (column - 1, column):
            numpy.maximum.at(found, side, y)
    return (numpy.arange(len(found)) + first + 0.5) * width, found


def sides(grains, places):
    """From and to of every side of the outlines, n x 2 x 2, and the grain of each; disks have ROUND of them."""
    angle, radius = grains["angle"][:], grains["radius"][:]
    if "outline" in grains:
        start, outline = grains["outline_start"][:].astype(int), grains["outline"][:]
    else:
        start, turns = numpy.arange(len(places) + 1) * ROUND, numpy.arange(ROUND) * 2 * math.pi / ROUND
        outline = (radius[:, None, None] * numpy.stack((numpy.cos(turns), numpy.sin(turns)), axis=1)).reshape(-1, 2)
    grain = numpy.repeat(numpy.arange(len(places)), numpy.diff(start))
    cosine, sine = numpy.cos(angle[grain]), numpy.sin(angle[grain])
    corners = places[grain] + numpy.stack((cosine * outline[:, 0] - sine * outline[:, 1],
                                           sine * outline[:, 0] + cosine * outline[:, 1]), axis=1)
    after = numpy.arange(1, len(corners) + 1)
    after[start[1:] - 1] = start[:-1]
    return numpy.stack((corners, corners[after]), axis=1), grain


def theil_sen(x, y):
    """Slope and height at 0 of a line by medians."""
    a, b = numpy.triu_indices(len(x), 1)
    slope = numpy.median((y[b] - y[a]) / (x[b] - x[a]))
    return slope, numpy.median(y - slope * x)


def flank(x, y, height):
    """The line of a flank; x and y from the top outwards."""
    low, high = (share * height for share in FLANK)
    outside = numpy.flatnonzero(y < low)
    end = outside[0] if len(outside) else len(y)
    begin = max((k + 1 for k in range(end) if y[k] > high), default=0)
    chosen = numpy.arange(begin, end)
    line = theil_sen(x[chosen], y[chosen])
    for _ in range(ROUNDS):
        on_line = line[1] + line[0] * x
        following = numpy.flatnonzero((on_line >= low) & (on_line <= high))
        if numpy.array_equal(following, chosen):
            break
        chosen, line = following, theil_sen(x[following], y[following])
    return line


class Heap:
    """A heap at rest on a plane floor or on fixed grains, by the group of its state in a snapshots.h5.

    A dictionary of arrays serves as well.
    """

    def __init__(self, state):
        self.gravity = abs(float(state.attrs["gravity_y"])) if hasattr(state, "attrs") else GRAVITY
        grains, contacts = state["grains"], state["contacts"]
        places = grains["position"][:][:, :2]
        free = grains["fixed"][:] == 0 if "fixed" in grains else numpy.ones(len(places), dtype=bool)
        self.places, self.ids = places[free], grains["id"][:].astype(int)[free]
        self.areas, self.masses, self.radii = (grains[name][:][free] for name in ("volume", "mass", "radius"))
        self.diameter = 2 * self.radii.mean()
        self.i, self.j = (contacts[name][:].astype(int) for name in ("i", "j"))
        self.force, self.normal, self.point = (contacts[name][:][:, :2] for name in ("force", "normal", "point"))
        carriers = self._leave_out(~free)
        if len(carriers) > 0:
            self.floor = float((places[carriers, 1] + grains["radius"][:][carriers]).mean())
        else:
            self.floor = float(state["walls"]["point"][:][0, 1])
        edges, grain = sides(grains, places)
        edges = edges[free[grain]]
        edges[..., 1] -= self.floor
        self._frame(*tops(edges, self.diameter))

    def _leave_out(self, fixed):
        """Makes contacts with fixed grains, those of a rough floor, contacts with a floor; the fixed grains of them."""
        with_floor = self.j < 0
        turned = fixed[self.i] & ~with_floor
        self.i[turned], self.j[turned] = self.j[turned], self.i[turned]
        for vectors in (self.force, self.normal):
            vectors[turned] *= -1
        kept = ~fixed[self.i]
        self.i, self.j, self.force, self.normal, self.point = (
            one[kept] for one in (self.i, self.j, self.force, self.normal, self.point))
        on_fixed = (self.j >= 0) & fixed[self.j]
        carriers = self.j[on_fixed]
        number = numpy.cumsum(~fixed) - 1
        self.i, self.j = number[self.i], numpy.where((self.j < 0) | on_fixed, -1, number[self.j])
        return carriers

    def _frame(self, x, y):
        """Apex, height, feet and rho by the columns of the surface, as the program's."""
        apex = int(y.argmax())
        self.height = float(y[apex])
        self.left, self.right = flank(x[:apex][::-1], y[:apex][::-1], self.height), flank(x[apex + 1:], y[apex + 1:],
                                                                                         self.height)
        self.apex = (self.left[1] - self.right[1]) / (self.right[0] - self.left[0])
        self.half_left = self.apex + self.left[1] / self.left[0]
        self.half_right = -self.right[1] / self.right[0] - self.apex
        self.fraction = self._fraction()
        self.pressure = self.masses.sum() / self.areas.sum() * self.fraction * self.gravity * self.height
        self.scaled = (self.places - (self.apex, self.floor + self.height)) / self.height

    def _fraction(self):
        """Volume fraction inside, a diameter above the floor and BELOW under the flanks, up to 0.85 heights."""
        x, y = self.places[:, 0], self.places[:, 1] - self.floor
        low, high = self.diameter, FLANK[1] * self.height
        lines = [(slope, at - BELOW * self.diameter * math.hypot(1, slope)) for slope, at in (self.left, self.right)]
        inside = (y > low) & (y < high)
        for slope, at in lines:
            inside &= y < at + slope * x
        level = numpy.linspace(low, high, 2001)
        width = numpy.clip((level - lines[1][1]) / lines[1][0] - (level - lines[0][1]) / lines[0][0], 0, None)
        return float(self.areas[inside].sum() / (width.mean() * (high - low)))

    def room(self, points):
        """The distance of points to the nearest flank, in heights."""
        x, y = points.T
        sides = []
        for half, sign in ((self.half_left / self.height, -1), (self.half_right / self.height, 1)):
            sides.append((-y * half - sign * x) / math.hypot(half, 1))
        return numpy.minimum(*sides)

    @cached_property
    def branches(self):
        """Both ends of the branches in heights and the force on the grain at the first one, in rho g h times height;
        on the floor they end at the contact's point."""
        other = numpy.where((self.j >= 0)[:, None], self.places[self.j], self.point)
        origin = (self.apex, self.floor + self.height)
        return ((self.places[self.i] - origin) / self.height, (other - origin) / self.height,
                self.force / (self.pressure * self.height))

    def through(self, share):
        """What crosses the level at this share of the height: places in heights, and the forces upwards."""
        a, b, force = self.branches
        level = share - 1.0
        if share == 0:
            crosses = self.j < 0
            x = b[crosses, 0]
        else:
            crosses = (a[:, 1] > level) != (b[:, 1] > level)
            part = (level - a[crosses, 1]) / (b[crosses, 1] - a[crosses, 1])
            x = a[crosses, 0] + part * (b[crosses, 0] - a[crosses, 0])
        up = numpy.where(a[crosses, 1] > level, 1, -1) * force[crosses, 1]
        return x, up

    def dip(self, share):
        """Shoulder less centre of the vertical pressure at a level, over rho g h (1 - share); windows shrink with
        the level as the heap does."""
        x, force = self.through(share)
        halves = numpy.array((self.half_left, self.half_right)) / self.height * (1 - share)
        at = abs(x) / numpy.where(x < 0, *halves)
        whole = halves.sum()
        centre = force[at < CENTRE].sum() / (CENTRE * whole)
        beside = force[(at >= SHOULDER[0]) & (at < SHOULDER[1])].sum() / ((SHOULDER[1] - SHOULDER[0]) * whole)
        return float(beside - centre) / (1 - share)

    def axis_ratio(self, low, high):
        """sigma_xx over sigma_yy on the axis between two heights, as axis.stress_ratio of the program."""
        a, b, force = self.branches
        box = numpy.array([[-CENTRE * self.half_left / self.height, CENTRE * self.half_right / self.height],
                           [low - 1, high - 1]])
        way = b - a
        with numpy.errstate(divide="ignore", invalid="ignore"):
            ends = numpy.sort(numpy.stack([(box[:, k] - a) / way for k in (0, 1)]), axis=0)
        enter, leave = numpy.maximum(ends[0].max(axis=1), 0), numpy.minimum(ends[1].min(axis=1), 1)
        share = numpy.clip(leave - enter, 0, None)
        across, down = (share * force.T * way.T).sum(axis=1)
        return float(across / down)

    @cached_property
    def tensors(self):
        """Sums over each grain's contacts: force times lever (its stress times its area, in rho g h times squared
        heights), n n along the branches (Roul 2.96) and along the contacts' normals."""
        out = {name: numpy.zeros((len(self.places), 2, 2)) for name in ("stress", "branch", "normal")}
        pair = self.j >= 0
        for grain, contact, sign in ((self.i, slice(None), 1), (self.j[pair], pair, -1)):
            lever = self.point[contact] - self.places[grain]
            along = lever / numpy.linalg.norm(lever, axis=1)[:, None]
            normal = self.normal[contact]
            for name, one in (("stress", sign * self.force[contact][:, :, None] * lever[:, None, :]),
                              ("branch", along[:, :, None] * along[:, None, :]),
                              ("normal", normal[:, :, None] * normal[:, None, :])):
                numpy.add.at(out[name], grain, one)
        out["stress"] = (out["stress"] + out["stress"].transpose(0, 2, 1)) / (2 * self.pressure * self.height**2)
        return out

    def averaged(self, points, radius=RVE):
        """Averages over circles about points: density, stress, branch, normal."""
        area = math.pi * radius**2
        weights = self.areas / self.height**2
        out = {"density": numpy.zeros(len(points)), **{name: numpy.zeros((len(points), 2, 2)) for name in self.tensors}}
        for k, inside in enumerate(cKDTree(self.scaled).query_ball_point(points, radius)):
            out["density"][k] = weights[inside].sum() / area
            out["stress"][k] = self.tensors["stress"][inside].sum(axis=0) / area
            for name in ("branch", "normal"):
                out[name][k] = (weights[inside, None, None] * self.tensors[name][inside]).sum(axis=0) / area
        return out

    def inside(self, height, room=RVE):
        """The points of a row at this height that have room to the flanks."""
        points = row(height)
        return points[self.room(points) >= room]

    def density_ratio(self, room):
        """Density on the axis over that of circles with this room to the flanks, along their middle halves."""
        centre = self.averaged(numpy.stack((numpy.zeros(9), numpy.linspace(RVE, 0.6, 9) - 1), axis=1))["density"]
        near = []
        for half, sign in ((self.half_left / self.height, -1), (self.half_right / self.height, 1)):
            down = numpy.linspace(0.25, 0.75, 15)
            length = math.hypot(half, 1)
            at = numpy.stack((sign * half * down, -down), axis=1) - room * numpy.array((sign, half)) / length
            near.append(self.averaged(at[at[:, 1] >= RVE - 1])["density"])
        return float(centre.mean() / numpy.concatenate(near).mean())

    def strain(self, moved, points, radius=RVE):
        """The strain in circles by Cambou's best fit to the relative displacements of touching grains' centres
        (Roul 2.57); moved: the places of the same grains in another state. Contacts with the floor do not count."""
        pair = self.j >= 0
        i, j = self.i[pair], self.j[pair]
        branch = self.places[j] - self.places[i]
        way = moved[j] - moved[i] - branch
        middles = (self.scaled[i] + self.scaled[j]) / 2
        out = numpy.full((len(points), 2, 2), numpy.nan)
        for k, inside in enumerate(cKDTree(middles).query_ball_point(points, radius)):
            if len(inside) > 5:
                gradient, *_ = numpy.linalg.lstsq(branch[inside], way[inside], rcond=None)
                out[k] = (gradient + gradient.T) / 2
        return out

    def deviators(self, heights=(RVE, 2 * RVE), moved=None):
        """(xx - yy) + 2 i xy of the averages over the circles of rows, the left half mirrored to the right, of which
        the real axis is the direction of the largest principal value, of stress that of the greatest compression.

        moved: places under another, lower gravity; then of the strain, too, that of the greatest compression as
        gravity comes back."""
        points = numpy.concatenate([self.inside(height) for height in heights])
        found = self.averaged(points)
        if moved is not None:
            found["strain"] = self.strain(moved, points)
        halves = numpy.where(points[:, 0] < 0, self.half_left, self.half_right) / self.height
        out = {"x": abs(points[:, 0]) / halves}
        for name, sign in (("stress", -1), ("branch", 1), ("normal", 1), ("strain", 1)):
            if name in found:
                out[name] = deviator(sign * found[name], points[:, 0])
        return out


def deviator(tensors, x):
    """(xx - yy) + 2 i xy, mirrored where x is below 0."""
    z = tensors[:, 0, 0] - tensors[:, 1, 1] + 2j * tensors[:, 0, 1]
    return numpy.where(x < 0, z.conj(), z)


def remembered(early, late, buried=(3, 6)):
    """What grains that lay this many diameters below a flank keep of their stress to the end.

    turned_deg is the angle from the axis of their greatest compression then to that at the end, of the sums over the
    grains, left half mirrored (frozen axes: 0); early_deg and late_deg are both, from the horizontal; correlation is
    that of the grains' own deviators over their pressures, less the means of both.
    """
    at = {grain: k for k, grain in enumerate(late.ids)}
    deep = early.room(early.scaled) * early.height / early.diameter
    low = (early.places[:, 1] - early.floor) / early.diameter
    chosen = numpy.flatnonzero((deep >= buried[0]) & (deep < buried[1]) & (low > 2))
    later = numpy.array([at[grain] for grain in early.ids[chosen]], dtype=int)
    x = early.scaled[chosen, 0]
    both = []
    for heap, grains in ((early, chosen), (late, later)):
        stress = -heap.tensors["stress"][grains] * heap.pressure * heap.height**2
        both.append((deviator(stress, x), stress[:, 0, 0] + stress[:, 1, 1]))
    (then, p_then), (now, p_now) = both
    loaded = (p_then > 0) & (p_now > 0)
    a, b = (z[loaded] / p[loaded] for z, p in both)
    a, b = a - a.mean(), b - b.mean()
    return {"turned_deg": angle_deg(now.sum(keepdims=True), then.sum(keepdims=True)), "early_deg": angle_deg(then),
            "late_deg": angle_deg(now),
            "correlation": float((a.conj() * b).real.sum() / math.sqrt((abs(a) ** 2).sum() * (abs(b) ** 2).sum()))}


def row(height, step=0.025):
    """Points of a row at this height above the base, in heights."""
    x = numpy.arange(-80, 81) * step
    return numpy.stack((x, numpy.full(len(x), height - 1.0)), axis=1)


def angle_deg(a, b=1.0):
    """The mean angle from the axes b to the axes a, degrees, of deviators; each counts as much as both are unlike
    the isotropic tensor, so that a tensor without an axis does not count. Anticlockwise is positive."""
    return math.degrees(numpy.angle(numpy.nansum(a * numpy.conj(b)))) / 2

"""What two bodies, or a body and a plane, have in common: worked out anew, in its own way."""
import math
from dataclasses import dataclass

import numpy as np


@dataclass
class Overlap:
    depth: float = math.nan
    area: float = math.nan
    chord: float = math.nan
    arm_i: float = math.nan  # of the contact point; of a plane infinite
    arm_j: float = math.inf
    normal: np.ndarray = None  # from i to j; None: along the centres, or the plane's
    point: np.ndarray = None  # a place within it, from the first centre
    length: float = math.nan  # Roul's l
    swallowed: bool = False  # nearly: chord and normal go over to something else there


def segment(radius, depth):
    """Area and chord of the part of a disk beyond a line that leaves it this sagitta."""
    half = math.sqrt(max(depth * (2 * radius - depth), 0))
    arm = radius - depth
    if depth < 1e-3 * radius:  # the closed form cancels
        x = half / radius
        area = radius**2 * (2 / 3 * x**3 + x**5 / 5 + 3 / 28 * x**7)
    else:
        area = radius**2 * math.acos(arm / radius) - arm * half
    return area, 2 * half


def reduced(a, b):
    if math.isinf(a) or math.isinf(b):
        return min(a, b)
    return a * b / (a + b)


def round_pair(ri, rj, distance):
    """Disks, spheres; rj infinite: a plane, `distance` from it."""
    if math.isinf(rj):
        depth = ri - distance
        area, chord = segment(ri, depth)
        arm = ri - depth
        return Overlap(depth, area, chord, arm, length=arm)
    depth = ri + rj - distance
    sag_i = depth * (2 * rj - depth) / (2 * distance)
    sag_j = depth - sag_i
    area_i, chord = segment(ri, sag_i)
    area_j, _ = segment(rj, sag_j)
    ai, aj = ri - sag_i, rj - sag_j
    return Overlap(depth, area_i + area_j, chord, ai, aj, length=reduced(ai, aj))


def clipped(corners, point, outward):
    """Of a convex outline the part on the inner side of a line."""
    side = (corners - point) @ outward
    out = []
    for k in range(len(corners)):
        a, b, sa, sb = corners[k], corners[(k + 1) % len(corners)], side[k], side[(k + 1) % len(side)]
        if sa <= 0:
            out.append(a)
        if (sa < 0 < sb) or (sb < 0 < sa):
            out.append(a + (b - a) * (sa / (sa - sb)))
    return np.array(out).reshape(-1, 2)


def area_of(corners):
    if len(corners) < 3:
        return 0.0
    x, y = (corners - corners[0]).T
    return 0.5 * abs(np.dot(x, np.roll(y, -1)) - np.dot(y, np.roll(x, -1)))


def outward_lines(corners):
    edge = np.roll(corners, -1, axis=0) - corners
    turn = np.sign(np.cross(edge[0], edge[1]))
    return turn * np.stack([edge[:, 1], -edge[:, 0]], axis=1)


def common_region(a, b):
    region = a
    for corner, outward in zip(b, outward_lines(b)):
        region = clipped(region, corner, outward)
        if len(region) < 3:
            return region
    return region


def pieces_inside(a, b):
    """Sum of the vectors along the outline a within b."""
    total = np.zeros(2)
    lines = outward_lines(b)
    for k in range(len(a)):
        start, way = a[k], a[(k + 1) % len(a)] - a[k]
        low, high = 0.0, 1.0
        for corner, outward in zip(b, lines):
            at, along = (start - corner) @ outward, way @ outward
            if along > 0:
                high = min(high, -at / along)
            elif along < 0:
                low = max(low, -at / along)
            elif at > 0:
                high = -1.0
        if high > low:
            total += (high - low) * way
    return total


def inside(point, corners):
    return all((point - c) @ o <= 0 for c, o in zip(corners, outward_lines(corners)))


def polygon_pair(a, b, arm_i, arm_j):
    """Outlines in place; arms: of the contact point, from the centroids."""
    region = common_region(a, b)
    area = area_of(region)
    along = pieces_inside(a, b)
    chord = float(np.hypot(*along))
    smaller = min(area_of(a), area_of(b))
    normal = point = None
    if chord > 0:
        normal = np.array([along[1], -along[0], 0]) / chord
        point = np.append(region.mean(axis=0), 0)
        if normal @ point < 0 and not inside(np.zeros(2), b):
            normal = -normal
    return Overlap(math.nan, area, chord, arm_i, arm_j, normal, point, reduced(arm_i, arm_j),
                   swallowed=chord**2 < 0.0201 * area or area > 0.979 * smaller)


def polygon_on_plane(corners, point, normal, arm):
    """`normal`: into the room of the grains."""
    region = clipped(corners, point, normal)
    area = area_of(region)
    along = region[np.abs((region - point) @ normal) < 1e-9 * np.ptp(corners)] if len(region) else []
    chord = 0.0
    if len(along) >= 2:
        places = along @ np.array([-normal[1], normal[0]])
        chord = float(places.max() - places.min())
    depth = float(-((corners - point) @ normal).min())
    point = np.append(region.mean(axis=0), 0) if len(region) else None
    return Overlap(depth, area, chord, arm, point=point, length=arm,
                   swallowed=area > 0.979 * area_of(corners) or chord**2 < 0.0201 * area)


# ------------------------------------------------------------------ superellipsoids

def support(axes, exponents, turn, normals):
    """How far a superellipsoid reaches from its centre along each normal (rows), m."""
    n = np.abs(normals @ turn) * axes  # in the body's frame
    n = np.maximum(n, 1e-300)
    p, q = 2 / (2 - exponents[0]), 2 / (2 - exponents[1])
    top = n[..., :2].max(axis=-1)
    flat = top * ((n[..., 0] / top)**p + (n[..., 1] / top)**p)**(1 / p)
    most = np.maximum(flat, n[..., 2])
    return most * ((flat / most)**q + (n[..., 2] / most)**q)**(1 / q)


def surface_point(axes, exponents, turn, normal):
    """Where a superellipsoid has this outward normal, from its centre: the support's gradient."""
    step = 1e-5 * np.eye(3)
    forth = support(axes, exponents, turn, normal + step)
    back = support(axes, exponents, turn, normal - step)
    return (forth - back) / 2e-5


def sphere_of_directions(count=600):
    k = np.arange(count) + 0.5
    z, turn = 1 - 2 * k / count, math.pi * (1 + 5**0.5) * k
    flat = np.sqrt(1 - z * z)
    return np.stack([flat * np.cos(turn), flat * np.sin(turn), z], axis=1)


DIRECTIONS = sphere_of_directions()


def least_thickness(thickness, start=None):
    """Least of a function of the normals (rows) and its normal, by finer and finer looks about the
    best."""
    normals = DIRECTIONS if start is None else np.vstack([DIRECTIONS, start])
    values = thickness(normals)
    best, spread = normals[values.argmin()], 0.1
    least = values.min()
    rng = np.random.default_rng(1)
    for _ in range(24):
        around = best + spread * rng.normal(size=(40, 3))
        around /= np.linalg.norm(around, axis=1)[:, None]
        values = thickness(around)
        if values.min() < least:
            least, best = values.min(), around[values.argmin()]
        else:
            spread *= 0.55
    return least, best

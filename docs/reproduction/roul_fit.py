"""Cantelaube's stresses fitted as Roul does (4.3): one row of circles, mean heap, every point counts alike.

The friction angle is given, not measured, and the seven constants are free: a1, a2, b1 of the core, a_xx, a_yy,
a_xy of the flanks and the half angle of the core. His labels of a_xx and a_yy are exchanged (misprints.toml).
Lengths in heights, stresses in rho g h, tension positive, y up (his sigma_xy has the other sign: y down).
"""
import math

import numpy

from heaps import RVE

CONSTANTS = ("a1", "a2", "b1", "a_xx", "a_yy", "a_xy")
FIGURES = (*CONSTANTS, "beta_hat_deg", "a_sum", "axis_ratio", "b1_excess")
STEP = 0.05  # degrees, of the half angle


def columns(points, phi_deg, half_deg):
    """What the constants multiply, and the rest: sigma_xx, sigma_yy, sigma_xy of all points, one below the other."""
    x, depth = points[:, 0], -points[:, 1]
    size, side = abs(x), numpy.sign(x)
    core = size < depth * math.tan(math.radians(half_deg))
    flank = numpy.where(core, 0, size * math.tan(math.radians(phi_deg)) - depth)  # cot beta = tan phi
    deep, nothing = numpy.where(core, depth, 0), numpy.zeros(len(x))
    of = [[nothing, deep, numpy.where(core, x, 0)], [deep, nothing, nothing],
          [nothing, numpy.where(core, size, 0), nothing], [flank, nothing, nothing], [nothing, flank, nothing],
          [nothing, nothing, -side * flank]]
    return (numpy.array([numpy.concatenate(one) for one in of]).T, numpy.concatenate((-deep, -deep, nothing)))


def stresses(points, phi_deg, half_deg, constants):
    """sigma_xx, sigma_yy, sigma_xy of the constants, one below the other."""
    matrix, rest = columns(points, phi_deg, half_deg)
    return matrix @ numpy.array(constants) + rest


def fit(points, values, phi_deg):
    """The constants and half angle (degrees) of least squares, in the order of CONSTANTS; values as of stresses().

    The half angle is the middle of those that part the points as the best one does, between which the sum of
    squares does not change by it. Angles that leave less than two points a side to core or flanks are not tried.
    """
    best = (math.inf, None, [])
    ratio = numpy.degrees(numpy.arctan2(abs(points[:, 0]), -points[:, 1]))
    for half in numpy.arange(5, 90 - phi_deg, STEP):
        if (ratio < half).sum() < 5 or (ratio >= half).sum() < 4:
            continue
        matrix, rest = columns(points, phi_deg, half)
        found, *_ = numpy.linalg.lstsq(matrix, values - rest, rcond=None)
        left = float(((matrix @ found + rest - values) ** 2).sum())
        if left < best[0] * (1 - 1e-12):
            best = (left, found, [half])
        elif left <= best[0] * (1 + 1e-12):
            best[2].append(half)
    if best[1] is None:
        raise ValueError("too few points in the row for core and flanks")
    return numpy.append(best[1], numpy.mean(best[2]))


def continuous_b1(phi_deg, half_deg):
    """b1 of a core that is continuous with flanks at the limit (Roul 4.12): below 0, a dip, for a narrow core, above
    0, a peak, for a wide one."""
    beta, t = math.radians(90 - phi_deg), math.tan(math.radians(half_deg))
    jump = 1 / math.tan(beta) - 1 / t
    return 1 / math.tan(beta) + (math.cos(beta) ** 2 + math.cos(beta) * math.sin(beta) / t) * jump


def figures(heaps, phi_deg, height=RVE):
    """roul_fit.* of heaps by the row at this height, errors by the jackknife over heaps: CONSTANTS, beta_hat_deg,
    a_sum = a_xx + a_yy, axis_ratio = sigma_xx / sigma_yy on the axis, b1_excess = b1 less that of continuity."""
    half = min(min(one.half_left, one.half_right) / one.height for one in heaps)
    points = min((one.inside(height) for one in heaps), key=len)
    points = points[abs(points[:, 0]) < half]
    maps = []
    for one in heaps:
        stress = one.averaged(points)["stress"]
        maps.append(numpy.concatenate((stress[:, 0, 0], stress[:, 1, 1], stress[:, 0, 1])))
    maps = numpy.array(maps)

    def of(some):
        found = fit(points, some.mean(axis=0), phi_deg)
        return numpy.append(found, [found[3] + found[4], (1 - found[1]) / (1 - found[0]),
                                    found[2] - continuous_b1(phi_deg, found[6])])

    count = len(heaps)
    left = numpy.array([of(numpy.delete(maps, k, axis=0)) for k in range(count)]) if count > 1 else None
    out = {"ensemble.realizations": count}
    found = of(maps)
    for k, name in enumerate(FIGURES):
        out[f"roul_fit.{name}"] = float(found[k])
        if left is not None:
            spread = (count - 1) * ((left[:, k] - left[:, k].mean()) ** 2).mean()
            out[f"roul_fit.{name}.standard_error"] = float(math.sqrt(spread))
    return out

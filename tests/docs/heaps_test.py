"""What docs/reproduction measures in heaps by their states, on heaps with known answers."""
import math
import sys
from pathlib import Path

import numpy
import pytest

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "docs/reproduction"))

import heaps  # noqa: E402
import measure  # noqa: E402
import roul_fit  # noqa: E402

SIDE = 0.002  # m: squares in a lattice, 2 % smaller than its cells


def state(keep, normal=(0, 1), turned=0.0, stress=None):
    """A heap of squares on a floor, in lattice cells whose centres keep(x, y) has, its contacts along the lattice.

    Forces are those of a uniform stress (tension positive, N/m); normals are the branches turned by this many degrees.
    """
    cells = [(x, y) for y in range(160) for x in range(-280, 281) if keep(x * SIDE, (y + 0.5) * SIDE)]
    number = {cell: k for k, cell in enumerate(cells)}
    places = numpy.array([(x * SIDE, (y + 0.5) * SIDE, 0) for x, y in cells])
    stress = -numpy.eye(2) if stress is None else numpy.array(stress)
    i, j, force, point, normals = [], [], [], [], []
    turn = math.radians(turned)
    for (x, y), k in number.items():
        for dx, dy in ((1, 0), (0, 1)):
            other = number.get((x + dx, y + dy))
            if other is not None:
                i.append(k), j.append(other)
                point.append(((x + dx / 2) * SIDE, (y + 0.5 + dy / 2) * SIDE, 0))
                force.append((*(stress @ (dx, dy) * SIDE), 0))
                normals.append((dx * math.cos(turn) - dy * math.sin(turn), dx * math.sin(turn) + dy * math.cos(turn), 0))
        if y == 0:
            i.append(k), j.append(-1), point.append((x * SIDE, 0, 0))
            force.append((*(-stress @ (0, 1) * SIDE), 0)), normals.append((0, -1, 0))
    half = 0.49 * SIDE
    corners = numpy.array([(-half, -half), (half, -half), (half, half), (-half, half)])
    count = len(cells)
    grains = {"position": places, "id": numpy.arange(count) + 1, "volume": numpy.full(count, 4 * half**2), "mass": numpy.full(count, 20000 * half**2),
              "radius": numpy.full(count, math.sqrt(2) * half), "angle": numpy.zeros(count),
              "outline": numpy.tile(corners, (count, 1)), "outline_start": numpy.arange(count + 1) * 4}
    contacts = {"i": numpy.array(i), "j": numpy.array(j), "force": numpy.array(force), "normal": numpy.array(normals),
                "point": numpy.array(point)}
    return {"grains": grains, "contacts": contacts, "walls": {"point": numpy.zeros((3, 3))}}


def wedge(x, y):
    """30 degrees on the left, 45 on the right, 0.3 m high."""
    return y < 0.3 + x * math.tan(math.radians(30)) and y < 0.3 - x


@pytest.fixture(scope="module")
def heap():
    return heaps.Heap(state(wedge))


def test_the_frame_is_that_of_the_flanks(heap):
    assert heap.height == pytest.approx(0.3, abs=SIDE)
    assert math.degrees(math.atan(heap.left[0])) == pytest.approx(30, abs=0.5)
    assert math.degrees(math.atan(-heap.right[0])) == pytest.approx(45, abs=0.5)
    assert heap.apex == pytest.approx(0, abs=SIDE)
    assert heap.half_left == pytest.approx(0.3 / math.tan(math.radians(30)), abs=2 * SIDE)
    assert heap.half_right == pytest.approx(0.3, abs=2 * SIDE)
    assert heap.fraction == pytest.approx(0.98**2, rel=0.01)
    assert heap.pressure == pytest.approx(5000 * 9.81 * heap.fraction * heap.height)


def test_tops_follow_sides_across_columns():
    # One triangle from (0, 0) over (3, 6) to (6, 0) in columns of 2.
    corners = numpy.array([(0, 0), (3, 6), (5.999, 0)], dtype=float)
    x, y = heaps.tops(numpy.stack((corners, numpy.roll(corners, -1, axis=0)), axis=1), 2)
    assert list(x[:3]) == [1, 3, 5] and y[:3] == pytest.approx([4, 6, 4], abs=0.01)


def test_the_same_force_crosses_every_level_of_a_uniform_stress(heap):
    """A pressure of 1 N/m on every level: the force is the level's width."""
    for share in (0, 0.25, 0.5):
        width = (heap.half_left + heap.half_right) * (1 - share)
        _, force = heap.through(share)
        assert force.sum() * heap.pressure * heap.height == pytest.approx(width, rel=0.03)
        # Windows hold a whole number of columns each, some of 20.
        assert heap.dip(share) * heap.pressure * (1 - share) == pytest.approx(0, abs=0.12)


def test_a_dip_at_a_level_is_over_the_weight_above(heap):
    contacts = state(wedge)["contacts"]
    places = heap.places
    beside = abs((places[contacts["i"], 0]) / numpy.where(places[contacts["i"], 0] < 0, heap.half_left, heap.half_right))
    made = state(wedge)
    # Beside the middle tenth of the half bases of each height twice the force.
    part = 1 - contacts["point"][:, 1] / heap.height
    made["contacts"]["force"][(beside / part >= heaps.CENTRE)] *= 2
    found = heaps.Heap(made)
    for share in (0, 0.5):
        assert found.dip(share) * found.pressure * (1 - share) == pytest.approx(1, abs=0.2)


@pytest.mark.parametrize("low, high", [(0.1, 0.35), (0.35, 0.6)])
def test_stress_on_the_axis(low, high):
    """The sums over a window of whole cells: 0.4 of horizontal over vertical stress, but for the window's edges."""
    found = heaps.Heap(state(wedge, stress=((-0.4, 0.1), (0.1, -1))))
    assert found.axis_ratio(low, high) == pytest.approx(0.4, rel=0.05)


def test_averages_over_a_circle_are_those_of_the_uniform_field():
    stress = numpy.array(((-0.4, 0.1), (0.1, -1)))
    found = heaps.Heap(state(wedge, stress=stress))
    got = found.averaged(found.inside(0.3))
    assert got["stress"].mean(axis=0) * found.pressure == pytest.approx(stress, rel=0.02, abs=0.01)
    assert got["density"].mean() == pytest.approx(0.98**2, rel=0.02)
    # Each grain has two contacts along x and two along y.
    assert got["branch"].mean(axis=0) == pytest.approx(2 * 0.98**2 * numpy.eye(2), rel=0.02, abs=0.01)
    # The uniform lattice is as dense near the surface, and less so where circles reach out of it.
    assert found.density_ratio(heaps.RVE) == pytest.approx(1, abs=0.02)
    assert found.density_ratio(heaps.RVE / 2) == pytest.approx(1 / (1 - 0.1955), rel=0.05)


def test_fixed_grains_are_a_floor():
    """The lowest row of squares fixed: the rest is the heap on its tops, whichever of both grains is named first."""
    made = state(wedge, stress=((-0.4, 0.1), (0.1, -1)))
    height = made["grains"]["position"][:, 1]
    made["grains"]["fixed"] = (height < SIDE).astype(int)
    made["grains"]["radius"] = numpy.full(len(height), 0.49 * SIDE)  # to the tops of the squares
    contacts = made["contacts"]
    half = numpy.arange(len(contacts["i"])) % 2 == 0
    half &= contacts["j"] >= 0
    contacts["i"][half], contacts["j"][half] = contacts["j"][half], contacts["i"][half].copy()
    contacts["force"][half] *= -1
    contacts["normal"][half] *= -1
    got = heaps.Heap(made)
    assert got.floor == pytest.approx(SIDE, abs=0.02 * SIDE)
    assert got.height == pytest.approx(0.3 - SIDE, abs=SIDE) and len(got.places) == (height > SIDE).sum()
    _, force = got.through(0)
    assert force.sum() * got.pressure * got.height == pytest.approx(got.half_left + got.half_right, rel=0.03)
    assert got.dip(0) * got.pressure == pytest.approx(0, abs=0.12)
    assert got.axis_ratio(0.1, 0.6) == pytest.approx(0.4, rel=0.05)
    stress = got.averaged(got.inside(0.3))["stress"].mean(axis=0)
    assert stress * got.pressure == pytest.approx(numpy.array(((-0.4, 0.1), (0.1, -1))), rel=0.02, abs=0.01)


def test_disks_have_the_frame_of_their_circles():
    made = state(wedge)
    for name in ("outline", "outline_start"):
        del made["grains"][name]
    made["grains"]["radius"] = numpy.full(len(made["grains"]["id"]), 0.5 * SIDE)
    got = heaps.Heap(made)
    assert got.height == pytest.approx(0.3, abs=SIDE)
    assert math.degrees(math.atan(-got.right[0])) == pytest.approx(45, abs=0.5)


def test_axes_turned_by_an_angle_are_found_turned_by_it():
    z = numpy.exp(2j * numpy.radians([-70, -60])) * (1, 2)
    assert heaps.angle_deg(z) == pytest.approx(-63.4, abs=0.2)
    assert heaps.angle_deg(z * numpy.exp(2j * math.radians(-7)), z) == pytest.approx(-7)
    # Nothing is said by a tensor without an axis.
    assert heaps.angle_deg(numpy.array([1j, 0]), numpy.array([1j, 5])) == pytest.approx(0)


def test_deviators_mirror_the_left_half():
    """A stress whose greatest compression falls outwards at 60 degrees on both sides, as in a heap."""
    axis = numpy.array((math.cos(math.radians(60)), -math.sin(math.radians(60))))
    made, other = (state(wedge, stress=-numpy.outer(one, one) - 0.1 * numpy.eye(2)) for one in (axis, axis * (-1, 1)))
    left = made["contacts"]["point"][:, 0] < 0
    made["contacts"]["force"][left] = other["contacts"]["force"][left]
    got = heaps.Heap(made).deviators()
    away = got["x"] > 0.3  # circles that no other half reaches into
    assert heaps.angle_deg(got["stress"][away]) == pytest.approx(-60, abs=1.5)


def test_normals_turned_from_the_branches_are_told_from_them():
    """Slender cells: branches along x and y of unlike number give axes, the normals turned by 10 degrees."""
    made = state(wedge, turned=10)
    upright = abs(made["contacts"]["normal"][:, 1]) > 0.5
    less = {name: value[upright] for name, value in made["contacts"].items()}
    got = heaps.Heap(made | {"contacts": less}).deviators(heights=(0.3,))
    right = got["x"] > 0.3
    assert abs(heaps.angle_deg(got["branch"][right])) == pytest.approx(90, abs=0.1)
    turned = abs(heaps.angle_deg(got["normal"], got["branch"]))
    assert turned < 10  # the left half, mirrored, turns back


def test_strain_is_that_of_a_uniform_gradient_and_not_its_rotation(heap):
    gradient = numpy.array(((-0.2, 0.3), (0.1, -1))) * 1e-4
    got = heap.strain(heap.places + heap.places @ gradient.T, heap.inside(0.3))
    assert got == pytest.approx(numpy.broadcast_to((gradient + gradient.T) / 2, got.shape), abs=1e-10)


def test_what_is_measured_in_heaps_has_the_keys_that_are_listed():
    """The strain of a heap that is pressed down alone: its axis is upright, whatever the stress."""
    low, high = state(wedge, stress=((-0.4, 0.0), (0.0, -1))), state(wedge)
    high["grains"]["position"] = low["grains"]["position"] * (1, 1 + 1e-5, 1)
    run = {"pile": low, "gravity_8.8": {"grains/position": high["grains"]["position"]}}
    found = measure.heap_of(run)
    assert set(found) <= set(measure.ADDED) and "axes.strain_deg" in found
    assert abs(found["axes.strain_deg"]) == pytest.approx(90, abs=0.1)
    assert found["axes.strain_less_stress_deg"] == pytest.approx(0, abs=1)
    assert found["axis.low"] == pytest.approx(0.4, rel=0.05) and found["axis.high"] == pytest.approx(0.4, rel=0.05)
    assert not any("strain" in key for key in measure.heap_of({"pile": low}))
    growing = measure.memory_of({"pile": low, "poured_5": state(lambda x, y: wedge(x, y + 0.05))})
    assert set(growing) <= set(measure.ADDED) and growing["memory.turned_deg"] == pytest.approx(0, abs=0.1)


def test_grains_that_turn_their_stress_are_found_turned():
    """The axis of every grain at 60 degrees when it is buried and at 75 at the end, of both halves."""
    def pressed(deg):
        made = None
        for side in (-1, 1):
            axis = numpy.array((math.cos(math.radians(deg)), -side * math.sin(math.radians(deg))))
            one = state(wedge, stress=-numpy.outer(axis, axis) - 0.1 * numpy.eye(2))
            if made is None:
                made = one
            else:
                right = one["contacts"]["point"][:, 0] > 0
                made["contacts"]["force"][right] = one["contacts"]["force"][right]
        return heaps.Heap(made)

    early, late = pressed(60), pressed(75)
    got = heaps.remembered(early, late)
    assert (got["early_deg"], got["late_deg"]) == pytest.approx((-60, -75), abs=1)
    assert got["turned_deg"] == pytest.approx(-15, abs=1)
    assert heaps.remembered(early, early)["turned_deg"] == pytest.approx(0, abs=1e-9)


def test_grains_that_keep_their_own_stress_are_told_from_those_that_do_not():
    generator = numpy.random.default_rng(5)
    made = [state(wedge) for _ in range(3)]
    force = made[0]["contacts"]["force"]
    for one, seed in zip(made, (1, 1, 2)):
        one["contacts"]["force"] = force * numpy.random.default_rng(seed).uniform(0.2, 1.8, (len(force), 1))
    first, same, other = map(heaps.Heap, made)
    assert heaps.remembered(first, same)["correlation"] == pytest.approx(1)
    assert abs(heaps.remembered(first, other)["correlation"]) < 0.1
    # Grains are known by their ids, not by their places in the table.
    order = generator.permutation(len(same.ids))
    same.ids = same.ids[order]
    same.tensors = {name: values[order] for name, values in same.tensors.items()}
    assert heaps.remembered(first, same)["correlation"] == pytest.approx(1)


CONSTANTS = (0.34, 0.49, -0.2, 0.78, 1.23, 0.38)


def test_the_fit_finds_the_constants_of_its_field():
    points = heaps.row(0.1)
    points = points[abs(points[:, 0]) < 1.5]
    values = roul_fit.stresses(points, 28, 35, CONSTANTS)
    found = roul_fit.fit(points, values, 28)
    assert found[:6] == pytest.approx(CONSTANTS, abs=1e-9)
    assert found[6] == pytest.approx(35, abs=1)  # between two points
    noise = numpy.random.default_rng(1).normal(0, 0.01, len(values))
    assert roul_fit.fit(points, values + noise, 28)[:6] == pytest.approx(CONSTANTS, abs=0.05)


def test_the_fields_of_the_fit_are_in_equilibrium_and_continuous():
    """With the constants of a continuous core: div sigma = rho g in both regions, and no jump between them."""
    phi, half = 28, 35
    beta, t = math.radians(90 - phi), math.tan(math.radians(half))
    a1 = -math.sin(beta) * math.cos(beta) * (1 / math.tan(beta) - 1 / t)
    a2 = 1 + math.sin(beta) ** 2 * (t / math.tan(beta) - 1)
    flanks = (math.sin(beta) ** 2, 1 + math.cos(beta) ** 2, math.sin(beta) * math.cos(beta))
    constants = (a1, a2, roul_fit.continuous_b1(phi, half), *flanks)

    def at(x, y):
        return roul_fit.stresses(numpy.array([(x, y)]), phi, half, constants)

    step = 1e-4
    for x, y in ((0.2, -0.9), (-0.2, -0.9), (1.2, -0.9), (-1.2, -0.9)):
        (dxx, _, dxy), (_, eyy, exy) = ((at(x + step * a, y + step * b) - at(x - step * a, y - step * b)) / (2 * step)
                                        for a, b in ((1, 0), (0, 1)))
        assert (dxx + exy, dxy + eyy) == pytest.approx((0, 1), abs=1e-6)
    edge = 0.9 * t
    assert at(edge - 1e-9, -0.9) == pytest.approx(at(edge + 1e-9, -0.9), abs=1e-6)
    # The plateau parts dips from peaks: t0 = sin beta / sqrt(1 + cos^2 beta).
    flat = math.degrees(math.atan(math.sin(beta) / math.sqrt(1 + math.cos(beta) ** 2)))
    assert roul_fit.continuous_b1(phi, flat) == pytest.approx(0, abs=1e-12)
    assert roul_fit.continuous_b1(phi, 35) < -0.1 and roul_fit.continuous_b1(26, 49) > 0.2


def test_the_fit_of_heaps_has_a_jackknife_error():
    made = [heaps.Heap(state(wedge, stress=((-one, 0.0), (0.0, -1)))) for one in (0.4, 0.5, 0.6)]
    found = roul_fit.figures(made, 30)
    assert found["ensemble.realizations"] == 3
    assert set(found) == {"ensemble.realizations", *(f"roul_fit.{name}{end}" for name in roul_fit.FIGURES
                                                     for end in ("", ".standard_error"))}
    assert found["roul_fit.a_sum"] == pytest.approx(found["roul_fit.a_xx"] + found["roul_fit.a_yy"])
    assert found["roul_fit.a_xx.standard_error"] > 0

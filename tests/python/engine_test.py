"""The engine in a loop of Python: closed forms, views, bits, and Ctrl-C."""

import gc
import os
import signal
import threading
import time
import warnings

import numpy as np
import pytest

import grainfield as gf
from scene import ROOT, error_of

LINEAR = dict(law="linear", normal_stiffness=1e5, tangential_stiffness=3e4, normal_damping=0,
              tangential_damping=0, friction=0.3)


def layer(columns=12, rows=8, dim=2, gap=1e-5):
    """Grains on a square lattice above a floor between two walls."""
    d = 0.01
    x, y = (a.ravel() for a in np.meshgrid(np.arange(columns), np.arange(rows)))
    rng = np.random.default_rng(3)
    place = np.stack([x, y]) * (d + gap) + d / 2 + rng.uniform(-0.4, 0.4, (2, len(x))) * gap
    walls = [f"floor:{'xyz'[dim - 1]}=0", "left:x=0", f"right:x={columns * (d + gap)}"]
    z = {"z": place[1]} if dim == 3 else {}
    return gf.packing(place[0], np.zeros(len(x)) if dim == 3 else place[1], d / 2, density=2000,
                      walls=walls, friction=0.3, **z)


@pytest.mark.parametrize("dim", [2, 3])
def test_a_grain_falls(dim):
    z = {"z": [1.0]} if dim == 3 else {}
    grain = gf.packing([0.0], [1.0], 0.01, density=1000, velocities=[[0.5] + [0.0] * (dim - 1)], **z)
    engine = gf.Engine(grain, material=LINEAR, time_step=5e-5)
    engine.step(2000)
    up = dim - 1
    assert engine.time == pytest.approx(0.1) and engine.steps == 2000
    assert engine.positions[0, up] == pytest.approx(1 - 9.81 * 0.1**2 / 2, rel=1e-12)
    assert engine.velocities[0, up] == pytest.approx(-9.81 * 0.1, rel=1e-12)
    assert engine.positions[0, 0] == pytest.approx(0.05, rel=1e-12)


def test_two_disks_swap_their_velocities():
    pair = gf.packing([0.0, 0.03], [0.0, 0.0], 0.01, density=1000, velocities=[[1, 0], [0, 0]], gravity=(0, 0))
    engine = gf.Engine(pair, material=LINEAR)
    before = engine.measure()["kinetic_energy"]
    engine.step(int(0.03 / engine.time_step))
    v = engine.in_order(engine.velocities)
    np.testing.assert_allclose(v, [[0, 0], [1, 0]], atol=5e-3)  # the contact begins and ends between steps
    assert v.sum(axis=0) == pytest.approx([1, 0], abs=1e-12)
    assert engine.measure()["kinetic_energy"] == pytest.approx(before, rel=1e-2)


@pytest.mark.parametrize("dim", [2, 3])
def test_views_follow_the_steps(dim):
    engine = gf.Engine(layer(dim=dim), material=LINEAR)
    places, ids = engine.positions, engine.ids
    address, before = places.__array_interface__["data"][0], engine.in_order(places)
    assert not places.flags.writeable and not ids.flags.writeable
    engine.step(500)
    assert places.__array_interface__["data"][0] == engine.positions.__array_interface__["data"][0] == address
    after = engine.in_order(places)
    assert (after[:, dim - 1] < before[:, dim - 1]).any()
    state = engine.packing()
    np.testing.assert_array_equal(after, state.positions)
    np.testing.assert_array_equal(engine.in_order(engine.velocities), state.velocities)
    spins = state.spins if dim == 2 else state.angular_velocities
    np.testing.assert_array_equal(engine.in_order(engine.spins), spins)
    del engine
    gc.collect()
    np.testing.assert_array_equal(places[np.argsort(ids)], after)


def test_grains_are_not_added_under_a_view():
    engine = gf.Engine(layer(), material=LINEAR)
    places = engine.positions
    part = places[3:5]
    del places
    with pytest.raises(BufferError, match="1 arrays on its grains are alive"):
        engine.add((0.05, 0.5), 0.005)
    del part
    assert engine.add((0.05, 0.5), 0.005, velocity=(0, -1)) == 96 and len(engine) == 97
    engine.step(100)
    np.testing.assert_allclose(engine.in_order(engine.velocities)[96],
                               [0, -1 - 9.81 * engine.time], rtol=1e-9)
    assert error_of(lambda: engine.add((0, 0), -1)) == "radius: found -1, allowed: above 0"


def test_any_calls_and_threads_end_in_the_same_bits():
    engines = [gf.Engine(layer(), material=LINEAR, threads=threads) for threads in (1, 1, 2)]
    engines[0].step(600)
    for _ in range(60):
        engines[1].step(10)
    engines[2].step(600)
    for other in engines[1:]:
        np.testing.assert_array_equal(engines[0].packing().positions, other.packing().positions)
        np.testing.assert_array_equal(engines[0].contacts.forces, other.contacts.forces)


def test_the_floor_feels_the_weight_and_the_load():
    engine = gf.Engine(layer(4, 3), material=LINEAR | dict(normal_damping=300, tangential_damping=300))
    engine.set_damping(20)
    engine.step(40000)
    weight = 9.81 * engine.packing().masses.sum()
    at_rest = -engine.walls()["floor"]["force"][1]
    contacts = engine.contacts
    floor = contacts.pairs[:, 1] == -1
    # What the walls beside carry by friction is missing at the floor.
    side = sum(-engine.walls()[name]["force"][1] for name in ("left", "right"))
    assert at_rest + side == pytest.approx(weight, rel=1e-3)
    assert contacts.forces[floor, 1].sum() == pytest.approx(at_rest, rel=1e-12)
    engine.apply(9, (0, -5), ramp=0.05)
    engine.step(40000)
    total = sum(-wall["force"][1] for wall in engine.walls().values())
    assert total == pytest.approx(weight + 5, rel=1e-3)
    assert engine.packing().loaded_grain == 9
    assert error_of(lambda: engine.apply(12, (0, 1))) == "apply: found grain 12, allowed: 0 to 11"
    nan = float("nan")
    assert error_of(lambda: engine.apply(9, (0, nan))) == "force: found nan, allowed: finite numbers, N"
    assert error_of(lambda: engine.apply(9, (0, 1), ramp=-1)) == "ramp: found -1, allowed: a finite time, s, 0 or more"
    assert error_of(lambda: engine.set_gravity((nan, 0))) == "gravity: found nan, allowed: finite numbers, m/s2"
    with pytest.raises(TypeError, match="grain: found 9.7, allowed: the id of a grain, a whole number"):
        engine.apply(9.7, (0, 1))


def test_walls_move():
    engine = gf.Engine(layer(4, 3), material=LINEAR)
    engine.move_wall("right", (0.01, 0))
    before = engine.walls()["right"]["point"][0]
    engine.step(200)
    assert engine.walls()["right"]["point"][0] - before == pytest.approx(0.01 * engine.time, rel=1e-9)
    assert "lid" in error_of(lambda: engine.move_wall("lid", (0, 0)))
    servo = error_of(lambda: engine.move_wall("right", servo={"fource": 1}))
    assert servo.startswith('servo: found "fource", allowed: force, stress')


def test_the_loop_of_the_page():
    text = (ROOT / "docs/python.md").read_text()
    loop = text.partition("## The engine in a loop")[2].partition("```python\n")[2].partition("```")[0]
    names = {"gf": gf, "np": np}
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # of places above the grains
        exec(loop, names)
    engine, field = names["engine"], names["field"]
    assert len(engine) == 60 and engine.measure()["unbalanced_force_ratio"] < 0.1
    assert engine.in_order(names["places"])[9, 1] == engine.packing().positions[9, 1]
    assert field.attributes["F"] == 5 and np.nanmin(field.sigma_yy) < -5 / 0.06


def test_what_cannot_be_set_up_is_refused():
    packing = layer(2, 2)
    key = error_of(lambda: gf.Engine(packing, material={"frictoin": 0.3}))
    assert "material.frictoin" in key and "friction" in key
    assert "material.friction" in error_of(lambda: gf.Engine(packing, material={"friction": -1}))
    assert "motion.time_step: found" in error_of(lambda: gf.Engine(packing, material=LINEAR, time_step=1))
    smooth = gf.packing([0], [1], 0.1, density=1, walls="floor:y=0")
    assert error_of(lambda: gf.Engine(smooth)).startswith("Engine: wall floor has no friction")


def test_divergence_is_a_runtime_error():
    fast = gf.packing([0.0], [1.0], 0.01, density=1000, velocities=[[1e6, 0]])
    with pytest.raises(RuntimeError, match="diverge|half its radius"):
        gf.Engine(fast, material=LINEAR).step(10)


def test_ctrl_c_stops_between_steps():
    engine = gf.Engine(layer(), material=LINEAR)
    threading.Timer(0.3, os.kill, (os.getpid(), signal.SIGINT)).start()
    start = time.monotonic()
    with pytest.raises(KeyboardInterrupt):
        engine.step(10**9)
    assert time.monotonic() - start < 5
    done = engine.steps
    engine.step(10)
    assert engine.steps == done + 10 > 10


def test_other_threads_run_while_it_steps():
    engine = gf.Engine(layer(), material=LINEAR)
    worker = threading.Thread(target=engine.step, args=(30000,))
    worker.start()
    with pytest.raises(RuntimeError, match="another thread is stepping it"):
        while worker.is_alive():
            engine.step(1)
    worker.join()
    assert engine.steps >= 30000


def test_what_nobody_gives_follows_the_normal_stiffness():
    """normal_stiffness alone once left k_t at an absolute 2.857e6 N/m: a twelfth of the time step."""
    soft, stiff = (gf.Engine(layer(), material=dict(law="linear", normal_stiffness=k)).time_step
                   for k in (2e4, 2e6))
    np.testing.assert_allclose(soft / stiff, 10, rtol=1e-9)
    given = gf.Engine(layer(), material=dict(law="linear", normal_stiffness=2e4,
                                             tangential_stiffness=2 / 7 * 2e4)).time_step
    np.testing.assert_allclose(soft, given, rtol=1e-12)

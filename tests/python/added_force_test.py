"""Forces and contact laws that functions of Python add to the engine."""

import html
import os
import signal
import subprocess
import threading
import warnings

import numpy as np
import pytest

import grainfield as gf
from engine_test import LINEAR, layer
from scene import PROGRAM, ROOT, error_of, heap, heap_arrays, program


def still(function=None, **options):
    """A layer without damping, with a force of nothing in particular."""
    engine = gf.Engine(layer(5, 4), material=LINEAR, **options)
    if function is not None:
        engine.add_force(function)
    return engine


@pytest.mark.parametrize("dim, integrator", [(2, "verlet"), (3, "verlet"), (2, "gear")])
def test_a_grain_swings_on_a_spring(dim, integrator):
    """x = x0 cos(w t), to second order with verlet; the function's views are those of the moment."""
    x0, w = np.array([0.3, 0.1, -0.2])[:dim], 60.0
    z = {"z": [x0[2]]} if dim == 3 else {}
    grain = gf.packing([x0[0]], [x0[1]], 0.01, density=1000, gravity=(0,) * dim, **z)
    errors, soft = [], LINEAR | dict(normal_stiffness=100, tangential_stiffness=30)  # of no effect but on the step's limit
    for steps in (100, 200, 400):
        engine = gf.Engine(grain, material=soft, time_step=0.02 / steps, motion={"integrator": integrator})
        seen = []

        def spring(t, grains):
            seen.append((t, grains.positions.shape, grains.spins.shape, grains.velocities.flags.writeable))
            return -w**2 * grains.masses[:, None] * grains.positions

        engine.add_force(spring)
        engine.step(steps)
        errors.append(np.abs(engine.positions[0] - x0 * np.cos(w * engine.time)).max())
    assert len(seen) == steps + 1 and seen[0][0] == 0 and seen[-1][0] == pytest.approx(0.02)
    assert seen[-1][1:] == ((1, dim), (1,) if dim == 2 else (1, 3), False)
    if integrator == "verlet":
        np.testing.assert_allclose(np.log2(np.divide(errors[:-1], errors[1:])), 2, atol=0.2)
    else:
        assert errors[-1] < 1e-8


@pytest.mark.parametrize("dim", [2, 3])
def test_forces_and_torques_are_by_id(dim):
    engine = gf.Engine(layer(dim=dim, gap=1e-3), material=LINEAR)  # no two touch
    n = len(engine)
    turn = np.zeros(n) if dim == 2 else np.zeros((n, 3))
    turn[30] = 1e-5
    push = np.zeros((n, dim))
    push[43, 0] = 0.2
    engine.add_force(lambda t, grains: (push, turn), name="push")
    engine.step(3)
    state = engine.packing()
    spins = state.spins if dim == 2 else state.angular_velocities[:, 2]
    inner = np.isin(np.arange(n) % 12, range(1, 11)) & (np.arange(n) >= 12)  # no wall touches these
    expected = np.where(np.arange(n) == 30, 1e-5 * engine.time / (state.inertias if dim == 2 else state.moments[:, 2]), 0)
    np.testing.assert_allclose(spins[inner], expected[inner], rtol=1e-12)
    expected = np.where(np.arange(n) == 43, 0.2 * engine.time / state.masses, 0)
    np.testing.assert_allclose(state.velocities[inner, 0], expected[inner], rtol=1e-12)
    assert state.attributes["added_forces"] == "push" == engine.added_forces[0]


@pytest.mark.parametrize("dim", [2, 3])
def test_cohesion_against_its_closed_form(dim):
    """d = F/k + (d0 - F/k) cos(w t), w^2 = 2 k/m, of two grains that touch; momentum stays."""
    k, pull, z = 1e5, 2.0, {"z": [0, 0]} if dim == 3 else {}
    d0 = 0.25 * pull / k
    pair = gf.packing([0, 0.02 - d0], [0, 0], 0.01, density=1000, gravity=(0,) * dim, **z)
    w = np.sqrt(2 * k / pair.masses[0])
    errors = []
    for steps in (20, 40, 80):
        engine = gf.Engine(pair, material=LINEAR | dict(normal_stiffness=k), time_step=0.8 / w / steps)

        def cohesion(t, contacts):
            assert contacts.i.tolist() == [0] and contacts.j.tolist() == [1] and contacts.radii[0] == 0.005
            assert np.all(contacts.velocities[:, 0] >= 0)  # 0 comes nearer to 1
            assert contacts.grains.masses[contacts.i].shape == (1,)
            return pull * contacts.normals

        engine.add_contact_force(cohesion)
        engine.step(steps)
        x, v = engine.in_order(engine.positions), engine.in_order(engine.velocities)
        overlap = 0.02 - (x[1, 0] - x[0, 0])
        errors.append(abs(overlap - (pull / k + (d0 - pull / k) * np.cos(w * engine.time))))
        np.testing.assert_allclose(v.sum(axis=0), 0, atol=1e-15)
        assert engine.contacts.forces[0, 0] == pytest.approx(pull - k * overlap, abs=1e-9)
    np.testing.assert_allclose(np.log2(np.divide(errors[:-1], errors[1:])), 2, atol=0.2)


def test_a_law_from_scratch():
    """A Hertz-like repulsion by a function, the material's own next to nothing: energy as of F = a d^1.5."""
    a, v = 1e6, 0.2
    pair = gf.packing([0, 0.021], [0, 0], 0.01, density=1000, gravity=(0, 0), velocities=[[v, 0], [-v, 0]])
    engine = gf.Engine(pair, material=LINEAR | dict(normal_stiffness=1e-3, tangential_stiffness=1e-3, friction=0),
                       time_step=2e-6)
    deepest = []

    def hertz(t, contacts):
        deepest.extend(contacts.overlaps)
        return -a * contacts.overlaps[:, None] ** 1.5 * contacts.normals

    engine.add_contact_force(hertz)
    engine.step(6000)
    mass = engine.packing().masses[0]
    assert max(deepest) == pytest.approx((2.5 * mass * v**2 / a) ** 0.4, rel=1e-4)
    np.testing.assert_allclose(engine.in_order(engine.velocities)[:, 0], [-v, v], rtol=1e-3)


def test_threads_and_calls_end_in_the_same_bits():
    def drag(t, grains):
        return -0.01 * grains.velocities

    def glue(t, contacts):
        return 0.1 * contacts.normals * (contacts.j >= 0)[:, None]

    ends = []
    for threads, calls in ((1, 1), (2, 1), (1, 60)):
        engine = gf.Engine(layer(), material=LINEAR, threads=threads)
        engine.add_force(drag)
        engine.add_contact_force(glue, every=4)
        for _ in range(calls):
            engine.step(600 // calls)
        ends.append(engine.packing())
    for other in ends[1:]:
        np.testing.assert_array_equal(ends[0].positions, other.positions)
        np.testing.assert_array_equal(ends[0].contacts.forces, other.contacts.forces)


def test_a_force_of_nothing_changes_no_bit():
    with_one, without = still(lambda t, grains: 0 * grains.positions), still()
    with_one.step(500), without.step(500)
    np.testing.assert_array_equal(with_one.packing().positions, without.packing().positions)


def test_exceptions_come_out_as_they_are_and_the_step_is_whole():
    class Mine(Exception):
        pass

    calls = 0

    def fails(t, grains):
        nonlocal calls
        calls += 1
        if calls == 5:
            raise Mine("at five")
        return 0 * grains.positions

    engine, other = still(fails), still()
    with pytest.raises(Mine, match="at five"):
        engine.step(100)
    assert engine.steps == 4  # the first call comes before the first step
    other.step(4)
    np.testing.assert_array_equal(engine.packing().positions, other.packing().positions)
    engine.add_force(lambda t, grains: 0 * grains.positions, name="fails")
    assert engine.added_forces == ["fails"]
    engine.step(96)
    assert engine.steps == 100


def test_arrays_that_are_kept_stay():
    kept = []

    def keeps(t, grains):
        kept.append(grains.positions)
        return 0 * grains.positions

    engine = still(keeps)
    start = engine.in_order(engine.positions)
    engine.step(3)
    del engine
    np.testing.assert_array_equal(kept[0], start)
    assert all((a != b).any() for a, b in zip(kept, kept[1:]))
    with pytest.raises(ValueError, match="read-only"):
        kept[0][0] = 1


@pytest.mark.parametrize("made, line", [
    (None, "mine: forces: found None, allowed: an array of shape (20, 2); does the function return it?"),
    (np.zeros((20, 3)), "mine: forces: found shape (20, 3), allowed: (20, 2)"),
    ((np.zeros((20, 2)), np.zeros(3)), "mine: torques: found shape (3,), allowed: (20,)"),
    (np.full((20, 2), np.nan), "mine: forces: found nan on grain 0 at t = 0 s, allowed: finite numbers"),
    (np.ma.zeros((20, 2)), "mine: forces: found a masked array, allowed: an array of shape (20, 2); fill it first"),
    (np.zeros((20, 2), complex), "mine: forces: found complex128, allowed: real numbers"),
])
def test_what_a_function_may_not_return(made, line):
    engine = gf.Engine(layer(5, 4), material=LINEAR)
    engine.add_force(lambda t, grains: made, name="mine")
    assert error_of(lambda: engine.step()) == line and engine.steps == 0


def test_what_cannot_be_added():
    engine = still()
    assert error_of(lambda: engine.add_force(3)) == "function: found 3, allowed: a function of t and grains"
    assert error_of(lambda: engine.add_force(layer, every=0)) == "layer: every: found 0, allowed: 1 or more steps"
    assert "text without commas" in error_of(lambda: engine.add_force(layer, name="a, b"))
    assert error_of(lambda: engine.remove_force("well")) == 'found no added force "well", allowed: none'


def test_marked_and_not_resumed_without(tmp_path):
    def glue(t, contacts):
        return 0.02 * contacts.normals

    engine = gf.Engine(layer(4, 3), material=LINEAR)
    engine.add_contact_force(glue)
    engine.step(2000)
    engine.add_force(lambda t, grains: 0 * grains.positions, name="nothing")
    engine.remove_force("nothing")
    gf.write(tmp_path / "state.h5", engine.packing())
    assert "added_forces: glue\n  former_added_forces: nothing" in program("info", tmp_path / "state.h5")
    state = gf.read(tmp_path / "state.h5")
    assert "<td>added forces</td><td>glue</td>" in state._repr_html_()
    again = gf.Engine(state, material=LINEAR)
    assert error_of(again.step) == (
        "Engine: this packing comes from a run with forces of a Python function: found none of glue; add each with "
        "add_force or add_contact_force(function, name=...), or go on without by remove_force(name)")
    assert again.packing().attributes["added_forces"] == "glue" and again.steps == 0
    again.add_contact_force(glue)
    again.step(10)
    without = gf.Engine(state, material=LINEAR)
    without.remove_force("glue")
    without.step(10)
    assert "added_forces" not in without.packing().attributes
    assert without.packing().attributes["former_added_forces"] == "nothing, glue"


def marked_state(names):
    """A layer that forces of these names made."""
    engine = gf.Engine(layer(5, 4), material=LINEAR)
    for name in names.split(", "):
        engine.add_contact_force(lambda t, contacts: 0.02 * contacts.normals, name=name)
    engine.step(2000)
    return engine.packing()


def test_averages_and_fits_say_so(tmp_path):
    field_warnings = []
    engine = still(lambda t, grains: 0 * grains.positions)
    engine.step(2000)
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        field = gf.average(engine.packing(), frame="packing", grid=(5, 5))
        field_warnings = [str(w.message) for w in caught]
    assert any("forces of a Python function act on these grains: lambda" in line for line in field_warnings)
    assert field.attributes["added_forces"] == "lambda" and "added forces: lambda" in field._repr_html_()
    gf.write(tmp_path / "state.h5", engine.packing())
    said = subprocess.run([PROGRAM, "average", tmp_path / "state.h5", "--frame", "packing", "-o", tmp_path / "field.h5"],
                          capture_output=True, text=True).stderr
    assert "forces of a Python function act on these grains: lambda" in said
    assert "added_forces: lambda" in program("info", tmp_path / "field.h5")
    a = heap_arrays(1)
    touching = gf.packing(a["x"], a["y"], 1.0002 * a["radius"], mass=a["mass"], walls="floor:y=0", friction=0.5)
    pile = gf.Engine(touching, material=LINEAR | dict(normal_stiffness=1e6))
    pile.add_force(lambda t, grains: 0 * grains.positions, name="nothing")
    pile.step()
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        fit = gf.fit([pile.packing(), heap(2)], ["osl"], heights=[0.2])
        compared = gf.compare(gf.average([pile.packing(), heap(2)], frame="heap", cuts=[0.2]), "bcc", folder=tmp_path / "c")
    assert any("forces of a Python function" in line and "nothing" in line for line in fit.warnings)
    for result in (fit, compared):
        assert any("forces of a Python function act on these grains: nothing" in note for note in result.profiles.notes)
    for file in ("profiles.csv", "profiles.md", "profiles.tex", "report.html", "summary.json", "verdict.json", "verdict.md"):
        assert "nothing" in (tmp_path / "c" / file).read_text(), file


@pytest.mark.parametrize("to, ending", [("csv", "-grains.csv"), ("csv", "-contacts.csv"), ("csv", "-walls.csv"),
                                        ("vtu", "-grains.vtu"), ("vtu", "-contacts.vtu"), ("vtu", "-chains.vtu"),
                                        ("svg", ".svg"), ("html", ".html"), ("lammps", ".data"), ("lammps", ".lammps")])
def test_every_export_says_so(to, ending, tmp_path):
    """Of a packing that such forces made, and of none else."""
    state = marked_state("glue, a<b")
    for packing, there in ((state, True), (layer(5, 4), False)):
        paths = gf.export(packing, to, tmp_path / str(there))
        text = html.unescape(open(next(path for path in paths if path.endswith(ending)), encoding="utf-8").read())
        assert ("glue, a<b" in text) == there


def test_every_export_of_a_field_says_so(tmp_path):
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        field = gf.average(marked_state("glue"), frame="packing", grid=(5, 5))
        plain = gf.average(layer(5, 4), frame="packing", grid=(5, 5))
    gf.write(tmp_path / "field.h5", field)
    assert 'Name="added_forces" Value="glue"' in (tmp_path / "field.xdmf").read_text()
    for to in ("csv", "vtu", "svg"):
        (path,) = [path for path in gf.export(field, to, tmp_path / to) if path.endswith(to)]
        assert "glue" in open(path).read()
        (path,) = [path for path in gf.export(plain, to, tmp_path / f"plain-{to}") if path.endswith(to)]
        assert "forces" not in open(path).read()


def test_marked_files_are_read_by_others(tmp_path):
    """The tables come back, and a reader of VTK sees the names."""
    state = marked_state("glue")
    tables = [path for path in gf.export(state, "csv", tmp_path) if path.endswith(".csv")]
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # not at rest
        back = gf.import_packing("csv", *tables)
    np.testing.assert_array_equal(back.contacts.forces, state.contacts.forces)
    assert back.walls.names == state.walls.names
    meshio = pytest.importorskip("meshio")
    (grains,) = [path for path in gf.export(state, "vtu", tmp_path) if path.endswith("grains.vtu")]
    assert list(meshio.read(grains).field_data) == ["added_forces: glue"]


def test_strains_say_so():
    before = layer(5, 4)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        field = gf.strain(before, marked_state("glue"), frame="packing", grid=(4, 3))
    assert field.attributes["added_forces"] == "glue"


def test_ctrl_c_within_the_function_leaves_a_whole_step():
    sent = threading.Event()

    def busy(t, grains):
        if not sent.is_set() and t > 0:
            sent.set()
            os.kill(os.getpid(), signal.SIGINT)
        return 0 * grains.positions

    engine, other = still(busy), still()
    with pytest.raises(KeyboardInterrupt):
        engine.step(10**7)
    assert 0 < engine.steps < 10**6 and signal.getsignal(signal.SIGINT) is signal.default_int_handler
    engine.step(10)
    other.step(engine.steps)
    np.testing.assert_array_equal(engine.packing().positions, other.packing().positions)


def test_the_engine_is_not_for_the_function():
    engine = gf.Engine(layer(5, 4), material=LINEAR)
    engine.add_force(lambda t, grains: -engine.velocities)
    with pytest.raises(RuntimeError, match="is stepping it"):
        engine.step()


def test_the_force_of_the_page():
    text = (ROOT / "docs/python.md").read_text()
    loop = text.partition("## The engine in a loop")[2].partition("```python\n")[2].partition("```")[0]
    own = text.partition("### A force or contact law of one's own")[2].partition("```python\n")[2].partition("```")[0]
    assert 0 < own.count("\n") <= 20
    names = {"gf": gf, "np": np}
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # of places above the grains
        exec(loop.replace("20000", "200").replace("1000)", "10)").replace("> 1e-3", "> 1e9"), names)
        exec(own.replace("20000", "200"), names)
    assert names["engine"].added_forces == ["cohesion", "wind"]

"""Packings, fields and summaries as arrays."""

import gc
import re
import warnings
from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest

import grainfield as gf
from scene import GRAIN_DENSITY, error_of, heap, heap_arrays, program, python


def test_members_are_arrays_with_units():
    packing = heap()
    n, contacts = len(packing), packing.contacts
    assert packing.positions.shape == packing.velocities.shape == (n, 2)
    assert contacts.forces.shape == contacts.normals.shape == contacts.branches.shape == (len(contacts), 2)
    assert packing.units["positions"] == "m" and packing.units["volumes"] == "m2"
    assert contacts.units["forces"] == "N" and contacts.units["branches"] == "m"
    assert repr(contacts).startswith(f"<Contacts: {len(contacts)}, with points, ")
    assert packing.walls.names == ["floor"] and packing.walls.units["forces"] == "N"
    np.testing.assert_allclose(packing.masses, GRAIN_DENSITY * packing.volumes, rtol=1e-15)
    at_floor = contacts.pairs[:, 1] < 0
    np.testing.assert_allclose(np.hypot(*contacts.branches[~at_floor].T), 0.01, rtol=1e-12)
    np.testing.assert_allclose(contacts.branches[at_floor], np.tile([0, -0.005], (at_floor.sum(), 1)), atol=1e-15)
    np.testing.assert_array_equal(contacts.normal_forces, -(contacts.forces * contacts.normals).sum(axis=1))
    with pytest.raises(AttributeError, match="has no velocity; there are: ids, positions"):
        packing.velocity


def test_floor_carries_the_weight():
    packing = heap()
    down = packing.contacts.forces[packing.contacts.pairs[:, 1] < 0, 1].sum()
    check = packing.check()
    assert check["support_ratio"] == pytest.approx(down / (9.81 * packing.masses.sum()), rel=1e-12)
    assert check["support_ratio"] == pytest.approx(1, abs=0.03)  # noise of 5 % on 80 contacts, steps of the surface


def test_arrays_are_views_that_keep_the_state():
    packing = heap()
    places = packing.positions
    assert np.shares_memory(places, packing.positions) and not places.flags.writeable
    with pytest.raises(ValueError):
        places[0, 0] = 1
    before, contacts = places.copy(), packing.contacts
    forces = contacts.forces
    size = forces.copy()
    del packing, contacts
    gc.collect()
    np.testing.assert_array_equal(places, before)
    np.testing.assert_array_equal(forces, size)


def test_a_file_holds_the_bits(tmp_path):
    packing, other = heap(1, time=2.5, load=(3, (0.0, -2.0))), heap(2)
    file = tmp_path / "heaps.h5"
    gf.write(f"{file}:realization_000/state_020", packing)
    gf.write(f"{file}:realization_001/state_020", other, add=True)
    assert "time 2.5 s" in program("info", file)
    back = gf.read(f"{file}:realization_000/state_020")
    for name in ("ids", "positions", "velocities", "radii", "masses", "inertias", "fixed"):
        np.testing.assert_array_equal(getattr(back, name), getattr(packing, name))
    for name in ("pairs", "forces", "points", "normals", "branches", "friction", "sliding"):
        np.testing.assert_array_equal(getattr(back.contacts, name), getattr(packing.contacts, name))
    assert back.time == 2.5 and back.loaded_grain == 3 and back.applied_force.tolist() == [0, -2]
    both = gf.read(file)
    assert list(both) == ["realization_000/state_020", "realization_001/state_020"]
    np.testing.assert_array_equal(both["realization_001/state_020"].contacts.forces, other.contacts.forces)
    with pytest.raises(KeyError, match="holds no pile; there are: realization_000/state_020"):
        both["pile"]
    with pytest.raises(ValueError, match="holds a snapshot /realization_001/state_020 already"):
        gf.write(f"{file}:realization_001/state_020", other, add=True)


def csv(path, columns):
    rows = zip(*columns.values())
    path.write_text(",".join(columns) + "\n" + "".join(",".join(map(str, row)) + "\n" for row in rows))
    return path


@pytest.mark.parametrize("dim", [2, 3])
def test_a_packing_of_arrays_is_that_of_the_same_tables(dim, tmp_path):
    rng = np.random.default_rng(5)
    n = 40
    x = np.arange(n) * 0.01 + rng.uniform(0, 1e-3, n)
    y, z, radius = (rng.uniform(low, high, n) for low, high in ((0, 1e-3), (0, 1e-3), (0.005, 0.006)))
    force = rng.uniform(-1, 1, (n - 1, dim))
    z = z if dim == 3 else None
    axes = "xyz"[:dim]
    grains = {"id": np.arange(n) * 3 + 7, "x": x, "y": y} | ({"z": z} if dim == 3 else {})
    grains |= {"radius": radius, "density": np.full(n, 2500.0), "spin": rng.uniform(-1, 1, n)}
    contacts = {"i": grains["id"][1:], "j": grains["id"][:-1]}
    contacts |= {f"f{axis}": force[:, k] for k, axis in enumerate(axes)}
    contacts["friction"] = np.full(n - 1, 0.3)
    program("import", "--from", "csv", csv(tmp_path / "g.csv", grains), csv(tmp_path / "c.csv", contacts),
            "-o", tmp_path / "p.h5")
    there = gf.read(tmp_path / "p.h5")
    here = gf.packing(x, y, radius, z, ids=grains["id"], spin=grains["spin"],
                      density=2500, contacts={"i": contacts["i"], "j": contacts["j"], "forces": force,
                                              "friction": contacts["friction"]})
    assert here.dim == there.dim == dim
    for name in here.units:
        np.testing.assert_array_equal(getattr(here, name), getattr(there, name), err_msg=name)
    for name in here.contacts.units:
        np.testing.assert_array_equal(getattr(here.contacts, name), getattr(there.contacts, name), err_msg=name)


def test_mistakes_in_arrays_are_those_of_an_import(tmp_path):
    grains = {"id": [0, 1], "x": [0.0, 0.01], "y": [0.0, 0.0], "radius": [0.005, 0.005], "mass": [1.0, 1.0]}

    def both(contacts, **other):
        table = grains | other
        text = error_of(lambda: gf.packing(table["x"], table["y"], table["radius"], ids=table["id"],
                                           mass=table["mass"], contacts=contacts))
        files = csv(tmp_path / "grains", table), csv(tmp_path / "contacts", contacts)
        there = program("import", "--from", "csv", *files, "-o", tmp_path / "p.h5", code=2)
        # Options are named as Python's arguments.
        there = there.replace("(--wall)", "(walls)")
        there = re.sub("; a wall or facet of that number: .*|, and no axis is periodic .*", "", there)
        there = re.sub("--periodic .*", 'periodic={"x": (low, high)} says where', there)
        # Rows are counted from 0, lines of a file from 1 with the header.
        assert there == re.sub(r"(grains|contacts):(\d+)",
                               lambda m: f"{tmp_path / m[1]}:{int(m[2]) + 2}", text)
        return text

    good = {"i": [0], "j": [1], "fx": [-1.0], "fy": [0.0]}
    assert "contact of the unknown grain 5; known: 2 grains with ids from 0 to 1" in both(good | {"j": [5]})
    assert "grain 1: found radius -1 m, allowed: above 0" in both(good, radius=[0.005, -1.0])
    assert both(good, id=[1, 1]) == "grains:1: grain 1 is there already, at grains:0; of several times or steps import one at a time"
    assert "grain 0 in contact with itself" in both(good | {"j": [0]})
    assert "in contact at a distance of 0.1 m" in both(good, x=[0.0, 0.1])
    wrong = error_of(lambda: gf.packing([0], [0], 1, mass=1, colour=[3]))
    assert wrong.startswith('grains: unknown column "colour"; nearest: ')
    assert error_of(lambda: gf.packing([0, 1], [0], 1, mass=1)) == (
        "grains: found 1 values of y and 2 of x, allowed: as many")
    assert error_of(lambda: gf.packing([0], [0], 1, mass=1, contact=good)) == (
        "packing: unknown argument contact; did you mean contacts?")
    assert "expected a finite number" in error_of(lambda: gf.packing([np.nan], [0], 1, mass=1))
    assert error_of(lambda: gf.packing([0], [0], 1)) == (
        "grains: no \"mass\"; found: x id y radius; mass (kg) or density (kg/m2) tells it")
    one = error_of(lambda: gf.packing([0, 2], [0, 0], 1, mass=1, contacts={"i": [0], "j": [1], "force": [[0, 1]]}))
    assert one == "contacts.force: found an array of shape (1, 2), allowed: (n,); did you mean forces, which takes (n, 2)?"
    none = error_of(lambda: gf.packing([0, 2], [0, 0], 1, mass=1, contacts={"i": [0], "j": [1]}))
    assert none == "contacts: no \"fx\"; found: i j; forces (n, dim) tells it"
    assert "--" not in error_of(lambda: gf.packing([0], [0], 1, mass=1, friction=-1))
    large = error_of(lambda: gf.packing([0], [0.005], 5, mass=1, walls="floor:y=0",
                                        contacts={"i": [0], "j": ["floor"], "forces": [[0, 1]]}))
    assert large.startswith("1 of 1 grains in contact with wall floor reach through it") and "radius 5 m" in large
    short = error_of(lambda: gf.packing([0], [0], 1, mass=1, velocities=[[1, 2, 3]]))
    assert short == "grains.velocities: found an array of shape (1, 3), allowed: (n, 2)"


def test_what_makes_a_packing_doubtful_is_a_warning():
    pulled = {"i": [0], "j": [1], "forces": [[1.0, 0.0]]}
    with pytest.warns(UserWarning) as told:
        packing = gf.packing([0.0, 0.01], [0.0, 0.0], 0.005, mass=1, contacts=pulled)
    assert [str(one.message) for one in told] == packing.check()["warnings"]
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        heap()


def test_polygons_and_periodic_cells_come_from_arrays():
    square = np.array([[-1, -1], [1, -1], [1, 1], [-1, 1]]) * 0.01
    packing = gf.packing([0.0, 0.05], [0.0, 0.0], 0.01, density=1000, outlines=[square, None],
                         periodic={"x": (-0.1, 0.1)})
    assert packing.volumes[0] == pytest.approx(4e-4) and packing.volumes[1] == pytest.approx(np.pi * 1e-4)
    np.testing.assert_allclose(packing.outlines[0], square)
    assert packing.cell["periodic"].tolist() == [True, False]
    assert packing.cell["edges"][0].tolist() == [0.2, 0]


def test_fields_of_arrays_are_files_like_any_other(tmp_path):
    x = np.linspace(-1, 1, 9)
    field = gf.Field(
        np.stack([x, 0 * x], axis=1), {"sigma_yy": -(1 - x * x), "sigma_xy": x}, units={"sigma_yy": "N/m"},
        errors={"sigma_yy": 0.1 + 0 * x}, samples={"sigma_yy": np.stack([x, 2 * x], axis=1)},
        realizations=2, attributes={"h": 0.5, "frame": "packing"}, name="measured",
    )
    gf.write(tmp_path / "f.h5", field)
    back = gf.read(f"{tmp_path / 'f.h5'}:measured")
    np.testing.assert_array_equal(back.sigma_yy, field["sigma_yy"])
    np.testing.assert_array_equal(back.error("sigma_yy"), field.error("sigma_yy"))
    np.testing.assert_array_equal(back.samples("sigma_yy"), field.samples("sigma_yy"))
    assert back.units == {"sigma_yy": "N/m", "sigma_xy": "1"} and back.attributes["h"] == 0.5
    assert "field measured: 9 points in 2D, 2 realizations" in program("info", tmp_path / "f.h5")
    gf.write(tmp_path / "f.csv", field)
    table = gf.read(tmp_path / "f.csv")
    np.testing.assert_array_equal(table["sigma_yy_error"], field.error("sigma_yy"))
    with pytest.raises(KeyError, match="no column sigma_zz; there are: sigma_yy, sigma_xy"):
        back["sigma_zz"]
    negative = error_of(lambda: gf.Field([[0, 0]], {"a": [1]}, errors={"a": [-0.5]}))
    assert negative == "a: found the error -0.5 at point 0, allowed: 0 and above"
    assert error_of(lambda: gf.Field([[0, 0]], {"a": [1, 2]})) == "a: found 2 values for 1 points"


def test_summaries_have_units(tmp_path):
    gf.write(tmp_path / "summary.json", {"dem.grains": 12, "pile.height": 0.5, "verdict.best_model": "osl"})
    summary = gf.read(tmp_path / "summary.json")
    assert summary == {"dem.grains": 12, "pile.height": 0.5, "verdict.best_model": "osl"}
    assert summary.units == {"dem.grains": "-", "pile.height": "m", "verdict.best_model": "text"}
    assert summary.under("dem.") == {"grains": 12}


def test_reading_refuses_as_the_program(tmp_path):
    missing, text = tmp_path / "none.h5", tmp_path / "text.h5"
    text.write_text("no HDF5")
    for file in (missing, text):
        assert error_of(lambda: gf.read(file)) == program("info", file, code=2)
    gf.write(tmp_path / "p.h5", heap())
    group = f"{tmp_path / 'p.h5'}:nothing"
    assert error_of(lambda: gf.read(group)) == program("structure", group, code=2)


def test_threads_take_turns_at_files(tmp_path):
    file, packing = tmp_path / "p.h5", heap()
    gf.write(file, {f"s{k}": packing for k in range(3)})
    alone = gf.average(f"{file}:s0", frame="heap", grid=(9, 5))

    def work(number):
        for _ in range(3):
            assert len(gf.read(file)) == 3
            field = gf.average(f"{file}:s{number % 3}", frame="heap", grid=(9, 5))
            np.testing.assert_array_equal(field.sigma_yy, alone.sigma_yy)
            gf.write(tmp_path / f"f{number}.h5", field)
        return number

    with ThreadPoolExecutor(4) as pool:
        assert list(pool.map(work, range(4))) == [0, 1, 2, 3]


@pytest.mark.parametrize("first", ["h5py", "grainfield"])
def test_h5py_reads_the_same_file_in_one_process(first, tmp_path):
    pytest.importorskip("h5py")
    second = "grainfield" if first == "h5py" else "h5py"
    gf.write(tmp_path / "p.h5", heap())
    done = python(f"""
import {first}, {second}, numpy
ours = grainfield.read({str(tmp_path / 'p.h5')!r})
with h5py.File({str(tmp_path / 'p.h5')!r}) as file:
    numpy.testing.assert_array_equal(file['packing/grains/radius'][:], ours.radii)
grainfield.write({str(tmp_path / 'q.h5')!r}, ours)
""")
    assert done.returncode == 0, done.stderr
    np.testing.assert_array_equal(gf.read(tmp_path / "q.h5").radii, heap_arrays(1)["radius"])


def test_files_hold_plain_types_that_others_open(tmp_path):
    h5py = pytest.importorskip("h5py")
    field = gf.average([heap(1), heap(2)], frame="heap", grid=(5, 4))
    gf.write(tmp_path / "f.h5", field)
    gf.write(tmp_path / "p.h5", heap())
    kinds = set()
    for name in ("f.h5", "p.h5"):
        with h5py.File(tmp_path / name) as file:
            file.visititems(lambda _, item: kinds.update([item.dtype.str] if isinstance(item, h5py.Dataset) else []))
    assert kinds == {"<f8", "<i8"}
    xarray = pytest.importorskip("xarray")
    pytest.importorskip("h5netcdf")
    with xarray.open_dataset(tmp_path / "f.h5", engine="h5netcdf", group="average/value", phony_dims="sort") as values:
        np.testing.assert_array_equal(values["sigma_yy"], field.sigma_yy)
        assert values["sigma_yy"].unit == "N/m"


def test_ids_beyond_doubles_keep_their_last_digit():
    ids = np.array([2**53 + 1, 2**53 + 2])
    packing = gf.packing([0, 0.0199], [0.01, 0.01], 0.01, ids=ids, density=2500,
                                 contacts={"i": ids[:1], "j": ids[1:], "forces": [[-1.0, 0.0]]})
    assert packing.ids.tolist() == ids.tolist()
    assert len(packing.contacts) == 1
    with pytest.raises(ValueError, match="numbers of float64 from 2\\^53 on"):
        gf.packing([0, 0.0199], [0.01, 0.01], 0.01, ids=ids.astype(float), density=2500)


@pytest.mark.parametrize(("kind", "bits"), [(np.float32, 24), (np.float16, 11)])
def test_short_numbers_round_ids_earlier(kind, bits):
    ids = np.arange(3) + 2**bits - 2  # the last is 2^bits, which 2^bits + 1 becomes, too
    pair = {"i": ids[:1].astype(kind), "j": ids[1:2].astype(kind), "forces": [[-1.0, 0.0]]}
    row = dict(x=[0, 0.0199, 0.0398], y=[0.01] * 3, radius=0.01, ids=ids, density=2500)
    assert gf.packing(**row, contacts=pair).contacts.pairs.tolist() == [[0, 1]]
    with pytest.raises(ValueError, match=rf"contacts.j: found numbers of {np.dtype(kind)} from 2\^{bits} on"):
        gf.packing(**row, contacts={**pair, "j": ids[2:].astype(kind)})


class Frame:
    """Columns as a DataFrame has them: its truth is ambiguous."""

    def __init__(self, **columns):
        self._of, self.columns = columns, list(columns)

    def __getitem__(self, name):
        return self._of[name]

    def __bool__(self):
        raise ValueError("the truth value is ambiguous")


def test_contacts_are_any_table():
    row = dict(x=[0, 0.0199, 0.0398], y=[0.01] * 3, radius=0.01, density=2500)
    structured = np.array([(0, 1, -1.0, 0.5), (1, 2, -2.0, 0.0)],
                          dtype=[("i", "i8"), ("j", "i8"), ("fx", "f8"), ("fy", "f8")])
    vectors = np.zeros(2, dtype=[("i", "i4"), ("j", "i4"), ("forces", "f8", (2,))])
    vectors["i"], vectors["j"] = structured["i"], structured["j"]
    vectors["forces"] = np.stack([structured["fx"], structured["fy"]], axis=1)
    frame = Frame(**{name: structured[name] for name in structured.dtype.names})
    wall = Frame(name=["floor"], x=[0.0], y=[0.0], nx=[0.0], ny=[1.0])
    for contacts in (structured, structured.view(np.recarray), vectors, frame):
        packing = gf.packing(**row, contacts=contacts, walls=wall)
        assert packing.contacts.forces.tolist() == [[-1.0, 0.5], [-2.0, 0.0]]
        assert packing.walls.names == ["floor"]
    with pytest.raises(ValueError, match="contacts: found list, allowed: columns by their names, as a dict"):
        gf.packing(**row, contacts=[(0, 1, -1.0, 0.5)])


def test_masked_points_are_refused():
    points = np.ma.array([[0.0, -0.1], [0.1, -0.1]], mask=[[False, False], [True, False]])
    for call in (lambda: gf.model("flamant", F=1)(points), lambda: gf.average(heap(), points=points)):
        with pytest.raises(ValueError, match="points: found 1 masked values of 4"):
            call()


def test_masked_values_are_none():
    x = np.ma.array([0, 0.0199], mask=[False, True])
    with pytest.raises(ValueError, match="grains.x: found 1 masked values of 2"):
        gf.packing(x, [0.01, 0.01], 0.01, density=2500)


def test_a_period_is_two_numbers():
    with pytest.raises(ValueError, match=r"periodic: found 0.1 for x, allowed: \(low, high\)"):
        gf.packing([0], [0], 0.01, density=2500, periodic={"x": 0.1})


def test_periods_are_a_dict_or_pairs():
    made = [gf.packing([0], [0], 0.01, density=2500, periodic=given)
            for given in ({"x": (-0.1, 0.1)}, [("x", (-0.1, 0.1))])]
    for packing in made:
        assert packing.cell["periodic"].tolist() == [True, False] and packing.cell["edges"][0].tolist() == [0.2, 0]
    with pytest.raises(ValueError, match=r"periodic: found \['x', 0.1\], allowed: \(low, high\) of each axis"):
        gf.packing([0], [0], 0.01, density=2500, periodic=["x", 0.1])


def test_what_is_no_number_is_named():
    with pytest.raises(ValueError, match='found "nan", expected a finite number'):
        gf.packing([0, np.nan], [0, 0.1], 0.01, density=2500)


def test_the_import_is_quick():
    """CPU seconds with numpy, the least of three: 0.3 s are promised."""
    code = "import time; start = time.process_time(); import grainfield; print(time.process_time() - start)"
    assert min(float(python(code).stdout) for _ in range(3)) < 0.3

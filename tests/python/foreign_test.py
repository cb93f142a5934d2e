"""import_packing, export, check and keys: what the commands of these names do."""

import warnings

import numpy as np
import pytest

import grainfield as gf
from scene import error_of, heap, program, same, write_dumps

LAMMPS = dict(columns={"i,j": "c_ids[1..2]", "fnx,fny,fnz": "c_p[1..3]", "ftx,fty,ftz": "c_p[4..6]"},
              walls="floor:y=0:fix=f_floor")


def same_packing(a, b):
    for table, other in ((a, b), (a.contacts, b.contacts), (a.walls, b.walls)):
        for name in table.units:
            np.testing.assert_array_equal(getattr(table, name), getattr(other, name), err_msg=name)


def test_dumps_of_lammps(tmp_path):
    files = write_dumps(tmp_path, 1)
    here = gf.import_packing("lammps", *files, **LAMMPS, gravity=(0, -9.5))
    options = [word for text in ("i,j=c_ids[1..2]", "fnx,fny,fnz=c_p[1..3]", "ftx,fty,ftz=c_p[4..6]")
               for word in ("--column", text)]
    told = program("import", "--from", "lammps", *files, *options, "--wall", "floor:y=0:fix=f_floor",
                   "--gravity", "0,-9.5", "-o", tmp_path / "p.h5")
    same_packing(here, gf.read(tmp_path / "p.h5"))
    assert here.report == told and here.gravity.tolist() == [0, -9.5] and here.walls.names == ["floor"]
    assert here.contacts.forces[here.contacts.pairs[:, 1] < 0, 1].sum() == pytest.approx(9.81 * here.masses.sum(), rel=0.05)


def tables(folder, n=3):
    (folder / "g.csv").write_text("id,x (mm),y (mm),radius (mm)\n" + "".join(f"{k},{20 * k},0,10\n" for k in range(n)))
    (folder / "c.csv").write_text("i,j,fx,fy\n" + "".join(f"{k},{k + 1},2.5,0\n" for k in range(n - 1)))
    return folder / "g.csv", folder / "c.csv"


def test_options_are_arguments(tmp_path):
    files = tables(tmp_path)
    made = gf.import_packing("csv", *files, density="2.5 g/cm2", friction=0.25, flip_forces=True, gravity=(0, 0),
                             periodic={"x": (-0.01, 0.05)}, load=(1, (0, -3)), walls=["floor:y=-0.01 m", "lid:y=10 mm"],
                             fixed="id=0,2", dim=2)
    assert made.contacts.forces.tolist() == [[-2.5, 0], [-2.5, 0]] and (made.contacts.friction == 0.25).all()
    assert made.masses[0] == pytest.approx(25 * np.pi * 0.01**2) and made.fixed.tolist() == [True, False, True]
    for words, turned in (("pairs", 2), ("walls", 0)):
        part = gf.import_packing("csv", *files, density="2.5 g/cm2", gravity=(0, 0), periodic={"x": (-0.01, 0.05)}, dim=2,
                                 flip_forces=words)
        assert (part.contacts.forces[:, 0] < 0).sum() == turned
    with pytest.raises(ValueError, match="--flip-forces=none: allowed: --flip-forces, --flip-forces=pairs"):
        gf.import_packing("csv", *files, density=1, flip_forces="none")
    assert made.cell["periodic"].tolist() == [True, False] and made.walls.names == ["floor", "lid"]
    assert made.loaded_grain == 1 and made.applied_force.tolist() == [0, -3]
    bare = gf.import_packing("csv", files[0], columns=["density=1000"], without_contacts=True)
    assert len(bare.contacts) == 0 and bare.masses[0] == pytest.approx(1000 * np.pi * 0.01**2)


def test_several_steps_are_a_collection(tmp_path):
    text = "".join(
        f"ITEM: TIMESTEP\n{step}\nITEM: NUMBER OF ATOMS\n1\nITEM: BOX BOUNDS ff ff pp\n0 1\n0 1\n-0.5 0.5\n"
        f"ITEM: ATOMS id type x y z radius mass\n1 1 0.5 {step / 100} 0 0.1 1\n" for step in (10, 20, 30))
    (tmp_path / "g.dump").write_text(text)
    options = dict(without_contacts=True, time_step=1e-3, dim=2)
    every = gf.import_packing("lammps", tmp_path / "g.dump", steps="all", **options)
    assert list(every) == ["step_10", "step_20", "step_30"]
    assert [every[name].time for name in every] == [0.01, 0.02, 0.03]
    two = gf.import_packing("lammps", tmp_path / "g.dump", steps={10: "first", 30: "last"}, **options)
    assert list(two) == ["first", "last"] and two["last"].positions[0, 1] == 0.3
    assert gf.import_packing("lammps", tmp_path / "g.dump", **options).time == 0.03


def test_mistakes_and_warnings_are_those_of_the_command(tmp_path):
    files = tables(tmp_path)
    out = ["-o", tmp_path / "o.h5"]
    for call, command in [
        (lambda: gf.import_packing("lamps", *files), ["import", "--from", "lamps", *files, *out]),
        (lambda: gf.import_packing("csv", *files), ["import", "--from", "csv", *files, *out]),
        (lambda: gf.import_packing("csv", tmp_path / "none.csv"), ["import", "--from", "csv", tmp_path / "none.csv", *out]),
        (lambda: gf.export(heap(), "lamp", tmp_path / "x"), None),
        (lambda: gf.check("point-load-mono", set={"material.frict": 1}),
         ["check", "point-load-mono", "--set", "material.frict=1"]),
        (lambda: gf.keys("frictn"), ["keys", "frictn"]),
    ]:
        text = error_of(call)
        assert text and "\n" not in text
        if command:
            assert text == program(*command, code=2)
    assert error_of(lambda: gf.import_packing("csv", *files, periodic={"x": 0.1})) == (
        'periodic: found 0.1 for x, allowed: (low, high) in m, such as {"x": (0, 0.1)}')
    with pytest.warns(UserWarning, match="the contacts pull") as told:
        gf.import_packing("csv", files[0], files[1], density=1000, gravity=(0, 0), flip_forces=False)
    assert told[0].filename == __file__
    with pytest.raises(OSError, match="the program grainfield is not"):
        missing()


def missing():
    from grainfield import _program

    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("PATH", "")
        patch.delenv("GRAINFIELD_PROGRAM", raising=False)
        patch.setattr(_program, "__file__", "/nowhere/a/b/c/grainfield/_program.py")
        _program.path.cache_clear()
        try:
            _program.path()
        finally:
            _program.path.cache_clear()


def test_exports_come_back(tmp_path):
    packing = heap()
    files = gf.export(packing, "csv", tmp_path / "csv")
    assert [name.rpartition("/")[2] for name in files] == [f"packing-{part}.csv" for part in ("contacts", "grains", "walls")]
    back = gf.import_packing("csv", *files)
    np.testing.assert_array_equal(back.positions, packing.positions)
    np.testing.assert_array_equal(back.contacts.forces, packing.contacts.forces)
    assert gf.export(packing, "svg", tmp_path / "csv") == [str(tmp_path / "csv" / "packing.svg")]
    gf.write(tmp_path / "p.h5", {"one": packing, "two": packing})
    assert len(gf.export(f"{tmp_path / 'p.h5'}:two", "csv", tmp_path / "two")) == 3
    assert len(gf.export({"one": packing, "two": packing}, "csv", tmp_path / "both")) == 6
    deck = gf.export(packing, "lammps", tmp_path / "deck")
    assert [name.rpartition("/")[2] for name in deck] == ["ids.csv", "in.lammps", "packing.data"]
    field = gf.average(packing, frame="heap", grid=(9, 5))
    (table,) = gf.export(field, "csv", tmp_path / "field")
    np.testing.assert_array_equal(gf.read(table)["sigma_yy"], field.sigma_yy)


def test_check_says_what_a_case_would_compute():
    told = gf.check("point-load-mono", quick=True, set={"ensemble.realizations": 1})
    assert told == program("check", "point-load-mono", "--quick", "--set", "ensemble.realizations=1")
    assert "ok (point-load" in told
    with pytest.warns(UserWarning, match="material.young.* has no effect"):
        gf.check("sample-biaxial", set={"material.young": 2e7})


def test_samples_are_those_of_the_program():
    listed = program("samples").splitlines()
    assert [line.split()[0] for line in listed[:-1]] == list(gf.samples())
    assert len(gf.read(gf.samples()["heaps.h5"])) == 4 and "value" in gf.read(gf.samples()["measured.csv"])


def test_keys_are_a_table():
    every = gf.keys()
    rows = {row["key"]: row for row in every.rows()}
    assert rows["material.friction"]["default"].startswith("0.5; pile: 0.54") and rows["material.friction"]["type"] == "number"
    assert rows["load.force"]["unit"] == "N" and rows["title"]["default"] == '""'
    assert " | " in rows["material.law"]["allowed"] and len(rows) == len(every["key"]) > 300
    assert set(gf.keys("fit")["key"]) == {key for key in rows if key.startswith("fit.")}
    part = gf.keys("frict")["key"]
    assert "material.floor_friction" in part and all("frict" in key for key in part)
    assert gf.keys("fit.heights", "rest")["key"][0].startswith("rest.") and "rest.max_time" in gf.keys("rest")["key"]
    summary = {row["key"]: row for row in gf.keys(summary=True).rows()}
    assert summary["pile.height"]["unit"] == "m"
    assert error_of(lambda: gf.keys("nothing", summary=True)) == "keys: no key of summary.json with nothing"


def test_gaps_are_no_warnings_of_a_grid():
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        field = gf.average(heap(), frame="heap", grid=(15, 9))
    assert np.isnan(field.sigma_yy).any() and not field.warnings
    assert any("lie outside the packing" in line and "are nan" in line for line in field.gaps)
    with pytest.warns(UserWarning, match="are nan"):
        one = gf.average(heap(), frame="heap", points=[[0, -0.5], [3, -0.5]])
    assert np.isnan(one.sigma_yy).tolist() == [False, True] and one.warnings == one.gaps
    with pytest.warns(UserWarning, match="are nan"):
        gf.average(heap(), frame="packing", grid=(2, 2), width=1e-5)

"""What a notebook shows, and tables that travel to pandas and xarray."""

import re
import sys
import types
from xml.etree import ElementTree

import numpy as np
import pytest

import grainfield as gf
from scene import heap, python

HEAPS = [heap(1), heap(2)]


def cells(shown):
    """Rows of the tables of a piece of HTML, which is well formed."""
    tree = ElementTree.fromstring(f"<div>{shown}</div>")
    return [[cell.text or "" for cell in row] for row in tree.iter("tr")]


def test_packings_and_fields_show_what_they_hold():
    rows = dict(row for row in cells(HEAPS[0]._repr_html_()))
    assert rows["grains"] == str(len(HEAPS[0])) and rows["contacts"] == str(len(HEAPS[0].contacts))
    assert rows["walls"] == "floor" and "Packing, 2D" in rows
    field = gf.average(HEAPS, frame="heap", grid=(5, 4))
    assert "20 points (5 x 4), 2 realizations" in field._repr_html_()
    assert field.gaps and all(line in ElementTree.fromstring(f"<p>{field._repr_html_()}</p>").itertext() for line in field.gaps)
    rows = {row[0]: row[1:] for row in cells(field._repr_html_())}
    assert list(rows)[1:] == field.columns
    unit, least, largest, errors = rows["sigma_yy"]
    assert unit == "N/m" and errors == "yes"
    assert float(least) == pytest.approx(np.nanmin(field.sigma_yy), rel=1e-5) and float(largest) <= 0


def test_contacts_and_walls_show_their_rows():
    contacts = HEAPS[0].contacts
    header, first, *_ = cells(contacts._repr_html_())
    assert header[:4] == ["pairs_0", "pairs_1", "points_x (m)", "points_y (m)"] and len(cells(contacts._repr_html_())) == 14
    assert f"{len(contacts)} rows" in contacts._repr_html_()
    assert float(first[header.index("normal_forces (N)")]) == pytest.approx(contacts.normal_forces[0], rel=1e-5)
    header, *walls = cells(HEAPS[0].walls._repr_html_())
    assert [wall[0] for wall in walls] == ["floor"] and walls[0][header.index("normals_y")] == "1"
    assert repr(HEAPS[0].walls) == "<Walls: floor>"
    pytest.importorskip("pandas")
    assert HEAPS[0].walls.to_pandas()["name"].tolist() == ["floor"]


def test_summaries_and_structures_show_their_figures():
    summary = gf.fit(HEAPS, ["osl"], heights=[0.2], set={"fit.bootstrap": 0}).summary
    rows = {row[0]: row[1:] for row in cells(summary._repr_html_())[1:]}
    assert list(rows) == list(summary) and rows["fit.slope_deg"] == [f"{summary['fit.slope_deg']:.6g}", "deg"]
    pytest.importorskip("pandas")
    frame = summary.to_pandas()
    assert list(frame.index) == list(summary) and frame.loc["fit.slope_deg", "unit"] == "deg"
    assert frame.loc["fit.osl.eta", "value"] == summary["fit.osl.eta"]
    made = gf.structure(HEAPS[0])
    shown = dict(cells(made._repr_html_()))
    assert shown["rattlers"] == str(made.rattlers) and float(shown["coordination"]) == pytest.approx(made.coordination, rel=1e-5)
    assert repr(made).startswith(f"<Structure: {made.grains_counted} grains, coordination ")


def test_results_show_what_there_is_to_ask_for(tmp_path):
    gf.write(tmp_path / "summary.json", {"verdict.sentence": "osl is <nearest>.", "dem.grains": 12})
    gf.write(tmp_path / "fields.h5", gf.average(HEAPS, frame="heap", grid=(5, 4)))
    (tmp_path / "profiles.csv").write_text("x_m\n1\n")
    result = gf.Result(tmp_path, ["loose"])
    shown = result._repr_html_()
    assert dict(cells(shown)[1:]) == {".summary": "2 figures", ".tables": "profiles", ".fields": "average"}
    words = list(ElementTree.fromstring(f"<p>{shown}</p>").itertext())
    assert "osl is <nearest>." in words and "loose" in words


def test_judgements_show_what_the_report_shows():
    result = gf.fit(HEAPS, ["osl", "bcc"], heights=[0.2], set={"fit.bootstrap": 0})
    shown = result._repr_html_()
    assert shown == result.judgement._repr_html_()
    rows = cells(shown)
    assert rows[0] == list(result.judgement.table) and len(rows) == 3
    assert result.judgement.headlines[0] in re.sub("<[^>]*>", "", shown)
    assert all(doubt in ElementTree.fromstring(f"<p>{shown}</p>").itertext() for doubt in result.judgement.doubts)


def test_long_tables_show_both_ends_and_escape_words():
    table = gf.Table({"x": np.arange(50.0), "word": np.array(["a<b"] * 50)}, {"x": "m", "word": "1"}, [])
    rows = cells(table._repr_html_())
    assert rows[0] == ["x (m)", "word"] and rows[1] == ["0", "a<b"] and rows[7] == ["...", "..."]
    assert rows[-1][0] == "49" and len(rows) == 14 and "50 rows" in table._repr_html_()
    short = gf.Table({"x": np.array([np.nan, 1])}, {"x": "1"}, [])
    assert cells(short._repr_html_()) == [["x"], ["-"], ["1"]]
    assert cells(gf.Table({}, {}, [])._repr_html_()) == [[]]


def test_a_table_names_its_columns_and_its_profiles():
    table = gf.Table({"profile": np.array(["base"]), "x": np.zeros(1)}, {"x": "m"}, [])
    with pytest.raises(KeyError, match="no column y; there are: profile, x.$"):
        table["y"]
    with pytest.raises(KeyError, match=r"no column base; .*; base is a profile: plot\(profile='base'\)"):
        table["base"]
    assert table.get("base") is None


def test_tables_become_frames():
    pytest.importorskip("pandas")
    result = gf.compare(gf.average(HEAPS, frame="heap", cuts=[0.2]), "bcc")
    frame = result.profiles.to_pandas()
    assert list(frame) == list(result.profiles) and frame.attrs["units"] == result.profiles.units
    np.testing.assert_array_equal(frame["bcc"], result.profiles["bcc"])
    grains = HEAPS[0].to_pandas()
    np.testing.assert_array_equal(grains[["positions_x", "positions_y"]], HEAPS[0].positions)
    assert grains.attrs["units"]["positions_x"] == "m" and len(grains) == len(HEAPS[0])
    contacts = HEAPS[0].contacts.to_pandas()
    np.testing.assert_array_equal(contacts[["pairs_0", "pairs_1"]], HEAPS[0].contacts.pairs)
    np.testing.assert_array_equal(contacts["forces_y"], HEAPS[0].contacts.forces[:, 1])


def test_fields_become_frames_and_datasets(tmp_path):
    pytest.importorskip("pandas")
    pytest.importorskip("xarray")
    field = gf.average(HEAPS, frame="heap", grid=(5, 4))
    frame = field.to_pandas()
    np.testing.assert_array_equal(frame[["x", "y"]], field.points)
    np.testing.assert_array_equal(frame["sigma_xy_error"], field.error("sigma_xy"))
    assert frame.attrs["units"] | {"x": "1"} == frame.attrs["units"]  # heap: shares of the height
    grid = field.to_xarray()
    assert grid["sigma_yy"].dims == ("y", "x") and grid.sizes["x"] == 5 and grid["sigma_yy"].units == "N/m"
    np.testing.assert_array_equal(grid["sigma_yy"], field.grid("sigma_yy"))
    np.testing.assert_array_equal(np.stack([a.ravel() for a in np.meshgrid(grid.x, grid.y)], axis=1), field.points)
    samples = grid["sigma_yy_samples"]
    assert samples.dims == ("y", "x", "realization") and grid["realization"].values.tolist() == [0, 1]
    np.testing.assert_array_equal(samples.sel(realization=1).values.ravel(), field.samples("sigma_yy")[:, 1])
    np.testing.assert_allclose(samples.mean("realization"), grid["sigma_yy"], rtol=1e-12)
    pytest.importorskip("scipy")
    grid.to_netcdf(tmp_path / "field.nc")
    with pytest.importorskip("xarray").open_dataset(tmp_path / "field.nc") as back:
        assert back.identical(grid)
    line = gf.average(HEAPS, frame="heap", cuts=[0.2]).to_xarray()
    assert line["sigma_yy"].dims == ("point",) and set(line.coords) == {"x", "y", "realization"}


def test_grids_in_space_keep_their_order():
    pytest.importorskip("xarray")
    x, y, z = np.meshgrid([0.0, 1, 2], [0.0, 1], [0.0, 1, 2, 3], indexing="ij")
    points = np.stack([a.transpose(2, 1, 0).ravel() for a in (x, y, z)], axis=1)  # x fastest
    field = gf.Field(points, {"sum": points @ [1, 10, 100]}, shape=(3, 2, 4))
    grid = field.to_xarray()
    assert grid["sum"].dims == ("z", "y", "x") and float(grid["sum"].sel(x=2, y=1, z=3)) == 312


def test_fields_and_packings_become_meshes(tmp_path):
    meshio = pytest.importorskip("meshio")
    field = gf.average(HEAPS, frame="heap", grid=(5, 4))
    field.to_meshio().write(tmp_path / "field.vtu")
    back = meshio.read(tmp_path / "field.vtu")
    np.testing.assert_array_equal(back.points, np.pad(field.points, ((0, 0), (0, 1))))
    np.testing.assert_array_equal(back.point_data["sigma_xy"], field.sigma_xy)
    np.testing.assert_array_equal(back.point_data["sigma_xy_error"], field.error("sigma_xy"))
    (quads,) = back.cells
    assert quads.type == "quad" and len(quads.data) == 4 * 3
    corners = field.points[quads.data]  # counterclockwise, of equal area
    turned = np.roll(corners, -1, axis=1)
    areas = (corners[..., 0] * turned[..., 1] - corners[..., 1] * turned[..., 0]).sum(axis=1) / 2
    np.testing.assert_allclose(areas, np.prod(np.ptp(field.points, axis=0)) / 12)
    x, y, z = np.meshgrid([0.0, 1, 2], [0.0, 1], [0.0, 1, 2, 3], indexing="ij")
    points = np.stack([a.transpose(2, 1, 0).ravel() for a in (x, y, z)], axis=1)
    (bricks,) = gf.Field(points, {"sum": points @ [1, 10, 100]}, shape=(3, 2, 4)).to_meshio().cells
    assert bricks.type == "hexahedron" and len(bricks.data) == 2 * 1 * 3
    assert points[bricks.data[0]].tolist() == [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [0, 0, 1], [1, 0, 1], [1, 1, 1], [0, 1, 1]]
    HEAPS[0].to_meshio().write(tmp_path / "heap.vtu")
    mesh = meshio.read(tmp_path / "heap.vtu")
    np.testing.assert_array_equal(mesh.point_data["radii"], HEAPS[0].radii)
    pair = HEAPS[0].contacts.pairs[:, 1] >= 0
    np.testing.assert_array_equal(mesh.cells_dict["line"], HEAPS[0].contacts.pairs[pair])
    np.testing.assert_array_equal(mesh.cell_data_dict["normal_forces"]["line"], HEAPS[0].contacts.normal_forces[pair])


class Bar:
    """Records what is asked of tqdm."""

    def __init__(self, total, **_):
        self.total, self.seen, self.words, self.closed = total, [], [], False

    def set_description(self, words):
        self.seen.append(self.n)
        self.words.append(words)

    def close(self):
        self.closed = True


def test_long_calls_show_a_bar_in_a_notebook(monkeypatch, capsys):
    from grainfield._progress import Progress

    made = []
    tqdm = types.ModuleType("tqdm")
    tqdm.tqdm = lambda **options: made.append(Bar(**options)) or made[-1]
    tqdm.notebook = types.ModuleType("tqdm.notebook")
    tqdm.notebook.tqdm = tqdm.tqdm
    for name, module in (("ipykernel", types.ModuleType("ipykernel")), ("tqdm", tqdm), ("tqdm.notebook", tqdm.notebook)):
        monkeypatch.setitem(sys.modules, name, module)
    line = Progress()
    line.show("rest  3/4", 0.25)
    line.show("load", 1.0)
    line.end()
    (bar,) = made
    assert bar.total == 1 and bar.seen == [0.25, 1.0] and bar.words == ["rest 3/4", "load"] and bar.closed
    monkeypatch.delitem(sys.modules, "ipykernel")
    Progress().show("rest", 0.5)  # neither a notebook nor a terminal
    assert len(made) == 1 and capsys.readouterr().err == ""


def test_without_pandas_the_error_says_what_to_install():
    done = python("""
import sys
sys.modules["pandas"] = None
import grainfield as gf
try:
    gf.packing([0], [0], 1, mass=1).to_pandas()
except ImportError as error:
    print(error)
""")
    assert done.stdout == "this needs pandas, which is not installed (Debian: python3-pandas)\n", done.stderr

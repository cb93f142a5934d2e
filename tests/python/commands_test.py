"""Every function gives what the command of its name gives, to the bit, and refuses with its words."""

import json
import os
import subprocess
import warnings

import numpy as np
import pytest

import grainfield as gf
from scene import ETA, MU, PROGRAM, RHO_G, SLOPE, error_of, heap, program, python, same, same_summary

HEAPS = [heap(seed) for seed in (1, 2, 3)]


@pytest.fixture(scope="module")
def file(tmp_path_factory):
    path = tmp_path_factory.mktemp("heaps") / "heaps.h5"
    gf.write(path, {f"heap_{k}": one for k, one in enumerate(HEAPS)})
    return path


@pytest.mark.parametrize(
    "options, given",
    [
        (["--grid", "21x9"], {"grid": (21, 9)}),
        (["--cuts", "0.05,0.3", "--kernel", "gaussian", "--width", "0.012"],
         {"cuts": [0.05, 0.3], "kernel": "gaussian", "width": 0.012}),
        (["--grid", "9x5", "--method", "particle_centre", "--quantities", "sigma,density", "--threads", "2"],
         {"grid": "9x5", "method": "particle_centre", "quantities": ["sigma", "density"], "threads": 2}),
    ],
)
def test_average(file, tmp_path, options, given):
    program("average", file, "--frame", "heap", *options, "-o", tmp_path / "f.h5")
    there = gf.read(tmp_path / "f.h5")
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        here, of_file = (gf.average(source, frame="heap", **given) for source in (HEAPS, str(file)))
    same(here, there)
    same(of_file, there)
    assert here.attributes == there.attributes and here.shape == there.shape
    assert here.realizations == 3
    for name in here.columns:
        if here.samples(name) is not None:
            np.testing.assert_array_equal(here.samples(name), there.samples(name))


def test_average_finds_the_stress_that_was_put_in():
    there = np.array([[-0.3, -0.6], [0.0, -0.5], [0.4, -0.75]])
    field = gf.average(HEAPS, frame="heap", points=there, width=0.015)
    stress = gf.model("osl", phi_deg=SLOPE, rho_g=RHO_G, eta=ETA, mu=MU)
    height = field.attributes["heap.h"][0]
    # The contacts' noise of 5 % (standard deviation), over some hundred of them.
    np.testing.assert_allclose(field.stress, stress(there * height), atol=0.015 * RHO_G * height)
    assert (field.error("sigma_yy") > 0).all()


@pytest.mark.parametrize("options, given", [
    (["--grid", "4x3x3"], {"grid": (4, 3, 3)}),
    (["--grid", "4x5", "--rings", "--axis", "0.02,0.02"], {"grid": (4, 5), "rings": True, "axis": (0.02, 0.02)}),
])
def test_average_in_space(tmp_path, options, given):
    d, n = 0.01, 5
    k = np.stack(np.unravel_index(np.arange(n**3), (n, n, n)), axis=1)
    places = d * (k + 0.5)
    i = np.concatenate([np.flatnonzero(k[:, a] < n - 1) for a in range(3)])
    step = np.repeat([n * n, n, 1], n * n * (n - 1))
    force = 2.5  # N on every bond: the pressure of the lattice is F/d^2
    bond = (places[i + step] - places[i]) / d
    spheres = gf.packing(*places.T[:2], d / 2, places[:, 2], density=2500, gravity=(0, 0, -9.81),
                         contacts={"i": i, "j": i + step, "forces": -force * bond})
    here = gf.average(spheres, frame="packing", width=0.008, **given)
    gf.write(f"{tmp_path / 'p.h5'}:s", spheres)
    program("average", tmp_path / "p.h5", "--frame", "packing", "--width", "0.008", *options, "-o", tmp_path / "f.h5")
    same(here, gf.read(tmp_path / "f.h5"))
    middle = gf.average(spheres, frame="packing", points=[[n * d / 2] * 3], width=0.008)
    np.testing.assert_allclose(middle.stress[0], -force / d**2 * np.array([1, 1, 1, 0, 0, 0]), rtol=0.01, atol=1e-6 * force / d**2)


def loaded_pair():
    """Two grains on a floor, the upper one without and with 3 N on it."""
    weight = 9.81
    def state(load):
        return gf.packing(
            [0, 0, 0.02], [0.01, 0.03, 0.01], 0.01, mass=1, walls=["floor:y=0"], friction=0.5,
            contacts={"i": [0, 0, 2], "j": ["floor", "1", "floor"],
                      "forces": [[0, 2 * weight + load], [0, -weight - load], [0, weight]]},
            load=(1, (0, -3)) if load else None)
    return state(0), state(3)


def test_response(tmp_path):
    before, after = loaded_pair()
    gf.write(tmp_path / "p.h5", {"a/unloaded": before, "a/loaded": after})
    program("average", tmp_path / "p.h5", "--response", "--grid", "7x5", "--least-grains", "1",
            "-o", tmp_path / "f.h5")
    here = gf.average(after, unloaded=before, grid=(7, 5), least_grains=1)
    there = gf.read(tmp_path / "f.h5")
    same(here, there["response"])
    same(here.beside["base_response"], there["base_response"])
    base = here.beside["base_response"]
    x = base.points[:, 0]
    assert here.attributes["F"] == 3
    carried = -np.sum((base.sigma_yy[1:] + base.sigma_yy[:-1]) / 2 * np.diff(x))
    assert carried <= 3.0001  # the base's line may end before the kernel does


@pytest.mark.parametrize("measure", ["cambou", "kernel"])
def test_strain_is_affine(file, tmp_path, measure):
    before = HEAPS[0]
    gradient = np.array([[1e-4, 3e-4], [-2e-4, -5e-4]])
    moved = before.positions + before.positions @ gradient.T
    after = gf.packing(moved[:, 0], moved[:, 1], before.radii, mass=before.masses, walls="floor:y=0")
    here = gf.strain(before, after, frame="packing", grid=(7, 4), measure=measure)
    got = np.isfinite(here.strain_xx)
    assert got.sum() > 5
    for name, value in (("du_x_dx", 1e-4), ("du_x_dy", 3e-4), ("du_y_dx", -2e-4), ("du_y_dy", -5e-4)):
        np.testing.assert_allclose(here[name][got], value, rtol=1e-8)
    gf.write(tmp_path / "s.h5", {"before": before, "after": after})
    program("strain", f"{tmp_path / 's.h5'}:before", f"{tmp_path / 's.h5'}:after", "--frame", "packing",
            "--grid", "7x4", "--measure", measure, "-o", tmp_path / "f.h5")
    same(here, gf.read(tmp_path / "f.h5"))


def test_structure(file, tmp_path):
    made = gf.structure(HEAPS[1])
    text = program("structure", f"{file}:heap_1", "-o", tmp_path / "s")
    assert f"{made.grains_counted} free grains, {made.rattlers} rattlers" in text
    assert f"coordination: {made.coordination:.4g}; without rattlers {made.coordination_bearing:.4g}" in text
    table = gf.read(tmp_path / "s" / "grains.csv")
    for name in made.grains:
        np.testing.assert_array_equal(made.grains[name], table[name], err_msg=name)
    base = gf.read(tmp_path / "s" / "base_forces.csv")
    np.testing.assert_array_equal(made.base["force"], base["force"])
    assert made.base["force"].sum() == pytest.approx(9.81 * HEAPS[1].masses.sum(), rel=0.05)
    counts = gf.read(tmp_path / "s" / "coordination.csv")
    np.testing.assert_array_equal(made.grains_with_contacts, counts["grains"])
    for chain in made.chains:
        assert len(chain) >= 3 and (made.grains["chain"][chain] == made.grains["chain"][chain[0]]).all()


def test_model(tmp_path):
    points = np.stack([np.linspace(-0.3, 0.3, 13), np.full(13, -0.1)], axis=1)
    np.savetxt(tmp_path / "p.csv", points, delimiter=",", header="x,y", comments="")
    layer = gf.model("layer", F=300, h=0.15, nu=0.3, base="rough")
    stress = layer(points)
    program("model", "layer", "--set", "F=300", "--set", "h=0.15", "--set", "nu=0.3", "--set", "base=rough",
            "--points", tmp_path / "p.csv", "-o", tmp_path / "s.csv")
    table = gf.read(tmp_path / "s.csv")
    for k, name in enumerate(layer.components):
        np.testing.assert_array_equal(stress[:, k], table[name])
    # Flamant's closed form: sigma_r = 2 F cos(theta)/(pi r), downwards.
    flamant = gf.model("flamant", F=2)([[0, -0.5]])
    np.testing.assert_allclose(flamant, [[0, -2 * 2 / (np.pi * 0.5), 0]], atol=1e-12)
    assert np.isnan(layer([[0, -0.2]])).all()
    space = gf.model("boussinesq", F=1)
    assert space.dim == 3 and space([[0.1, 0, -0.2]]).shape == (1, 6)
    assert gf.models()["layer"]["parameters"]["h"]["unit"] == "m"


def test_finite_elements_are_loaded_by_the_module():
    points = [[0.0, -0.5], [0.4, -0.5]]
    layer = gf.model("fe_elastic_layer", F=1, h=1, tolerance=0.01)
    np.testing.assert_allclose(layer(points), gf.model("layer", F=1, h=1)(points), atol=0.02)
    assert layer.figures["unknowns"] > 100
    failed = ["fe_elastic_layer", "--set", "iterations=1"]
    with pytest.raises(RuntimeError) as error:
        gf.model("fe_elastic_layer", iterations=1)(points)
    assert str(error.value) == program_at(points, failed, code=3)


def program_at(points, options, code):
    import tempfile

    with tempfile.NamedTemporaryFile("w", suffix=".csv") as file:
        file.write("x,y\n" + "".join(f"{x},{y}\n" for x, y in points))
        file.flush()
        return program("model", *options, "--points", file.name, code=code)


def summary_of(folder):
    return json.loads((folder / "summary.json").read_text())


def test_fit_gives_back_the_constants(file, tmp_path):
    models = ["osl", "bcc"]
    here = gf.fit(HEAPS, models, heights=[0.15, 0.3], set={"fit.bootstrap": 20})
    program("fit", file, "--model", "osl", "--model", "bcc", "--heights", "0.15,0.3", "--set",
            "fit.bootstrap=20", "-o", tmp_path / "f")
    # These name the packings.
    same_summary(here.summary, summary_of(tmp_path / "f"), "case.hash", "fit.warnings")
    same_table(here.profiles, gf.read(tmp_path / "f" / "profiles.csv"))
    for name, true in (("eta", ETA), ("mu", MU)):
        value, error = here.constants["osl"][name]
        assert 0 < error < 0.01
        assert abs(value - true) < 0.02, name  # 25 rows of grains: the steps of the surface count
    assert here.folder is None and "osl" in here.verdict.lower()
    with open(tmp_path / "f" / "verdict.json", encoding="utf-8") as written:
        assert here.judgement.to_dict() == dict(here.judgement) == json.load(written)
    assert str(here.judgement) == (tmp_path / "f" / "verdict.md").read_text()
    assert here.judgement.latex() == (tmp_path / "f" / "verdict.tex").read_text()
    for name, fit in here.fits.items():
        for one in fit.parameters:
            key = f"fit.{name}.{one.name}"
            assert here.constants[name][one.name] == (one.value, one.error)
            assert (one.value, one.error, one.bootstrap_error, one.jackknife_error) == tuple(
                here.summary[key + end] for end in ("", ".error", ".bootstrap_error", ".jackknife_error"))
            assert one.low < one.value < one.high and one.unit == "-" and one.meaning
        assert fit.chi2_per_dof == here.summary[f"fit.{name}.chi2_per_dof"]
        assert fit.correlation.shape == (len(fit.parameters),) * 2


def same_table(here, there):
    """As far as a CSV file holds it, nine digits; names, units and comments in full."""
    assert list(here) == list(there) and here.units == there.units and here.notes == there.notes
    for name, values in here.items():
        if name == "profile":
            assert values.tolist() == there[name].tolist()
        else:
            np.testing.assert_array_equal([float(f"{value:.9g}") for value in values], there[name])


def test_a_judgement_is_an_object(file):
    here = gf.fit(HEAPS, ["osl", "bcc"], heights=[0.15, 0.3], set={"fit.bootstrap": 0}).judgement
    first, second = here.models
    assert first.name == here.best == here["best_model"] == "osl" and first.supported == "yes"
    assert first.behind == 0 and second.behind > 0 and second.distinguishable == "yes"
    assert first.distinguishable == here["models"][0]["distinguishable"] == "reference"
    assert here.realizations == 3 and here.headlines[0] in str(here) and here.headlines[0] in repr(here)
    for model, row in zip(here["models"], here.models):
        for name, value in model.items():
            there = getattr(row, name)
            assert value == there or value is None and not np.isfinite(there), name
    table = here.table
    assert len(table["model"]) == 2 and list(table.rows())[0]["model"] == first.label
    assert table["distinguishable"].tolist() == ["-", "yes"] and "Chance: threshold" in table.notes[0]
    assert table.notes[0] in str(here) and table.notes[0] in here._repr_html_().replace("&#x27;", "'")
    assert len(here.power) > 0 and list(here) == list(here.to_dict())


def test_without_a_folder_nothing_is_written(tmp_path):
    done = python(f"""
import os, sys
sys.path.insert(0, {os.path.dirname(__file__)!r})
os.environ["TMPDIR"] = {str(tmp_path)!r}
os.chdir({str(tmp_path)!r})
import grainfield as gf
from scene import heap
fit = gf.fit([heap(1), heap(2)], ["bcc"], heights=[0.2], set={{"fit.bootstrap": 0}})
field = gf.average([heap(1), heap(2)], frame="heap", cuts=[0.2])
print(fit.folder, gf.compare(field, "bcc").folder, os.listdir({str(tmp_path)!r}))
""")
    assert done.stdout == "None None []\n", done.stderr

def test_compare(tmp_path):
    field = gf.average(HEAPS, frame="heap", cuts=[0.1, 0.3])
    models = {"true": f"osl:eta={ETA},mu={MU}", "other": gf.model("ife")}
    gf.write(tmp_path / "f.h5", field)
    program("compare", tmp_path / "f.h5", "--model", f"true=osl:eta={ETA},mu={MU}", "--model", "other=ife",
            "-o", tmp_path / "c")
    there = summary_of(tmp_path / "c")
    for here in (gf.compare(field, models), gf.compare(tmp_path / "f.h5", models, folder=tmp_path / "d")):
        same_summary(here.summary, there)
        same_table(here.profiles, gf.read(tmp_path / "c" / "profiles.csv"))
        assert here.measures["true"]["rel_l2"] < here.measures["other"]["rel_l2"]
        for label, one in here.measures.items():
            for name, value in one.items():
                assert value == there[f"compare.{label}.{name}"], name
        assert here.verdict == there["verdict.sentence"]
        assert here.verdict.startswith(here.judgement["headlines"][0])
    assert (tmp_path / "d" / "report.html").exists()


def test_warnings_are_those_of_the_program(tmp_path):
    bare = gf.packing(HEAPS[0].positions[:, 0], HEAPS[0].positions[:, 1], HEAPS[0].radii, mass=1, walls="floor:y=0")
    gf.write(f"{tmp_path / 'p.h5'}:bare", bare)
    done = subprocess.run([PROGRAM, "average", tmp_path / "p.h5", "--grid", "5x4", "-o", tmp_path / "f.h5"],
                          capture_output=True, text=True)
    with pytest.warns(UserWarning, match="has no contacts: stress and fabric are 0") as told:
        field = gf.average(f"{tmp_path / 'p.h5'}:bare", grid=(5, 4))
    lines = [line.removeprefix("grainfield: ").removeprefix("warning: ") for line in done.stderr.splitlines()]
    ours = [text.replace(":bare", ":/bare") for text in [*field.warnings, *field.gaps]]
    assert ours == lines and [str(one.message) for one in told] == field.warnings and len(field.gaps) == 2


def test_measured_fields(tmp_path):
    x = np.linspace(-100, 100, 15)
    stress = gf.model("osl", phi_deg=30, rho_g=15000, eta=ETA, mu=MU)(np.stack([x / 1000, 0 * x - 0.08], axis=1))
    table = tmp_path / "m.csv"
    table.write_text("x (mm),component,value (kPa),error (kPa)\n" + "".join(
        f"{place},pressure,{-one[1] / 1000},0.01\n{place},shear,{one[2] / 1000},0.01\n"
        for place, one in zip(x, stress)))
    here = gf.import_field(table, height=0.08, slope=30, rho_g=15000)
    program("import-field", table, "--height", "0.08", "--slope", "30", "--rho-g", "15000", "-o", tmp_path / "f.h5")
    same(here, gf.read(tmp_path / "f.h5"))
    assert here.name == "base"
    np.testing.assert_allclose(here.sigma_yy, stress[:, 1], rtol=1e-12)
    fit = gf.fit(here, ["osl", "bcc"], heights=[0], components=["sigma_yy", "sigma_xy"])
    assert fit._of == gf.compare(here, "bcc")._of == "measured"
    for name, true in (("eta", ETA), ("mu", MU)):
        value, error = fit.constants["osl"][name]
        assert abs(value - true) < 0.1 * error  # without noise: only the cells' width is left
    with pytest.warns(UserWarning, match="base: errors are 1e-05 times their values .*: is their unit right?"):
        small = tmp_path / "small.csv"
        small.write_text("x (mm),component,value (kPa),error (Pa)\n" + "".join(
            f"{place},pressure,1,0.01\n" for place in x))
        gf.import_field(small, height=0.08, slope=30, rho_g=15000)
    assert error_of(lambda: gf.import_field(table, height=0.08, slope=30)) == program(
        "import-field", table, "--height", "0.08", "--slope", "30", "-o", tmp_path / "f.h5", code=2)


def test_mistakes_have_the_words_of_the_program(file, tmp_path):
    one = f"{file}:heap_0"
    out = ["-o", tmp_path / "o.h5"]
    for call, command in [
        (lambda: gf.average(one, width=-1), ["average", one, "--width", "-1", *out]),
        (lambda: gf.average(one, grid="4"), ["average", one, "--grid", "4", *out]),
        (lambda: gf.average(one, cuts=[2]), ["average", one, "--cuts", "2", *out]),
        (lambda: gf.average(one, frame="heep"), ["average", one, "--frame", "heep", *out]),
        (lambda: gf.average(one, kernel="lucky"), ["average", one, "--kernel", "lucky", *out]),
        (lambda: gf.average(one, rings=True), ["average", one, "--rings", *out]),
        (lambda: gf.average(str(file), response=True), ["average", file, "--response", *out]),
        (lambda: gf.strain(one, one, measure="cambo"), ["strain", one, one, "--measure", "cambo", *out]),
        (lambda: gf.model("layr"), ["model", "layr", "--list"]),
        (lambda: gf.model("layer", h="-1")([[0, 0]]), None),
        (lambda: gf.fit(one, "ols"), ["fit", one, "--model", "ols", "-o", tmp_path / "f"]),
        (lambda: gf.fit(one, set={"fit.hight": 1}), ["fit", one, "--set", "fit.hight=1", "-o", tmp_path / "f"]),
        (lambda: gf.compare(one, "osl"), ["compare", one, "--model", "osl", "-o", tmp_path / "c"]),
        (lambda: gf.run("no-such-case"), ["run", "no-such-case"]),
    ]:
        text = error_of(call)
        assert "\n" not in text and text
        if command:
            assert text == program(*command, code=2)
    assert error_of(lambda: gf.average(HEAPS[0], points=[[0, 0, 0]])) == (
        "points: found 3 columns, allowed: 2 (the packing is 2D)")
    assert error_of(lambda: gf.model("flamant")([[0, 0, 0]])) == (
        "points: found 3 columns, allowed: 2 (flamant is 2D here)")
    with pytest.raises(ValueError, match="/proc/nowhere is not a folder"):
        gf.write("/proc/nowhere/p.h5", HEAPS[0])


def test_a_full_disk_is_an_oserror(tmp_path):
    done = python(f"""
import resource
import grainfield as gf
packing = gf.packing([0.0] * 4000, [0.02 * k for k in range(4000)], 0.01, density=1)
resource.setrlimit(resource.RLIMIT_FSIZE, (20000, 20000))
try:
    gf.write({str(tmp_path / 'p.h5')!r}, packing)
except OSError as error:
    print(type(error).__name__, error)
""")
    assert done.stdout.startswith("OSError") and str(tmp_path) in done.stdout, done.stderr
    assert not (tmp_path / "p.h5").exists()

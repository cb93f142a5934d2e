"""The script of docs/python.md runs, and its numbers are those of the commands."""

import inspect
import json
import runpy
import sys
import textwrap
import warnings

import numpy as np

import grainfield as gf
from scene import ETA, ROOT, error_of, heap_arrays, import_dumps, program, same, same_summary, write_dumps

SCRIPT = ROOT / "docs/examples/lammps_heaps.py"


def test_the_script_gives_what_the_commands_give(tmp_path, monkeypatch):
    files = [write_dumps(tmp_path, seed) for seed in (1, 2, 3)]
    monkeypatch.setattr(sys, "argv", ["", str(tmp_path / "fit.png"), *(str(f) for pair in files for f in pair)])
    made = runpy.run_path(str(SCRIPT))
    assert (tmp_path / "fit.png").stat().st_size > 5000
    import_dumps(tmp_path / "heaps.h5", files)
    program("average", tmp_path / "heaps.h5", "--frame", "heap", "--cuts", "0.05,0.2", "-o", tmp_path / "f.h5")
    same(made["stress"], gf.read(tmp_path / "f.h5"))
    program("fit", tmp_path / "heaps.h5", "--model", "osl", "--model", "bcc", "--heights", "0.2",
            "-o", tmp_path / "fit")
    there = json.loads((tmp_path / "fit" / "summary.json").read_text())
    same_summary(made["fit"].summary, there, "case.hash", "fit.warnings")  # these name the packings
    assert abs(made["fit"].constants["osl"]["eta"][0] - ETA) < 0.01


def test_the_script_is_short_and_stands_on_the_page():
    text = SCRIPT.read_text()
    lines = [line for line in text.splitlines() if line.strip()]
    assert len(lines) < 25
    assert text in (ROOT / "docs/python.md").read_text()


def test_the_strip_footing_of_the_page(capsys):
    script = ROOT / "docs/examples/strip_footing.py"
    made = runpy.run_path(str(script))
    page = (ROOT / "docs/geotechnical.md").read_text()
    assert script.read_text() in page and capsys.readouterr().out in page
    # The textbook's strip on a half space: q (alpha + sin alpha)/pi below its middle.
    alpha = 2 * np.arctan(made["width"] / 2 / -made["below"])
    strip = made["pressure"] / np.pi * (alpha + np.sin(alpha))
    deep = made["below"] < -0.5
    assert np.abs(made["half_plane"][deep, 1] + strip[deep]).max() < 1e-3 * made["pressure"]
    # A uniform pressure on a wide strip: the layer is in uniaxial strain.
    e, nu = made["young"], made["poisson"]
    wide = (1 + nu) * (1 - 2 * nu) / (1 - nu) * made["pressure"] * made["depth"] / e
    assert 0.5 * wide < made["settlement"] < wide


def example_of(text):
    """The indented lines of a help text."""
    lines = text.splitlines()
    return textwrap.dedent("\n".join(line for line in lines if line.startswith("    ")))


def test_what_help_shows_runs(capsys):
    a = heap_arrays(1)
    names = {name: a[name] for name in ("x", "y", "radius", "i", "j", "forces", "points")}
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # without contacts of the floor
        exec(example_of(gf.__doc__), names)
        assert "osl is nearest" in capsys.readouterr().out and names["fit"].profiles["profile"][0].startswith("sigma_xx")
        told = inspect.getdoc(gf.Engine)
        names |= {"packing": gf.packing(a["x"], a["y"], a["radius"], density=2500, walls="floor:y=0", friction=0.3)}
        exec(example_of(told).replace("20000", "20").replace("> 1e-3", "> 1e9"), names)
    assert repr(names["engine"]).startswith(f"<Engine: 2D, {len(a['x'])} grains, 20 steps of ")
    assert error_of(lambda: gf.fit(names["packing"])) == (
        "packing:0: has no contacts, so no stress; add them with their forces, or let the engine settle it")

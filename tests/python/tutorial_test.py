"""The script of docs/python.md runs, and its numbers are those of the commands."""

import json
import runpy
import sys

import numpy as np

import grainfield as gf
from scene import ETA, ROOT, import_dumps, program, same, same_summary, write_dumps

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

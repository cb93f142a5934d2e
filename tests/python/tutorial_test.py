"""The script of docs/python.md runs, and its numbers are those of the commands."""

import json
import runpy
import sys

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

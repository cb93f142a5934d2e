#!/usr/bin/python3
"""The picture of docs/python.md: draw_lammps_heaps.py PICTURE, with the module of build/release/python."""

import os
import runpy
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path[:0] = [str(Path(__file__).parent), str(ROOT / "build/release/python")]
os.environ["MPLBACKEND"] = "Agg"

from scene import write_dumps  # noqa: E402

with tempfile.TemporaryDirectory() as folder:
    files = [str(file) for seed in (1, 2, 3) for file in write_dumps(Path(folder), seed)]
    sys.argv = ["lammps_heaps.py", sys.argv[1], *files]
    runpy.run_path(str(ROOT / "docs/examples/lammps_heaps.py"))

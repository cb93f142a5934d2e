"""The types that editors and mypy see are those of the module."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

import grainfield as gf

pytest.importorskip("mypy")

SCRIPT = """
import numpy as np
import grainfield as gf

packing = gf.packing([0.0], [0.0], 1.0, density=1000)
field = gf.average(packing, frame="packing", grid=(5, 5))
values: np.ndarray = field["sigma_yy"]
verdict: str = gf.fit([packing], ["osl"]).verdict
"""


def mypy(module, *arguments, folder):
    """Its exit code and what it prints; the cache is in the folder."""
    here = str(Path(gf.__file__).parents[1])
    place = os.environ | {"MYPYPATH": here, "PYTHONPATH": here, "MYPY_CACHE_DIR": str(folder / "cache")}
    done = subprocess.run([sys.executable, "-m", module, *map(str, arguments)], cwd=folder, env=place, capture_output=True, text=True)
    return done.returncode, done.stdout + done.stderr


def test_the_stub_has_every_function_of_the_core(tmp_path):
    (tmp_path / "allowed").write_text(r"grainfield\._core\.[A-Z]\w*(\.__init__)?" + "\n")  # metaclass of pybind11
    (tmp_path / "mypy.ini").write_text("[mypy]\n[mypy-grainfield.*]\nfollow_imports = silent\n")
    code, said = mypy("mypy.stubtest", "--mypy-config-file", "mypy.ini", "--allowlist", "allowed", "grainfield._core",
                      folder=tmp_path)
    assert code == 0, said


def test_the_package_is_sound_and_a_users_mistake_is_seen(tmp_path):
    (tmp_path / "mypy.ini").write_text("[mypy]\n[mypy-matplotlib.*,tqdm.*]\nignore_missing_imports = True\n")
    code, said = mypy("mypy", "-p", "grainfield", folder=tmp_path)
    assert code == 0, said
    (tmp_path / "good.py").write_text(SCRIPT)
    (tmp_path / "bad.py").write_text(SCRIPT.replace('grid=(5, 5)', 'widht=0.1').replace("verdict: str", "verdict: int"))
    code, said = mypy("mypy", "--follow-imports=silent", "good.py", folder=tmp_path)
    assert code == 0, said
    code, said = mypy("mypy", "--follow-imports=silent", "bad.py", folder=tmp_path)
    assert code == 1 and '"widht" for "average"' in said and 'variable has type "int"' in said, said

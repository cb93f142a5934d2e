"""The notebooks of docs/examples run, are short and are stored without outputs."""

import re
import shutil
import sys
from pathlib import Path

import pytest

from scene import PROGRAM, ROOT

import grainfield as gf

nbformat = pytest.importorskip("nbformat")
pytest.importorskip("ipykernel")
pytest.importorskip("matplotlib")
execute = pytest.importorskip("nbconvert.preprocessors").ExecutePreprocessor

EXAMPLES = ROOT / "docs/examples"
BOOKS = sorted(path.stem for path in EXAMPLES.glob("*.ipynb"))


def code_of(book):
    return [cell for cell in book.cells if cell.cell_type == "code"]


def run(name, folder, monkeypatch):
    """The executed notebook, at a copy of its folder, and all it prints."""
    shutil.copytree(EXAMPLES, folder / "examples", ignore=shutil.ignore_patterns("results"))
    monkeypatch.setenv("PYTHONPATH", str(Path(gf.__file__).parents[1]))
    monkeypatch.setenv("GRAINFIELD_PROGRAM", PROGRAM)
    monkeypatch.setenv("IPYTHONDIR", str(folder))
    monkeypatch.setenv("JUPYTER_DATA_DIR", str(folder))
    monkeypatch.delenv("MPLBACKEND", raising=False)  # pictures in the notebook
    spec = folder / "kernels/python3"
    spec.mkdir(parents=True)
    (spec / "kernel.json").write_text(
        '{"display_name": "Python 3", "language": "python", "argv": ["%s", "-m", "ipykernel_launcher", "-f", '
        '"{connection_file}"]}' % sys.executable)
    book = nbformat.read(EXAMPLES / f"{name}.ipynb", as_version=4)
    execute(timeout=120, kernel_name="python3").preprocess(book, {"metadata": {"path": str(folder / "examples")}})
    outputs = [output for cell in code_of(book) for output in cell.outputs]
    text = "".join(output.get("text", "") + "".join(output.get("data", {}).get("text/plain", "")) for output in outputs)
    pictures = sum("image/png" in output.get("data", {}) for output in outputs)
    return book, text, pictures


@pytest.mark.parametrize("name", BOOKS)
def test_notebooks_are_short_and_stored_without_outputs(name):
    book = nbformat.read(EXAMPLES / f"{name}.ipynb", as_version=4)
    lines = [line for cell in code_of(book) for line in cell.source.splitlines() if line.strip()]
    assert 5 < len(lines) < 40
    assert all(not cell.outputs and cell.execution_count is None for cell in code_of(book))
    assert book.cells[0].cell_type == "markdown" and book.cells[0].source.startswith("# ")


def test_heaps_of_lammps(tmp_path, monkeypatch):
    book, text, pictures = run("lammps_heap", tmp_path, monkeypatch)
    assert pictures == 3 and "weight carried by walls and fixed grains: 1\n" in text and "'osl': {'eta':" in text
    shown = [output.data.get("text/html", "") for cell in code_of(book) for output in cell.outputs if "data" in output]
    assert any("<table>" in one and "osl" in one for one in shown)


def test_own_measurement(tmp_path, monkeypatch):
    _, text, pictures = run("own_measurement", tmp_path, monkeypatch)
    eta, eta_error, mu, mu_error = map(float, re.search(r"eta = (\S+) \+- (\S+), mu = (\S+) \+- (\S+)", text).groups())
    assert pictures == 2 and abs(eta - 0.74) < 2.5 * eta_error < 0.1 and abs(mu + 0.31) < 2.5 * mu_error < 0.5


def test_point_load_in_space(tmp_path, monkeypatch):
    _, text, pictures = run("point_load_in_space", tmp_path, monkeypatch)
    assert pictures == 2 and "carried by the base, over the load: 0.99" in text


def test_calibration(tmp_path, monkeypatch):
    _, text, pictures = run("calibration", tmp_path, monkeypatch)
    friction, error = map(float, re.search(r"friction (\S+) \+- (\S+)", text).groups())
    assert pictures == 1 and 0.2 < friction < 0.32 and 0.02 < error < 0.15


def test_own_model(tmp_path, monkeypatch):
    _, text, pictures = run("own_model", tmp_path, monkeypatch)
    k, error = map(float, re.search(r"k = (\S+) \+- (\S+),", text).groups())
    assert pictures == 1 and 0.1 < k < 1 and 0 < error < 0.2

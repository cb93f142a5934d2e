"""Sweeps: the program side by side, resumed, and a table with errors."""

import importlib.util
import json
import os
import shutil
import signal
import subprocess
import sys
import threading
import time
import types
from concurrent.futures import ProcessPoolExecutor
from pathlib import Path

import numpy as np
import pytest

import grainfield as gf
from run_test import CASE
from scene import ROOT, error_of, program, same_summary

FRICTION = {"material.friction": [0.2, 0.5]}


@pytest.fixture(scope="module")
def case(tmp_path_factory):
    path = tmp_path_factory.mktemp("case") / "tiny.toml"
    path.write_text(CASE)
    return path


@pytest.fixture(scope="module")
def swept(case, tmp_path_factory):
    return gf.sweep(case, FRICTION, realizations=3, workers=2, folder=tmp_path_factory.mktemp("s") / "s")


def test_members_are_runs_of_the_program(case, swept, tmp_path):
    assert list(swept) == ["friction_0.2", "friction_0.5"] and swept.settings["friction_0.5"] == {"material.friction": 0.5}
    program("run", case, "--threads", "1", "--set", "ensemble.realizations=3", "--set", "material.friction=0.5", "-o", tmp_path / "r")
    same_summary(swept["friction_0.5"].summary, json.loads((tmp_path / "r" / "summary.json").read_text()))
    with pytest.raises(KeyError, match="no member friction_1; there are: friction_0.2, friction_0.5"):
        swept["friction_1"]


def test_the_table_has_errors(swept):
    table = swept.table("response.peak", "verdict.best_model")
    assert list(table) == ["material.friction", "response.peak", "response.peak_error", "verdict.best_model"]
    assert table["material.friction"].tolist() == [0.2, 0.5]
    for k, member in enumerate(swept.values()):
        assert table["response.peak"][k] == member.summary["response.peak"]
        assert table["response.peak_error"][k] == member.summary["response.peak.standard_error"] > 0
    assert table.units["response.peak"] == table.units["response.peak_error"] == "N/m (3D: Pa)"
    assert "response.peak" in swept.figures and "ensemble.seed" not in swept.figures
    assert set(swept.table()) == {"material.friction"} | set(swept.figures) | {f"{key}_error" for key in swept.figures}
    assert "material.friction" in swept._repr_html_() and len(swept.to_pandas()) == 2
    assert error_of(lambda: swept.table("response.peek")).startswith("table: no member has the figure response.peek")


MPI = """
import sys
import grainfield as gf
from mpi4py.futures import MPIPoolExecutor

if __name__ == "__main__":
    with MPIPoolExecutor() as workers:
        gf.sweep(sys.argv[1], {"material.friction": [0.2, 0.5]}, realizations=3, workers=workers, folder="s")
"""


def test_workers_of_dask_and_mpi4py(case, swept, tmp_path):
    """The lines of docs/python.md, where these are installed."""
    expected = swept.table("response.peak")["response.peak"]
    mpiexec = shutil.which("mpiexec")
    if mpiexec and importlib.util.find_spec("mpi4py"):
        (tmp_path / "mpi.py").write_text(MPI)
        allowed = {"OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1", "PYTHONPATH": str(Path(gf.__file__).parents[1])}
        done = subprocess.run([mpiexec, "--oversubscribe", "-n", "3", sys.executable, "-m", "mpi4py.futures", "mpi.py", str(case)],
                              cwd=tmp_path, env=os.environ | allowed, capture_output=True, text=True)
        assert done.returncode == 0, done.stderr
        there = gf.Sweep(tmp_path / "s", swept.settings).table("response.peak")
        np.testing.assert_array_equal(there["response.peak"], expected)
    distributed = pytest.importorskip("dask.distributed")
    with distributed.Client(n_workers=1, threads_per_worker=2, processes=False, dashboard_address=None) as client:
        other = gf.sweep(case, FRICTION, realizations=3, workers=client.get_executor(), folder=tmp_path / "d", progress=False)
    np.testing.assert_array_equal(other.table("response.peak")["response.peak"], expected)


class DynamicSystem:
    """What GrainLearning's system of this name has for a callback: (samples, parameters) in, (samples, observables,
    steps) out."""

    def __init__(self, param_data):
        self.param_data, self.sim_data = np.array(param_data), None

    def set_sim_data(self, data):
        self.sim_data = np.array(data)


def test_the_page_hands_over_to_grainlearning(case, tmp_path, monkeypatch):
    """The callback of docs/examples, with another case and figure, as a BayesianCalibration calls it."""
    page = (ROOT / "docs/examples/grainlearning.py").read_text()
    text = "def run_piles(" + page.partition("def run_piles(")[2]
    for theirs, ours in (("pile-line-source", str(case)), ("repose.mean_deg", "response.peak"), ("realizations=4", "realizations=2")):
        assert theirs in text
        text = text.replace(theirs, ours)
    monkeypatch.chdir(tmp_path)
    names = {"gf": gf, "__name__": "page"}
    exec(text, names)
    calibration = types.SimpleNamespace(system=DynamicSystem([[0.5], [0.2]]), curr_iter=1)
    names["run_piles"](calibration)
    done = gf.Sweep("repose/1", {f"friction_{value}": {"material.friction": value} for value in (0.5, 0.2)})
    assert calibration.system.sim_data.shape == (2, 1, 1)
    np.testing.assert_array_equal(calibration.system.sim_data[:, 0, 0], done.table("response.peak")["response.peak"])


def test_figures_are_drawn_with_errors(swept):
    pytest.importorskip("matplotlib")
    axes = swept.plot("response.peak")
    (line, _, bars), = axes.containers
    np.testing.assert_array_equal(line.get_xydata(), np.stack([[0.2, 0.5], swept.table("response.peak")["response.peak"]], axis=1))
    half = [np.ptp(path.vertices[:, 1]) / 2 for path in bars[0].get_paths()]
    assert half == pytest.approx(swept.table("response.peak")["response.peak_error"])
    assert axes.get_xlabel() == "material.friction" and axes.get_ylabel() == "response.peak, N/m (3D: Pa)"


def test_what_is_finished_is_taken_and_more_is_added(case, swept):
    before = {name: os.stat(f"{swept.folder}/{name}/summary.json").st_mtime_ns for name in swept}
    more = gf.sweep(case, {"material.friction": [0.2, 0.5, 0.8]}, realizations=3, threads=1, folder=swept.folder)
    assert list(more) == ["friction_0.2", "friction_0.5", "friction_0.8"]
    assert {name: os.stat(f"{swept.folder}/{name}/summary.json").st_mtime_ns for name in before} == before
    other = error_of(lambda: gf.sweep(case, FRICTION, realizations=2, folder=swept.folder))
    assert other == f"{swept.folder}: holds a sweep with another friction_0.2, allowed: the same, or another folder"
    quick = error_of(lambda: gf.sweep(case, FRICTION, realizations=3, quick=True, folder=swept.folder))
    assert "another quick" in quick


def test_ctrl_c_leaves_checkpoints_and_the_same_call_goes_on(case, swept, tmp_path):
    slow = dict(set={"load.ramp_time": 1.5}, realizations=2, workers=2, folder=tmp_path / "s")
    both = [tmp_path / "s" / name / "checkpoint" for name in ("friction_0.2", "friction_0.5")]

    def interrupt():
        while not all(folder.is_dir() for folder in both):
            time.sleep(0.005)
        os.kill(os.getpid(), signal.SIGINT)

    threading.Thread(target=interrupt).start()
    with pytest.raises(KeyboardInterrupt):
        gf.sweep(case, FRICTION, **slow)
    assert all(folder.is_dir() and not (folder.parent / "summary.json").exists() for folder in both)
    resumed = gf.sweep(case, FRICTION, **slow)
    program("run", case, "--threads", "1", "--set", "load.ramp_time=1.5", "--set", "ensemble.realizations=2",
            "--set", "material.friction=0.2", "-o", tmp_path / "r")
    same_summary(resumed["friction_0.2"].summary, json.loads((tmp_path / "r" / "summary.json").read_text()))


def test_combinations_and_executors(case, tmp_path):
    with ProcessPoolExecutor(1) as pool:
        swept = gf.sweep(case, {"material.friction": [0.3], "packing.rows": np.array([3, 4])}, realizations=1,
                         workers=pool, folder=tmp_path / "s", set={"average.map_columns": 3})
    assert list(swept) == ["friction_0.3,rows_3", "friction_0.3,rows_4"]
    table = swept.table("dem.grains")
    assert table["packing.rows"].tolist() == [3, 4] and np.isnan(table["dem.grains_error"]).all()
    assert table["dem.grains"][0] < table["dem.grains"][1]
    pairs = [{"packing.rows": 3, "load.force": 1.0}, {"packing.rows": 4, "load.force": 2.0}]
    assert list(gf.sweep(case, pairs, realizations=1, threads=1, folder=tmp_path / "p")) == ["rows_3,force_1.0", "rows_4,force_2.0"]


def test_mistakes_are_told_before_anything_runs(case, tmp_path):
    def refused(values, **options):
        text = error_of(lambda: gf.sweep(case, values, folder=tmp_path / "s", **options))
        assert not (tmp_path / "s").exists()
        return text

    assert refused({"material.friction": 0.3}) == (
        "sweep: found 0.3 for material.friction, allowed: a list of values, such as [0.3]")
    assert "material.friction: found -1" in refused({"material.friction": [0.3, -1]})
    assert refused({"material.friction": [0.3, 0.3]}) == (
        "sweep: found the member friction_0.3 twice, allowed: every combination of values once")
    assert "did you mean material.friction?" in refused({"material.frict": [1]})
    assert refused([]).startswith("sweep: found no values")
    assert refused(FRICTION, workers=0) == "workers: found 0, allowed: 1 or more"
    (tmp_path / "mine").mkdir()
    (tmp_path / "mine" / "notes.txt").write_text("mine")
    assert "holds files and no sweep.json" in error_of(lambda: gf.sweep(case, FRICTION, folder=tmp_path / "mine"))


def test_a_member_that_fails_lets_the_others_finish(case, tmp_path):
    with pytest.raises(RuntimeError, match="^max_time_1e-06: .*rest") as error:
        gf.sweep(case, {"rest.max_time": [1e-6, 20.0]}, realizations=1, threads=1, folder=tmp_path / "s")
    assert error.value.__cause__ is not None
    assert (tmp_path / "s" / "max_time_20.0" / "summary.json").exists()

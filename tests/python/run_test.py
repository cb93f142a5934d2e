"""Runs: the program's results, progress, and Ctrl-C with resume."""

import json
import os
import signal

import numpy as np
import pytest

import grainfield as gf
from scene import error_of, program, same_summary

CASE = """title = "tiny"
[packing]
kind = "triangular"
sizes = "mono"
columns = 7
rows = 3
jitter = 0.02
[rest]
background_damping = 300
unbalanced_force_ratio = 1e-4
kinetic_to_elastic_energy = 1e-7
[load]
force = 1
ramp_time = 0.01
[ensemble]
realizations = 2
[average]
methods = ["coarse_graining"]
depths = [0.5]
points = 11
map_columns = 5
map_rows = 4
[compare]
models = ["flamant"]
[output]
report = false
[quick.ensemble]
realizations = 1
"""


@pytest.fixture(scope="module")
def case(tmp_path_factory):
    path = tmp_path_factory.mktemp("case") / "tiny.toml"
    path.write_text(CASE)
    return path


def test_a_run_leaves_what_the_program_leaves(case, tmp_path):
    seen, notes = [], []
    sets = {"material.friction": 0.25}
    result = gf.run(case, tmp_path / "here", set=sets, threads=1, progress=seen.append, note=notes.append)
    program("run", case, "--set", "material.friction=0.25", "--threads", "2", "-o", tmp_path / "there")
    same_summary(result.summary, json.loads((tmp_path / "there" / "summary.json").read_text()))
    there = gf.read(tmp_path / "there")
    assert list(result.fields) == list(there.fields)
    for name in result.fields:
        for column in result.fields[name].columns:
            np.testing.assert_array_equal(result.fields[name][column], there.fields[name][column])
    state = result.snapshots["realization_001/loaded"]
    np.testing.assert_array_equal(state.contacts.forces, there.snapshots["realization_001/loaded"].contacts.forces)
    assert seen[-1]["fraction"] == pytest.approx(1) and seen[-1]["done"] == 2 and notes
    assert result.verdict == result.summary["verdict.sentence"] and "flamant" in result.profiles
    assert result.summary.units["layer.depth"] == "m"


def test_ctrl_c_leaves_a_checkpoint_and_resume_ends_in_the_same_bits(case, tmp_path):
    def stop(progress):
        os.kill(os.getpid(), signal.SIGINT)

    slow = {"load.ramp_time": 0.3}
    with pytest.raises(KeyboardInterrupt, match="--resume"):
        gf.run(case, tmp_path / "r", set=slow, threads=1, progress=stop, checkpoint_seconds=0)
    assert "resume" in error_of(lambda: gf.run(case, tmp_path / "r", set=slow))
    resumed = gf.run(case, tmp_path / "r", set=slow, resume=True)
    whole = gf.run(case, tmp_path / "w", set=slow)
    same_summary(resumed.summary, whole.summary)


def test_an_exception_of_the_callback_stops_the_run(case, tmp_path):
    def fail(progress):
        raise LookupError("mine")

    with pytest.raises(LookupError, match="mine"):
        gf.run(case, tmp_path / "r", threads=1, progress=fail)
    assert not (tmp_path / "r" / "summary.json").exists()


def test_one_run_at_a_time(case, tmp_path):
    def another(progress):
        gf.run(case, tmp_path / "s")

    with pytest.raises(RuntimeError, match="another run is going on in this process"):
        gf.run(case, tmp_path / "r", threads=1, progress=another)
    packing = gf.packing([0], [0], 1, mass=1)
    with pytest.raises(RuntimeError, match="files of HDF5 are not read or written while a run goes on"):
        gf.run(case, tmp_path / "r", threads=1, resume=True, progress=lambda _: gf.write(tmp_path / "p.h5", packing))
    assert gf.run(case, tmp_path / "t", threads=1).summary["ensemble.realizations"] == 2


def test_shipped_cases_have_names():
    assert gf.cases()["point-load-mono"].endswith("point-load-mono.toml")
    assert "did you mean point-load-mono" in error_of(lambda: gf.run("point-load-mno"))


def test_tables_of_numbers_open_in_h5py(tmp_path):
    h5py = pytest.importorskip("h5py")
    program("run", "implicit-settling", "--quick", "-o", tmp_path / "out", "--set", "lattice.base_grains=5",
            "--set", 'sweep.values=["wells"]', "--set", "output.report=false")
    folder = next((tmp_path / "out").rglob("history.csv")).parent
    history = np.genfromtxt(folder / "history.csv", delimiter=",", names=True)
    file = folder / "snapshots.h5"
    with h5py.File(file) as opened:
        groups = []
        opened.visit(lambda name: groups.append(name) if name.endswith("tables/settling") else None)
        group = opened[groups[0]]
        frame = {name: data[()] for name, data in group.items()}  # what pandas.DataFrame takes
        assert group["time"].attrs["unit"] in ("1", b"1")
    assert set(frame) == set(history.dtype.names)
    assert {len(values) for values in frame.values()} == {len(history)}
    for name in frame:
        np.testing.assert_allclose(frame[name], history[name], rtol=1e-8, atol=1e-300)
    state = groups[0].removesuffix("/tables/settling")
    table = gf.read(f"{file}:{state}").tables["settling"]
    np.testing.assert_array_equal(table["kinetic"], frame["kinetic"])

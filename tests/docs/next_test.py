"""What docs/reproduction/runs/next.py commits of a run, by a program that stands in for grainfield."""
import json
import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
SCRIPT = "docs/reproduction/runs/next.py"
KEPT = "docs/reproduction/states/layers"
#: Writes the results of a run with its folder in the verdict, and ends with the number of the setting "ends".
PROGRAM = """#!/usr/bin/python3
import json, pathlib, sys
words = sys.argv[1:]
folder = pathlib.Path(words[words.index("-o") + 1])
settings = dict(one.split("=", 1) for at, one in enumerate(words) if words[at - 1] == "--set")
print("no equilibrium" if settings["ends"] == "3" else "rests", words[:2],
      words[words.index("--threads") + 1], flush=True)
value = folder / "deep_8"
value.mkdir(parents=True)
(value / "profiles.csv").write_text("x_m,simulation_N/m\\n0,1\\n")
(value / "model.csv").write_text("x_m\\n0\\n")
if settings["ends"] == "0":
    (value / "summary.json").write_text(json.dumps({
        "verdict.sentence": f"By depth agrees ({folder}/deep_8/moduli.csv, {folder}/deep_8/slabs.csv).",
        "layer.depth": 0.1, "ensemble.seed": int(settings["ensemble.seed"])}))
sys.exit(int(settings["ends"]))
"""


@pytest.fixture
def repository(tmp_path, monkeypatch):
    """Lists what git has and calls next.py in a repository whose program is built already."""
    for key in ("AUTHOR", "COMMITTER"):
        monkeypatch.setenv(f"GIT_{key}_NAME", "a")
        monkeypatch.setenv(f"GIT_{key}_EMAIL", "a@example.org")
    monkeypatch.setenv("GIT_CONFIG_GLOBAL", os.devnull)
    monkeypatch.delenv("GIT_DIR", raising=False)

    class Repository:
        def git(self, *words):
            return subprocess.run(["git", *words], cwd=tmp_path, check=True, capture_output=True, text=True).stdout

        def write(self, name, text, mode=0o644):
            file = tmp_path / name
            file.parent.mkdir(parents=True, exist_ok=True)
            file.write_text(text)
            file.chmod(mode)
            return file

        def next(self, *options):
            return subprocess.run([sys.executable, tmp_path / SCRIPT, tmp_path / "layers.txt", *options],
                                  cwd=tmp_path, capture_output=True, text=True)

        def list_runs(self, *lines):
            self.write("layers.txt", "commit first\n" + "".join(f"{one}\n" for one in lines))
            self.git("add", "layers.txt")
            self.git("commit", "--quiet", "-m", "list")
            return self.git("rev-parse", "HEAD")

    one = Repository()
    one.git("init", "--quiet")
    one.write(".gitignore", "/build/\n")
    one.write(SCRIPT, "")
    shutil.copy(ROOT / SCRIPT, tmp_path / SCRIPT)
    one.git("add", "-A")
    one.git("commit", "--quiet", "-m", "first")
    one.git("tag", "first")
    one.write("build/runs/first/source/build/release/grainfield", PROGRAM, 0o755)
    one.write("build/runs/first/built", "")
    one.folder = tmp_path
    return one


def test_a_finished_run_leaves_its_figures_without_a_folder_of_the_machine(repository):
    before = repository.list_runs("a 7 layer ends=0 output.snapshots=false")
    done = repository.next()
    assert (done.returncode, done.stdout) == (0, "a: committed\n"), done.stderr
    assert repository.git("diff", "--name-only", before.strip(), "HEAD").split() == [
        f"{KEPT}/a.json", f"{KEPT}/a.model.csv.xz", f"{KEPT}/a.profiles.csv.xz"]
    assert repository.git("status", "--porcelain") == ""
    assert repository.git("log", "-1", "--format=%s") == "Runs: a, seed 7, of first\n"
    text = (repository.folder / KEPT / "a.json").read_text()
    assert str(repository.folder) not in text
    record = json.loads(text)
    assert record["summary"] == {"verdict.sentence": "By depth agrees (deep_8/moduli.csv, deep_8/slabs.csv).",
                                 "layer.depth": 0.1, "ensemble.seed": 7}
    assert (record["case"], record["settings"]) == ("layer", ["ends=0", "output.snapshots=false"])
    assert record["commit"] == repository.git("rev-parse", "first").strip()
    again = repository.next()
    assert (again.returncode, again.stdout) == (1, "no run is missing\n")


def test_a_run_that_fails_names_its_log_and_commits_nothing(repository):
    before = repository.list_runs("b 7 layer ends=3 output.snapshots=false")
    done = repository.next()
    log = repository.folder / "build/runs/first/b/log.txt"
    assert (done.returncode, done.stdout) == (2, "")
    assert done.stderr == f"next.py: b: the program ended with 3: {log}\n"
    assert log.read_text() == "no equilibrium ['run', 'cases/layer.toml'] 1\n"
    assert repository.git("rev-parse", "HEAD") == before and repository.git("status", "--porcelain") == ""


def test_a_run_whose_time_was_over_stays_missing(repository):
    before = repository.list_runs("c 7 layer ends=130 output.snapshots=false")
    done = repository.next()
    assert done.returncode == 0 and done.stdout.startswith("c: not ended yet, "), done.stderr
    assert repository.git("rev-parse", "HEAD") == before and repository.git("status", "--porcelain") == ""


def test_a_run_has_the_threads_that_are_asked_for(repository):
    repository.list_runs("d 7 layer ends=0 output.snapshots=false")
    assert repository.next("--threads", "2").returncode == 0
    assert (repository.folder / "build/runs/first/d/log.txt").read_text() == "rests ['run', 'cases/layer.toml'] 2\n"

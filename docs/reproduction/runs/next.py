#!/usr/bin/python3
"""Takes the next missing run of a list, in pieces that fit between other work.

    docs/reproduction/runs/next.py docs/reproduction/runs/piles.txt [--minutes 150]
    while docs/reproduction/runs/next.py docs/reproduction/runs/piles.txt; do :; done

The list is committed. Its first line names the tag or commit that computes, then there is a run a line:

    commit TAG-OR-HASH
    NAME SEED CASE [KEY=VALUE ...]

with settings in quotes where they hold blanks. The program of that tag is built once, in a clone of
its own (build/runs/TAG). A run has one realization, unless it sets ensemble.realizations, the lowest
priority and one thread, or --threads of them, to the same bits. When the time is over it writes a checkpoint, and the
next call goes on to the same bits. Several calls at once take different runs. A finished run leaves
two files in docs/reproduction/states/LIST/, which are committed: NAME.h5.xz, its states compacted
(states/compact.py), and NAME.json with seed, commit, settings, processor time, the SHA-256 of the
states (of a table before it is packed) and the figures of summary.json. A run with
output.snapshots=false leaves its tables instead of states, NAME.TABLE.csv.xz: those beside states.csv
(of a sample) or profiles.csv. A run whose NAME.json is there is not missing. With --pack a run that has not ended leaves NAME.unfinished.tar.xz there,
committed: another machine goes on from it. A run whose grains.files name
docs/reproduction/states/LIST/NAME.h5 waits until that run's states are there, and unpacks them.

Ends with 0 when a run has ended or has come further, 1 when none is missing, 2 when it cannot start or a
run fails. Needs git, the build's packages, h5py, numpy and xz.
"""
import argparse
import fcntl
import hashlib
import json
import lzma
import os
import pathlib
import re
import resource
import shlex
import signal
import subprocess
import sys
import tarfile
import time

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parents[2]
LEAST_MINUTES = 2  # left of the time, below which no run begins
GRACE = 120  # s for a checkpoint


def fail(message):
    print(f"{pathlib.Path(sys.argv[0]).name}: {message}", file=sys.stderr)
    sys.exit(2)


def git(*words, folder=ROOT):
    done = subprocess.run(["git", *words], cwd=folder, capture_output=True, text=True)
    if done.returncode != 0:
        fail(f"git {' '.join(words)}: {done.stderr.strip()}")
    return done.stdout.strip()


def lower_session(pid):
    """Lets a session give way. Linux shares the processor out to sessions first, and only within one
    by the priority of its processes."""
    try:
        pathlib.Path(f"/proc/{pid}/autogroup").write_text("19")
    except OSError:  # a kernel without such groups
        pass


class Lock:
    """A file that one process has at a time; False where another has it."""

    def __init__(self, file, wait):
        file.parent.mkdir(parents=True, exist_ok=True)
        self.file = open(file, "w")
        try:
            fcntl.flock(self.file, fcntl.LOCK_EX if wait else fcntl.LOCK_EX | fcntl.LOCK_NB)
            self.held = True
        except BlockingIOError:
            self.held = False

    def release(self):
        self.file.close()


def read_list(file):
    """The tag and the runs (name, seed, case, settings) of a list."""
    tag, runs = None, []
    for number, line in enumerate(file.read_text().splitlines(), 1):
        words = shlex.split(line, comments=True)
        if not words:
            continue
        if words[0] == "commit" and len(words) == 2 and tag is None and not runs:
            tag = words[1]
        elif tag and len(words) >= 3 and re.fullmatch(r"[\w.-]+", words[0]) and words[1].isdigit():
            runs.append((words[0], int(words[1]), words[2], words[3:]))
        else:
            fail(f"{file}:{number}: found \"{line}\"; allowed: first \"commit TAG\", "
                 "then \"NAME SEED CASE [KEY=VALUE ...]\"")
    if len({name for name, *_ in runs}) != len(runs):
        fail(f"{file}: a name is there twice")
    return tag, runs


def check_committed(file):
    git("ls-files", "--error-unmatch", str(file))
    if git("status", "--porcelain", "--", str(file)):
        fail(f"{file} has changes that are not committed")


def build(tag, commit, work):
    """Builds the program of a commit in a clone of its own, once. Returns the clone."""
    source = work / "source"
    lock = Lock(work / "build.lock", wait=True)
    if not (work / "built").exists():
        if not source.exists():
            print(f"building {tag}", flush=True)
            git("clone", "--quiet", "--shared", "--no-checkout", str(ROOT), str(source))
        git("checkout", "--quiet", "--detach", commit, folder=source)
        with open(work / "build.log", "w") as log:
            for command in (["cmake", "--preset", "release", "-DGRAINFIELD_TESTS=OFF",
                             "-DGRAINFIELD_BENCHMARKS=OFF", "-DGRAINFIELD_PYTHON=OFF"],
                            ["nice", "-n", "19", "ninja", "-C", "build/release", "grainfield"]):
                if subprocess.run(command, cwd=source, stdout=log, stderr=log).returncode != 0:
                    fail(f"the build of {tag} failed: {work / 'build.log'}")
        (work / "built").touch()
    lock.release()
    return source


def packings(settings):
    """The files in grains.files of a run, relative to the root."""
    given = [s.partition("=")[2] for s in settings if s.startswith("grains.files=")]
    return json.loads(given[-1]) if given else []


def has_packings(settings):
    """Whether a run's packings are there, packed."""
    return all((ROOT / f"{file}.xz").exists() for file in packings(settings))


def unpack_packings(source, settings):
    """Puts a run's packings where the program of `source` looks for them."""
    for file in packings(settings):
        target = source / file
        target.parent.mkdir(parents=True, exist_ok=True)
        part = target.with_name(f"{target.name}.{os.getpid()}")
        part.write_bytes(lzma.decompress((ROOT / f"{file}.xz").read_bytes()))
        part.replace(target)


def unpack_unfinished(folder, packed):
    """The checkpoint of a run that was begun elsewhere."""
    if packed.exists() and not (folder / "results").exists():
        with tarfile.open(packed) as archive:
            archive.extractall(folder)


def pack_unfinished(name, folder, packed):
    """Commits the checkpoint of a run, and the processor time that it has taken."""
    packed.parent.mkdir(parents=True, exist_ok=True)
    with tarfile.open(packed, "w:xz") as archive:
        for part in sorted(path.relative_to(folder) for path in folder.rglob("checkpoint")):
            archive.add(folder / part, str(part))
        archive.add(folder / "cpu_seconds", "cpu_seconds")
    git("add", "--", str(packed))
    git("commit", "--quiet", "-m", f"Runs: {name} so far", "--", str(packed))


def compute(source, run, folder, deadline, threads):
    """Goes on with a run until it has ended (True) or the time is over (False)."""
    name, seed, case, settings = run
    results = folder / "results"
    half_done = any(results.rglob("checkpoint"))
    if any(results.rglob("summary.json")) and not half_done:  # ended, and could not be committed
        return True
    unpack_packings(source, settings)
    command = ["nice", "-n", "19", "build/release/grainfield", "run", f"cases/{case}.toml", "-o",
               str(results), "--threads", str(threads)]
    one = [] if any(s.startswith("ensemble.realizations=") for s in settings) else [
        "ensemble.realizations=1"]
    for setting in [f"ensemble.seed={seed}", *one, *settings]:
        command += ["--set", setting]
    if half_done:
        command.append("--resume")
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    with open(folder / "log.txt", "a") as log:
        child = subprocess.Popen(command, cwd=source, stdout=log, stderr=log, start_new_session=True)
        lower_session(child.pid)
        signal.signal(signal.SIGTERM, lambda *_: child.send_signal(signal.SIGINT))
        signal.signal(signal.SIGINT, lambda *_: child.send_signal(signal.SIGINT))
        try:
            status = child.wait(timeout=max(1, deadline - time.monotonic()))
        except subprocess.TimeoutExpired:
            child.send_signal(signal.SIGINT)
            try:
                status = child.wait(timeout=GRACE)
            except subprocess.TimeoutExpired:  # there is a checkpoint every 30 s
                child.kill()
                status = child.wait()
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    spent = folder / "cpu_seconds"
    seconds = float(spent.read_text()) if spent.exists() else 0.0
    seconds += after.ru_utime - before.ru_utime + after.ru_stime - before.ru_stime
    spent.write_text(f"{seconds:.1f}\n")
    if status in (130, -signal.SIGKILL):
        print(f"{name}: not ended yet, {seconds / 60:.0f} processor minutes so far", flush=True)
        return False
    if status != 0:
        fail(f"{name}: the program ended with {status}: {folder / 'log.txt'}")
    return True


def compressed(file):
    return lzma.compress(file.read_bytes(), preset=9 | lzma.PRESET_EXTREME)


def keep(run, tag, commit, folder, states):
    """Puts what a finished run leaves beside the other states and commits it."""
    name, seed, case, settings = run
    without_states = "output.snapshots=false" in settings
    compact = folder / "compact.h5"
    for wanted in ("states.csv", "profiles.csv") if without_states else ("snapshots.h5",):
        found = sorted((folder / "results").rglob(wanted))
        if found:
            break
    if len(found) != 1:  # a sweep leaves one in the folder of each value
        fail(f"{name}: found {len(found)} files {wanted}; allowed: one, of one value of a sweep")
    states.mkdir(parents=True, exist_ok=True)
    contents = {}
    if without_states:
        for table in sorted(found[0].parent.glob("*.csv")):
            contents[states / f"{name}.{table.name}.xz"] = compressed(table)
        kept = found[0].read_bytes()
    else:
        subprocess.run([sys.executable, str(HERE.parent / "states" / "compact.py"), str(found[0]),
                        str(compact)], check=True)
        kept = compressed(compact)
        contents[states / f"{name}.h5.xz"] = kept
    # Verdicts may name files of the run: without the folder of this machine.
    figures = json.loads(found[0].with_name("summary.json").read_text().replace(f"{folder / 'results'}/", ""))
    record = {"case": case, "seed": seed, "settings": settings, "tag": tag, "commit": commit,
              "cpu_seconds": float((folder / "cpu_seconds").read_text()),
              "sha256": hashlib.sha256(kept).hexdigest(), "summary": figures}
    contents[states / f"{name}.json"] = (json.dumps(record, indent=1) + "\n").encode()
    files = list(contents)
    unfinished = states / f"{name}.unfinished.tar.xz"
    for file, content in contents.items():
        file.write_bytes(content)
    lock = Lock(ROOT / "build" / "runs" / "commit.lock", wait=True)
    if unfinished.exists():
        git("rm", "--quiet", "--", str(unfinished))
        files.append(unfinished)
    git("add", "--", *map(str, contents))
    git("commit", "--quiet", "-m", f"Runs: {name}, seed {seed}, of {tag}", "-m",
        f"{case} by {commit[:12]}, {record['cpu_seconds'] / 60:.0f} processor minutes; "
        f"SHA-256 of the states {record['sha256']}.", "--", *map(str, files))
    lock.release()
    print(f"{name}: committed", flush=True)


def main():
    options = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    options.add_argument("list", type=pathlib.Path, help="the runs")
    options.add_argument("--minutes", type=float, default=150, help="the most this call may take")
    options.add_argument("--threads", type=int, default=1, help="of the run")
    options.add_argument("--pack", action="store_true", help="commit the checkpoint of a run that has not ended")
    given = options.parse_args()
    deadline = time.monotonic() + 60 * given.minutes - GRACE
    listed = given.list.resolve()
    if not listed.is_file():
        fail(f"{given.list}: no such list")
    check_committed(listed)
    tag, runs = read_list(listed)
    commit = git("rev-parse", "--verify", f"{tag}^{{commit}}")
    states = HERE.parent / "states" / listed.stem
    work = ROOT / "build" / "runs" / tag
    for run in runs:
        if (states / f"{run[0]}.json").exists() or not has_packings(run[3]):
            continue
        folder = work / run[0]
        lock = Lock(folder / "lock", wait=False)
        if not lock.held:
            continue
        os.nice(10)
        source = build(tag, commit, work)
        packed = states / f"{run[0]}.unfinished.tar.xz"
        unpack_unfinished(folder, packed)
        if deadline - time.monotonic() < 60 * LEAST_MINUTES:
            print("built; no time left for a run", flush=True)
        elif compute(source, run, folder, deadline, given.threads):
            keep(run, tag, commit, folder, states)
        elif given.pack:
            pack_unfinished(run[0], folder, packed)
        sys.exit(0)
    print("no run is missing")
    sys.exit(1)


if __name__ == "__main__":
    main()

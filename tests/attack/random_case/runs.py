"""Runs a case, looks at what it leaves, and tells what is wrong."""
import json
import os
import random
import re
import shutil
import signal
import subprocess
import time

import h5py

from . import balances, collisions, damage
from .declared import declared_keys, documented_figures
from .grammar import as_toml, draw_case, from_toml
from .packing import Packing

MOST_DRAWS = 8
LONG_ON_THREADS = 4  # s
# Figures of the run, not of the grains (docs/reliability.md).
OF_THE_RUN = re.compile(r"time\.|memory\.|case\.command|.*(solve_s|assemble_s)")


def environment():
    return dict(os.environ, OMP_NUM_THREADS="1", LC_ALL="C")


def start(program, case, folder, *options):
    return subprocess.Popen([program, "run", case, "-o", folder, *options], text=True,
                            stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                            stderr=subprocess.PIPE, env=environment())


def finished(process, limit):
    """Exit code (None: it did not end), what it said."""
    try:
        out, err = process.communicate(timeout=limit)
    except subprocess.TimeoutExpired:
        process.kill()
        process.communicate()
        return None, ""
    return process.returncode, (out + err)


def said(text):
    """The program's own last word."""
    lines = [line for line in text.splitlines() if line.startswith("grainfield: ")
             and not line.startswith("grainfield: warning")]
    return lines[-1] if lines else ""


def read_groups(folder):
    groups = {}
    with h5py.File(os.path.join(folder, "snapshots.h5")) as file:
        for name in file:
            number = int(name.rsplit("_", 1)[1])
            groups[number] = {state: Packing(file[name][state]) for state in file[name]
                              if file[name][state].attrs.get("format") is not None}
    return groups


def numbers_of(summary):
    return {k: v for k, v in summary.items() if not OF_THE_RUN.match(k)}


# What there is not of a single realization, and of heaps and layers as small as these: errors and
# chances, slopes, averages inside, widths of a response (docs/file-formats.md, summary.json).
MAY_BE_MISSING = re.compile(
    r"(?!energy\.|\w+\.balance_error)(compare\..*|verdict\.position.*|.*(error|p_value|_p)|.*\.(least|most|standard_error)"
    r"|average\..*\.(balance_rms|balance_largest|fluctuation)|response\.((rms_)?width|.*peak.*|integral)"
    r"|(dem\.repose_angle_(left|right)|repose\.\w+|cone\.(sector_)?repose\w*)_deg"
    r"|repose\.\w+|dem\.volume_fraction|(heap|cone)\.volume_fraction|density\.\w+"
    r"|pile\.(apex_x|half_base_\w+|volume_fraction_\w+|repose_error_\w+)|dip\.\w+|axis\.stress_ratio"
    r"|base\.(centre_pressure|largest_\w+)|relaxation\.(force_change|level_error_\w+)"
    r"|(strength|sample\.(secant|critical|peak|strain_at|lateral|residual|plastic|unloading|loop|stiffening))\w*(\.\w+)?"
    r"|liffman\.horizontal_\w+|settling\.within_(from|until)"
    r"|moduli\.\w+\.\w+|rve\..*|pair\.(restitution_tangential|closed_form\.\w+)(\.\w+)?)")


class Attack:
    def __init__(self, program, seed, room, limit, hurt):
        self.damage = hurt  # whether to try the checks themselves
        self.program, self.seed, self.room, self.limit = program, seed, room, limit
        self.keys = declared_keys(program)
        self.figures = documented_figures(program)

    def __call__(self, number):
        """One case: what became of it."""
        folder = os.path.join(self.room, f"case_{number}")
        shutil.rmtree(folder, ignore_errors=True)
        os.makedirs(folder)
        case = os.path.join(folder, "case.toml")
        out = {"number": number, "study": "", "outcome": "refused", "refused": [], "failures": [],
               "reason": "", "seconds": 0.0, "repeats": [], "case": case, "seen": {}}
        if isinstance(self.seed, str):  # a case file that was kept
            values = from_toml(self.seed)
            out["study"] = values["study"]
            shutil.copy(self.seed, case)
            self.try_case(case, values, os.path.join(folder, "out"), out)
            return out
        for attempt in range(MOST_DRAWS):
            values = draw_case(self.keys, self.seed, number, attempt)
            out["study"] = values["study"]
            with open(case, "w") as file:
                file.write(f"# case {number} of seed {self.seed}, draw {attempt}\n" + as_toml(values))
            if not self.try_case(case, values, os.path.join(folder, "out"), out):
                break
        if not out["failures"]:
            shutil.rmtree(os.path.join(folder, "out"), ignore_errors=True)
        return out

    def try_case(self, case, values, results, out):
        """True: it was refused."""
        def complain(check, what):
            out["failures"].append((check, what))

        began = time.monotonic()
        code, text = finished(start(self.program, case, results, "--threads", "1"), self.limit)
        out["seconds"] = time.monotonic() - began
        word = said(text)
        if code == 2:
            out["refused"].append(word)
            shutil.rmtree(results, ignore_errors=True)  # one that an analysis refuses keeps its grains
            if not any(path in word for path in self.keys if "." in path):
                complain("word", f"exit 2 without a key: {text.strip()[-300:]}")
                return False
            return True
        if code is None:
            out["outcome"] = "no end"
            complain("no end", f"not within {self.limit:g} s")
        elif code == 3:
            out["outcome"], out["reason"] = "exit 3", word
            if len(word) < 30:
                complain("word", f"exit 3 without a word: {text.strip()[-300:]}")
            self.repeat(case, values, results, out, complain, text)
        elif code != 0:
            out["outcome"] = f"exit {code}"
            complain("exit code", f"{code}: {text.strip()[-300:]}")
        else:
            out["outcome"] = "ended"
            self.look(values, results, complain, out)
            self.repeat(case, values, results, out, complain, text)
        return False

    def look(self, values, folder, complain, out):
        with open(os.path.join(folder, "summary.json")) as file:
            summary = json.load(file)
        for name, value in summary.items():
            if value is None:
                floats = name.startswith("dem.unbalanced_") and summary.get("dem.contacts") == 0
                refused = name.startswith("predicted.") and summary.get("predicted.refusal")
                if not (MAY_BE_MISSING.fullmatch(name) or floats or refused):
                    complain("nan", f"{name} is {value}")
            elif not any(pattern.fullmatch(name) for pattern, _ in self.figures):
                complain("undocumented", f"{name} of summary.json")
        run = balances.Run(complete(values, self.keys), folder, read_groups(folder), summary, complain)
        run.check()
        if self.damage and not out["failures"]:
            out["seen"] = damage.seen(run.values, folder, run.groups, out["number"])
        if values["study"] == "hard-disks":
            collisions.check_gas(run)
        if values["study"] in ("implicit-settling", "hard-to-soft"):
            collisions.check_soft(run)
        if values["study"] == "pair":
            collisions.check_pair(run)

    # ------------------------------------------------------------- the same bits

    def repeat(self, case, values, results, out, complain, text):
        """Every tenth case again, on one thread and on two; every tenth interrupted."""
        number = out["number"]
        if number % 10 == 0:
            for threads in ("1", "2"):
                again = f"{results}_again_{threads}"
                code, other = self.begin_on(threads, case, again)
                self.compare(results, again, code, said(text), said(other), complain,
                             f"again on {threads}")
                out["repeats"].append("again")
        if number % 10 == 5 and out["outcome"] == "ended":
            self.interrupt(case, results, out, complain)

    def begin_on(self, threads, case, again):
        """On so many threads, which a busy machine makes slow for so few grains: what is not done
        within some seconds one thread goes on with."""
        process = start(self.program, case, again, "--threads", threads)
        if threads != "1":
            try:
                process.wait(timeout=LONG_ON_THREADS)
            except subprocess.TimeoutExpired:
                process.send_signal(signal.SIGINT)
        code, text = finished(process, 2 * self.limit)
        if code == 130:
            return finished(start(self.program, case, again, "--threads", "1", "--resume"),
                            2 * self.limit)
        return code, text

    def compare(self, results, again, code, word, other, complain, how):
        if code == 3 and word == other:
            return
        if code != 0:
            complain("repeat", f"{how}: exit {code}, {other}")
            return
        for name in ("snapshots.h5",):
            with open(os.path.join(results, name), "rb") as a, open(os.path.join(again, name), "rb") as b:
                if a.read() != b.read():
                    complain("repeat", f"{how}: other bits in {name}")
        one, two = (numbers_of(json.load(open(os.path.join(f, "summary.json")))) for f in (results, again))
        if one != two:
            differ = [k for k in one.keys() | two.keys() if one.get(k) != two.get(k)]
            complain("repeat", f"{how}: other figures: {', '.join(sorted(differ)[:8])}")
        shutil.rmtree(again, ignore_errors=True)

    def interrupt(self, case, results, out, complain):
        again = f"{results}_resumed"
        rng = random.Random(f"{self.seed}/{out['number']}/interrupt")
        for number in range(20):
            options = ["--threads", "1"] + (["--resume"] if number else [])
            process = start(self.program, case, again, *options)
            time.sleep(0.15 + rng.uniform(0.05, 0.8) * max(out["seconds"] - 0.15, 0))
            if process.poll() is None:
                process.send_signal(signal.SIGINT)
            code, text = finished(process, self.limit)
            if code == 0:
                break
            if code == -signal.SIGINT or (code == 2 and "resume" in text and not os.path.isdir(again)):
                continue  # before it began: nothing is there
            if code != 130:
                complain("interrupt", f"exit {code}: {text.strip()[-200:]}")
                return
            if "are complete" in text:  # after the results had taken their places
                code = 0
                break
            out["repeats"].append("interrupted")
            rest = ["--threads", "1", "--resume"]
            code, text = finished(start(self.program, case, again, *rest), 2 * self.limit)
            if code == 0:
                break
            complain("interrupt", f"resumed: exit {code}: {text.strip()[-200:]}")
            return
        self.compare(results, again, code, "", "", complain, "interrupted and resumed")


def complete(values, keys):
    """With the defaults of what the case leaves out."""
    study = values["study"]
    out = {path: key.default(study) for path, key in keys.items()
           if study in key.studies and key.section}
    out.update(values)
    return {path: value for path, value in out.items() if value is not None}

#!/usr/bin/python3
"""Judges every ensemble whose states are kept anew: judge.py PROGRAM [-o FOLDER]

Unpacks the states that fits.toml names, runs the case of each with PROGRAM (a grainfield of today), prints
the first line of its verdict and takes the summaries of fits that the page has into
docs/reproduction/results/, as page.py --add does. Ends with 1 when a run fails. Needs Python 3.11.
"""
import argparse
import json
import lzma
import pathlib
import subprocess
import sys
import tempfile
import tomllib

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parents[2]


def judge(program: pathlib.Path, fit: dict, folder: pathlib.Path) -> pathlib.Path:
    """Runs the fit of one ensemble in `folder`; the folder of its results."""
    states = folder / f"{fit['states']}.h5"
    states.write_bytes(lzma.decompress((HERE / f"{states.name}.xz").read_bytes()))
    out = folder / fit["name"]
    command = [program, "run", f"cases/{fit['case']}.toml", "--set", f"grains.files=[\"{states.name}\"]"]
    command += [word for setting in fit.get("set", []) for word in ("--set", setting)]
    (folder / "cases").exists() or (folder / "cases").symlink_to(ROOT / "cases")
    subprocess.run([*command, "-o", out], cwd=folder, check=True, capture_output=True, text=True)
    return out


def main() -> int:
    options = argparse.ArgumentParser(description="Judges every ensemble whose states are kept anew.")
    options.add_argument("program", type=pathlib.Path)
    options.add_argument("-o", "--output", type=pathlib.Path, help="keeps the runs there; default: nowhere")
    given = options.parse_args()
    with tempfile.TemporaryDirectory() as made:
        folder = (given.output or pathlib.Path(made)).resolve()
        folder.mkdir(parents=True, exist_ok=True)
        add = []
        for fit in tomllib.loads((HERE / "fits.toml").read_text())["fit"]:
            try:
                out = judge(given.program.resolve(), fit, folder)
            except subprocess.CalledProcessError as error:
                print(f"judge.py: {fit['name']}: {error.stderr.strip()}", file=sys.stderr)
                return 1
            summary = next(out.glob("*/summary.json"), out / "summary.json")  # of a sweep its member's
            verdict = json.loads(summary.read_text())["verdict.sentence"]
            print(f"{fit['name']} ({fit['states']}): {verdict}", flush=True)
            if fit["name"] == fit["case"]:
                add += ["--add", out]
        subprocess.run([ROOT / "docs/reproduction/page.py", *add], check=True)
    return 0


if __name__ == "__main__":
    sys.exit(main())

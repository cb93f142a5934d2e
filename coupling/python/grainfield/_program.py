"""The program beside this module: for the commands that have no function in it."""

from __future__ import annotations

import functools
import os
import shutil
import signal
import subprocess
import sys
import warnings
from pathlib import Path
from typing import Sequence

_ERRORS = {2: ValueError, 3: RuntimeError, 74: OSError, 130: KeyboardInterrupt}
_RANKS = ("OMPI_", "PMIX_", "PMI_")  # variables of mpirun: a program started from a rank is no rank


@functools.lru_cache(maxsize=None)
def path() -> str:
    """The file of the program: GRAINFIELD_PROGRAM, that of the same build or installation, or the one
    on PATH. Raises OSError where there is none."""
    folder = Path(__file__).absolute().parent
    places: list[str | Path] = [os.environ.get("GRAINFIELD_PROGRAM", ""), folder.parents[1] / "grainfield"]
    places += [folder.parents[3] / "bin/grainfield"] if len(folder.parents) > 3 else []
    for place in places:
        if place and os.access(place, os.X_OK) and os.path.isfile(place):
            return os.fspath(place)
    found = shutil.which("grainfield")
    if found is None:
        raise OSError("the program grainfield is not beside this module and not on PATH; the variable "
                      "GRAINFIELD_PROGRAM names it")
    return found


def start(words: Sequence[object]) -> subprocess.Popen:
    """The program at work, in a group of its own: Ctrl-C reaches it through stop() alone."""
    kept = {name: value for name, value in os.environ.items() if not name.startswith(_RANKS)}
    return subprocess.Popen([path(), *map(str, words)], stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                            stderr=subprocess.PIPE, text=True, encoding="utf-8", env=kept, start_new_session=True)


def stop(process: subprocess.Popen) -> None:
    """Ctrl-C for it, and waits until it has written its checkpoint."""
    if process.poll() is None:
        process.send_signal(signal.SIGINT)
    process.communicate()


def result(process: subprocess.Popen) -> tuple[str, list[str]]:
    """What it prints, and what it notes on standard error, a line each. Raises by its exit code what
    the functions of this module raise, with its message."""
    try:
        out, said = process.communicate()
    except BaseException:
        stop(process)
        raise
    lines = [line.removeprefix("grainfield: ") for line in said.splitlines() if line]
    if process.returncode == 0:
        return out, lines
    message = lines[-1] if lines else f"grainfield ended with exit code {process.returncode}"
    raise _ERRORS.get(process.returncode, RuntimeError)(message)


def call(*words: object) -> str:
    """What a command prints; its warnings are Python warnings. Raises as result()."""
    out, lines = result(start(words))
    level = 2
    while sys._getframe(level - 1).f_globals["__name__"].startswith(__package__ + "."):
        level += 1  # the line of the caller's own code
    for line in lines:
        if line.startswith("warning: "):
            warnings.warn(line.removeprefix("warning: "), stacklevel=level)
    return out

"""cases, samples, check and keys: what is shipped, and what a case may say."""

from __future__ import annotations

import os
import re
from typing import Any, Mapping, Sequence

import numpy as np

from . import _core, _program
from ._commands import _overrides
from ._data import Table


def cases() -> dict[str, str]:
    """The shipped cases: name to file."""
    return {os.path.basename(path)[: -len(".toml")]: path for path in _core.cases()}


def samples() -> dict[str, str]:
    """The shipped samples to try things on: name to file, such as gf.read(gf.samples()["heaps.h5"])."""
    folder = os.path.join(os.path.dirname(_core.cases()[0]), "samples")
    return {name: os.path.join(folder, name) for name in sorted(os.listdir(folder)) if name.endswith((".h5", ".csv"))}


def check(
    case: str | os.PathLike,
    *,
    set: Mapping[str, Any] | Sequence[str] | None = None,
    quick: bool = False,
) -> str:
    """Validates a case without running it, as `grainfield check`: what it would compute, in words.

    case, set, quick: as of run(). Keys without effect are Python warnings. Raises ValueError with the
    line, the key, what was found and what is allowed.
    """
    words = ["check", os.fspath(case), *(["--quick"] if quick else [])]
    for text in _overrides(set):
        words += ["--set", text]
    return _program.call(*words)


def _cells(row: str) -> list[str]:
    """The cells of a row of a Markdown table, without its marks of code."""
    return [cell.strip().replace("\\|", "|").replace("`", "") for cell in re.split(r"(?<!\\)\|", row)[1:-1]]


def keys(*names: str, summary: bool = False) -> Table:
    """The keys of a case as a Table: key, type, unit, default, allowed, meaning, source; of names only
    those of a study ("pile"), a section ("fit"), a key ("fit.heights") or with a part ("frict"), as
    `grainfield keys`. summary: instead the keys of summary.json: key, unit, meaning.

    Raises ValueError for a name that nothing has.
    """
    wanted = None if summary or not names else _named(_program.call("keys", *names))
    section, header, rows = "", [], []
    for line in _program.call("keys", "--markdown", *(["--summary"] if summary else [])).splitlines():
        if line.startswith("## "):
            title = line[3:].strip()
            section = title[1:-1] + "." if title.startswith("[") else ""
        elif line.startswith("| key "):
            header = _cells(line)
        elif line.startswith("| `"):
            key, *others = _cells(line)
            rows.append([section + key, *others])
    if wanted is not None:
        rows = [row for row in rows if row[0] in wanted]
    if summary and names:
        rows = [row for row in rows if any(name in row[0] for name in names)]
        if not rows:
            raise ValueError(f"keys: no key of summary.json with {' or '.join(names)}")
    columns = {name: np.array(values) for name, values in zip(header, zip(*rows))}
    return Table(columns, dict.fromkeys(columns, "text"), [])


def _named(text: str) -> set[str]:
    """The keys that `grainfield keys NAME` prints."""
    section, out = "", set()
    for line in text.splitlines():
        if line.startswith("[") or line == "top level":
            section = line.strip("[]") + "." if line.startswith("[") else ""
        elif found := re.match(r"  (\S+) = ", line):
            out.add(section + found[1])
    return out

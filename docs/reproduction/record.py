"""What of a finished run goes into the folder that the page is made from."""
from __future__ import annotations

import base64
import lzma
import os
import pathlib
import re

from summaries import Refused, read_summary

#: Pictures of the report that are kept, by their titles there.
KEPT = {"Vertical pressure on the base": "base-pressure", "Volume fraction": "volume-fraction"}


def write_file(file: pathlib.Path, content: bytes) -> None:
    """Writes a file as a whole: a reader finds the earlier one or this one."""
    partial = file.with_name(file.name + ".part")
    partial.write_bytes(content)
    os.replace(partial, file)


def read_text(file: pathlib.Path) -> str:
    """The text of a file, unpacked where its name ends with .xz."""
    content = file.read_bytes()
    return (lzma.decompress(content) if file.suffix == ".xz" else content).decode()


def record_run(run: pathlib.Path, results: pathlib.Path) -> list[pathlib.Path]:
    """Copies summary.json, profiles.md and the kept pictures under the name of the run's case.

    They become CASE.json, CASE.profiles.md, CASE.base-pressure.svg and CASE.volume-fraction.png. Cases fit-*
    fit models to the piles of another case, which has the pictures.
    Returns the files written. Raises Refused where the folder holds no summary.json with a case.name
    that is a file's name.
    """
    summary = run / "summary.json"
    if not summary.exists():
        raise Refused(f"{run}: no summary.json; name the folder of a finished run")
    name = read_summary(summary).get("case.name")
    if name is None:
        raise Refused(f"{summary}: no case.name")
    if not isinstance(name, str) or not re.fullmatch(r"[^./\0][^/\0]*", name):
        raise Refused(f'{summary}: case.name: found "{name}", which is no name of a file')
    files = {f"{name}.json": summary.read_bytes()}
    if (run / "profiles.md").exists():
        files[f"{name}.profiles.md"] = (run / "profiles.md").read_bytes()
    report = (run / "report.html").read_text(encoding="utf-8") if (run / "report.html").exists() else ""
    for title, kept in ({} if name.startswith("fit-") else KEPT).items():
        found = re.search(rf'alt="{re.escape(title)}" src="data:image/(svg|png)[^;]*;base64,([^"]*)"', report)
        if found:
            files[f"{name}.{kept}.{found[1]}"] = base64.b64decode(found[2])
    for file, content in files.items():
        write_file(results / file, content)
    return [results / file for file in files]

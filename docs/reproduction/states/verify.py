#!/usr/bin/python3
"""Verifies the stored states by their SHA-256: verify.py [FILE ...]

    docs/reproduction/states/verify.py            all of them
    docs/reproduction/states/verify.py --write    writes SHA256SUMS anew, for states that were meant to change

Every *.h5.xz below docs/reproduction/states has its SHA-256 in the record NAME.json beside it (runs/next.py writes
both) or else a line in SHA256SUMS, as sha256sum writes it. Ends with 1 where a file is missing, has neither or is
another one, and says which. Needs Python 3.11.
"""
import argparse
import hashlib
import json
import pathlib
import sys

HERE = pathlib.Path(__file__).resolve().parent
SUMS = "SHA256SUMS"


def digest(file: pathlib.Path) -> str:
    with open(file, "rb") as opened:
        return hashlib.file_digest(opened, "sha256").hexdigest()


def listed(folder: pathlib.Path) -> dict[str, str]:
    """The SHA-256 of every name of the list."""
    lines = [line.split("  ", 1) for line in (folder / SUMS).read_text().splitlines()]
    return {name: one for one, name in lines}


def by_record(file: pathlib.Path) -> str | None:
    """The SHA-256 that the record of the run says; none where there is no record of it."""
    record = file.with_name(file.name.removesuffix(".h5.xz") + ".json")
    return json.loads(record.read_text()).get("sha256") if record.exists() else None


def expected(folder: pathlib.Path) -> dict[str, str | None]:
    """The SHA-256 that every file of states should have; None where nothing says so."""
    there = sorted(folder.rglob("*.h5.xz"))
    found = {str(file.relative_to(folder)): by_record(file) for file in there}
    return found | {name: one for name, one in listed(folder).items() if found.get(name) is None}


def wrong(folder: pathlib.Path, only: list[str] | None = None) -> list[str]:
    """A line for everything that is not as it should be; only: of these names."""
    known, out = expected(folder), []
    for name in sorted(set(only) if only else known):
        file = folder / name
        if known.get(name) is None:
            out.append(f"{name}: neither a record nor a line in {SUMS}")
        elif not file.exists():
            out.append(f"{name}: missing")
        elif (found := digest(file)) != known[name]:
            out.append(f"{name}: {found}, should be {known[name]}")
    return out


def main(words: list[str] | None = None) -> int:
    options = argparse.ArgumentParser(description="Verifies the stored states by their SHA-256.")
    options.add_argument("file", nargs="*", help="names below the folder; default: all")
    options.add_argument("--write", action="store_true", help=f"writes {SUMS} anew")
    options.add_argument("--folder", type=pathlib.Path, default=HERE, help="default: docs/reproduction/states")
    given = options.parse_args(words)
    if given.write:
        names = sorted(str(file.relative_to(given.folder)) for file in given.folder.rglob("*.h5.xz")
                       if by_record(file) is None)
        (given.folder / SUMS).write_text("".join(f"{digest(given.folder / name)}  {name}\n" for name in names))
    found = wrong(given.folder, given.file)
    for line in found:
        print(line)
    if not found:
        print(f"{len(given.file) or len(expected(given.folder))} files as stored")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())

"""The stored states are those of the list, and the command that says so sees what is not."""
import hashlib
import json
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "docs/reproduction/states"))

import verify  # noqa: E402


def test_the_stored_states_are_those_of_the_list(capsys):
    assert verify.main([]) == 0, capsys.readouterr().out


@pytest.fixture
def folder(tmp_path):
    (tmp_path / "list").mkdir()
    for name, content in {"a.h5.xz": b"one", "list/b.h5.xz": b"two"}.items():
        (tmp_path / name).write_bytes(content)
    (tmp_path / "list/b.json").write_text(json.dumps({"sha256": hashlib.sha256(b"two").hexdigest()}))
    assert verify.main(["--write", "--folder", str(tmp_path)]) == 0
    return tmp_path


def test_a_list_is_as_sha256sum_writes_it_and_leaves_out_what_has_a_record(folder):
    assert (folder / "SHA256SUMS").read_text() == f"{hashlib.sha256(b'one').hexdigest()}  a.h5.xz\n"


@pytest.mark.parametrize("change, says", [
    (lambda f: (f / "a.h5.xz").write_bytes(b"ono"), "a.h5.xz: "),
    (lambda f: (f / "a.h5.xz").unlink(), "a.h5.xz: missing"),
    (lambda f: (f / "list/c.h5.xz").write_bytes(b"three"), "list/c.h5.xz: neither"),
    (lambda f: (f / "list/b.h5.xz").write_bytes(b"twa"), "list/b.h5.xz: "),
    (lambda f: (f / "list/b.json").write_text(json.dumps({"sha256": "0"})), "should be 0")])
def test_what_is_not_as_listed_is_told(folder, capsys, change, says):
    change(folder)
    capsys.readouterr()
    assert verify.main(["--folder", str(folder)]) == 1
    said = capsys.readouterr().out
    assert says in said and len(said.splitlines()) == 1


def test_single_files(folder):
    (folder / "list/b.h5.xz").write_bytes(b"twa")
    assert verify.main(["--folder", str(folder), "a.h5.xz"]) == 0
    assert verify.main(["--folder", str(folder), "list/b.h5.xz"]) == 1

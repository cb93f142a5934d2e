"""docs/gallery.md and docs/index.md are what docs/reference.py makes of the case files and the other pages."""
import re
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "docs"))

import reference  # noqa: E402


def test_gallery_and_index_are_current():
    assert reference.main(["--check"]) == 0, "docs/reference.py makes them again"


def test_check_sees_another_page(monkeypatch):
    monkeypatch.setattr(reference, "gallery", lambda: "other\n")
    assert reference.main(["--check"]) == 1


def test_the_index_has_every_key_command_and_column():
    listed = set(re.findall(r"^\| `([^`]+)` \|", (ROOT / "docs/index.md").read_text(), flags=re.M))
    for page, least in (("keys.md", 300), ("summary-keys.md", 500), ("columns.md", 100)):
        names = {name for name, _ in reference.rows(page)}
        assert len(names) > least / 2
        assert all(name in listed or any(term.endswith("." + name) for term in listed) for name in names), page
    assert {"grainfield run", "grainfield fit", "--threads", "pile-dip-funnel", "contacts/force"} <= listed


def test_a_case_without_page_is_named():
    with pytest.raises(SystemExit, match="no-such-case"):
        reference.page_of("no-such-case")

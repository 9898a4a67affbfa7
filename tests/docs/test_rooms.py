"""The drawing of gap/ in docs/design.md is the house as it stands."""

from __future__ import annotations

import re

from tests.conftest import ROOT

GAP = ROOT / "src" / "hystbench" / "gap"
PAGE = (ROOT / "docs" / "design.md").read_text(encoding="utf-8")
ROOMS = PAGE[PAGE.index("| room of `gap/`") : PAGE.index("Where things happen")]
ROWS = re.findall(r"^\| `(\w+)` \|.*\| (.+) \|$", ROOMS, re.M)


def test_every_room_is_drawn_and_no_other():
    stands = {item.parent.name for item in GAP.glob("*/__init__.py")}
    assert {room for room, _ in ROWS} == stands


def test_files_that_are_named_stand_in_their_rooms():
    for room, cell in ROWS:
        for name in re.findall(r"`([\w.]+)`", cell):
            assert (GAP / room / name).is_file(), f"{room}/{name}"


def test_places_where_things_happen_are_there():
    """A file is named from gap/, the package or the project."""
    text = PAGE[PAGE.index("Where things happen") : PAGE.index("**The contest.**")]
    named = set(re.findall(r"`([\w/]+\.(?:py|yaml|c|j2|md))`", text))
    assert len(named) > 40
    roots = (GAP, GAP.parent, GAP / "report", ROOT)
    lost = {x for x in named if not any((root / x).is_file() for root in roots)}
    assert lost == set()


def test_functions_where_things_happen_are_there():
    """``x in `file` `` tells where x is defined, or the method of a class."""
    pairs = re.findall(r"`(\w+)(?:\.(\w+))?` (?:in|of) `([\w/]+\.py)`", PAGE)
    assert len(pairs) > 15
    for name, member, place in pairs:
        found = [root / place for root in (GAP, GAP.parent) if (root / place).is_file()]
        code = found[0].read_text(encoding="utf-8")
        assert re.search(rf"^(def |class )?{name}\b", code, re.M), (name, place)
        assert not member or f"def {member}(" in code, (name, member, place)


def test_files_beside_the_rooms_are_all_told():
    start = PAGE.index("`gap/` has twelve rooms")
    text = PAGE[start : PAGE.index("## Where", start)]
    beside = {item.name for item in GAP.glob("*.py")} - {"__init__.py"}
    assert {name for name in beside if f"`{name}`" not in text} == set()

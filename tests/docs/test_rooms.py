"""The drawing of gap/ in docs/design.md is the house as it stands."""

from __future__ import annotations

import re

from tests.conftest import ROOT

GAP = ROOT / "src" / "hystbench" / "gap"
PAGE = (ROOT / "docs" / "design.md").read_text(encoding="utf-8")
ROWS = re.findall(r"^\| `(\w+)` \|.*\| (.+) \|$", PAGE[: PAGE.index("## Where")], re.M)


def test_every_room_is_drawn_and_no_other():
    stands = {item.parent.name for item in GAP.glob("*/__init__.py")}
    assert {room for room, _ in ROWS} == stands


def test_files_that_are_named_stand_in_their_rooms():
    for room, cell in ROWS:
        for name in re.findall(r"`([\w.]+)`", cell):
            assert (GAP / room / name).is_file(), f"{room}/{name}"
    named = re.findall(r"`(\w+/\w+\.py)`", PAGE[PAGE.index("Some questions") :])
    rooms = {room for room, _ in ROWS}
    for place in named:
        if place.partition("/")[0] in rooms:
            assert (GAP / place).is_file(), place


def test_files_beside_the_rooms_are_all_told():
    start = PAGE.index("`gap/` has twelve rooms")
    text = PAGE[start : PAGE.index("## Where", start)]
    beside = {item.name for item in GAP.glob("*.py")} - {"__init__.py"}
    assert {name for name in beside if f"`{name}`" not in text} == set()

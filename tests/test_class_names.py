"""A class can be found by its name alone."""

import ast
from collections import defaultdict

from tests.conftest import ROOT

SOURCE = ROOT / "src" / "hystbench"


def test_no_two_classes_share_a_name_but_an_effect_and_its_block():
    places = defaultdict(list)
    for path in sorted(SOURCE.rglob("*.py")):
        room = path.parent.relative_to(SOURCE).as_posix()
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
            if isinstance(node, ast.ClassDef):
                places[node.name].append(room)
    twice = {name: rooms for name, rooms in places.items() if len(rooms) > 1}
    assert all(rooms == ["blocks", "gap/effects"] for rooms in twice.values()), twice

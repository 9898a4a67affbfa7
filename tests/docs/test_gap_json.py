"""The reference of gap.json tells of every key that the schema has."""

import re

from hystbench.gap.schema import SCHEMA
from tests.conftest import ROOT

PAGE = ROOT / "docs" / "gap-json.md"


def keys(schema):
    """Give the keys of an object and of all objects in it."""
    found = set()
    if isinstance(schema, dict):
        found |= set(schema.get("properties", {}))
        for part in schema.values():
            found |= keys(part)
    if isinstance(schema, list):
        for part in schema:
            found |= keys(part)
    return found


def test_every_key_and_word_of_the_schema_stands_on_the_page():
    told = set(re.findall(r"`([\w-]+)`", PAGE.read_text(encoding="utf-8")))
    assert sorted(keys(SCHEMA) - told) == []
    verdicts = SCHEMA["properties"]["verdict"]["enum"]
    assert {*verdicts} <= told

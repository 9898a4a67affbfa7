"""The page of measured devices: a sentence, two pictures and what is known of each."""

import re

import pytest

from tests.conftest import ROOT

PAGE = ROOT / "docs" / "measured" / "gap.md"
#: A picture of a result, and no copy of somebody's records.
SMALL = 150_000


def sections():
    parts = re.split(r"^## (.*)\n", PAGE.read_text(encoding="utf-8"), flags=re.M)
    texts = dict(zip(parts[1::2], parts[2::2], strict=True))
    return {name: text for name, text in texts.items() if "/verdict.md -->" in text}


def test_the_sentences_come_before_the_devices():
    head = PAGE.read_text(encoding="utf-8").split("\n## ")[0]
    rows = re.findall(r"^\| ([\w-]+) \| \S.*\|$", head, re.M)
    assert {*sections()} <= {*rows}
    assert len(sections()) == 6


@pytest.mark.parametrize("name", sections())
def test_a_device_has_its_verdict_pictures_literature_and_what_is_not_known(name):
    text = sections()[name]
    # What a command wrote there, from the results of this device.
    found = re.search(
        rf"<!-- from results/gap/{name}/verdict.md -->\n\n\*\*(.+)\*\*\n", text
    )
    assert found
    assert found[1].endswith(".")
    for words in ("**What the literature says.**", "**What is not known.**"):
        assert words in text
    pictures = re.findall(
        rf"<!-- picture results/gap/{name}/(\w+\.svg) -->\n!\[.+\]\((.+)\)", text
    )
    made = [each for each, _ in pictures]
    # Modes were measured at several levels of one device.
    levels = ["where.svg"] if name == "f16-ground-vibration" else []
    assert made == ["model.svg", "residual.svg", *levels]
    for _, place in pictures:
        assert 0 < (PAGE.parent / place).stat().st_size < SMALL

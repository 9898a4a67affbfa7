"""README.md can be read in two minutes."""

from tests.conftest import ROOT


def test_it_stays_under_600_words_tables_and_commands_included():
    words = (ROOT / "README.md").read_text(encoding="utf-8").split()
    assert len(words) < 600

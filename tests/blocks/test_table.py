"""The table of blocks in the docs, and their laws, are the registry's."""

import re
from pathlib import Path

from tests.blocks.table import laws, markdown_table

DOCS = Path(__file__).parents[2] / "docs"


def test_the_page_on_model_files_holds_the_table():
    # To write it: python -c 'from tests.blocks.table import *;
    # print(markdown_table(), end="")' and paste it between the two comments.
    page = (DOCS / "model-files.md").read_text(encoding="utf-8")
    assert f"<!-- blocks -->\n\n{markdown_table()}\n<!-- end of blocks -->" in page


def test_the_page_on_blocks_holds_their_laws():
    # To write it: print laws() as the table above.
    page = (DOCS / "blocks.md").read_text(encoding="utf-8")
    assert f"<!-- laws -->\n\n{laws()}\n<!-- end of laws -->" in page


def test_every_law_is_told_without_marks_of_another_language():
    for part in laws().split("### ")[1:]:
        name, _, text = part.partition("\n\n")
        assert len(text) > 20, name
        assert not re.search(r"``|\]_|:\w+:`|-----", text), name

"""The table of blocks in the docs is the registry's."""

from pathlib import Path

from tests.blocks.table import markdown_table

PAGE = Path(__file__).parents[2] / "docs" / "model-files.md"


def test_the_page_on_model_files_holds_the_table():
    # To write it: python -c 'from tests.blocks.table import *;
    # print(markdown_table(), end="")' and paste it between the two comments.
    page = PAGE.read_text(encoding="utf-8")
    assert f"<!-- blocks -->\n\n{markdown_table()}\n<!-- end of blocks -->" in page

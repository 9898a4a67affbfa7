"""The pages of the project, and the code that they show."""

from __future__ import annotations

import re
from pathlib import Path

from tests.conftest import ROOT

PAGES = (
    *(ROOT / f"{name}.md" for name in ("README", "CONTRIBUTING", "CHANGELOG")),
    *sorted((ROOT / "docs").rglob("*.md")),
)
NAMES = [page.relative_to(ROOT).as_posix() for page in PAGES]
#: Blocks of code between fences, and indented ones.
FENCED = re.compile(r"^```.*?\n(.*?)^```", re.MULTILINE | re.DOTALL)
INDENTED = re.compile(r"^ {4}\S.*$", re.MULTILINE)
SPAN = re.compile(r"`([^`]+)`")


def without_code(text: str) -> str:
    """Give a page's text without what stands in blocks and spans of code."""
    return SPAN.sub("", INDENTED.sub("", FENCED.sub("", text)))


def code_of(page: Path) -> list[str]:
    """Give each line of code of a page, and each span of code, as one line."""
    text = page.read_text(encoding="utf-8")
    lines = [line for block in FENCED.findall(text) for line in block.splitlines()]
    rest = FENCED.sub("", text)
    lines += [line.strip() for line in INDENTED.findall(rest)]
    return lines + [" ".join(span.split()) for span in SPAN.findall(rest)]

"""``hystbench docs``: fill the tables of README.md and docs from results."""

from __future__ import annotations

import re
from functools import partial
from pathlib import Path

import click

from hystbench.errors import InputError
from hystbench.files import atomic_path, write_text

#: What stands between the two lines is what the named file holds.
BLOCK = re.compile(
    r"(?P<open><!-- from (?P<source>\S+) -->\n).*?(?P<close><!-- end -->)", re.DOTALL
)
#: A picture in docs/ that is a copy of one in results/.
PICTURE = re.compile(
    r"<!-- picture (?P<source>\S+) -->\n!\[[^\]]*\]\((?P<copy>[^)]+)\)"
)


@click.command()
@click.argument(
    "pages", nargs=-1, type=click.Path(exists=True, dir_okay=False, path_type=Path)
)
def docs(pages: tuple[Path, ...]) -> None:
    """Fill PAGES (README.md and docs/*.md where none are named) from results.

    A block ``<!-- from FILE -->`` to ``<!-- end -->`` gets the text of FILE; the
    picture below ``<!-- picture FILE -->`` gets a copy of FILE. Numbers in the pages
    come from results in this way only.
    """
    for page in pages or [Path("README.md"), *sorted(Path("docs").glob("*.md"))]:
        text = page.read_text(encoding="utf-8")
        filled = BLOCK.sub(partial(_filled, page), text)
        for found in PICTURE.finditer(filled):
            _copy(page, Path(found["source"]), page.parent / found["copy"])
        if filled != text:
            write_text(page, filled)


def _filled(page: Path, found: re.Match[str]) -> str:
    source = _existing(page, Path(found["source"]))
    content = source.read_text(encoding="utf-8").strip()
    return f"{found['open']}\n{content}\n\n{found['close']}"


def _copy(page: Path, source: Path, copy: Path) -> None:
    content = _existing(page, source).read_bytes()
    if not copy.is_file() or copy.read_bytes() != content:
        with atomic_path(copy) as temporary:
            temporary.write_bytes(content)


def _existing(page: Path, source: Path) -> Path:
    if not source.is_file():
        raise InputError(f"{page}: no file {source}; expected 'make reproduce' to run")
    return source

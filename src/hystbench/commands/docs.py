"""``hystbench docs``: fill the tables of README.md and docs from results."""

from __future__ import annotations

import csv
import re
from functools import partial
from pathlib import Path

import click

from hystbench.errors import InputError, nearest
from hystbench.files import atomic_path, write_text

#: What stands between the two lines is what the named file holds.
BLOCK = re.compile(
    r"(?P<open><!-- from (?P<source>[^\s;]+)(?P<choice>[^>]*?) -->\n).*?"
    r"(?P<close><!-- end -->)",
    re.DOTALL,
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

    A block ``<!-- from FILE -->`` to ``<!-- end -->`` gets the text of FILE. Of a CSV
    file it gets a table, of some columns and rows where it says so:
    ``<!-- from FILE; columns: a, b; rows: c = value -->``. The picture below
    ``<!-- picture FILE -->`` gets a copy of FILE. Numbers in the pages come from
    results in this way only.
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
    if source.suffix == ".csv":
        content = _table(page, source, found["choice"])
    else:
        content = source.read_text(encoding="utf-8").strip()
    return f"{found['open']}\n{content}\n\n{found['close']}"


def _table(page: Path, source: Path, choice: str) -> str:
    """Make a Markdown table of the chosen columns and rows of a CSV file."""
    with source.open(newline="", encoding="utf-8") as stream:
        reader = csv.DictReader(stream)
        rows = list(reader)
        known = list(reader.fieldnames or ())
    asked = {}
    for part in filter(None, (part.strip() for part in choice.split(";"))):
        key, _, value = part.partition(":")
        if key not in ("columns", "rows"):
            near = nearest(key, ("columns", "rows"))
            raise InputError(f"{page}: from {source}: unknown key {key!r}; {near}")
        asked[key] = value.strip()
    columns = [
        name.strip() for name in asked.get("columns", ",".join(known)).split(",")
    ]
    wanted, _, value = (word.strip() for word in asked.get("rows", "").partition("="))
    for name in filter(None, (*columns, wanted)):
        if name not in known:
            near = nearest(name, known)
            raise InputError(f"{page}: from {source}: no column {name!r}; {near}")
    lines = [columns, ["---"] * len(columns)]
    lines += [
        [row[name].replace("|", r"\|") for name in columns]
        for row in rows
        if not wanted or row[wanted] == value
    ]
    return "\n".join("| " + " | ".join(cells) + " |" for cells in lines)


def _copy(page: Path, source: Path, copy: Path) -> None:
    content = _existing(page, source).read_bytes()
    if not copy.is_file() or copy.read_bytes() != content:
        with atomic_path(copy) as temporary:
            temporary.write_bytes(content)


def _existing(page: Path, source: Path) -> Path:
    if not source.is_file():
        raise InputError(f"{page}: no file {source}; expected 'make reproduce' to run")
    return source

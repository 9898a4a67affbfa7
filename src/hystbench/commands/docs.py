"""``hystbench docs``: fill the tables of README.md and docs from results."""

import csv
import re
from functools import partial
from pathlib import Path
from typing import Annotated

import click

from hystbench.errors import InputError, refuse_unknown
from hystbench.files import atomic_path, markdown_table, write_text
from hystbench.options import command

Page = Annotated[Path, click.Path(exists=True, dir_okay=False, path_type=Path)]

#: What stands between the two lines is what the named file holds.
BLOCK = re.compile(
    r"(?P<open><!-- from (?P<source>[^\s;]+)(?P<choice>[^>]*?) -->\n)"
    r"(?P<content>.*?)(?P<close><!-- end -->)",
    re.DOTALL,
)
#: Which block of another page is repeated.
BLOCK_OF = re.compile(r"; block: (?P<file>\S+)")
#: A picture in docs/ that is a copy of one in results/.
PICTURE = re.compile(
    r"<!-- picture (?P<source>\S+) -->\n!\[[^\]]*\]\((?P<copy>[^)]+)\)"
)
#: What makes a source, by how its path begins; the first that fits.
MAKERS = (
    ("results/benchmarks/slurm", "make test-slurm"),
    ("results/benchmarks/", "make bench"),
    ("results/blind/elsewhere", "hystbench job blind-elsewhere"),
    ("docs/left-out-rounds", "hystbench job blind-rounds"),
    ("results/blind/", "snakemake blind"),
    ("results/blind-mechanisms/", "snakemake blind with the set mechanisms"),
    ("results/gap/", "snakemake gap"),
    ("", "make reproduce"),
)
#: Made of records that the project does not ship: where they are missing, a page stays
#: as it is, and that is no failure.
NOT_SHIPPED = ("results/blind/elsewhere",)


@command
def docs(pages: tuple[Page, ...] = ()) -> None:
    """Fill PAGES (README.md and docs/*.md where none are named) from results.

    A block ``<!-- from FILE -->`` to ``<!-- end -->`` gets the text of FILE. Of a CSV
    file it gets a table, of some columns and rows where it says so:
    ``<!-- from FILE; columns: a, b; rows: c = value -->``. ``<!-- from PAGE; block:
    FILE -->`` repeats the block of another page, where FILE is not made with the rest.
    The picture below
    ``<!-- picture FILE -->`` gets a copy of FILE. Numbers in the pages come from
    results in this way only. A page of which a source is missing or wrong is left as
    it is, the others are filled.
    """
    left = False
    # README.md repeats blocks of the others.
    for page in pages or [*sorted(Path("docs").glob("*.md")), Path("README.md")]:
        try:
            if not pages and _is_of_records_elsewhere(page):
                click.echo(f"{page}: left as it is: its records are not shipped")
                continue
            _fill(page)
        except InputError as error:
            click.echo(f"hystbench: {error}", err=True)
            left = True
    if left:
        raise SystemExit(2)


def _is_of_records_elsewhere(page: Path) -> bool:
    """Tell whether a page lacks only what is made of records that are not shipped."""
    missing = _missing(page.read_text(encoding="utf-8"))
    return bool(missing) and all(x.startswith(NOT_SHIPPED) for x in missing)


def _missing(text: str) -> list[str]:
    """List the files that a page is filled from and that are not there."""
    found = (item for pattern in (BLOCK, PICTURE) for item in pattern.finditer(text))
    sources = dict.fromkeys(item["source"] for item in found)
    return [source for source in sources if not Path(source).is_file()]


def _fill(page: Path) -> None:
    text = page.read_text(encoding="utf-8")
    if missing := _missing(text):
        told = [f"{source} (made by '{_maker(source)}')" for source in missing]
        raise InputError(f"{page}: left as it is: no file {', '.join(told)}")
    filled = BLOCK.sub(partial(_filled, page), text)
    for found in PICTURE.finditer(text):
        _copy(Path(found["source"]), page.parent / found["copy"])
    if filled != text:
        write_text(page, filled, edit=True)


def _maker(source: str) -> str:
    return next(command for start, command in MAKERS if source.startswith(start))


def _filled(page: Path, found: re.Match[str]) -> str:
    source = Path(found["source"])
    if source.suffix == ".csv":
        content = _table(page, source, found["choice"])
    elif key := BLOCK_OF.fullmatch(found["choice"]):
        content = _repeated(page, source, key["file"])
    else:
        content = source.read_text(encoding="utf-8").strip()
    return f"{found['open']}\n{content}\n\n{found['close']}"


def _repeated(page: Path, source: Path, file: str) -> str:
    """Give what stands in the block of another page that is filled from a file."""
    blocks = {
        found["source"]: found["content"].strip()
        for found in BLOCK.finditer(source.read_text(encoding="utf-8"))
    }
    refuse_unknown(file, blocks, f"{page}: from {source}: no block {file!r}")
    return blocks[file]


def _table(page: Path, source: Path, choice: str) -> str:
    """Make a Markdown table of the chosen columns and rows of a CSV file."""
    with source.open(newline="", encoding="utf-8") as stream:
        reader = csv.DictReader(stream)
        rows = list(reader)
        known = list(reader.fieldnames or ())
    asked = {}
    for part in filter(None, (part.strip() for part in choice.split(";"))):
        key, _, value = part.partition(":")
        refuse_unknown(
            key, ("columns", "rows"), f"{page}: from {source}: unknown key {key!r}"
        )
        asked[key] = value.strip()
    columns = [
        name.strip() for name in asked.get("columns", ",".join(known)).split(",")
    ]
    wanted, _, value = (word.strip() for word in asked.get("rows", "").partition("="))
    for name in filter(None, (*columns, wanted)):
        refuse_unknown(name, known, f"{page}: from {source}: no column {name!r}")
    chosen = (row for row in rows if not wanted or row[wanted] == value)
    return markdown_table(columns, ([row[name] for name in columns] for row in chosen))


def _copy(source: Path, copy: Path) -> None:
    content = source.read_bytes()
    if not copy.is_file() or copy.read_bytes() != content:
        with atomic_path(copy, edit=True) as temporary:
            temporary.write_bytes(content)

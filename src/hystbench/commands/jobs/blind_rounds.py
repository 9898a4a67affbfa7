"""``hystbench job blind-rounds``: the scores of what was left out, round by round."""

import csv
from pathlib import Path
from typing import Annotated, Any

import click

from hystbench.errors import InputError
from hystbench.files import read_json
from hystbench.signature import Folder, command

Table = Annotated[
    Path, click.Path(dir_okay=False, path_type=Path), "Table to add rows to."
]


@command
def blind_rounds(scores: tuple[Folder, ...], *, to: Table) -> None:
    """Add the SCORES, folders as results/blind, to the table of all rounds.

    Rows that are there stay as they are.
    """
    from hystbench.challenge.contest.rounds import COLUMNS, new_rows  # late: pandas

    before = to.read_text(encoding="utf-8") if to.exists() else ""
    table = csv.DictReader(before.splitlines())
    rows: list[Any] = list(table)
    added: list[tuple[str, ...]] = []
    if before and tuple(table.fieldnames or ()) != COLUMNS:
        raise InputError(f"{to}: expected the columns {', '.join(COLUMNS)}")
    for folder in scores:
        summary = read_json(folder / "summary.json")
        with (folder / "never-seen.csv").open(newline="", encoding="utf-8") as stream:
            found = new_rows(rows, summary, csv.DictReader(stream))
        rows += [dict(zip(COLUMNS, row, strict=True)) for row in found]
        added += found
    with to.open("a", newline="", encoding="utf-8") as stream:
        write = csv.writer(stream, lineterminator="\n")
        if not before:
            write.writerow(COLUMNS)
        elif not before.endswith("\n"):
            stream.write("\n")
        write.writerows(added)

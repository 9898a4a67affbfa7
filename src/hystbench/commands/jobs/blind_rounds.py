"""``hystbench job blind-rounds``: the scores of what was left out, round by round."""

import csv
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Annotated, Any

import click

from hystbench.challenge.contest.never_seen import ALL_NAMES
from hystbench.errors import InputError
from hystbench.files import read_json
from hystbench.options import Folder, command

Table = Annotated[
    Path, click.Path(dir_okay=False, path_type=Path), "Table to add rows to."
]
ROUND = ("set", "group", "first_seed", "sort")
"""Columns that tell one score from another."""
COLUMNS = (*ROUND, "cases", "right", "low", "high", "confidently_wrong")


@command
def blind_rounds(scores: tuple[Folder, ...], *, to: Table) -> None:
    """Add the SCORES, folders as results/blind, to the table of all rounds.

    Rows that are there stay as they are.
    """
    before = to.read_text(encoding="utf-8") if to.exists() else ""
    table = csv.DictReader(before.splitlines())
    rows: list[Any] = list(table)
    added: list[tuple[str, ...]] = []
    if before and tuple(table.fieldnames or ()) != COLUMNS:
        raise InputError(f"{to}: expected the columns {', '.join(COLUMNS)}")
    for folder in scores:
        summary = read_json(folder / "summary.json")
        with (folder / "never-seen.csv").open(newline="", encoding="utf-8") as stream:
            found = _new_rows(rows, summary, csv.DictReader(stream))
        rows += [dict(zip(COLUMNS, row, strict=True)) for row in found]
        added += found
    with to.open("a", newline="", encoding="utf-8") as stream:
        write = csv.writer(stream, lineterminator="\n")
        if not before:
            write.writerow(COLUMNS)
        elif not before.endswith("\n"):
            stream.write("\n")
        write.writerows(added)


def _new_rows(
    before: Iterable[Mapping[str, Any]],
    summary: Mapping[str, Any],
    never_seen: Iterable[Mapping[str, Any]],
) -> list[tuple[str, ...]]:
    """Give what a score adds to the rows of earlier rounds: a row a sort.

    A score of the same set, group and seeds adds nothing: a round is scored once.
    """
    about = {
        "set": summary["set"],
        "group": summary["kept"],  # its name in the file since the first round
        "first_seed": summary["seeds"][0],
    }
    there = {tuple(str(row[name]) for name in ROUND) for row in before}
    now = [{**row, **about} for row in never_seen if row["name"] == ALL_NAMES]
    rows = [tuple(str(row[name]) for name in COLUMNS) for row in now]
    return [row for row in rows if row[: len(ROUND)] not in there]

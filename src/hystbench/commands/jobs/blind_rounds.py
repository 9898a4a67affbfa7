"""``hystbench job blind-rounds``: the scores of what was left out, round by round."""

import csv
from pathlib import Path
from typing import Annotated

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
    from hystbench.challenge.contest.rounds import COLUMNS, further  # late: pandas

    if not to.exists():
        to.write_text(",".join(COLUMNS) + "\n", encoding="utf-8")
    rows = _rows(to)
    if rows and tuple(rows[0]) != COLUMNS:
        raise InputError(f"{to}: expected the columns {', '.join(COLUMNS)}")
    for folder in scores:
        summary = read_json(folder / "summary.json")
        added = further(rows, summary, _rows(folder / "never-seen.csv"))
        rows += [dict(zip(COLUMNS, row, strict=True)) for row in added]
        with to.open("a", newline="", encoding="utf-8") as stream:
            csv.writer(stream, lineterminator="\n").writerows(added)


def _rows(path: Path) -> list[dict[str, str]]:
    with path.open(newline="", encoding="utf-8") as stream:
        return list(csv.DictReader(stream))

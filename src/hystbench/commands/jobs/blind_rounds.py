"""``hystbench job blind-rounds``: the scores of what was left out, round by round."""

import csv
from pathlib import Path
from typing import Any

from hystbench.files import read_json, write_csv
from hystbench.signature import Folder, Out, command


@command
def blind_rounds(scores: tuple[Folder, ...], *, out: Out) -> None:
    """Add the SCORES, folders as results/blind, to the table of all rounds."""
    from hystbench.challenge.contest.rounds import COLUMNS, collected  # late: pandas

    rows: list[Any] = _rows(out) if out.is_file() else []
    for folder in scores:
        summary = read_json(folder / "summary.json")
        found = collected(rows, summary, _rows(folder / "never-seen.csv"))
        rows = [dict(zip(COLUMNS, row, strict=True)) for row in found]
    write_csv(out, COLUMNS, (tuple(row.values()) for row in rows))


def _rows(path: Path) -> list[dict[str, str]]:
    with path.open(newline="", encoding="utf-8") as stream:
        return list(csv.DictReader(stream))

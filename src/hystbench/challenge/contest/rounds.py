"""Scores of each group that was ever left out, round by round."""

from collections.abc import Iterable, Mapping
from typing import Any

from hystbench.challenge.contest.never_seen import ALL_NAMES

ROUND = ("set", "group", "first_seed", "sort")
"""Columns that tell one score from another."""
COLUMNS = (*ROUND, "cases", "right", "low", "high", "confidently_wrong")


def new_rows(
    before: Iterable[Mapping[str, Any]],
    summary: Mapping[str, Any],
    never_seen: Iterable[Mapping[str, Any]],
) -> list[tuple[str, ...]]:
    """Give what a score of what was left out adds to the rows of earlier rounds.

    A score of the same set, group and seeds adds nothing: a round is scored once.

    Parameters
    ----------
    before, summary, never_seen
        Earlier rows, summary.json, and the rows of never-seen.csv.

    Returns
    -------
    list of tuple
        A row a sort (forms, families, unlisted effects), by :data:`COLUMNS`.
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

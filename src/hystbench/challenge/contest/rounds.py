"""Scores of each group that was ever left out, round by round."""

from collections.abc import Iterable, Mapping
from typing import Any

from hystbench.challenge.contest.never_seen import EVERY

ROUND = ("set", "group", "first_seed", "sort")
"""Columns that tell one score from another."""
COLUMNS = (*ROUND, "cases", "right", "low", "high", "confidently_wrong")


def collected(
    before: Iterable[Mapping[str, Any]],
    summary: Mapping[str, Any],
    never_seen: Iterable[Mapping[str, Any]],
) -> list[tuple[str, ...]]:
    """Add a score of what was left out to those of earlier rounds.

    Parameters
    ----------
    before : iterable of mapping
        Earlier rows, by :data:`COLUMNS`. A score of the same set, group and seeds is
        replaced.
    summary, never_seen : mapping, iterable of mapping
        summary.json and the rows of never-seen.csv.

    Returns
    -------
    list of tuple
        A row a round and sort (forms, families, unlisted effects), the earliest seeds
        of a set first.
    """
    about = {
        "set": summary["set"],
        "group": summary["kept"],
        "first_seed": summary["seeds"][0],
    }
    now = [{**row, **about} for row in never_seen if row["name"] == EVERY]
    every = {tuple(str(row[name]) for name in ROUND): row for row in [*before, *now]}
    rows = [tuple(str(row[name]) for name in COLUMNS) for row in every.values()]
    return sorted(rows, key=lambda row: (row[0], int(row[2])))

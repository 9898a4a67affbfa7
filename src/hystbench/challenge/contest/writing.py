"""The score as files: one for each table that docs, figures and readers use."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import astuple
from pathlib import Path
from typing import Any

from hystbench.challenge.contest import tables
from hystbench.challenge.contest.rows import write_rows
from hystbench.challenge.contest.score import Row
from hystbench.challenge.contest.summary import reach, summary
from hystbench.files import write_csv, write_json

_SHARE = ("share", "low", "high", "cases")
_CONFUSION = ("kind", "hidden", "answered", "right", "cases")
_REACH = ("figure", "asked", "reached", "low", "high", "cases", "met")
_RIVALS = (
    "solver",
    "cases",
    "lost",
    "top1 GPI 20 dB",
    "top1 foreign 20 dB",
    "top1 GPI 10 dB",
    "exact_set GPI 20 dB",
    "false_alarm",
    "pairs_both",
    "unlisted_unnamed",
    "shrink_median",
    "seconds_per_case",
    "note",
)


def write_score(
    rows: Sequence[Row],
    transfer: Sequence[Row],
    solver: str,
    about: Mapping[str, Any],
    skipped: Mapping[str, str],
    out: Path,
) -> None:
    """Write the score of a solver, and its rivals' beside it.

    Parameters
    ----------
    rows : sequence of Row
        Of all solvers on one set.
    transfer : sequence of Row
        Of the solver on the transfer set; may be empty.
    solver : str
        Whose score it is.
    about : mapping
        What summary.json says of the contest: the set, its seeds.
    skipped : mapping of str to str
        Solvers that did not enter, and why.
    out : Path
        Folder: ``summary.json``, ``reach.csv``, ``cases.csv``, ``transfer-cases.csv``,
        ``confusion.csv``, ``confused.csv``, ``effects.csv``, ``power.csv``,
        ``reliability.csv`` and ``rivals.csv``.
    """
    own = [row for row in rows if row.solver == solver]
    asked = reach(own, transfer)
    write_csv(out / "reach.csv", _REACH, (_told(astuple(item)) for item in asked))
    write_rows(out / "cases.csv", rows)
    write_rows(out / "transfer-cases.csv", transfer)
    counts = tables.confusion(own)
    write_csv(out / "confusion.csv", _CONFUSION, counts)
    write_csv(
        out / "confused.csv",
        ("hidden", "answered", "cases", "of", "experiment"),
        tables.confused(own),
    )
    write_csv(
        out / "effects.csv",
        ("effect", "family", "figure", *_SHARE),
        map(_told, tables.by_effect(own)),
    )
    write_csv(
        out / "power.csv",
        ("effect", "family", "ratio_db", *_SHARE),
        map(_told, tables.power(own)),
    )
    write_csv(
        out / "reliability.csv",
        ("from", "to", "stated", *_SHARE),
        map(_told, tables.reliability(own)),
    )
    rivals = [_rival(name, rows) for name in dict.fromkeys(r.solver for r in rows)]
    unheard = [(name, 0, *[None] * 10, why) for name, why in skipped.items()]
    write_csv(out / "rivals.csv", _RIVALS, [*rivals, *unheard])
    # Last: where it stands, all is there.
    write_json(
        out / "summary.json",
        {
            "solver": solver,
            **about,
            **summary(own),
            "transfer": summary(transfer) if transfer else None,
            "reach": [item.__dict__ for item in asked],
        },
    )


def _rival(name: str, rows: Sequence[Row]) -> tuple[Any, ...]:
    mine = [row for row in rows if row.solver == name]
    found = {item.figure: item.reached for item in reach(mine, ())}
    lost = [row.lost for row in mine if row.lost]
    figures = [found[figure] for figure in _RIVALS[3:-1]]
    note = f"first loss: {lost[0]}" if lost else ""
    return _told((name, len(mine), len(lost), *figures, note))


def _told(row: Sequence[Any]) -> tuple[Any, ...]:
    """Round numbers to what a table shows; say yes and no."""
    words = {True: "yes", False: "no"}
    return tuple(
        words[item]
        if isinstance(item, bool)
        else (float(f"{item:.4g}") if isinstance(item, float) else item)
        for item in row
    )

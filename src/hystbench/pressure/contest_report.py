"""The contest as files: every entry, the rankings, and both as Markdown."""

from __future__ import annotations

import math
from collections.abc import Sequence
from pathlib import Path

from tabulate import tabulate

from hystbench.files import write_csv, write_text
from hystbench.pressure.contest import Entry, Ranking

COLUMNS = (
    "twin",
    "family",
    "algorithm",
    "protocol",
    "signal",
    "model",
    "fraction_of_bound",
    "second_fraction_of_bound",
    "step_size",
    "second_step_size",
    "at_edge_of_grid",
    "mse",
    "rank",
)
RANKING_COLUMNS = (
    "twin",
    "family",
    "algorithm",
    "protocol",
    "signals",
    "gpo_first",
    "not_first",
    "pairs",
    "pairs_as_published",
    "at_edge_of_grid",
)

PROTOCOLS = {
    "held-out": "one step size, chosen on the calibration's signals, on the others",
    "best": "the best step size for each signal",
}


WRITTEN = ("contest.csv", "ranking.csv", "contest.md")
"""Files of a contest."""


def write_contest(
    entries: Sequence[Entry], rankings: Sequence[Ranking], out: Path
) -> None:
    """Write ``contest.csv``, ``ranking.csv`` and ``contest.md``; empty: diverged."""
    write_csv(out / "contest.csv", COLUMNS, map(_row, entries))
    rows = [
        [
            *(each.twin, each.family, each.algorithm, each.protocol),
            *(each.signals, each.gpo_first, _where(each)),
            *(each.pairs, each.pairs_as_published, _edges(each, entries)),
        ]
        for each in rankings
    ]
    write_csv(out / "ranking.csv", RANKING_COLUMNS, rows)
    write_text(out / "contest.md", markdown(rankings))


def _row(entry: Entry) -> list[object]:
    fractions, steps = list(entry.fractions), list(entry.steps.values())
    return [
        *(entry.twin, entry.family, entry.algorithm, entry.protocol),
        *(entry.signal, entry.model, *_two(fractions), *_two(steps)),
        "yes" if entry.at_edge else "no",
        entry.mse if math.isfinite(entry.mse) else None,
        entry.rank,
    ]


def _two(values: list[float]) -> list[float | None]:
    return [values[0], values[1] if len(values) > 1 else None]


def _edges(ranking: Ranking, entries: Sequence[Entry]) -> str:
    """Name the filters whose best step size lies at an end of the grid somewhere."""
    names = dict.fromkeys(
        e.model
        for e in entries
        if e.at_edge
        and (e.twin, e.algorithm, e.protocol)
        == (ranking.twin, ranking.algorithm, ranking.protocol)
    )
    return " ".join(names)


def _where(ranking: Ranking) -> str:
    return "; ".join(f"{s}: {winner}" for s, winner in ranking.not_first.items())


def markdown(rankings: Sequence[Ranking]) -> str:
    """Write both protocols as tables, one below the other."""
    parts = []
    for protocol, meaning in PROTOCOLS.items():
        mine = [each for each in rankings if each.protocol == protocol]
        if not mine:
            continue
        models = list(mine[0].mean)
        headers = ["twin", "algorithm", "GPO first on", "not on (who is)"]
        headers += ["pairs as published", *(f"{m} (um^2)" for m in models)]
        lines = [
            [
                *(f"{each.twin} ({each.family})", each.algorithm),
                f"{each.gpo_first} of {each.signals}",
                _where(each),
                f"{each.pairs_as_published} of {each.pairs}",
                *(_mean(each.mean[model]) for model in models),
            ]
            for each in mine
        ]
        table = tabulate(lines, headers, tablefmt="pipe", disable_numparse=True)
        parts.append(f"**{meaning[0].upper()}{meaning[1:]}**\n\n{table}")
    legend = "The last columns are geometric means of the MSE over the signals."
    return "\n\n".join([*parts, legend]) + "\n"


def _mean(value: float) -> str:
    return f"{value:.3g}" if math.isfinite(value) else "diverged"

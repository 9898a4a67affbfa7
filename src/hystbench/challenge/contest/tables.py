"""What many judged cases say together: tables, one row a group."""

from __future__ import annotations

import itertools
from collections import Counter
from collections.abc import Callable, Iterable, Sequence
from statistics import median
from typing import Any

import numpy as np

from hystbench.challenge.contest.experiments import experiment
from hystbench.challenge.contest.score import SHAPE, Row
from hystbench.challenge.contest.wilson import Share, share, wilson

#: Edges of the bins of stated confidence.
CONFIDENCES = (0.0, 0.5, 0.6, 0.7, 0.8, 0.9, 0.95, 1.0)
#: First answers that are no effect.
NO_EFFECT = ("no-gap", "unnamed", "parameters", "lost")


def confusion(rows: Iterable[Row]) -> list[tuple[str, str, str, str, int]]:
    """Count what was answered first where at most one effect is hidden.

    Returns
    -------
    list of (kind, hidden, answered, right, cases)
        ``kind`` is single, unlisted or none; ``right`` yes or no. With nothing hidden
        beside a plant of another family than the base's, the shape is right too.
    """
    counts: Counter[tuple[str, str, str, str]] = Counter()
    for row in rows:
        if row.kind not in ("single", "unlisted", "none"):
            continue
        first = _first(row)
        right = {
            "single": first == row.truth,
            "unlisted": first == "unnamed",
            "none": row.false_alarm is False,
        }[row.kind]
        counts[row.kind, row.truth or "none", first, "yes" if right else "no"] += 1
    order = ["single", "unlisted", "none"]
    return [
        (*key, count)
        for key, count in sorted(
            counts.items(), key=lambda item: (order.index(item[0][0]), item[0])
        )
    ]


def confused(rows: Sequence[Row]) -> list[tuple[str, str, int, int, str]]:
    """List single effects that were taken for another, the most frequent first.

    Returns
    -------
    list of (hidden, answered, cases, of, experiment)
        ``of`` is how often the effect was hidden.
    """
    counts = confusion(rows)
    hidden: Counter[str] = Counter()
    for kind, name, _, _, cases in counts:
        hidden[name] += cases if kind == "single" else 0
    wrong = [
        (name, answered, cases, hidden[name], experiment(name, answered))
        for kind, name, answered, right, cases in counts
        if kind == "single" and right == "no" and answered not in NO_EFFECT
    ]
    return sorted(wrong, key=lambda item: -item[2])


def _first(row: Row) -> str:
    if row.lost:
        return "lost"
    if row.verdict == "unnamed":
        return "unnamed"
    names = row.named.split()
    if row.family != "gpi" and row.truth != SHAPE and len(names) > 1:
        names = [name for name in names if name != SHAPE] or [SHAPE]
    return names[0] if names else row.verdict


def by_effect(rows: Iterable[Row]) -> list[tuple[Any, ...]]:
    """Give for each single effect, family and ratio the shares that matter.

    Returns
    -------
    list of tuple
        ``effect, family, ratio_db, figure, share, low, high, cases``.
    """
    out: list[tuple[Any, ...]] = []
    for (effect, ratio), mine in _singles(rows).items():
        for family in ("all", *sorted({row.family for row in mine})):
            group = [row for row in mine if family in ("all", row.family)]
            out += [
                (effect, family, ratio, figure, *shares(group, figure))
                for figure in ("top1", "in_set", "exact", "where_hit")
            ]
    return out


def retuned(rows: Iterable[Row]) -> list[tuple[Any, ...]]:
    """Give how hard each single effect is once the base is re-tuned at its best.

    Returns
    -------
    list of tuple
        ``effect, ratio_db``, then the least, the median and the greatest ratio that is
        left (dB), and ``cases``.
    """
    out: list[tuple[Any, ...]] = []
    for (effect, ratio), mine in _singles(rows).items():
        left = [x.ratio_retuned_db for x in mine if x.ratio_retuned_db is not None]
        if left:
            out.append((effect, ratio, min(left), median(left), max(left), len(left)))
    return out


def _singles(rows: Iterable[Row]) -> dict[tuple[str, float], list[Row]]:
    """Sort cases of one hidden effect by the effect and the ratio."""
    found: dict[tuple[str, float], list[Row]] = {}
    for row in rows:
        if row.kind == "single" and row.ratio_db is not None:
            found.setdefault((row.truth, row.ratio_db), []).append(row)
    return dict(sorted(found.items()))


def power(rows: Iterable[Row]) -> list[tuple[Any, ...]]:
    """Give the share of cases in which an effect was named, by the hidden ratio.

    Returns
    -------
    list of tuple
        ``effect, family, ratio_db, share, low, high, cases``; effect and family may
        be ``all``.
    """
    chosen = [row for row in rows if row.kind == "single"]
    effects = ("all", *sorted({row.truth for row in chosen}))
    families = ("all", *sorted({row.family for row in chosen}))
    out: list[tuple[Any, ...]] = []
    for effect in effects:
        for family in families:
            group = [
                row
                for row in chosen
                if effect in ("all", row.truth) and family in ("all", row.family)
            ]
            for ratio in sorted({float(row.ratio_db or 0.0) for row in group}):
                same = [row for row in group if row.ratio_db == ratio]
                out.append((effect, family, ratio, *shares(same, "all_named")))
    return out


def stated(rows: Iterable[Row]) -> list[tuple[float, bool]]:
    """Give the stated confidence of each effect named, and whether it is hidden."""
    out = []
    for row in rows:
        hidden = row.truth.split()
        for told in row.confidences.split():
            name, _, confidence = told.rpartition("=")
            out.append((float(confidence), name in hidden))
    return out


def reliability(rows: Iterable[Row]) -> list[tuple[Any, ...]]:
    """Hold stated confidence against what happened.

    Returns
    -------
    list of tuple
        ``from, to, stated, share, low, high, effects`` of each bin that holds any;
        ``stated`` is the mean.
    """
    pairs = stated(rows)
    edges = list(itertools.pairwise(CONFIDENCES))
    out: list[tuple[Any, ...]] = []
    for low, high in edges:
        inside = [
            (said, right)
            for said, right in pairs
            if low <= said < high or (said == high == 1.0)
        ]
        if inside:
            mean = float(np.mean([said for said, _ in inside]))
            out.append((low, high, mean, *share([right for _, right in inside])))
    return out


def brier(rows: Iterable[Row]) -> float | None:
    """Mean square of stated confidence minus what happened (1 or 0)."""
    pairs = stated(rows)
    if not pairs:
        return None
    return float(np.mean([(said - right) ** 2 for said, right in pairs]))


def shares(rows: Sequence[Row], figure: str) -> Share:
    """Share of rows of which a figure is true; rows without it are left out."""
    return share([value for row in rows if (value := getattr(row, figure)) is not None])


def middle(rows: Iterable[Row], figure: Callable[[Row], float | None]) -> float | None:
    """Median of a figure; None where no row has it."""
    values = [value for row in rows if (value := figure(row)) is not None]
    return float(np.median(values)) if values else None


def coverage(rows: Sequence[Row]) -> Share:
    """Share of the 95 % intervals that hold the true value.

    Numbers of one case are not independent; the interval takes them so.
    """
    return wilson(sum(row.covered for row in rows), sum(row.intervals for row in rows))

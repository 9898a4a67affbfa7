"""A race of starts: all are fitted a little, and the better ones further."""

from __future__ import annotations

from collections.abc import Sequence
from math import ceil

import numpy as np

from hystbench.gap.fitting.fit_each import fit_each
from hystbench.gap.fitting.least_squares import Fitted, fitted
from hystbench.gap.fitting.score import Score
from hystbench.gap.inside.beginnings import Beginnings
from hystbench.gap.thresholds import SCALE

FEW = 4
"""Evaluations of the residual after which the worse half of the starts is left."""

Running = list[tuple[Fitted, Fitted]]
"""Starts, each with what it came to; the least score first."""


def a_little(begun: Sequence[Fitted], beginnings: Beginnings) -> Running:
    """Fit starts by a few evaluations."""
    cut = [(item, Fitted(beginnings.cut(item.state), np.inf)) for item in begun]
    return further(cut, beginnings.score, FEW)


def further(running: Running, score: Score, evaluations: int) -> Running:
    """Fit all of them by so many evaluations more."""
    more = fit_each(
        lambda own: fitted(own.state, score, evaluations),
        [own for _, own in running],
        evaluations,
    )
    pairs = zip((item for item, _ in running), more, strict=True)
    return sorted(pairs, key=lambda pair: pair[1].score)


def raced(
    running: Running, score: Score, evaluations: int, most: int
) -> tuple[Fitted, Fitted]:
    """Fit the better half of starts further, until one is left.

    Successive halving [1]_: the same time is spent on all starts of a round together.
    The best start of each law stays for a round more: some laws take longer to come
    near. It also stays while it cannot be told apart from the best of all. Of laws that
    cannot be told apart it is the one of the fewest numbers.

    Parameters
    ----------
    running : list of (Fitted, Fitted)
        Fitted by so many evaluations of the residual.
    score : Score
    evaluations, most : int
        As many as before at first, twice as many each time, and so many at the end.

    References
    ----------
    .. [1] K. Jamieson, A. Talwalkar, "Non-stochastic best arm identification and
       hyperparameter optimization", AISTATS 2016, 240-248.
    """
    as_likely = np.inf
    while len(running) > 1 and evaluations < most:
        half = ceil(len(running) / 2)
        best_of_law = {_law(item): item for item, _ in reversed(running)}
        kept = [
            (item, own)
            for k, (item, own) in enumerate(running)
            if k < half or (best_of_law[_law(item)] is item and own.score <= as_likely)
        ]
        evaluations = min(2 * evaluations, most)
        running = further(kept, score, evaluations)
        as_likely = running[0][1].score + SCALE
    most_likely = running[0][1].score + SCALE
    near = [pair for pair in running if pair[1].score <= most_likely] or running
    return min(near, key=lambda pair: (pair[1].state.freedom, pair[1].score))


def _law(item: Fitted) -> tuple[tuple[str, ...], tuple[str, ...]]:
    return item.effects, item.forms

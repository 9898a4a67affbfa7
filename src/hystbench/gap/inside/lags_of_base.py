"""Lags beside an identified host: poles of the base, and no effects."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from hystbench.gap.fitting.edit_chain import without_effect
from hystbench.gap.fitting.fit_each import fit_states
from hystbench.gap.fitting.least_squares import (
    EVALUATIONS,
    Fitted,
    fitted_to_the_end,
    judged,
)
from hystbench.gap.fitting.score import Score
from hystbench.gap.fitting.state import ModelState
from hystbench.gap.inside.choose import best_of_each

LAGS = frozenset({"drive-lag", "sensor-lag"})


def with_lags_of_base(
    best: Fitted, found: Sequence[Fitted], score: Score
) -> list[Fitted]:
    """Give lags that were put beside an identified host to the host.

    A linear model that is identified has the poles that its records ask for, and one
    coordinate has two of them. A device of a higher order needs another pole beside its
    effects. No simulation lacked it.

    Parameters
    ----------
    best : Fitted
        Of those found.
    found : sequence of Fitted
        The host alone first.
    score : Score

    Returns
    -------
    list of Fitted
        Those found as they were, where the best one has no lag. Else the host with the
        lag: alone, with the effects of the best one, with all but one of these, and
        with effects that were found beside the same lag. Of each set the best.
    """
    if LAGS.isdisjoint(best.effects):
        return list(found)
    state = _as_host(best.state)
    alone = state
    while alone.added:
        alone = without_effect(alone, 0)
    fewer = (without_effect(state, k) for k in range(len(state.added)))
    less = [alone, *(item for item in fewer if item.added)]
    fits = fit_states(lambda item: fitted_to_the_end(item, score), less, EVALUATIONS)
    lags = LAGS.intersection(best.effects)
    states = (_as_host(x.state) for x in found if LAGS.intersection(x.effects) == lags)
    return best_of_each([*fits, *(Fitted(x, judged(x, score)) for x in states)])


def _as_host(state: ModelState) -> ModelState:
    """Count the lags that were added among the blocks of the host."""
    added = tuple(item for item in state.added if item.effect not in LAGS)
    return replace(state, added=added)

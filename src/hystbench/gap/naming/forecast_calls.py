"""How many calls of a simulator of somebody's own a search is likely to need."""

from __future__ import annotations

from math import prod

from hystbench.blocks.calls import PATIENCE, current, minutes
from hystbench.blocks.simulator import Simulator
from hystbench.errors import InputError
from hystbench.gap.effects import among
from hystbench.gap.effects.effect import Declined
from hystbench.gap.effects.variant import Variant
from hystbench.gap.fitting.refit import LOOKS
from hystbench.gap.fitting.state import ModelState
from hystbench.gap.fitting.tried import records_at_a_glance
from hystbench.gap.fitting.variant_search import POINTS_EACH
from hystbench.gap.naming.rank import FINALISTS
from hystbench.gap.naming.rounds import MOST_EFFECTS
from hystbench.gap.progress import Say
from hystbench.gap.records.evidence import Evidence

AROUND = 7
"""Runs over all records that the search around the best point of a grid takes."""
ERRORS = 10
"""Runs over all records that are kept back for errors of numbers."""
REFITS = 20
"""Runs over all records that the refits of a likely effect take, on folds too."""


def calls_of_a_round(state: ModelState) -> int:
    """Estimate the calls that one round of naming needs, from its grids.

    What the grids ask is counted. What comes behind them depends on what is found
    there, and is estimated by typical numbers.

    Returns
    -------
    int
        0 where the model has no function, or none can be put behind an effect.
    """
    places = [k for k, x in enumerate(state.chain) if isinstance(x, Simulator)]
    if not places:
        return 0
    count = len(state.records)
    few = records_at_a_glance(count)
    grids, before, names = 0, 0, set()
    for effect in among(state.offered).values():
        try:
            variants = list(effect.every_variant(state.simulation))
        except Declined:
            continue
        for item in variants:
            if item.beside is not None or item.start > places[-1]:
                continue
            points = prod(len(axis) for axis in item.grids.values())  # at most
            again = 0 if few == count else 1 + points // POINTS_EACH
            grids += _runs(item) * (points * few + again * (count - few))
            before += 1
            names.add(item.effect)
    finalists = min(FINALISTS, len(names))
    return grids + count * (AROUND * before + REFITS * finalists + LOOKS)


def reserve_calls(evidence: Evidence) -> None:
    """Keep back, of the calls that a user allows, those that come after the search.

    That is what errors of numbers need on the fit records, and each stage from the
    base to the last effect on the hold-out records.

    Raises
    ------
    InputError
        If as many or more are kept back than are left.
    """
    calls = current()
    if calls.bound is None or not calls.made:
        return
    calls.reserve = ERRORS * len(evidence.fit) + (MOST_EFFECTS + 1) * len(
        evidence.hold_out
    )
    least = calls.made + calls.reserve
    if calls.bound <= least:
        raise InputError(
            f"--calls {calls.bound}: {calls.made} were made to run the base, and "
            f"{calls.reserve} are kept back for what follows the search; expected more "
            f"than {least}"
        )


def foretell(state: ModelState, say: Say) -> None:
    """Tell how long a search will take at most, where a simulator makes it long.

    Parameters
    ----------
    state : ModelState
        The base on the fit records, which has been run.
    say : callable
    """
    calls, one = current(), foretell_rest(state, 0)
    took = calls.expected * calls.mean_seconds
    if took < PATIENCE:
        return
    bound = "" if calls.bound is None else f"; --calls stops at {calls.bound:,}"
    say(
        f"{calls.mean_seconds:.2g} s a call of the simulator; an estimate: about "
        f"{one:,} calls for each effect that is added, {calls.expected:,} calls and "
        f"{minutes(took)} at the most{bound}"
    )


def foretell_rest(state: ModelState, rounds: int) -> int:
    """Estimate what is still to come, by what earlier rounds have really needed.

    Parameters
    ----------
    state : ModelState
        The model before the next round.
    rounds : int
        How many are done.

    Returns
    -------
    int
        Calls of one round; 0 where no simulator is called.
    """
    calls = current()
    if not calls.made:
        return 0
    one = calls_of_a_round(state)
    calls.expected = calls.asked + max(MOST_EFFECTS - rounds, 0) * one
    return one


def _runs(variant: Variant) -> int:
    """Count the simulations that a point of the grid takes."""
    return len(variant.unit) + (not variant.neutral) if variant.unit else 1

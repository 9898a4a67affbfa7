"""What naming has to compute: here and now, or looked up where a job computed it."""

from __future__ import annotations

from hystbench.blocks.simulated_column import NEEDS_RERUN
from hystbench.gap.effects.base import Declined, Effect, Variant
from hystbench.gap.fit import added, finished
from hystbench.gap.score import Score
from hystbench.gap.search import Attempt, Trial, at_a_glance, coarse, fine
from hystbench.gap.state import State

Tried = tuple[Attempt, Trial]
"""A variant beside a model, and how it does over its grid."""


class Work:
    """The four steps that jobs can take elsewhere; all are computed here and now.

    Naming decides by what they give, and by folds, which are judged where it decides:
    so jobs lead to the same names.
    """

    def tried(
        self, effect: Effect, state: State, score: Score
    ) -> tuple[list[Tried], str]:
        """Score every variant of an effect over its grid; or say why it declines."""
        try:
            variants = list(effect.variants(state.scene))
        except Declined as reason:
            return [], str(reason)
        runnable = [
            (number, item)
            for number, item in enumerate(variants)
            if not _needs_rerun(state, item)
        ]
        if variants and not runnable:
            return [], NEEDS_RERUN
        few, few_score = at_a_glance(state, score)
        found = []
        refused = ""
        for number, item in runnable:
            attempt = Attempt(state, item, score, number)
            try:
                trial = coarse(attempt, Attempt(few, item, few_score))
            except Declined as reason:
                refused = str(reason)
                continue
            found.append((attempt, trial))
        return found, "" if found else refused

    def fine(self, attempt: Attempt, trial: Trial) -> Trial:
        """Search a variant around the best point of its grid."""
        return fine(attempt, trial)

    def added(self, state: State, trial: Trial, score: Score) -> tuple[State, float]:
        """Add an effect as a trial found it and refit everything together.

        Raises
        ------
        InputError
            If a block refuses the values.
        """
        return added(state, trial, score)

    def finished(self, state: State, score: Score) -> tuple[State, float]:
        """Simulate a model exactly and refit it to the end."""
        return finished(state, score)


def _needs_rerun(state: State, variant: Variant) -> bool:
    """Tell whether a variant changes what enters a block whose output is stored."""
    behind = state.chain[variant.start :]
    return variant.beside is None and not all(block.reruns for block in behind)


IN_PROCESS = Work()

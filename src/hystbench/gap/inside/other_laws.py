"""Other laws of effects that were found together.

A law that was fitted alone may have explained a second effect as well. When that
effect is added, the law starts from those numbers. Its fit may then end in a worse
minimum than that of a simpler law, or of another law of as many numbers.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

from hystbench.gap.effects import effects
from hystbench.gap.effects.law import Law
from hystbench.gap.fitting.fit_each import fit_states
from hystbench.gap.fitting.least_squares import EVALUATIONS, Fitted, fitted_to_the_end
from hystbench.gap.fitting.score import Score
from hystbench.gap.fitting.state import ModelState


def by_other_laws(best: Fitted, score: Score) -> list[Fitted]:
    """Fit a hypothesis of several effects with another law of one, each in turn.

    Parameters
    ----------
    best : Fitted
    score : Score

    Returns
    -------
    list of Fitted
        None of a single effect, nor of a law beside which there is no other.
    """
    if len(best.effects) < 2:
        return []
    return fit_states(
        lambda state: fitted_to_the_end(state, score),
        list(_begun(best.state)),
        EVALUATIONS,
    )


def _begun(state: ModelState) -> Iterator[ModelState]:
    """Put other laws in the place of those that effects act by inside."""
    for number, added in enumerate(state.added):
        if added.place != "inside" or len(added.blocks) != 1:
            continue
        (place,) = added.blocks
        for law in effects()[added.effect].other_laws(state.chain[place]):
            yield _with(state, number, place, law)


def _with(state: ModelState, number: int, place: int, law: Law) -> ModelState:
    every = list(state.added)
    fewer = sum(x.block == place for x in state.free) - len(law.free)
    own = (x for x in state.free if x.block != place or x.parameter in law.free)
    added = every[number]
    every[number] = added._replace(
        form=law.form,
        values={name: getattr(law.block, name) for name in law.free},
        charge=added.charge - fewer,
    )
    state = replace(state, free=tuple(own), added=tuple(every))
    return state.with_blocks({place: law.block})

"""Forces inside the dynamics of records whose sensor has another zero every time."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

from hystbench.gap.fitting.model_score import score_of
from hystbench.gap.fitting.own_values import NONE, OwnValues, own_values
from hystbench.gap.fitting.score import Score
from hystbench.gap.fitting.state import ModelState
from hystbench.gap.inside.named_inside import Inside
from hystbench.gap.naming.with_own_values import ROUNDS, on_records
from hystbench.gap.progress import Say
from hystbench.gap.thresholds import PAYS

Look = Callable[[ModelState], Inside | None]


def apart_inside(
    start: ModelState, inside: Inside | None, floor_rms: float, look: Look, say: Say
) -> tuple[ModelState, Inside | None, OwnValues]:
    """Look for forces again without the offsets that records have of their own.

    Offsets are found beside what was named, then beside what is named without them, and
    so on while the score falls. The first time it has to fall by what an effect has to
    gain, all offsets charged.

    Parameters
    ----------
    start : ModelState
        The base on the fit records.
    inside : Inside or None
        What was found on them as they are.
    floor_rms : float
    look : callable
        Finds forces beside a base.
    say : callable

    Returns
    -------
    start : ModelState
        The base on records without their offsets, or as it was.
    inside : Inside or None
    own : OwnValues
    """
    square = floor_rms**2
    score = Score.plain(start.sample, square)
    state = start if inside is None else inside.named.state
    found, least = (start, inside, NONE), score_of(state, score) - PAYS
    for _ in range(ROUNDS):
        own = own_values(start.records, state.exact, square, ("offset",))
        if not own.records:
            break
        say("inside: records have an offset of their own: looking beside that")
        apart = on_records(start, own.taken_off(start.records, start.hold))
        again, before = look(apart), [item.effect for item in state.added]
        state = apart if again is None else again.named.state
        value = score_of(state, score) + own.charge
        if again is None or value >= least:
            break
        share = apart.share(start, square, start.power(square))
        found, least = (apart, again, replace(own, share=share)), value
        if [item.effect for item in state.added] == before:
            break  # looking has told all that it can
    return found

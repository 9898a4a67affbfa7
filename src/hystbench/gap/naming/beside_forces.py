"""What the input does not explain, beside forces inside the dynamics."""

from __future__ import annotations

from dataclasses import replace

from hystbench.gap.effects import among
from hystbench.gap.fitting.edit_chain import without_effect
from hystbench.gap.fitting.model_score import make_score, score_of
from hystbench.gap.fitting.refit import finished, finished_to_the_end
from hystbench.gap.fitting.state import ModelState
from hystbench.gap.naming.add_effects import Named, names, pays
from hystbench.gap.naming.rank import rank
from hystbench.gap.naming.removal import without_what_goes
from hystbench.gap.naming.rounds import Round
from hystbench.gap.progress import Say
from hystbench.gap.records.floor import Floor
from hystbench.gap.thresholds import FURTHER

NOT_OF_THE_INPUT = ("mains-pickup", "drift")
"""Effects that the input does not explain: they are beside all others."""


def beside_forces(
    named: Named, start: ModelState, floor: Floor, share: float, say: Say
) -> Named:
    """Take out forces of unknown size, and add signals that no force makes.

    Where forces were named in the dynamics no chain is tried behind them; but what the
    input does not explain is beside any of them, if it pays and matters.

    Parameters
    ----------
    named : Named
        Forces inside, by rounds.
    start : ModelState
        What stands for the base, without them.
    floor : Floor
    share : float
        Of the gap, that may stay unnamed.
    say : callable
    """
    state, gone = without_what_goes(named.state, floor, None, say)
    if gone:  # what went was judged beside other forms of those that stay
        state = finished_to_the_end(state, make_score(state, floor, forms=False))
    named = replace(named, state=state, taken_out=(*named.taken_out, *gone))
    gap = start.gap(floor.square)
    while (more := _with_one_beside(named, floor, gap, share)) is not None:
        if len(more.rounds) > len(named.rounds):
            first = more.rounds[-1].ranking[0]
            say(f"inside: beside it {first.effect}: gain {first.gain:.1f}")
        named = more
    return named


def _with_one_beside(
    named: Named, floor: Floor, gap: float, share: float
) -> Named | None:
    """Add the signal that the input does not explain and that does best, if it pays.

    Forces are refitted beside it. If the signal matters little then, it only freed them
    from a bad fit: they stay, it goes.
    """
    square, state = floor.square, named.state
    known = [
        item
        for item in among(state.offered).values()
        if item.name in NOT_OF_THE_INPUT and item.name not in names(state)
    ]
    if not known:
        return None
    ranking = rank(state, make_score(state, floor), known, needs=FURTHER)
    first = ranking[0]
    if not pays(first, state, square, gap, share):
        return None
    assert first.state is not None  # noqa: S101  (for the type checker)
    one = Round(state, first.score + first.gain, ranking, True)
    # They were fitted with the signal in what is left.
    score = make_score(first.state, floor, forms=False)
    beside, _ = finished(first.state, score)
    alone = without_effect(beside, len(beside.added) - 1)
    if alone.power(square) - beside.power(square) > share * gap:
        return replace(named, state=beside, rounds=(*named.rounds, one))
    alone, value = finished(alone, score)
    better = value < score_of(state, score) - FURTHER
    return replace(named, state=alone) if better else None

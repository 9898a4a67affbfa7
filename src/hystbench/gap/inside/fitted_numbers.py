"""Numbers of a host that were fitted though the base gives them."""

from __future__ import annotations

from hystbench.gap.effects import effects
from hystbench.gap.fitting.state import ModelState
from hystbench.gap.inside.host import Host
from hystbench.gap.inside.one_coordinate import ZEROS
from hystbench.gap.thresholds import ABOUT, CERTAIN
from hystbench.sentences import percent


def more_for_numbers(host: Host, state: ModelState, known: float) -> float:
    """Charge the numbers of a base that were fitted though it gives them, beyond usual.

    Changes of no more than `ABOUT`, the tolerance of a data sheet, are free of charge
    if as many effects are named as with the numbers as they are. If fewer are named,
    the usual charge stays: the numbers stand for an effect. Larger changes have to be
    beyond doubt.

    Parameters
    ----------
    host : Host
    state : ModelState
        The host with its effects.
    known : float
        How many effects are named with the numbers as they are.
    """
    held = any(free.given is not None for free in state.free)
    if not (host.charge and held):
        return 0.0
    far, _ = moved_most(host.alone, state)
    if far > ABOUT:
        return CERTAIN - host.charge
    return -host.charge if len(state.added) >= known else 0.0


def re_tuning(alone: ModelState, state: ModelState) -> str:
    """Say which of a host's own numbers the fit with the effects moved most, if far.

    Nobody said that they are free: a wrong number of the base would hide behind a name.
    """
    far, name = moved_most(alone, state)
    if far < ABOUT:
        return ""
    return (
        f"; of its own numbers the fit moved {name} most, by {percent(far)}: check "
        "whether it can be so far off"
    )


def moved_most(alone: ModelState, state: ModelState) -> tuple[float, str]:
    """Give by which share a host's own number moved that moved most, and its name.

    What an effect stands for is taken out of the host's own numbers, and is not meant.
    """
    added = state.places_added
    own = [place for place in range(len(state.chain)) if place not in added]
    if len(own) != len(alone.chain):
        return 0.0, ""  # effects of stores are the stores' own numbers
    meant = {effects()[item.effect].taken_from for item in state.added}
    moves = [(0.0, "")]
    for place, given in zip(own, alone.chain, strict=True):
        for free in state.free:
            if free.block != place or free.parameter in {*meant, *ZEROS}:
                continue
            was = getattr(given, free.parameter)
            if free.element is None and was:
                moves.append((abs(state.value(free) / was - 1.0), free.parameter))
    return max(moves)

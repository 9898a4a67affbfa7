"""What re-tuning a base that is known only roughly could gain, and how far it went."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from hystbench.blocks.base import Block
from hystbench.blocks.input_delay import InputDelay
from hystbench.blocks.linear import LinearBlock
from hystbench.blocks.mechanism import Mechanism
from hystbench.blocks.relaxation_force import RelaxationForce
from hystbench.blocks.resonance import Resonance
from hystbench.blocks.structure import Structure
from hystbench.gap.bases.roughly_known import LATE, behind_a_delay, stated
from hystbench.gap.fitting.edit_chain import rearranged
from hystbench.gap.fitting.held import Held
from hystbench.gap.fitting.model_score import beside_of
from hystbench.gap.fitting.on_records import free_within
from hystbench.gap.fitting.refit import finished
from hystbench.gap.fitting.score import Score
from hystbench.gap.fitting.state import Free, ModelState
from hystbench.gap.thresholds import ABOUT, PARAMETER
from hystbench.sentences import finely, shortly

LEAST = 5e-3
"""Share by which a number has to move to be told."""


def re_tuned_score(
    state: ModelState, score: Score, wanted: float, far: bool = False
) -> float:
    """Give the score of a model whose base is re-tuned, as slopes tell.

    Each number that is freed is charged by how far the records tell it.

    Parameters
    ----------
    state : ModelState
        A model of a given base with effects.
    score : Score
    wanted : float
        Score that is of use: what cannot come below it is not computed.
    far : bool
        Whether numbers may have to move so far that a fit goes first.
    """
    if score.least(state.freedom) >= wanted:
        return np.inf
    loose = _loosened(state)
    if far:
        loose, _ = finished(loose, score)
    columns = loose.tangents
    if not np.isfinite(columns).all():
        return -np.inf
    found = score.amplitudes(
        loose.residual,
        columns,
        state.freedom,
        loose.held,
        beside=beside_of(loose, score),
    )
    return found.score + charge_of_base(loose, score)


def charge_of_base(state: ModelState, score: Score) -> float:
    """Charge the free numbers of a model's base, by how far the records tell them."""
    own = state.places_added
    base = [k for k, free in enumerate(state.free) if free.block not in own]
    if not base:
        return 0.0
    held = Held(state.held.stiffness[base], state.held.moved[base])
    return PARAMETER * score.numbers_told(state.left, state.tangents[:, base], held)


def _loosened(state: ModelState) -> ModelState:
    """Free the numbers that a base states beside effects, and its timing."""
    known = {(free.block, free.parameter) for free in state.free}
    numbers: list[Free] = []
    # An effect may be other numbers of a base's block: the rest may be off too.
    changed = {key for item in state.added for key in item.old_numbers}
    own = state.places_added - {place for place, _ in changed}
    for place, block in enumerate(state.chain):
        for name in () if place in own else stated(block):
            if (place, name) not in known | changed:
                numbers += free_within(place, name, getattr(block, name), ABOUT)
    state = replace(state, free=(*state.free, *numbers))
    most = LATE * min(record.dt for record in state.records)
    chain = behind_a_delay(state.chain, most)
    state = rearranged(state, chain, {k: k + 1 for k in range(len(state.chain))})
    timing = Free(0, "delay_s", None, most, 0.0, 2 * most, given=most)
    state = replace(state, free=(*state.free, timing))
    return state.settled()


def repeats_the_base(state: ModelState) -> bool:
    """Tell whether an effect is of a kind that the base has, as far as it is known.

    A mode is of the base's own kind where the base has one about there. Any other
    block, such as a spring, is where the base holds such a block; other numbers of a
    block, where they are about what they were. A force that relaxes is a damper to slow
    motions and a spring to fast ones, which all mechanisms have.
    """
    for item in state.added:
        moves = [
            abs(getattr(state.chain[place], name) - old) / max(abs(old), 1e-300)
            for (place, name), old in item.old_numbers.items()
        ]
        if moves and max(moves) < ABOUT:
            return True
    own = state.places_added
    added = [state.chain[k] for k in own]
    base = [x for place, x in enumerate(state.chain) if place not in own]
    modes = [x for x in added if isinstance(x, Resonance)]
    kinds = {type(x) for x in added} - {Resonance}
    if RelaxationForce in kinds or kinds & {type(x) for x in base}:
        return True
    if not modes:
        return False
    known = np.array([frequency for x in base for frequency in _swings(x)])
    return any(np.any(np.abs(known / x.frequency_hz - 1.0) < ABOUT) for x in modes)


def _swings(block: Block) -> list[float]:
    """Give the frequencies in Hz of the modes of a block that is linear without forces.

    A mass with a spring has one, however it is damped.
    """
    if isinstance(block, LinearBlock):
        poles = np.linalg.eigvals(block.continuous().a)
        found = np.abs(poles[np.abs(poles.imag) > 0.0])
    elif isinstance(block, Mechanism | Structure):
        masses = [block.linear] if isinstance(block, Mechanism) else block.modes
        found = np.array([np.sqrt(spring / mass) for mass, _, spring in masses])
    else:
        return []
    return list(found / (2 * np.pi))


def re_tuned_words(start: ModelState, state: ModelState) -> str:
    """Say which number of a base the fit moved most, and how late its input is.

    Parameters
    ----------
    start : ModelState
        The base on the fit records, its free numbers as they are given.
    state : ModelState
        A model with effects, beside which they were re-tuned.
    """
    own = state.places_added
    left = [k for k in range(len(state.chain)) if k not in own]
    if len(left) != len(start.chain):
        return "its numbers and its timing were re-tuned"  # an effect stands for one
    dt = min(record.dt for record in start.records)
    moves, samples = [(0.0, "")], 0.0
    for free in start.free:
        was = start.value(free)
        place = left[free.block]
        now = state.value(free._replace(block=place))
        if isinstance(state.chain[place], InputDelay) and free.parameter == "delay_s":
            samples = (now - was) / dt
        elif was:
            moves.append((abs(now / was - 1.0), free.parameter))
    far, name = max(moves)
    told = []
    if far >= LEAST:
        told.append(f"{name} moved most, by {finely(far)}")
    if far > (1.0 - LEAST) * ABOUT:
        told.append("which is as far as it may")
    if abs(samples) >= 10 * LEAST:
        word = "late" if samples > 0 else "early"
        told.append(f"its input counts as {shortly(abs(samples), 2)} samples {word}")
    return ", ".join(told) or "nothing moved far"

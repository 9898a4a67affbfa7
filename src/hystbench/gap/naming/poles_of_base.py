"""Poles of an identified base that show only once effects are beside it."""

from __future__ import annotations

from dataclasses import replace
from typing import NamedTuple

import numpy as np

from hystbench.blocks.base import Block
from hystbench.blocks.linear import LinearBlock
from hystbench.blocks.transfer_function import TransferFunction
from hystbench.errors import InputError
from hystbench.gap.bases.linear import with_its_numbers_free
from hystbench.gap.fitting.model_score import score_of, score_of_numbers
from hystbench.gap.fitting.refit import finished_to_the_end
from hystbench.gap.fitting.score import Score
from hystbench.gap.fitting.state import ModelState
from hystbench.gap.naming.add_effects import Named
from hystbench.gap.naming.removal import TakenOut, without_what_goes
from hystbench.gap.progress import Say
from hystbench.gap.thresholds import PAYS
from hystbench.model import Model

OF_FEW_POLES = frozenset({"creep", "drive-lag", "sensor-lag", "resonance"})
"""Blocks whose poles a transfer function may have as well. A diffusion has many."""
OF_THE_BASE = "its poles may be those of the base, which was identified with the gap"


def with_poles_named(base: Model, found: ModelState) -> Model | None:
    """Give an identified base with the poles that were named beside it.

    A base is identified with the gap in it: folds ask for poles only where these lower
    the error, of which a curve or a loop may be the larger part. Once that is named
    these poles show. They belong to the linear part of the device, which identification
    missed, so they are no missing effect.

    Parameters
    ----------
    base : Model
    found : ModelState
        The base with effects.

    Returns
    -------
    Model or None
        None where no linear effect of few poles was named, or nothing else was.
    """
    count, of_base = len(_linear(found)), len(found.chain) - len(found.places_added)
    if not 0 < count < len(found.added) or of_base != len(base.chain):
        return None
    try:
        pieces = _pieces(found)
    except InputError:
        return None  # rounding makes a slow pole unstable
    chain = tuple(piece.block for piece in pieces if piece.place is None)
    return with_its_numbers_free(replace(base, chain=chain, free=()))


def named_beside_them(
    named: Named, start: ModelState, floor_rms: float, say: Say
) -> Named | None:
    """Give what was named, beside a base that has the poles of its linear effects.

    Parameters
    ----------
    named : Named
    start : ModelState
        The base of :func:`with_poles_named` on the same records.
    floor_rms : float
    say : callable

    Returns
    -------
    Named or None
        None where that leaves more, or an effect is needless then.
    """
    state, linear = named.state, _linear(named.state)
    gone = [TakenOut(state.added[k].effect, OF_THE_BASE) for k in linear]
    pieces = _pieces(state)
    own = [k for k, piece in enumerate(pieces) if piece.place is None]
    chain = [piece.block for piece in pieces]
    for block, place in zip(start.chain, own, strict=True):
        chain[place] = block
    moved = {x.place: k for k, x in enumerate(pieces) if x.place is not None}
    others = tuple(x for k, x in enumerate(state.added) if k not in linear)
    state = replace(state, added=others).rearranged(tuple(chain), moved)
    free = (item._replace(block=own[item.block]) for item in start.free)
    state = replace(state, free=(*free, *state.free), correction=None).settled()
    state = finished_to_the_end(state, score_of_numbers(state, floor_rms))
    score = Score.plain(state.sample, floor_rms**2)
    if score_of(state, score) > score_of(named.state, score) + PAYS:
        return None
    gap = start.power(floor_rms**2)
    if without_what_goes(state, floor_rms, gap, say)[1]:
        return None
    first, *rest = named.rounds
    rounds = (replace(first, before=start), *rest)
    return Named(state, rounds, (*named.gone, *gone))


class _Piece(NamedTuple):
    """A block of a chain, with its place if it belongs to an effect."""

    block: Block
    place: int | None


def _linear(found: ModelState) -> list[int]:
    """Give which effects are linear, of few poles."""
    return [
        number
        for number, item in enumerate(found.added)
        if item.blocks and all(found.chain[k].name in OF_FEW_POLES for k in item.blocks)
    ]


def _pieces(found: ModelState) -> list[_Piece]:
    """Give a chain whose linear effects are ratios of the base; neighbours are one."""
    linear = {k for number in _linear(found) for k in found.added[number].blocks}
    effects = found.places_added - linear
    pieces: list[_Piece] = []
    for place, block in enumerate(found.chain):
        if place in effects:
            pieces.append(_Piece(block, place))
            continue
        own: Block = block
        if isinstance(block, LinearBlock) and place in linear:
            own = _ratio_of(block)
        before, of_effect = pieces[-1] if pieces else (None, None)
        if (
            of_effect is None
            and isinstance(before, TransferFunction)
            and isinstance(own, TransferFunction)
        ):
            pieces[-1] = _Piece(_product(before, own), None)
        else:
            pieces.append(_Piece(own, None))
    return pieces


def _ratio_of(block: LinearBlock) -> TransferFunction:
    """Give a linear block as a ratio of polynomials."""
    system = block.continuous()
    below = np.poly(system.a)
    above = np.poly(system.a - np.outer(system.b, system.c)) + (system.d - 1.0) * below
    return TransferFunction(
        numerator=tuple((np.trim_zeros(above, "f") / below[-1]).tolist()),
        denominator=tuple((below / below[-1]).tolist()),
        start=block.start,
        hold=block.hold,
    )


def _product(one: TransferFunction, other: TransferFunction) -> TransferFunction:
    """Multiply two ratios; the start and the hold are those of the first."""
    up = np.polymul(one.numerator, other.numerator)
    down = np.polymul(one.denominator, other.denominator)
    return replace(one, numerator=tuple(up.tolist()), denominator=tuple(down.tolist()))

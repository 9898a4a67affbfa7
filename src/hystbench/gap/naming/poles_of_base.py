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
from hystbench.gap.fitting.edit_chain import rearranged
from hystbench.gap.fitting.model_score import score_of, score_of_numbers
from hystbench.gap.fitting.refit import finished_to_the_end
from hystbench.gap.fitting.score import Score
from hystbench.gap.fitting.state import ModelState
from hystbench.gap.naming.add_effects import Named
from hystbench.gap.naming.removal import TakenOut, without_what_goes
from hystbench.gap.progress import Say
from hystbench.gap.records.floor import Floor
from hystbench.gap.thresholds import PAYS
from hystbench.model import Model
from hystbench.record import FloatArray

OF_FEW_POLES = frozenset({"creep", "drive-lag", "sensor-lag", "resonance"})
"""Blocks whose poles a transfer function may have as well. A diffusion has many."""
ROUNDING = 1e-12
"""Share of a denominator's coefficient below which the numerator's is rounding."""
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
        pieces = [piece for piece in _pieces(found) if piece.of_base]
    except InputError:
        return None  # rounding makes a slow pole unstable
    chain = tuple(piece.block for piece in pieces)
    given = with_its_numbers_free(replace(base, chain=chain, free=()))
    # What stands by itself keeps a static gain of one: curves beside it have their own.
    was_free = {(item.block, item.parameter) for item in found.free}
    held = {
        f"{label}.{name}"
        for (label, block), piece in zip(given.labelled(), pieces, strict=True)
        if block.name in OF_FEW_POLES
        for name in block.parameters()
        if (piece.place, name) not in was_free
    }
    return replace(given, free=tuple(name for name in given.free if name not in held))


def named_beside_them(
    named: Named, start: ModelState, floor: Floor, say: Say
) -> Named | None:
    """Give what was named, beside a base that has the poles of its linear effects.

    Parameters
    ----------
    named : Named
    start : ModelState
        The base of :func:`with_poles_named` on the same records.
    floor : Floor
    say : callable

    Returns
    -------
    Named or None
        None where that leaves more, or an effect is needless then.
    """
    state, linear = named.state, _linear(named.state)
    gone = [TakenOut(state.added[k].effect, OF_THE_BASE) for k in linear]
    pieces = _pieces(state)
    own = [k for k, piece in enumerate(pieces) if piece.of_base]
    chain = [piece.block for piece in pieces]
    for block, place in zip(start.chain, own, strict=True):
        chain[place] = block
    moved = {x.place: k for k, x in enumerate(pieces) if not x.of_base}
    others = tuple(x for k, x in enumerate(state.added) if k not in linear)
    state = rearranged(replace(state, added=others), tuple(chain), moved)
    free = (item._replace(block=own[item.block]) for item in start.free)
    state = replace(state, free=(*free, *state.free), correction=None).settled()
    state = finished_to_the_end(state, score_of_numbers(state, floor))
    score = Score.plain(state.sample, floor.square)
    if score_of(state, score) > score_of(named.state, score) + PAYS:
        return None
    gap = start.power(floor.square)
    if without_what_goes(state, floor, gap, say)[1]:
        return None
    first, *rest = named.rounds
    rounds = (replace(first, before=start), *rest)
    return Named(state, rounds, (*named.taken_out, *gone))


class _Piece(NamedTuple):
    """A block of a chain, with the place that it, or the first of a product, had."""

    block: Block
    place: int
    of_base: bool
    """Whether it belongs to the base, and not to an effect."""


def _linear(found: ModelState) -> list[int]:
    """Give which effects are linear, of few poles."""
    return [
        number
        for number, item in enumerate(found.added)
        if item.blocks and all(found.chain[k].name in OF_FEW_POLES for k in item.blocks)
    ]


def _pieces(found: ModelState) -> list[_Piece]:
    """Give a chain whose linear effects are the base's, in a ratio beside them."""
    linear = {k for number in _linear(found) for k in found.added[number].blocks}
    effects = found.places_added - linear
    pieces: list[_Piece] = []
    for place, block in enumerate(found.chain):
        one = _Piece(block, place, place not in effects)
        last = pieces[-1] if pieces else None
        if last is not None and last.of_base and one.of_base:
            product = _product(last.block, block)
            if product is not None:
                pieces[-1] = last._replace(block=product)
                continue
        pieces.append(one)
    return pieces


def _product(one: Block, other: Block) -> TransferFunction | None:
    """Multiply a ratio with another or with a block of few poles; of others none."""
    ratio = one if isinstance(one, TransferFunction) else other
    first, second = _ratio_of(one), _ratio_of(other)
    if first is None or second is None or not isinstance(ratio, TransferFunction):
        return None
    up, down = (np.polymul(*pair).tolist() for pair in zip(first, second, strict=True))
    return replace(ratio, numerator=tuple(up), denominator=tuple(down))


def _ratio_of(block: Block) -> tuple[FloatArray, FloatArray] | None:
    """Give numerator and denominator of a ratio, or of a block of few poles."""
    if isinstance(block, TransferFunction):
        return np.array(block.numerator), np.array(block.denominator)
    if not isinstance(block, LinearBlock) or block.name not in OF_FEW_POLES:
        return None
    system = block.continuous()
    below = np.poly(system.a)
    above = np.poly(system.a - np.outer(system.b, system.c)) + (system.d - 1.0) * below
    above[np.abs(above) < ROUNDING * np.abs(below)] = 0.0
    return np.trim_zeros(above, "f") / below[-1], below / below[-1]

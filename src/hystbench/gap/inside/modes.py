"""Modes of a transfer function: one of them as a mechanism, the others beside it."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from hystbench.blocks.base import Block
from hystbench.blocks.gain import Gain
from hystbench.blocks.mechanism import Mechanism
from hystbench.blocks.other_modes import OtherModes
from hystbench.blocks.transfer_function import TransferFunction
from hystbench.errors import InputError
from hystbench.gap.fitting.state import Free, ModelState
from hystbench.gap.thresholds import MOST
from hystbench.record import ComplexArray

NUMBERS = ("mass", "damping", "stiffness", "blend")
"""Of a mode."""
NONE = 1e-3
"""Share of a mode in the output that is none of the motion that is asked for."""
APART = 1e-6
"""Share of its size by which a pole must be away from all others."""


def modes(
    start: ModelState, output: str, others_too: bool = False
) -> Iterator[ModelState]:
    """Give a linear model with one of its modes as a mechanism.

    The model does what it did. The modes come in the order in which they deserve a
    force inside: first the one whose own numbers, were they free in every record,
    would take most of the residual away, and none that would take less than half of
    that. A mode that is linear has the same numbers at every level.

    Parameters
    ----------
    start : ModelState
        Its chain is a transfer function of two oscillating modes or more, of which no
        two poles coincide, and gains; of any other nothing is given.
    output : {"position", "velocity", "acceleration"}
    others_too : bool
        Whether the numbers of the other modes are free as well, and each of them is a
        block of its own: a base that was fitted with the gap in it has all modes wrong.

    Yields
    ------
    ModelState
        The numbers of the mode are free.
    """
    block, *behind = start.chain
    if not isinstance(block, TransferFunction):
        return
    if not all(isinstance(item, Gain) for item in behind):
        return
    poles, _ = poles_of(block)
    away = np.abs(poles[:, None] - poles) + np.diag(np.abs(poles))
    if np.sum(poles.imag > 0) < 2 or np.any(away < APART * np.abs(poles)):
        return
    free = tuple(Free(0, name) for name in NUMBERS)
    split = [
        replace(start, chain=(one.mode, one.rest, *behind), free=free).settled()
        for one in taken_out(block, output)
        if one.rest is not None
    ]
    shares = np.array([explained_by_levels(state) for state in split])
    for k in np.argsort(-shares, kind="stable"):
        if shares[k] >= MOST * shares.max():
            yield with_others_free(split[k]) if others_too else split[k]


def frequency_of(mode: Block) -> float:
    """Give the natural frequency of a mechanism in Hz."""
    assert isinstance(mode, Mechanism)  # noqa: S101  (for the type checker)
    return float(np.sqrt(mode.stiffness / mode.mass) / (2 * np.pi))


def with_others_free(state: ModelState) -> ModelState:
    """Write the other modes beside a mechanism as a block each, all numbers free."""
    mode, others, *behind = state.chain
    assert isinstance(others, OtherModes)  # noqa: S101  (for the type checker)
    each = one_by_one(others)
    free = [
        item for place, block in enumerate(each, 1) for item in numbers_of(block, place)
    ]
    chain = (mode, *each, *behind)
    return replace(state, chain=chain, free=(*state.free, *free)).settled()


def numbers_of(block: OtherModes, place: int) -> list[Free]:
    """Give the coefficients of a ratio as free numbers; the leading one is fixed."""
    return [
        *(Free(place, "numerator", k) for k in range(len(block.numerator))),
        *(Free(place, "denominator", k) for k in range(1, len(block.denominator))),
    ]


def poles_of(block: TransferFunction) -> tuple[ComplexArray, ComplexArray]:
    """Give simple poles and their residues."""
    down = np.array(block.denominator)
    poles = np.asarray(np.roots(down), dtype=np.complex128)
    residues = np.polyval(block.numerator, poles) / np.polyval(np.polyder(down), poles)
    return poles, np.asarray(residues, dtype=np.complex128)


def one_by_one(others: OtherModes) -> list[OtherModes]:
    """Write a ratio as a sum of ratios of order two, and one of all real poles."""
    poles, residues = poles_of(others)
    direct = direct_of(others)
    pairs = [[poles[k], poles[k].conj()] for k in np.flatnonzero(poles.imag > 0)]
    groups = [np.flatnonzero(np.isin(poles, pair)) for pair in pairs]
    real = np.flatnonzero(poles.imag == 0)
    groups += [real] if len(real) else []
    parts = [sum_of(others, poles[k], residues[k], 0.0) for k in groups[:-1]]
    last = groups[-1]
    return [*parts, sum_of(others, poles[last], residues[last], direct)]


class ModeTakenOut(NamedTuple):
    """A mode that was taken out of a transfer function."""

    mode: Mechanism
    rest: OtherModes | None
    """All other poles; None without any."""
    direct: float
    """What passes at once beside the mode."""
    through: float
    """What passes the mode at once."""


def taken_out(block: TransferFunction, output: str) -> Iterator[ModeTakenOut]:
    """Take each oscillating mode out of a transfer function in turn, by frequency.

    With the residues R of a pair of poles p the mode is
    ``2 (Re R (s - Re p) - Im R Im p) / (s^2 + c s + k)``: a motion of the coordinate
    and a share of the next derivative.

    Left out are those that are none of the motion, and those beside which the rest is
    so little damped that rounding its numbers makes it unstable.
    """
    poles, residues = poles_of(block)
    for k in np.argsort(np.abs(poles)):
        if poles[k].imag <= 0:
            continue
        one = mode_of(block, poles[k], residues[k], output)
        if one is None:
            continue
        mode, through = one
        direct, rest = direct_of(block) - through, None
        others = ~np.isin(poles, (poles[k], poles[k].conj()))
        if np.any(others):
            try:
                rest = sum_of(block, poles[others], residues[others], direct)
            except InputError:
                continue
        yield ModeTakenOut(mode, rest, direct, through)


def direct_of(block: TransferFunction) -> float:
    """Give what passes a transfer function at once."""
    up, down = block.numerator, block.denominator
    return float(up[0] / down[0]) if len(up) == len(down) else 0.0


def mode_of(
    block: TransferFunction, pole: complex, residue: complex, output: str
) -> tuple[Mechanism, float] | None:
    """Write a pair of poles as a mechanism.

    Returns
    -------
    mode : Mechanism
    through : float
        What passes it at once, which the pair of poles alone does not let pass.
    """
    damping, stiffness = -2 * pole.real, abs(pole) ** 2
    rate = 2 * residue.real
    constant = -2 * (residue.real * pole.real + residue.imag * pole.imag)
    # What the mode is in the output at its own frequency; of a motion that is nothing
    # beside it there is no mass.
    whole = abs(rate) * abs(pole) + abs(constant)
    if output == "position":
        if abs(constant) <= NONE * whole:
            return None
        size, blend, through = constant, rate / constant, 0.0
    elif output == "velocity":
        size = rate - damping * constant / stiffness
        if abs(size) * abs(pole) <= NONE * whole:
            return None
        blend = -constant / (stiffness * size)
        through = size * blend
    else:
        if abs(constant) <= NONE * whole:
            return None
        size = -constant / stiffness
        blend = rate / size + damping
        through = size
    mass = 1 / abs(size)
    mode = Mechanism(
        mass=float(mass),
        damping=float(damping * mass),
        stiffness=float(stiffness * mass),
        gain=float(np.sign(size)),
        output=output,
        blend=float(blend),
        start=block.start,
        hold=block.hold,
    )
    return mode, float(through)


def sum_of(
    block: TransferFunction, poles: ComplexArray, residues: ComplexArray, direct: float
) -> OtherModes:
    """Join simple poles and a constant to one ratio."""
    down = np.poly(poles)
    up = direct * down.astype(np.complex128)
    for i in range(len(poles)):
        up[1:] = up[1:] + residues[i] * np.poly(np.delete(poles, i))
    return OtherModes(
        numerator=tuple(up.real.tolist()),
        denominator=tuple(down.real.tolist()),
        start=block.start,
        hold=block.hold,
    )


def explained_by_levels(state: ModelState) -> float:
    """Mean share of a record that other numbers of the mode in it would explain."""
    shares = []
    for part in state.sample.slices:
        rest, columns = state.residual[part], state.tangents[part]
        power = float(np.sum(rest**2))
        if power > 0:
            sizes = np.maximum(np.linalg.norm(columns, axis=0), 1e-300)
            basis = np.linalg.qr(columns / sizes)[0]
            shares.append(float(np.sum((basis.T @ rest) ** 2)) / power)
    return float(np.mean(shares)) if shares else 0.0

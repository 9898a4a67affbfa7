"""Modes of a transfer function: each as a mechanism, or several as a ratio again."""

from __future__ import annotations

import numpy as np

from hystbench.blocks.mechanism import Mechanism
from hystbench.blocks.other_modes import OtherModes
from hystbench.blocks.transfer_function import TransferFunction
from hystbench.gap.bases.poles import poles_of, residues_of
from hystbench.gap.fitting.state import Free
from hystbench.record import ComplexArray

NONE = 1e-3
"""Share of a mode in the output that is none of the motion that is asked for."""
APART = 1e-6
"""Share of its size by which a pole must be away from all others."""


def coincide(poles: ComplexArray) -> bool:
    """Tell whether two poles are one."""
    away = np.abs(poles[:, None] - poles) + np.diag(np.abs(poles))
    return bool(np.any(away < APART * np.abs(poles)))


def coefficients_of(block: OtherModes, place: int) -> list[Free]:
    """Give the coefficients of a ratio as free numbers; the leading one is fixed."""
    return [
        *(Free(place, "numerator", k) for k in range(len(block.numerator))),
        *(Free(place, "denominator", k) for k in range(1, len(block.denominator))),
    ]


def one_by_one(others: OtherModes) -> list[OtherModes]:
    """Write a ratio as a sum of ratios of order two, and one of all real poles."""
    poles = poles_of(others)
    residues = residues_of(others, poles)
    direct = direct_of(others)
    pairs = [[poles[k], poles[k].conj()] for k in np.flatnonzero(poles.imag > 0)]
    groups = [np.flatnonzero(np.isin(poles, pair)) for pair in pairs]
    real = np.flatnonzero(poles.imag == 0)
    groups += [real] if len(real) else []
    parts = [sum_of(others, poles[k], residues[k], 0.0) for k in groups[:-1]]
    last = groups[-1]
    return [*parts, sum_of(others, poles[last], residues[last], direct)]


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

"""Poles of a transfer function, and what each is of the whole."""

from __future__ import annotations

import numpy as np

from hystbench.blocks.transfer_function import TransferFunction
from hystbench.gap.thresholds import MOST
from hystbench.record import ComplexArray


def poles_of(block: TransferFunction) -> ComplexArray:
    """Give the poles, shape (order,), in rad/s."""
    return np.asarray(np.roots(block.denominator), dtype=np.complex128)


def lasting_ones(poles: ComplexArray, seconds: float) -> ComplexArray:
    """Choose poles that hardly fade, one of each pair.

    What each does alone has over half as much power in the second half of a time as in
    the first.

    Parameters
    ----------
    poles : ndarray, shape (n,)
        In 1/s.
    seconds : float
        That time.
    """
    return poles[(np.exp(poles.real * seconds) > MOST) & (poles.imag >= 0.0)]


def residues_of(block: TransferFunction, poles: ComplexArray) -> ComplexArray:
    """Give the residue at each of some poles: ``N(p) / D'(p)``.

    Parameters
    ----------
    block : TransferFunction
    poles : ndarray, shape (n,)
        Poles of it that are simple.
    """
    slopes = np.polyval(np.polyder(np.array(block.denominator)), poles)
    residues = np.polyval(block.numerator, poles) / slopes
    return np.asarray(residues, dtype=np.complex128)

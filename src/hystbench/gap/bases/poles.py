"""Poles of a transfer function, and what each is of the whole."""

from __future__ import annotations

import numpy as np

from hystbench.blocks.transfer_function import TransferFunction
from hystbench.record import ComplexArray


def poles_of(block: TransferFunction) -> ComplexArray:
    """Give the poles, shape (order,), in rad/s."""
    return np.asarray(np.roots(block.denominator), dtype=np.complex128)


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

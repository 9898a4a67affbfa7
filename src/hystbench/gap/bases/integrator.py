"""Whether an identified base integrates: any small error of it becomes a path."""

from __future__ import annotations

import numpy as np

from hystbench.blocks.transfer_function import TransferFunction
from hystbench.gap.bases.linear import is_identified_linear
from hystbench.gap.bases.poles import poles_of, residues_of
from hystbench.gap.thresholds import MOST
from hystbench.model import Model


def integrates(base: Model, span: float) -> bool:
    """Tell whether an identified linear base integrates over records.

    It does if most of its static gain is that of a pole whose time constant is longer
    than all of them. Then what it lacks, a friction say, winds as a slow path through
    the output and does not die out.

    Parameters
    ----------
    base : Model
    span : float
        Longest record, in seconds.
    """
    if not is_identified_linear(base):
        return False
    return any(
        isinstance(block, TransferFunction) and _is_slow(block, span)
        for block in base.chain
    )


def _is_slow(block: TransferFunction, span: float) -> bool:
    if block.integrates:
        return True
    poles = poles_of(block)
    slowest = poles[[np.argmin(np.abs(poles))]]
    (pole,) = slowest
    if abs(pole) * span >= 1.0 or pole.imag != 0.0:
        return False
    (residue,) = residues_of(block, slowest)
    return bool(abs(residue / pole) > MOST * abs(block.static_gain))

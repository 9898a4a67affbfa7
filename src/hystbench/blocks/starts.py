"""What was before the first sample of a record: the starts of linear dynamics."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Literal

import numpy as np

from hystbench.blocks.step import REPEATED, TURNED
from hystbench.record import FloatArray, Record

Start = Literal["rest", "settled", "moving", "repeating"]
STARTS: tuple[Start, ...] = ("rest", "settled", "moving", "repeating")
PASTS = {"moving": TURNED, "repeating": REPEATED}
"""Starts that depend on samples to come, and what came before."""


def possible_starts(records: Sequence[Record]) -> tuple[Start, ...]:
    """Give the starts that records may have: only whole periods repeat."""
    return STARTS if all(record.repeats for record in records) else STARTS[:-1]


def path_from(z: FloatArray, start: str) -> tuple[FloatArray, float]:
    """Put before a record what its start stands for.

    Parameters
    ----------
    z : ndarray, shape (n,)
    start : {"rest", "settled", "moving", "repeating"}

    Returns
    -------
    path : ndarray, shape (n,), (2n - 1,) or (2n,)
        What was before, and ``z``.
    before : float
        What was for ever before that.
    """
    if start == "rest" or len(z) == 0:
        return z, 0.0
    if start == "moving":
        z = np.concatenate([2 * z[0] - z[:0:-1], z])
    elif start == "repeating":
        z = np.concatenate([z, z])
    return z, float(z[0])

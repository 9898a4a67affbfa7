"""Samples that stand alone, far off from the others: dropouts, spikes."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from hystbench.record import FloatArray

FAR = 8.0
"""Robust standard deviations: of normal noise no sample is so far off."""
TO_SIGMA = 1.4826
"""Standard deviation of normal noise over its median absolute deviation."""


def lone_share(residuals: Sequence[FloatArray]) -> float:
    """Give the share of the power of residuals that stands in samples far off.

    Each record is held against its own median absolute deviation; one more than half
    of which is a single value says nothing.

    Parameters
    ----------
    residuals : sequence of ndarray, shape (n,)
    """
    far = whole = 0.0
    for residual in residuals:
        about = residual - np.median(residual)
        usual = TO_SIGMA * float(np.median(np.abs(about)))
        squares = about**2
        whole += float(squares.sum())
        if usual > 0:
            far += float(squares[np.abs(about) > FAR * usual].sum())
    return far / whole if whole > 0 else 0.0

"""Lone samples, far off the others: dropouts, spikes, lost words."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from hystbench.gap.records.scored_samples import Compared
from hystbench.gap.thresholds import FOREIGN
from hystbench.record import FloatArray, Mask
from hystbench.sentences import MAKE_MISSING, listed

MEND = f"If they are no motion of the device, {MAKE_MISSING}"

FAR_DEVIATIONS = 8.0
"""Robust standard deviations: of normal noise no sample is so far off."""
NEIGHBOURS = 50
"""Samples on either side of one, that it is held against too."""
TO_SIGMA = 1.4826
"""Standard deviation of normal noise over its median absolute deviation."""


def usual_deviation(residual: FloatArray) -> float:
    """Give the standard deviation that a residual has but for lone samples."""
    return _deviation(np.abs(residual - np.median(residual)))


def _deviation(off: FloatArray) -> float:
    """Give the standard deviation of normal noise that is so far off its median."""
    return TO_SIGMA * float(np.median(off))


def far_off(residual: FloatArray) -> Mask:
    """Tell which samples of a residual are lone: far off the others.

    A record is held against its own median absolute deviation, and a sample against
    that of its neighbours too: noise may grow with the motion. If more than half of a
    record has one value, no sample is lone.

    Parameters
    ----------
    residual : ndarray, shape (n,)
    """
    off = np.abs(residual - np.median(residual))
    usual = _deviation(off)
    far = np.asarray((usual > 0) & (off > FAR_DEVIATIONS * usual))
    for k in np.flatnonzero(far).tolist():
        about = off[max(k - NEIGHBOURS, 0) : k + NEIGHBOURS + 1]
        far[k] = off[k] > FAR_DEVIATIONS * _deviation(about)
    return far


def lone_share(compared: Sequence[Compared]) -> float:
    """Give the share of the power of residuals that stands in lone samples.

    Only samples that count are looked at.
    """
    far = whole = 0.0
    for item in compared:
        residual = item.residual[item.record.counted]
        squares = (residual - np.median(residual)) ** 2
        whole += float(squares.sum())
        far += float(squares[far_off(residual)].sum())
    return far / whole if whole > 0 else 0.0


def much_stands_alone(lone: float, after: float, before: float) -> bool:
    """Tell whether lone samples hold a share of a gap that no effect does.

    Parameters
    ----------
    lone : float
        Their share of the power of what is left.
    after, before : float
        Power of what is left, with the noise, and of the gap, at least the noise.
    """
    return lone * after > FOREIGN * before


def lone_words(kind: str, compared: Sequence[Compared], lone: float) -> str:
    """Say where the lone samples are, record by record, and what mends it.

    Parameters
    ----------
    kind : str
        Of the records: "fit" or "hold-out".
    compared : sequence of Compared
    lone : float
        Their share of the power of what is left.
    """
    places = []
    for item in compared:
        record, counted = item.record, item.record.counted
        there = np.flatnonzero(counted)[far_off(item.residual[counted])]
        if len(there):
            word = "sample" if len(there) == 1 else "samples"
            since = record.time[there[0]]
            places.append(f"{record.name} ({len(there)} {word} from {since:.4g} s on)")
    return (
        f"{100 * lone:.0f} % of the power that is left on the {kind} records stands in "
        f"lone samples, far off the others: {listed(places)}. {MEND}"
    )

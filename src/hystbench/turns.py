"""Where a signal turns back, small wiggles passed over."""

import numpy as np
from numpy.typing import NDArray

from hystbench.record import FloatArray


def turning_places(x: FloatArray, swing: float) -> list[int]:
    """Give the samples at which a signal turns back by more than a swing.

    Smaller wiggles, such as noise, are passed over. Its ends are no turns.

    Parameters
    ----------
    x : ndarray, shape (n,)
    swing : float
        In the unit of ``x``.
    """
    found: list[int] = []
    low = high = (float(x[0]), 0)
    rising: bool | None = None
    places = np.flatnonzero(_extremes(x))
    for value, k in zip(x[places].tolist(), places.tolist(), strict=True):
        low = (value, k) if value <= low[0] else low
        high = (value, k) if value >= high[0] else high
        if rising is not False and high[0] - value > swing:
            if rising:
                found.append(high[1])
            rising = False
            low = high = (value, k)
        elif rising is not True and value - low[0] > swing:
            if rising is False:
                found.append(low[1])
            rising = True
            low = high = (value, k)
    return found


def _extremes(x: FloatArray) -> NDArray[np.bool_]:
    """Mark both ends and where x does not go on the way it came: few in a long x."""
    step = np.diff(x)
    inside = step[:-1] * step[1:] <= 0
    return np.concatenate(([True], inside, [True]))[: len(x)]

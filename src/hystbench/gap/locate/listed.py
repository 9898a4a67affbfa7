"""Short lists of numbers, as a picture needs them."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

IntArray = NDArray[np.int64]

# Points of a curve over frequency or time.
POINTS = 200


def in_groups(place: IntArray, count: int) -> IntArray:
    """Number the group of each bin, so that there are at most ``POINTS``."""
    size = max(1, -(-count // POINTS))
    return place // size


def listed(values: ArrayLike) -> list[float]:
    """Give plain floats, with as many digits as a picture can show."""
    return [float(f"{value:.6g}") for value in np.asarray(values)]

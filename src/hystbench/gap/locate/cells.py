"""Samples sorted into cells along an axis."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from hystbench.record import FloatArray


def cell_of(edges: FloatArray, values: FloatArray) -> NDArray[np.intp]:
    """Number the cell of each value; the last one holds its upper edge."""
    return np.clip(np.searchsorted(edges, values, "right") - 1, 0, len(edges) - 2)

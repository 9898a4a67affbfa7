"""Frequency responses of linear blocks, straight from their matrices."""

import numpy as np


def frequency_response(block, frequency_hz):
    """Evaluate ``C (jwI - A)^-1 B + D``, a frequency at a time."""
    a, b, c, d = block.continuous()
    one = np.eye(len(b))
    inside = [np.linalg.solve(2j * np.pi * f * one - a, b) for f in frequency_hz]
    return np.array(inside) @ c + d

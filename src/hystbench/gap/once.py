"""Whether a record shows anything twice: what is slow and new in it needs that."""

from __future__ import annotations

import numpy as np

from hystbench.record import Record

TWICE = 1.5
"""Periods, counted by crossings of the mean, of which two whole ones have three."""
STILL = 0.1
"""Of the mean rate, for half of a record, to be a hold."""


def shows_a_path(record: Record) -> bool:
    """Tell whether a path of its own would show beside what the input does.

    Within one period of an input that never rests, a path can stand in for any error
    of the loop: nothing comes twice. A second period, or a hold, tells them apart.
    """
    moves = np.abs(np.diff(record.u))
    holds = float(np.median(moves)) < STILL * float(np.mean(moves))
    return holds or periods(record) >= TWICE


def periods(record: Record) -> float:
    """Count the input's periods in a record by how often it crosses its mean."""
    above = record.u > float(np.mean(record.u))
    return float(np.count_nonzero(above[1:] != above[:-1])) / 2

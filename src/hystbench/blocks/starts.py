"""What was before the first sample of a record: the starts of linear dynamics."""

from collections.abc import Sequence
from dataclasses import replace
from typing import Any, Literal

import numpy as np

from hystbench.blocks.step import REPEATED, TURNED
from hystbench.record import FloatArray, Record

Start = Literal["rest", "settled", "moving", "repeating"]
STARTS: tuple[Start, ...] = ("rest", "settled", "moving", "repeating")
CLEARLY = 1.01
"""The plainest start is taken whose squares of errors are within this factor of the
best."""
PASTS = {"moving": TURNED, "repeating": REPEATED}
"""Starts that depend on samples to come, and what came before."""


def begun_once(block: Any) -> Any:
    """Give a block on a record that does not repeat: its first value has stood there.

    A free mass has no place of balance, and rests.
    """
    if getattr(block, "start", "") != "repeating":
        return block
    free = getattr(block, "stiffness", None) == 0.0
    return replace(block, start="rest" if free else "settled")


def started(block: Any, record: Record) -> Any:
    """Give a block as it begins on a record: only whole periods repeat."""
    return block if record.repeats else begun_once(block)


def start_on(record: Record, start: str) -> str:
    """Give the start of linear dynamics on a record, as :func:`started` does."""
    return "settled" if start == "repeating" and not record.repeats else start


def possible_starts(records: Sequence[Record]) -> tuple[Start, ...]:
    """Give the starts that records may have: ``repeating`` where some repeat."""
    return STARTS if any(record.repeats for record in records) else STARTS[:-1]


def plainest_start(costs: Sequence[float]) -> int:
    """Choose among possible starts, the plainest first, by what each leaves.

    Parameters
    ----------
    costs : sequence of float
        Squares of the errors, in the order of :func:`possible_starts`.

    Returns
    -------
    int
        Place of the first that is as good as the best, to a hundredth.
    """
    most = CLEARLY * min(costs)
    return next(k for k, cost in enumerate(costs) if cost <= most)


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

"""Whether a function that cannot be looked into may hold a hysteresis."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from hystbench.blocks.base import Block
from hystbench.errors import InputError
from hystbench.record import Record

REST = 6
"""Rest of the input after it has gone there and back, in lengths of the longest
record."""
REMEMBERED_SHARE = 0.01
"""Share of the output's range by which outputs must differ to remember the way; and of
that difference, by which a linear function may miss superposition, as solvers do."""
STAYING_SHARE = 0.5
"""Share of that difference, in the first half of the rest, that must be left in the
other."""
WEIGHT = 0.75
"""Weight of one way in the mean of two; with equal weights an odd hysteresis would
answer zero."""


def may_have_hysteresis(block: Block, records: Sequence[Record]) -> bool:
    """Tell whether a block is a simulator that may hold a hysteresis.

    Of a stored output it is not known, nor of a function that refuses to be asked. Any
    other is asked: its input goes to one end of its range and back to the middle, or to
    the other end and back, as slowly as the longest record lasts, and rests there. What
    forgets comes to the same output; a hysteresis does not. Nor does an integrator or a
    slow creep; but what they answer to a weighted mean of both inputs is that mean of
    their answers (superposition), which a hysteresis does not fulfil.

    Parameters
    ----------
    block : Block
    records : sequence of Record
        Their inputs are the range; the way starts where the longest of them does.
    """
    if block.seen:
        return False
    if not block.reruns:
        return True
    low = min(float(record.u.min()) for record in records)
    high = max(float(record.u.max()) for record in records)
    longest = max(records, key=lambda record: record.dt * len(record))
    first, n = float(longest.u[0]), len(longest)
    ways = [
        np.interp(
            np.arange((2 + REST) * n), [0, n, 2 * n], [first, end, (low + high) / 2]
        )
        for end in (high, low)
    ]
    try:
        up, down = (block.simulate(way, way, longest.dt) for way in ways)
    except InputError:
        return True
    early, late = (abs(float(x.mean())) for x in np.split((up - down)[2 * n :], 2))
    reach = max(float(np.ptp(up)), float(np.ptp(down)))
    if late <= max(REMEMBERED_SHARE * reach, STAYING_SHARE * early):
        return False
    mean, wanted = (WEIGHT * a + (1 - WEIGHT) * b for a, b in (ways, (up, down)))
    try:
        missed = block.simulate(mean, mean, longest.dt) - wanted
    except InputError:
        return True
    return float(np.max(np.abs(missed))) > REMEMBERED_SHARE * late

"""Records of one input: what differs between their outputs the input does not tell."""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from hystbench.record import Record

FAR_APART = 2.0
"""Times the noise by which outputs of one input may differ; noise of few samples is not
known better than to a few percent."""


class SameInput(NamedTuple):
    """Two records with one input, sample by sample."""

    first: str
    other: str
    rms: float
    """Of the difference of their outputs over the root of two: as of noise in each."""
    noise: float
    """The same without the mean of the difference, which is a sensor's zero."""


def same_inputs(records: Sequence[Record]) -> list[SameInput]:
    """Hold each record against the first one that has its input.

    Parameters
    ----------
    records : sequence of Record
    """
    first: dict[tuple[float, bytes], Record] = {}
    found = []
    for record in records:
        one = first.setdefault((record.dt, record.u.tobytes()), record)
        counted = np.zeros(len(record), dtype=bool)
        counted[one.counted] = True
        only = np.zeros(len(record), dtype=bool)
        only[record.counted] = True
        counted &= only
        if one is record or not counted.any():
            continue
        differ = (record.y - one.y)[counted] / np.sqrt(2)
        rms, noise = float(np.sqrt(np.mean(differ**2))), float(np.std(differ))
        found.append(SameInput(one.name, record.name, rms, noise))
    return found

"""Which modes hold most of the output of one level: its strongest peaks, fitted."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from hystbench.gap.locate.lines import Lines
from hystbench.gap.locate.mode import Mode, fit_mode

PEAKS = 6
"""Of the output's spectrum, that are tried."""
WIDTH = 0.03
"""Of a frequency, over which lines are averaged before peaks are sought."""
GUESS = 0.01
"""Damping ratio from which a peak is fitted: in a narrow band, away from others."""
LEAST_SHARE = 0.1
"""Of the output's power, that a mode worth a picture holds."""


def find_modes(level: Sequence[Lines], integrals: int) -> tuple[Mode, ...]:
    """Find the one or two modes that hold most of the output of a level.

    Parameters
    ----------
    level : sequence of Lines
        Records of one level.
    integrals : int
        How often the output has to be integrated for a position.

    Returns
    -------
    tuple of Mode
        The one that explains most of the output first; each a width of it apart.
    """
    whole = sum(float(np.sum(np.abs(one.y) ** 2)) for one in level)
    fits = [fit_mode(level, peak, GUESS, integrals) for peak in _peaks(level[0])]
    shares = [(float(mode.held - mode.left), mode) for mode in fits if mode is not None]
    found: list[Mode] = []
    for share, mode in sorted(shares, key=lambda item: -item[0]):
        apart = [abs(one.frequency - mode.frequency) for one in found]
        width = 2 * mode.damping * mode.frequency
        if share >= LEAST_SHARE * whole and all(each > width for each in apart):
            found.append(mode)
    return tuple(found[:2])


def _peaks(lines: Lines) -> list[float]:
    """Give the frequencies of the strongest peaks, in Hz."""
    from scipy.signal import find_peaks  # late: it takes long to load

    at, power = lines.frequency[lines.excited], np.abs(lines.y[lines.excited]) ** 2
    if not len(at):
        return []
    ends = np.searchsorted(at, [at * (1 - WIDTH / 2), at * (1 + WIDTH / 2)], "right")
    sums = np.concatenate([[0.0], np.cumsum(power)])
    smooth = (sums[ends[1]] - sums[ends[0]]) / (ends[1] - ends[0])
    # A mode may be highest at an end of the band.
    tops, _ = find_peaks(np.concatenate([[0.0], smooth, [0.0]]))
    strongest = tops[np.argsort(-smooth[tops - 1])][:PEAKS] - 1
    return [float(at[top]) for top in strongest]

"""``resonance``: a mechanical mode."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from numpy.lib.stride_tricks import sliding_window_view
from scipy import fft

from hystbench.gap.effects.effect import Effect
from hystbench.gap.effects.variant import Variant, logarithmic
from hystbench.gap.simulation.simulation import Simulation
from hystbench.record import FloatArray

PEAKS = 3
"""Frequencies at which the residual looks most like a lightly damped mode."""
LIGHT = 0.02
"""Damping ratio of that mode: its peak is as wide as a step of the search."""
BINS = 8
"""Of the spectrum in a step from mode to mode, that is in a half-width of a peak."""
NEAR = 0.25
"""Share of a frequency around it in which a mode is told by its peak."""


class Resonance(Effect):
    """A mode behind the hysteresis, of less than a third of critical damping.

    A heavily damped fast mode is a lag or a delay to the data: it may not take their
    place.
    """

    name = "resonance"
    shows = "frequency"
    place = "mechanics"

    def variants(self, simulation: Simulation) -> Iterator[Variant]:
        """Offer modes from two periods in the shortest record to 0.45 of the rate.

        A lightly damped mode falls between the points of a grid, so that frequencies at
        which the residual has its peaks are points too.
        """
        low, high = 2 / simulation.shortest, 0.45 / simulation.step
        grid = logarithmic(low, high, 6)
        yield self.inserted(
            simulation,
            simulation.behind_linear,
            grids={
                "frequency_hz": np.union1d(grid, peaks(simulation, low, high)),
                "damping_ratio": np.array([0.01, 0.15]),
            },
            unit={"participation": 0.01},
            refused={"frequency_hz": "either", "damping_ratio": "either"},
            limits={"damping_ratio": (0.001, 0.33)},
        )


def peaks(simulation: Simulation, low: float, high: float) -> FloatArray:
    """Give the frequencies at which one light mode would lower the residual most.

    Only what lies within ``NEAR`` of a mode's frequency counts, where it stands out
    of what else the residual holds.

    Parameters
    ----------
    simulation : Simulation
    low, high : float
        In Hz.

    Returns
    -------
    ndarray, shape (PEAKS or fewer,)
        In Hz, rising.
    """
    count = int(np.log(high / low) / LIGHT) + 2
    modes = np.geomspace(low, high, count)
    # In bins of the logarithm of frequency all modes look alike, each further along.
    width = np.log(modes[1] / low) / BINS
    first, last = (int(np.log(1 + end) / width) for end in (-NEAR, NEAR))
    x = np.exp(width * np.arange(first, last + 1))
    mode = 1 / (1 - x**2 + 2j * LIGHT * x) - 1
    bins = np.zeros((3, (count - 1) * BINS + len(x)))
    inputs = simulation.at(simulation.behind_linear)
    for record, v, simulated in zip(
        simulation.records, inputs, simulation.output, strict=True
    ):
        length = fft.next_fast_len(2 * len(record), real=True)
        left = fft.rfft(record.y - simulated, length)[1:]
        driven = fft.rfft(v, length)[1:]
        place = np.log(fft.rfftfreq(length, record.dt)[1:] / low) / width - first
        place = np.rint(place).astype(int)
        inside = slice(*np.searchsorted(place, [0, bins.shape[1]]))
        both = (driven.conj() * left)[inside]
        for row, lines in zip(
            bins, (both.real, both.imag, np.abs(driven[inside]) ** 2), strict=True
        ):
            row += np.bincount(place[inside], lines, len(row))
    real, imaginary, square = sliding_window_view(bins, len(x), axis=1)[:, ::BINS]
    along = real @ mode.real + imaginary @ mode.imag
    square = square @ np.abs(mode) ** 2
    gain = along**2 / np.maximum(square, np.finfo(float).tiny)
    inner = gain[1:-1]
    tops = 1 + np.flatnonzero((inner > gain[:-2]) & (inner >= gain[2:]))
    best = tops[np.argsort(gain[tops])[-PEAKS:]]
    return np.sort(modes[best])

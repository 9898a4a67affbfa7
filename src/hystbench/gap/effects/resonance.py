"""``resonance``: a mechanical mode."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from scipy import fft

from hystbench.gap.effects.effect import Effect
from hystbench.gap.effects.variant import Variant, logarithmic
from hystbench.gap.simulation.simulation import Simulation
from hystbench.record import FloatArray

PEAKS = 3
"""Frequencies at which the residual looks most like a lightly damped mode."""
LIGHT = 0.02
"""Damping ratio of that mode: its peak is as wide as a step of the search."""
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
            simulation.behind_material,
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
    along, square = np.zeros(count), np.zeros(count)
    inputs = simulation.before[simulation.behind_material]
    for record, v, simulated in zip(
        simulation.records, inputs, simulation.output, strict=True
    ):
        length = fft.next_fast_len(2 * len(record), real=True)
        left = fft.rfft(record.y - simulated, length)
        driven = fft.rfft(v, length)
        frequencies = fft.rfftfreq(length, record.dt)
        ends = np.searchsorted(frequencies, [modes * (1 - NEAR), modes * (1 + NEAR)])
        for k, (first, last) in enumerate(ends.T):
            x = frequencies[first:last] / modes[k]
            mode = (1 / (1 - x**2 + 2j * LIGHT * x) - 1) * driven[first:last]
            along[k] += np.vdot(mode, left[first:last]).real
            square[k] += np.vdot(mode, mode).real
    gain = along**2 / np.maximum(square, np.finfo(float).tiny)
    inner = gain[1:-1]
    tops = 1 + np.flatnonzero((inner > gain[:-2]) & (inner >= gain[2:]))
    best = tops[np.argsort(gain[tops])[-PEAKS:]]
    return np.sort(modes[best])

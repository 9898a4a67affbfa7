"""How fast a reference may be: sines of one stroke, each with its own inverse."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from hystbench.errors import InputError
from hystbench.model import Model
from hystbench.record import FloatArray

PERIODS = 4
"""Of each sine; the first two may still show how it began."""
PER_DECADE = 6
"""Frequencies of the table."""
HOLDS = 0.01
"""RMS error, as a share of the stroke, up to which the inverse is said to hold."""


@dataclass(frozen=True)
class FollowedSine:
    """A sine: its frequency, and what is left of it, as a share of the stroke."""

    frequency_hz: float
    error: float | None
    largest_input: float | None
    said: str = ""


Invert = Callable[[FloatArray], FloatArray]
"""Gives the input for a reference."""


def bandwidth(
    model: Model, stroke: float, dt: float, band_hz: float, invert: Invert
) -> list[FollowedSine]:
    """Invert a model for sines of one stroke, from slow to the edge of the band.

    Parameters
    ----------
    model : Model
    stroke : float
        Peak-to-peak of each sine, in the unit of the model's output.
    dt : float
        Sampling interval in seconds.
    band_hz : float
    invert : callable

    Returns
    -------
    list of FollowedSine
        The error is that of the model itself, over the second half of the record.
    """
    decades = 2
    count = PER_DECADE * decades + 1
    frequencies = band_hz * np.logspace(-decades, 0, count)
    rest = float(model.simulate(np.zeros(64), dt)[-1])
    rows = []
    for frequency in frequencies:
        samples = max(round(PERIODS / frequency / dt), 64)
        time = np.arange(samples) * dt
        reference = rest + stroke / 2 * np.sin(2 * np.pi * frequency * time)
        try:
            u = invert(reference)
        except InputError as error:
            rows.append(FollowedSine(float(frequency), None, None, str(error)))
            continue
        off = (reference - model.simulate(u, dt))[samples // 2 :]
        left = float(np.sqrt(np.mean(off**2))) / stroke
        rows.append(FollowedSine(float(frequency), left, float(np.abs(u).max())))
    return rows


def holds_to(rows: list[FollowedSine]) -> float | None:
    """Give the highest frequency to which each error is at most :data:`HOLDS`."""
    highest = None
    for row in rows:
        if row.error is None or row.error > HOLDS:
            break
        highest = row.frequency_hz
    return highest

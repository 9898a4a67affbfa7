"""Samples of an uneven clock, put on even times."""

from collections.abc import Mapping
from typing import NamedTuple

import numpy as np

from hystbench.errors import InputError
from hystbench.record import FloatArray, Hold, Mask

LONG = 1.5
"""Steps between two samples from which on what lies between them was not measured."""
MOST = 10
"""Even times for each sample, at most: beyond that the clock has long gaps."""


class EvenSamples(NamedTuple):
    """Signals on even times."""

    signals: dict[str, FloatArray]
    """Shape (n,) each."""
    lost: Mask
    """Shape (n,). Samples that were not measured, or next to such."""


def usual_step(time: FloatArray) -> float:
    """Give the median step of a clock, where neither sample is missing."""
    steps = np.diff(time)
    there = steps[np.isfinite(steps)]
    return float(np.median(there)) if len(there) else np.nan


def on_even_times(
    where: str,
    time: FloatArray,
    step: float,
    signals: Mapping[str, FloatArray],
    lost: Mask,
    hold: Hold,
) -> EvenSamples:
    """Interpolate signals to even times.

    They are straight lines between samples, but the input of a staircase stays as it
    was. Between samples that are one and a half steps apart or more, what is more than
    half a step from both was not measured.

    Parameters
    ----------
    where : str
        For messages.
    time : ndarray, shape (n,)
        Increasing, in seconds.
    step : float
        Of the even times, in seconds.
    signals : mapping of str to ndarray, shape (n,)
        ``input`` is the input.
    lost : ndarray of bool, shape (n,)
        Samples that were not measured.
    hold : {"zero-order", "linear", "band-limited"}
        How the input moves between samples.

    Raises
    ------
    InputError
        If time has such gaps that most even times would have no sample near them.
    """
    count = int(np.floor((time[-1] - time[0]) / step * (1 + 1e-9))) + 1
    if not count <= MOST * len(time):
        raise InputError(
            f"{where}: {len(time)} samples in {time[-1] - time[0]:g} s, of which most "
            f"are {step:g} s apart; expected fewer gaps: give 'rows' between them"
        )
    even = time[0] + step * np.arange(count)
    found = {key: np.interp(even, time, values) for key, values in signals.items()}
    before = np.clip(np.searchsorted(time, even, "right") - 1, 0, len(time) - 2)
    if hold == "zero-order":
        found["input"] = signals["input"][before]
        found["input"][even >= time[-1]] = signals["input"][-1]
    apart = np.diff(time)[before] >= LONG * step
    near = np.minimum(np.abs(even - time[before]), np.abs(time[before + 1] - even))
    between_lost = np.interp(even, time, lost.astype(np.float64)) > 0.0
    return EvenSamples(found, between_lost | (apart & (near > 0.5 * step)))

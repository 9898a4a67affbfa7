"""What of the gap is coherent with the input, and what is not."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from scipy import fft, special

from hystbench.gap.compared import Compared
from hystbench.gap.locate.listed import IntArray, in_groups, listed
from hystbench.gap.locate.samples import Samples
from hystbench.gap.locate.spectra import HANN_INFLATION
from hystbench.gap.locate.view import MATTERS, chance, percent
from hystbench.record import FloatArray

# Segments of a record, that overlap by half, and what the overlap takes from them:
# neighbours under a Hann window share a sixth (Welch 1967).
QUARTERS = 4
OVERLAP = 1 + 2 / 36
SHORTEST = 64
# Bins of the common axis, evenly spaced in the logarithm of frequency; neighbours are
# put together until they hold this many facts: one alone is coherent with anything.
BINS = 400
FACTS = 3.0
# The input has no power where it has less than this share of its strongest bin.
EXCITED = 1e-5


@dataclass(frozen=True)
class Coherence:
    """Coherence of the residual with the input, on the bins that the input excites.

    Parameters
    ----------
    frequency, coherence : ndarray, shape (m,)
        In Hz; from 0 to 1, as estimated.
    chance : ndarray, shape (m,)
        What an unrelated residual exceeds in one of twenty.
    share : float
        Of the gap above the noise, what is coherent with the input; the estimate's
        bias, 1 / count, is taken off. Less than the truth where a response bends within
        a bin, as that of a lightly damped mode.
    p_value : float
        How often a residual unrelated to the input would be as coherent.
    """

    frequency: FloatArray
    coherence: FloatArray
    chance: FloatArray
    share: float
    p_value: float


def take_coherence(samples: Samples) -> Coherence | None:
    """Estimate it by Welch's method, over all segments of all records.

    A bin's segments count by the input's power in them. The chance of each bin, of
    ``(1 - coherence) ** (count - 1)``, is combined by Fisher's method.

    Returns
    -------
    Coherence or None
        None where no record is long enough for segments.
    """
    long = [item for item in samples.compared if len(item.record) >= SHORTEST]
    if not long:
        return None
    columns = np.concatenate([_segments(item) for item in long], axis=1)
    frequency, power, square, real, imaginary, left = columns
    edges = np.geomspace(frequency.min() * 0.999, frequency.max() * 1.001, BINS + 1)
    place = np.digitize(frequency, edges) - 1

    def gather(values: FloatArray) -> FloatArray:
        return np.bincount(place, values, BINS).astype(np.float64)

    everywhere = gather(power)
    excited = everywhere > EXCITED * float(np.max(everywhere))
    if not np.any(excited):
        return None
    starts = _starts(everywhere[excited], gather(square)[excited])

    def merged(values: FloatArray) -> FloatArray:
        return np.add.reduceat(gather(values)[excited], starts)

    held, count = merged(power), _count(merged(power), merged(square))
    if np.any(count < FACTS):
        return None
    residual, across = merged(left), merged(real) ** 2 + merged(imaginary) ** 2
    found = np.clip(across / np.maximum(held * residual, 1e-300), 0.0, 1.0)
    coherent = float(np.sum((count * found - 1) / (count - 1) * residual))
    n = sum(len(item.record) for item in long)
    # As the gap's power everywhere: at least what chance may leave of the noise.
    least = 3 * samples.noise * np.sqrt(2 * n)
    above = max(float(np.sum(left)) - samples.noise * n, least, 1e-300)
    squares = -2 * np.sum((count - 1) * np.log(np.maximum(1 - found, 1e-300)))
    return Coherence(
        frequency=merged(power * frequency) / held,
        coherence=found,
        chance=1 - 0.05 ** (1 / (count - 1)),
        share=float(np.clip(coherent / above, 0.0, 1.0)),
        p_value=float(special.chdtrc(2 * len(found), float(squares))),
    )


def _count(held: FloatArray, square: FloatArray) -> FloatArray:
    """Count the facts in a bin: lines and segments by their power.

    Neighbouring lines are not independent under a window, nor segments that overlap.
    """
    return held**2 / np.maximum(square, 1e-300) / HANN_INFLATION / OVERLAP


def _starts(held: FloatArray, square: FloatArray) -> IntArray:
    """Put neighbours together until each group holds enough facts."""
    starts, power, squares = [0], 0.0, 0.0
    enough = FACTS * HANN_INFLATION * OVERLAP
    for place, (one, its_square) in enumerate(
        zip(held.tolist(), square.tolist(), strict=True)
    ):
        if squares > 0 and power**2 >= enough * squares:
            starts.append(place)
            power = squares = 0.0
        power, squares = power + one, squares + its_square
    if len(starts) > 1 and power**2 < enough * squares:
        starts.pop()
    return np.array(starts)


def coherence_curve(coherence: Coherence | None) -> dict[str, Any] | None:
    """Give what the picture draws."""
    if coherence is None:
        return None
    groups = in_groups(np.arange(len(coherence.frequency)), len(coherence.frequency))
    count = np.bincount(groups)
    curve: dict[str, Any] = {
        name: listed(np.bincount(groups, getattr(coherence, name)) / count)
        for name in ("frequency", "coherence", "chance")
    }
    return curve | {"share": coherence.share}


def told(coherence: Coherence | None) -> str:
    """Tell how much of the gap is linear in the input, and how much is not."""
    if coherence is None:
        return ""
    if coherence.share < MATTERS:
        return (
            " Next to none of the gap is coherent with the input: it is distortion or "
            "no doing of the input."
        )
    return (
        f" At least {percent(coherence.share)} of the gap is coherent with the input "
        f"({chance(coherence.p_value)}), as what a linear path from it leaves; the "
        f"other {percent(1 - coherence.share)} is distortion or no doing of the input."
    )


def _segments(item: Compared) -> FloatArray:
    """Sum a record's segments, line by line.

    Segments are of whole periods where a record has enough of them.

    Returns
    -------
    ndarray, shape (6, lines)
        Frequencies; the input's power, and its square summed over segments; the cross
        power of residual and input, real and imaginary; the residual's power, which
        sums to its energy.
    """
    n, period = len(item.record), item.record.period_samples
    size = n // QUARTERS
    if period and period <= size:
        size = size // period * period
    window = np.hanning(size + 1)[:size]
    starts = range(0, n - size + 1, size // 2)
    u, r = (
        fft.rfft(
            np.stack([(x - x.mean())[k : k + size] * window for k in starts]), axis=1
        )[:, 1:]
        for x in (item.record.u, item.residual)
    )
    weight = 2 * n / len(starts) / size / float(np.sum(window**2))
    power = weight * np.abs(u) ** 2
    cross = weight * np.sum(r * np.conj(u), axis=0)
    return np.array(
        [
            fft.rfftfreq(size, item.record.dt)[1:],
            power.sum(axis=0),
            np.sum(power**2, axis=0),
            cross.real,
            cross.imag,
            weight * np.sum(np.abs(r) ** 2, axis=0),
        ]
    )

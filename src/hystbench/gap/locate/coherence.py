"""What of the gap is coherent with the input, and what is not."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from scipy import fft, special

from hystbench.gap.compared import Compared
from hystbench.gap.locate.listed import IntArray, in_groups, listed
from hystbench.gap.locate.samples import Samples
from hystbench.gap.locate.spectra import HANN_INFLATION, ComplexArray
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
    parts = [_segments(item) for item in long]
    frequency, weight, u, r = (
        np.concatenate(each) for each in zip(*parts, strict=True)
    )
    power, cross = weight * np.abs(u) ** 2, weight * r * np.conj(u)
    edges = np.geomspace(frequency.min() * 0.999, frequency.max() * 1.001, BINS + 1)
    place = np.digitize(frequency, edges) - 1

    def gather(values: FloatArray) -> FloatArray:
        return np.bincount(place, values, BINS).astype(np.float64)

    held, square = gather(power), gather(power**2)
    excited = held > EXCITED * float(np.max(held))
    if not np.any(excited):
        return None
    starts = _starts(held[excited], square[excited])

    def merged(values: FloatArray) -> FloatArray:
        return np.add.reduceat(gather(values)[excited], starts)

    held, count = merged(power), _count(merged(power), merged(power**2))
    residual = merged(weight * np.abs(r) ** 2)
    across = merged(cross.real) ** 2 + merged(cross.imag) ** 2
    found = np.clip(across / np.maximum(held * residual, 1e-300), 0.0, 1.0)
    coherent = float(np.sum((count * found - 1) / (count - 1) * residual))
    n = sum(len(item.record) for item in long)
    # As the gap's power everywhere: at least what chance may leave of the noise.
    least = 3 * samples.noise * np.sqrt(2 * n)
    above = max(
        float(np.sum(weight * np.abs(r) ** 2)) - samples.noise * n, least, 1e-300
    )
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
    count = held**2 / np.maximum(square, 1e-300) / HANN_INFLATION / OVERLAP
    return np.maximum(count, 1.0 + 1e-9)


def _starts(held: FloatArray, square: FloatArray) -> IntArray:
    """Put neighbours together until each group holds enough facts."""
    starts, power, squares = [0], 0.0, 0.0
    for place, (one, its_square) in enumerate(zip(held, square, strict=True)):
        if _count(np.array([power]), np.array([squares]))[0] >= FACTS:
            starts.append(place)
            power = squares = 0.0
        power, squares = power + one, squares + its_square
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


def _segments(
    item: Compared,
) -> tuple[FloatArray, FloatArray, ComplexArray, ComplexArray]:
    """Transform a record's segments: frequencies, weights, input and residual.

    Weights make the residual's weighted squares sum to its energy. Segments are of
    whole periods where a record has enough of them.
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
    frequency = np.tile(fft.rfftfreq(size, item.record.dt)[1:], len(starts))
    return frequency, np.full(u.size, weight), u.ravel(), r.ravel()

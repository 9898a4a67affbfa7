"""Odd and even distortion: the residual of periodic records, line by line."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy import fft, special

from hystbench.gap.compared import Compared
from hystbench.gap.locate.samples import Samples
from hystbench.gap.locate.view import MATTERS, SIGNIFICANT, chance, percent
from hystbench.gap.periods import settled
from hystbench.record import FloatArray

IntArray = NDArray[np.int64]

KINDS = ("excited", "odd", "even", "either")
"""Lines of the input, and harmonics beside them: odd, even, or not to be told apart."""

# A line of the input holds at least this share of its strongest line's power, and as
# many times what noise on the input gives: of a thousand such lines of noise none.
EXCITED = 1e-6
ABOVE_NOISE = 20.0


@dataclass(frozen=True)
class Lines:
    """The residual of one periodic record, averaged over periods, line by line.

    Energies are sums of squares over the samples of the periods that were used.

    Parameters
    ----------
    record : str
    frequency, amplitude : ndarray, shape (m,)
        In Hz and in the output's unit.
    energy, scatter : ndarray, shape (m,)
        Energy of the mean period, and what differs from period to period.
    kind : ndarray of int, shape (m,)
        Index into ``KINDS``; 4 between the harmonics.
    periods : int
        Periods used.
    samples : int
        Samples of them.
    noise_amplitude : float
        RMS amplitude that the noise floor gives a line.
    """

    record: str
    frequency: FloatArray
    amplitude: FloatArray
    energy: FloatArray
    scatter: FloatArray
    kind: IntArray
    periods: int
    samples: int
    noise_amplitude: float

    def above(self, noise: float) -> FloatArray:
        """Give the energy above the noise of each of ``KINDS``, and of the rest."""
        held = np.bincount(self.kind, self.energy - 2 * noise, 5)
        # What the mean over periods leaves of white noise is in the lines already.
        share = (self.periods - 1) / self.periods
        held[4] += float(np.sum(self.scatter)) - share * self.samples * noise
        return np.maximum(held, 0.0)


@dataclass(frozen=True)
class Distortion:
    """Shares of the periodic records' gap above the noise, which add to one.

    Parameters
    ----------
    excited, odd, even, either : float
        On the input's lines; on odd and on even harmonics beside them; on harmonics of
        an input that has odd and even lines itself, and so cannot tell them apart.
    other : float
        What does not repeat with the input.
    p_odd, p_even, p_either, p_other : float
        How often noise alone would leave as much; 1 where there is no such line.
    records : tuple of Lines
    """

    excited: float
    odd: float
    even: float
    either: float
    other: float
    p_odd: float
    p_even: float
    p_either: float
    p_other: float
    records: tuple[Lines, ...]

    def shares(self) -> dict[str, float]:
        """Give the shares by name."""
        return {name: float(getattr(self, name)) for name in (*KINDS, "other")}


def take_distortion(samples: Samples) -> Distortion | None:
    """Sort the residual's power by harmonics, over records with at least two periods.

    The first period of three or more holds the way from rest and is left out. An input
    whose second half-period is the first with its sign turned has odd lines alone.
    Whatever a system then does that is odd, with memory or without, keeps to odd lines,
    so that even ones show even distortion (Pintelon and Schoukens 2012, ch. 4).
    Evidence is an F test of the lines' power against its scatter from period to period
    at the same lines, or against the floor where that is larger. The mean is left out:
    it may be an offset.

    Returns
    -------
    Distortion or None
        None where no record holds two whole periods, or no power lies above the noise.
    """
    found = [_lines(item, samples.noise) for item in samples.compared]
    records = tuple(one for one in found if one is not None)
    if not records:
        return None
    energy = np.sum([one.above(samples.noise) for one in records], axis=0)
    total = float(np.sum(energy))
    if total <= 0:
        return None
    excited, odd, even, either, other = (float(value) for value in energy / total)
    return Distortion(
        excited=excited,
        odd=odd,
        even=even,
        either=either,
        other=other,
        p_odd=_p_value(records, KINDS.index("odd"), samples.noise),
        p_even=_p_value(records, KINDS.index("even"), samples.noise),
        p_either=_p_value(records, KINDS.index("either"), samples.noise),
        p_other=_p_other(records, samples.noise),
        records=records,
    )


def told_repeating(distortion: Distortion | None) -> str:
    """Tell what does not repeat with the input, and so is none of its doing."""
    if distortion is None:
        return ""
    if distortion.other < MATTERS:
        return " Next to all of the gap of periodic records repeats with the input."
    return (
        f" Of the gap of periodic records {percent(distortion.other)} does not repeat "
        f"with the input ({chance(distortion.p_other)})."
    )


def told(distortion: Distortion | None) -> str:
    """Tell what lies on the lines beside the input's."""
    if distortion is None:
        return ""
    parts = [f"{percent(distortion.excited)} lies on the input's own lines"]
    for name, share, p_value, means in (
        (
            "even",
            distortion.even,
            distortion.p_even,
            "differs between the input's two halves, as of an asymmetry",
        ),
        (
            "odd",
            distortion.odd,
            distortion.p_odd,
            "is alike in both, as of saturation, friction or backlash",
        ),
        (
            "other",
            distortion.either,
            distortion.p_either,
            "an input of odd and even lines cannot call odd or even",
        ),
    ):
        if p_value < SIGNIFICANT and share >= MATTERS:
            parts.append(
                f"{percent(share)} on {name} lines beside them ({chance(p_value)}), "
                f"that is, distortion that {means}"
            )
    if len(parts) == 1:
        parts.append("little or nothing beside them")
    return f" Of the gap of periodic records {'; '.join(parts)}."


def _lines(item: Compared, noise: float) -> Lines | None:
    """Average a record's periods but the first, and sort its lines."""
    period = item.record.period_samples
    if not period or len(item.record) < 2 * period:
        return None
    count = len(item.record) // period
    excited = _excited(item.record.u[-count * period :].reshape(count, period))
    if not len(excited):
        return None
    runs = fft.rfft(settled(item.residual, period), axis=1)
    used = len(runs)
    mean = runs.mean(axis=0)
    twice = np.full(len(mean), 2.0)
    if period % 2 == 0:
        twice[-1] = 1.0
    scale = twice / period
    order = np.arange(len(mean))
    step = int(np.gcd.reduce(excited))
    harmonic, between = np.divmod(order, step)
    told_apart = bool(np.all((excited // step) % 2 == 1))
    beside = np.where(harmonic % 2 == 1, 1, 2) if told_apart else 3
    kind = np.where(between == 0, beside, 4)
    kind[excited] = 0
    return Lines(
        record=item.record.name,
        frequency=order[1:] / (period * item.record.dt),
        amplitude=np.abs(mean[1:]) * twice[1:] / period,
        energy=used * np.abs(mean[1:]) ** 2 * scale[1:],
        scatter=np.sum(np.abs(runs - mean) ** 2, axis=0)[1:] * scale[1:],
        kind=kind[1:].astype(np.int64),
        periods=used,
        samples=used * period,
        noise_amplitude=float(2 * np.sqrt(noise / (used * period))),
    )


def _excited(u: FloatArray) -> IntArray:
    """Find the harmonics of the period that an input holds; u is (periods, samples)."""
    count = len(u)
    mean = u.mean(axis=0)
    cause = np.abs(fft.rfft(mean - mean.mean())) ** 2
    scatter = float(np.sum((u - mean) ** 2)) / (count - 1) / count
    floor = max(EXCITED * float(np.max(cause)), ABOVE_NOISE * scatter)
    return np.flatnonzero(cause > floor)


def _p_value(records: tuple[Lines, ...], kind: int, noise: float) -> float:
    """Test the power of a kind of line against its scatter between periods."""
    chosen = [(one, one.kind == kind) for one in records]
    count = sum(int(np.sum(here)) for _, here in chosen)
    if not count:
        return 1.0
    energy = sum(float(np.sum(one.energy[here])) for one, here in chosen)
    scatter = sum(float(np.sum(one.scatter[here])) for one, here in chosen)
    freedom = sum(2 * (one.periods - 1) * int(np.sum(here)) for one, here in chosen)
    level = max(noise, scatter / freedom)
    return float(special.fdtrc(2 * count, freedom, energy / (2 * count) / level))


def _p_other(records: tuple[Lines, ...], noise: float) -> float:
    """Test what differs from period to period against the floor."""
    freedom = sum(2 * (one.periods - 1) * len(one.kind) for one in records)
    scatter = sum(float(np.sum(one.scatter)) for one in records)
    # The floor itself is a median of as many samples, worth half of them.
    return float(special.fdtrc(freedom, freedom / 2, scatter / freedom / noise))

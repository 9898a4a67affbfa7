"""Odd and even distortion: the residual of periodic records, line by line."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy import fft, special

from hystbench.gap.locate.forms import LEAST_SHARE, SIGNIFICANT
from hystbench.gap.locate.picture import FREQUENCY, Axis, Panel, ViewPicture, series
from hystbench.gap.locate.samples import ViewSamples
from hystbench.gap.records.scored_samples import Compared, whole_periods
from hystbench.record import FloatArray
from hystbench.sentences import percent

IntArray = NDArray[np.int64]

OWN, ODD, EVEN, EITHER, BETWEEN = range(5)
"""Lines of the input; harmonics beside them, odd, even or not to be told apart; and
what lies between harmonics."""
MEANS = {
    EVEN: ("even", "differs between the input's two halves, as of an asymmetry"),
    ODD: ("odd", "is alike in both, as of saturation, friction or backlash"),
    EITHER: ("other", "an input of odd and even lines cannot call odd or even"),
}
DRAWN = (
    (OWN, "own lines", "input's lines"),
    (ODD, "odd lines", "odd lines"),
    (EVEN, "even lines", "even lines"),
    (EITHER, "other lines", "odd or even"),
)
EXCITED_POWER = 1e-6
"""Least power of an excited line of the input, as a share of its strongest line's."""
TIMES_NOISE = 20.0
"""Times what noise on the input gives a line: of a thousand such lines of noise none is
so high."""
LINES_DRAWN = 100
"""Lines of a kind in the picture."""


@dataclass(frozen=True)
class RecordLines:
    """The residual of one periodic record, averaged over periods, line by line."""

    record: str
    frequency: FloatArray
    amplitude: FloatArray
    """Shape (m,). In Hz and in the output's unit."""
    kind: IntArray
    """Shape (m,)."""
    sums: FloatArray
    """Shape (4, 5). By kind: energy of the mean period and what differs from period to
    period (sums of squares over the samples of the periods that were used), the number
    of lines, and how many numbers the difference has."""
    samples: int
    """Samples that were used."""

    def above(self, noise: float) -> FloatArray:
        """Give the energy above the noise of each kind, what does not repeat last."""
        energy, scatter, count, freedom = self.sums
        held = energy - 2 * noise * count
        held[BETWEEN] += float(np.sum(scatter - noise * freedom))
        return np.asarray(np.maximum(held, 0.0))


@dataclass(frozen=True)
class Distortion:
    """Shares of the periodic records' gap above the noise, which add to one."""

    shares: FloatArray
    """Shape (5,). On the input's lines; on odd, on even harmonics beside them, and on
    those of an input that has odd and even lines itself; and what does not repeat."""
    p_values: FloatArray
    """Shape (5,). How often noise alone would leave as much; 1 where there is no such
    line."""
    records: tuple[RecordLines, ...]
    noise: float
    """Variance of the floor."""

    @property
    def told(self) -> str:
        """What lies on the lines beside the input's, and what does not repeat.

        The latter is none of the input's doing.
        """
        parts = [f"{percent(self.shares[OWN])} lies on the input's own lines"]
        parts += [
            f"{percent(self.shares[kind])} on {name} lines beside them "
            f"({_chance(self.p_values[kind])}), that is, distortion that {means}"
            for kind, (name, means) in MEANS.items()
            if self.p_values[kind] < SIGNIFICANT and self.shares[kind] >= LEAST_SHARE
        ]
        if len(parts) == 1:
            parts.append("little or nothing beside them")
        lines = f" Of the gap of periodic records {'; '.join(parts)}."
        if self.shares[BETWEEN] < LEAST_SHARE:
            other = (
                " Next to all of the gap of periodic records repeats with the input."
            )
        else:
            other = (
                f" Of the gap of periodic records {percent(self.shares[BETWEEN])} does "
                "not repeat with the input."
            )
        return lines + other

    def picture(self, unit: str) -> ViewPicture:
        """Draw the lines of the record that holds most beside the input's."""
        beside = [one.above(self.noise)[ODD:BETWEEN].sum() for one in self.records]
        one = self.records[int(np.argmax(beside))]
        floor = float(2 * np.sqrt(self.noise / one.samples))
        # An amplitude below a tenth of what the floor gives is rounding, not a line.
        seen = one.amplitude > 0.1 * floor
        places = [np.flatnonzero(seen & (one.kind == kind)) for kind, _, _ in DRAWN]
        lines = [
            series(role, one.frequency[at], one.amplitude[at], label)
            for every, (_, role, label) in zip(places, DRAWN, strict=True)
            if len(at := every[:LINES_DRAWN])
        ]
        ends = one.frequency[[0, -1]]
        lines.append(series("noise", ends, [floor, floor], "noise floor"))
        y = Axis("residual's amplitude", unit, logarithmic=True)
        panel = Panel(FREQUENCY, y, tuple(lines), title=one.record)
        words = (
            "Distortion: lines of the residual of the periodic record that has most "
            "beside the input's lines"
        )
        return ViewPicture("distortion", words, (panel,))


def _chance(p_value: float) -> str:
    """Write a p-value as it stands in a sentence."""
    return "p < 0.001" if p_value < 0.001 else f"p = {p_value:.2g}"


def take_distortion(samples: ViewSamples) -> Distortion | None:
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
    records = tuple(one for item in samples.compared if (one := _lines(item)))
    above = np.sum([one.above(samples.noise) for one in records], axis=0)
    total = float(np.sum(above))
    if total <= 0:
        return None
    energy, scatter, count, freedom = np.sum([one.sums for one in records], axis=0)
    level = np.maximum(samples.noise, scatter / np.maximum(freedom, 1))
    ratio = energy / np.maximum(2 * count, 1) / level
    p_values = special.fdtrc(np.maximum(2 * count, 1), np.maximum(freedom, 1), ratio)
    there = np.where(count > 0, p_values, 1.0)
    return Distortion(above / total, there, records, samples.noise)


def _lines(item: Compared) -> RecordLines | None:
    """Average a record's periods but the first, and sort its lines."""
    period = item.record.period_samples
    if not period or len(item.record) < 2 * period:
        return None
    count = len(item.record) // period
    excited = _excited(item.record.u[-count * period :].reshape(count, period))
    if not len(excited):
        return None
    runs = fft.rfft(whole_periods(item.residual, period), axis=1)
    used, mean = len(runs), runs.mean(axis=0)
    scale = np.full(len(mean), 2.0 / period)
    if period % 2 == 0:
        scale[-1] /= 2
    order = np.arange(len(mean))
    step = int(np.gcd.reduce(excited))
    harmonic, between = np.divmod(order, step)
    told_apart = bool(np.all((excited // step) % 2 == 1))
    beside = np.where(harmonic % 2 == 1, ODD, EVEN) if told_apart else EITHER
    kind = np.where(between == 0, beside, BETWEEN)
    kind[excited] = OWN
    one = np.ones(len(mean))
    scatter = np.sum(np.abs(runs - mean) ** 2, axis=0) * scale
    rows = (used * np.abs(mean) ** 2 * scale, scatter, one, 2 * (used - 1) * one)
    return RecordLines(
        record=item.record.name,
        frequency=order[1:] / (period * item.record.dt),
        amplitude=(np.abs(mean) * scale)[1:],
        kind=kind[1:].astype(np.int64),
        sums=np.array([np.bincount(kind[1:], row[1:], 5) for row in rows]),
        samples=used * period,
    )


def _excited(u: FloatArray) -> IntArray:
    """Find the harmonics of the period that an input holds; u is (periods, samples)."""
    count = len(u)
    mean = u.mean(axis=0)
    cause = np.abs(fft.rfft(mean - mean.mean())) ** 2
    scatter = float(np.sum((u - mean) ** 2)) / (count - 1) / count
    floor = max(EXCITED_POWER * float(np.max(cause)), TIMES_NOISE * scatter)
    return np.flatnonzero(cause > floor)

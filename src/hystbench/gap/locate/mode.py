"""Modes of one level of the input: lines of records, the strongest peaks, their fits.

In a band around a lightly damped mode a spectrum obeys ``Y = (B U + T) / D`` with
``D = s^2 + 2 zeta w s + w^2``; the polynomials B and T are short and complex, as they
stand for all other modes and for the ends of the record [1]_.

References
----------
.. [1] T. McKelvey, G. Guerin, "Non-parametric frequency response estimation using a
   local rational model", IFAC Proceedings 45 (2012) 49-54.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import product
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy import fft

from hystbench.gap.records.scored_samples import Compared, whole_periods
from hystbench.record import ComplexArray, FloatArray, Mask

EXCITED_POWER = 1e-3
"""Least input power of an excited line, as a share of the strongest line's."""
MOST_SAMPLES = 2**15
"""Samples of a record without periods that are looked at, from its end on."""


class LevelLines(NamedTuple):
    """Spectral lines of one record."""

    frequency: FloatArray
    """Shape (m,). In Hz."""
    u: ComplexArray
    y: ComplexArray
    missed: ComplexArray
    """Shape (m,). Input, output and what the simulation misses of it. The sum of
    ``|y|^2`` is the mean square about the mean."""
    ends: bool
    """Whether the record's ends leave a transient in the lines."""

    def within(self, chosen: Mask) -> LevelLines:
        """Give some of the lines."""
        u, y, missed = (each[chosen] for each in (self.u, self.y, self.missed))
        return LevelLines(self.frequency[chosen], u, y, missed, self.ends)

    @property
    def excited(self) -> Mask:
        """Lines that the input excites."""
        power = np.abs(self.u) ** 2
        return np.asarray(power > EXCITED_POWER * float(np.max(power, initial=0.0)))


def lines_of(compared: Compared) -> LevelLines:
    """Transform a record: its settled periods, or its end where none repeat."""
    record = compared.record
    period = record.period_samples
    signals = np.stack([record.u, record.y, compared.residual])
    repeats = period is not None and len(record) >= 2 * period
    if period is not None and repeats:
        runs = whole_periods(signals, period)
        # Of two periods the first still holds the way from rest.
        signals = runs[:, -1] if runs.shape[1] == 2 else runs.mean(axis=1)
    else:
        signals = signals[:, -MOST_SAMPLES:]
    n = signals.shape[1]
    centred = signals - signals.mean(axis=1, keepdims=True)
    u, y, missed = np.asarray(fft.rfft(centred))[:, 1:] * (np.sqrt(2) / n)
    frequency = np.asarray(fft.rfftfreq(n, record.dt))[1:]
    return LevelLines(frequency, u, y, missed, not repeats)


DEGREE = 2
"""Degree of the local polynomials, in the distance from the middle of the band."""
HALF_BAND = 6.0
"""Half the width of a band, in damping ratios: nine tenths of a mode's energy."""
NARROWEST, WIDEST = 0.08, 0.5
"""Ends of half the width of a band, as shares of its frequency."""
LEAST_LINES = 16
"""Fewest excited lines of a band: twice the numbers that are fitted."""
DAMPINGS, FREQUENCIES = 12, 25
"""Values of damping and of frequency on the grid in which a mode is searched."""
EDGE_TOLERANCE = 1e-3
"""Distance from an end of a range, relative to the fitted value: a fit that comes so
near to the end has none."""


@dataclass(frozen=True)
class Mode:
    """A mode at one level of the input."""

    frequency: float
    """Frequency in Hz."""
    damping: float
    """Damping ratio of the fitted pole."""
    power_damping: float
    """Damping ratio by power: what the input puts in, over the mean square velocity. A
    spring, however curved, takes no power: it may widen a peak, and does not change
    this."""
    gain: float
    """Acceleration a unit of input, of the mode alone: one over its mass. It does not
    depend on its stiffness."""
    errors: FloatArray
    """Shape (4,). Standard errors of the four, relative to them. What follows the input
    but not by a linear filter counts as noise."""
    reach: float
    """RMS of the output in the band."""
    held: float
    missed: float
    left: float
    """Mean square in the band of the output, of what the simulation misses of it, and
    of what the mode as fitted here misses; summed over the level's records."""


def fit_mode(
    level: Sequence[LevelLines], frequency: float, damping: float, integrals: int
) -> Mode | None:
    """Fit a mode in a band that follows it, starting from where it was a level below.

    Parameters
    ----------
    level : sequence of LevelLines
        Records of one level.
    frequency : float
        In Hz.
    damping : float
    integrals : int
        How often the output has to be integrated for a position: two for an
        acceleration.

    Returns
    -------
    Mode, optional
        None where the input excites too few lines of the band, or no peak is in it.
    """
    found: Mode | None = None
    half = float(np.clip(2 * HALF_BAND * damping, 2 * NARROWEST, WIDEST))
    for search in (True, False, False):
        band = _Band.of(level, frequency, half, integrals)
        found = None if band is None else band.fitted(frequency, damping, search)
        if found is None:
            return None
        frequency, damping = found.frequency, found.damping
        half = float(np.clip(HALF_BAND * damping, NARROWEST, WIDEST))
    return found


@dataclass(frozen=True)
class _Band:
    """Lines of one level in a band; s is ``j f / centre``."""

    centre: float
    lines: tuple[LevelLines, ...]
    integrals: int

    @classmethod
    def of(
        cls, level: Sequence[LevelLines], centre: float, half: float, integrals: int
    ) -> _Band | None:
        parts = []
        for one in level:
            near = one.within(
                (np.abs(one.frequency / centre - 1) <= half) & one.excited
            )
            away = near.frequency / centre - 1
            # Lines on both sides of the middle, half way out at least.
            many = len(away) >= LEAST_LINES
            if many and away.min() < -half / 2 < half / 2 < away.max():
                parts.append(near)
        return cls(centre, tuple(parts), integrals) if parts else None

    def fitted(self, frequency: float, damping: float, search: bool) -> Mode | None:
        """Fit the mode from a start; none where it leaves the band or is too sharp."""
        from scipy.optimize import least_squares  # late: it takes long to load

        low = min(float(one.frequency[0]) for one in self.lines) / self.centre
        high = max(float(one.frequency[-1]) for one in self.lines) / self.centre
        ends = np.log([[low, self._sharpest], [high, 1.0]])
        start = np.log([frequency / self.centre, damping])
        if search:
            grid = product(
                np.log(np.linspace(low, high, FREQUENCIES))[1:-1],
                np.linspace(ends[0, 1], np.log(0.6), DAMPINGS),
            )
            start = min(map(np.array, grid), key=lambda at: _square(self._residual(at)))
        inside = np.clip(start, ends[0] + EDGE_TOLERANCE, ends[1] - EDGE_TOLERANCE)
        best = least_squares(self._residual, inside, x_scale=0.1, bounds=ends)
        if np.any(np.abs(best.x - ends) < EDGE_TOLERANCE):
            return None
        nu, zeta = np.exp(best.x).tolist()
        return self._mode(nu, zeta, best.fun, best.jac)

    @property
    def _sharpest(self) -> float:
        """Damping ratio of a peak as wide as the lines are apart.

        One that is sharper stands on a single line, and may be that line's noise.
        """
        steps = [float(np.median(np.diff(one.frequency))) for one in self.lines]
        return min(steps) / (2 * self.centre)

    def _linear(self, nu: float, zeta: float) -> list[ComplexArray]:
        """Give the columns of B, then of T, of each record."""
        found = []
        for one in self.lines:
            s = 1j * one.frequency / self.centre
            powers = np.vander(s - 1j, DEGREE + 1, increasing=True)
            powers = powers / (s**2 + 2 * zeta * nu * s + nu**2)[:, None]
            columns = powers * one.u[:, None]
            found.append(np.hstack([columns, powers]) if one.ends else columns)
        return found

    def _residual(self, at: FloatArray) -> FloatArray:
        """Give what B and T cannot explain for a pole: real and imaginary parts."""
        parts = []
        for columns, one in zip(self._linear(*np.exp(at)), self.lines, strict=True):
            basis, _ = np.linalg.qr(columns)
            parts.append(one.y - basis @ (basis.conj().T @ one.y))
        whole = np.concatenate(parts)
        return np.concatenate([whole.real, whole.imag])

    def _mode(
        self, nu: float, zeta: float, residual: FloatArray, slopes: FloatArray
    ) -> Mode:
        """Give the numbers of the mode, and how sure they are."""
        linear = self._linear(nu, zeta)
        facts = len(residual) - 2 - 2 * sum(columns.shape[1] for columns in linear)
        noise = _square(residual) / max(facts, 1)
        errors = np.sqrt(noise * np.diag(np.linalg.pinv(slopes.T @ slopes)))
        # The numerator at the pole, over all records alike, weighted by their power.
        here = np.array([1.0, 1j * (nu - 1), (1j * (nu - 1)) ** 2])
        value, weights, spread = 0.0 + 0.0j, 0.0, 0.0
        for columns, one in zip(linear, self.lines, strict=True):
            found = np.linalg.lstsq(columns, one.y, rcond=None)[0]
            inverse = np.linalg.pinv(columns.conj().T @ columns)
            weight = float(np.sum(np.abs(columns[:, 0]) ** 2))
            value += weight * complex(here @ found[: DEGREE + 1])
            own = inverse[: DEGREE + 1, : DEGREE + 1]
            spread += weight**2 * 2 * noise * float(np.real(here @ own @ here.conj()))
            weights += weight
        value, of_gain = value / weights, np.sqrt(spread) / max(abs(value), 1e-300)
        taken, moved, blurred = self._power(value, nu, noise)
        frequency = nu * self.centre
        scale = (2 * np.pi) ** (2 - self.integrals)
        gain = abs(value) * self.centre**2 * scale / frequency**self.integrals
        # A pole that is damped more has a numerator that is larger alike.
        gain_error = float(np.hypot(of_gain, errors[1]))
        held = sum(float(np.sum(np.abs(one.y) ** 2)) for one in self.lines)
        return Mode(
            frequency,
            zeta,
            taken / (2 * nu * moved),
            float(gain),
            np.array([*errors, np.hypot(blurred, gain_error), gain_error]),
            float(np.sqrt(held / len(self.lines))),
            held,
            sum(float(np.sum(np.abs(one.missed) ** 2)) for one in self.lines),
            _square(residual),
        )

    def _power(
        self, value: complex, nu: float, noise: float
    ) -> tuple[float, float, float]:
        """Give power put in, mean square velocity, and the relative error of both."""
        taken = moved = spread = 0.0
        for one in self.lines:
            s = 1j * one.frequency / self.centre
            shape = value * (s / (1j * nu)) ** self.integrals
            velocity = s * one.y / shape
            taken += float(np.real(np.vdot(one.u, velocity)))
            moved += float(np.sum(np.abs(velocity) ** 2))
            spread += float(np.sum(np.abs(one.u * s / shape) ** 2)) * noise
        return taken, moved, float(np.sqrt(spread) / max(abs(taken), 1e-300))


def _square(values: FloatArray) -> float:
    return float(values @ values)


MOST_PEAKS = 6
"""Most peaks of the output's spectrum that are tried."""
SMOOTHED_WIDTH = 0.03
"""Share of a frequency over which lines are averaged before peaks are sought."""
DAMPING = 0.01
"""Damping ratio from which a peak is fitted: in a narrow band, away from others."""
LEAST_SHARE = 0.1
"""Least share of the output's power that a mode worth a picture holds."""


def find_modes(level: Sequence[LevelLines], integrals: int) -> tuple[Mode, ...]:
    """Find the one or two modes that hold most of the output of a level.

    Parameters
    ----------
    level : sequence of LevelLines
        Records of one level.
    integrals : int
        How often the output has to be integrated for a position.

    Returns
    -------
    tuple of Mode
        The one that explains most of the output first; each a width of it apart.
    """
    whole = sum(float(np.sum(np.abs(one.y) ** 2)) for one in level)
    fits = [fit_mode(level, peak, DAMPING, integrals) for peak in _peaks(level[0])]
    shares = [(float(mode.held - mode.left), mode) for mode in fits if mode is not None]
    found: list[Mode] = []
    for share, mode in sorted(shares, key=lambda item: -item[0]):
        apart = [abs(one.frequency - mode.frequency) for one in found]
        width = 2 * mode.damping * mode.frequency
        if share >= LEAST_SHARE * whole and all(each > width for each in apart):
            found.append(mode)
    return tuple(found[:2])


def _peaks(lines: LevelLines) -> list[float]:
    """Give the frequencies of the strongest peaks, in Hz.

    The ends of the band count: a mode may be highest there.
    """
    at, power = lines.frequency[lines.excited], np.abs(lines.y[lines.excited]) ** 2
    if not len(at):
        return []
    around = np.outer([1 - SMOOTHED_WIDTH / 2, 1 + SMOOTHED_WIDTH / 2], at)
    ends = np.searchsorted(at, around, "right")
    sums = np.concatenate([[0.0], np.cumsum(power)])
    smooth = (sums[ends[1]] - sums[ends[0]]) / (ends[1] - ends[0])
    tops = _tops(smooth)
    strongest = tops[np.argsort(-smooth[tops])][:MOST_PEAKS]
    return [float(at[top]) for top in strongest]


def _tops(power: FloatArray) -> NDArray[np.intp]:
    """Give where a power is highest among its neighbours, in the middle of a level.

    As scipy.signal.find_peaks, which takes a fifth of a search's time to load.
    """
    rises = np.diff([0.0, *power, 0.0])
    steps = np.flatnonzero(rises)
    up, down = rises[steps[:-1]] > 0, rises[steps[1:]] < 0
    return (steps[:-1] + steps[1:] - 1)[up & down] // 2

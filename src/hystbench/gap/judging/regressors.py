"""What the black box sees: past and present of input and simulated output.

The measured output is never among them: the black box runs as freely as the
simulator. Time is not among them either: what the input does not explain, the black
box cannot.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from hystbench.blocks.linear import low_pass
from hystbench.gap.records.residual import Compared
from hystbench.operators import play, state_space
from hystbench.record import FloatArray

Rows = NDArray[np.intp] | slice

#: Lags in shortest sampling intervals: dense where dynamics are fast.
LAGS = (1, 2, 3, 4, 6, 8, 12, 16, 24, 32, 48, 64)
#: Low-passes from the shortest sampling interval to a third of the longest record.
LOW_PASSES = 8
#: Damped modes from three periods in the longest record to a fifth of the sampling
#: frequency.
MODES = 12
DAMPING = 0.15
#: Thresholds of play operators, as parts of the input's largest excursion.
THRESHOLDS = (0.05, 0.15, 0.3, 0.5, 0.75)

#: Widths over which a signal turns its sign, in its spreads: friction, dead zones.
TURNS = (0.03, 0.3, 1.0)
#: Landmarks of the radial basis functions.
LANDMARKS = 80


@dataclass(frozen=True)
class Scale:
    """Middle and spread of a signal over the records that fit."""

    middle: float
    spread: float

    def __call__(self, values: FloatArray) -> FloatArray:
        """Bring values to middle 0 and spread 1."""
        return (values - self.middle) / self.spread


@dataclass(frozen=True)
class Regressors:
    """Signals made of input and simulated output, the same for every record.

    Parameters
    ----------
    input, simulated : Scale
    input_rate, simulated_rate : float
        RMS of the time derivatives, per second of the scaled signals.
    excursion : float
        Largest absolute value of the scaled input.
    lags_s, time_constants_s : tuple of float
    """

    input: Scale
    simulated: Scale
    input_rate: float
    simulated_rate: float
    excursion: float
    lags_s: tuple[float, ...]
    time_constants_s: tuple[float, ...]
    frequencies_hz: tuple[float, ...]

    @classmethod
    def of(cls, compared: Sequence[Compared]) -> Regressors:
        """Choose scales, lags and time constants by the records that fit."""
        records = [item.record for item in compared]
        inputs = [record.u for record in records]
        outputs = [item.simulated for item in compared]
        steps = [record.dt for record in records]
        step = min(record.dt for record in records)
        longest = max(record.dt * len(record) for record in records)
        u, s = _scale(inputs), _scale(outputs)
        input_rate, simulated_rate = (
            _rms([np.gradient(scale(x), dt) for x, dt in zip(each, steps, strict=True)])
            for scale, each in ((u, inputs), (s, outputs))
        )
        excursion = max(float(np.abs(u(each)).max()) for each in inputs)
        time_constants = np.geomspace(step, max(longest / 3, 2 * step), LOW_PASSES)
        frequencies = np.geomspace(3 / longest, 0.2 / step, MODES)
        return cls(
            u,
            s,
            input_rate,
            simulated_rate,
            excursion,
            tuple(step * lag for lag in LAGS),
            tuple(time_constants.tolist()),
            tuple(frequencies.tolist()),
        )

    def linear(self, compared: Compared, rows: Rows) -> FloatArray:
        """Past and present of both signals, low-passes and play operators.

        Parameters
        ----------
        compared : Compared
        rows : ndarray of int or slice
            Which samples.

        Returns
        -------
        ndarray, shape (rows, m)
        """
        dt = compared.record.dt
        u, s = self.input(compared.record.u), self.simulated(compared.simulated)
        signals = (u, s, u**2)
        position = np.arange(len(u))[rows]
        columns: list[FloatArray] = []
        for signal in (u, s):
            columns += [_lagged(signal, lag / dt, position) for lag in self.lags_s]
        for signal in signals:
            columns += [
                low_pass(signal, dt, time_constant, signal[0])[rows]
                for time_constant in self.time_constants_s
            ]
        plays, _ = play(u, self.excursion * np.array(THRESHOLDS))
        return np.column_stack([*columns, plays[rows]])

    def modes(self, compared: Compared, rows: Rows) -> FloatArray:
        """The simulated output through damped modes, shape (rows, m)."""
        s, dt = self.simulated(compared.simulated), compared.record.dt
        columns: list[FloatArray] = []
        for frequency in self.frequencies_hz:
            columns += [part[rows] for part in _ringing(s, dt, frequency)]
        return np.column_stack(columns)

    def state(self, compared: Compared, rows: Rows) -> FloatArray:
        """The few signals that everything nonlinear is made of, shape (rows, m)."""
        dt = compared.record.dt
        u, s = self.input(compared.record.u), self.simulated(compared.simulated)
        middle, _ = play(u, [0.3 * self.excursion])
        columns = (
            u,
            s,
            np.gradient(u, dt) / self.input_rate,
            np.gradient(s, dt) / self.simulated_rate,
            middle[:, 0],
        )
        return np.column_stack([column[rows] for column in columns])


#: Families of columns that may be left out: what helps one gap is ballast for another.
Family = Literal["plain", "modes", "landmarks"]


@dataclass(frozen=True)
class ColumnScale:
    """Middle and spread of each column over the rows that fit, shape (m,) each."""

    middle: FloatArray
    spread: FloatArray

    def __call__(self, raw: FloatArray) -> FloatArray:
        """Bring columns to middle 0 and spread 1, and append a constant one."""
        scaled = (raw - self.middle) / self.spread
        return np.column_stack([scaled, np.ones(len(raw))])


@dataclass(frozen=True)
class Columns:
    """Columns made of regressors, standardised by the rows that fit."""

    regressors: Regressors
    landmarks: Landmarks
    scale: ColumnScale
    families: tuple[Family, ...]  # of each column

    @classmethod
    def learn(
        cls, compared: Sequence[Compared], rows: Sequence[Rows]
    ) -> tuple[Columns, FloatArray]:
        """Learn landmarks and scales; give the table of those rows as well."""
        regressors = Regressors.of(compared)
        pairs = list(zip(compared, rows, strict=True))
        state = np.concatenate([regressors.state(*pair) for pair in pairs])
        landmarks = Landmarks.among(state, LANDMARKS)
        parts = [_parts(regressors, landmarks, *pair) for pair in pairs]
        widths = {name: part.shape[1] for name, part in parts[0].items()}
        families = [name for name, width in widths.items() for _ in range(width)]
        raw = np.concatenate([np.hstack(list(part.values())) for part in parts])
        spread = raw.std(axis=0)
        scale = ColumnScale(raw.mean(axis=0), np.where(spread > 0, spread, 1.0))
        columns = cls(regressors, landmarks, scale, (*families, "plain"))
        return columns, scale(raw)

    def weighed(self, compared: Compared, weights: FloatArray) -> FloatArray:
        """Sum the standardised columns and a constant one, by weights of shape (m,).

        Returns
        -------
        ndarray, shape (n,)
        """
        parts = _parts(self.regressors, self.landmarks, compared, slice(None))
        of_raw = weights[:-1] / self.scale.spread
        total = np.full(len(compared.record), weights[-1] - of_raw @ self.scale.middle)
        start = 0
        for part in parts.values():
            total += part @ of_raw[start : start + part.shape[1]]
            start += part.shape[1]
        return total


def _parts(
    regressors: Regressors, landmarks: Landmarks, compared: Compared, rows: Rows
) -> dict[Family, FloatArray]:
    """Columns of each family, not yet standardised."""
    state = regressors.state(compared, rows)
    first, second = np.triu_indices(state.shape[1])
    turns = [np.tanh(state / width) for width in TURNS]
    products = state[:, first] * state[:, second]
    linear = regressors.linear(compared, rows)
    return {
        "plain": np.hstack([linear, *turns, products]),
        "modes": regressors.modes(compared, rows),
        "landmarks": landmarks.seen_from(state),
    }


def _ringing(signal: FloatArray, dt: float, frequency_hz: float) -> list[FloatArray]:
    """Pass through a damped mode: two signals a quarter period apart.

    They are the parts of ``z(k) = p z(k-1) + (1 - |p|) v(k)`` with the mode's pole p.
    """
    pole = np.exp((-DAMPING + 1j) * 2 * np.pi * frequency_hz * dt)
    turn = np.array([[pole.real, -pole.imag], [pole.imag, pole.real]])
    drive = np.array([1 - abs(pole), 0.0])
    return [
        state_space(turn, drive, turn[k], float(drive[k]), signal)[0] for k in (0, 1)
    ]


def _lagged(signal: FloatArray, lag: float, position: NDArray[np.intp]) -> FloatArray:
    """Take a signal some samples ago; before the record it rests where it begins."""
    at = np.maximum(position - lag, 0)
    before = np.floor(at).astype(np.intp)
    after = np.minimum(before + 1, len(signal) - 1)
    part = at - before
    return np.asarray((1 - part) * signal[before] + part * signal[after])


def _scale(signals: Sequence[FloatArray]) -> Scale:
    joined = np.concatenate(signals)
    spread = float(joined.std())
    return Scale(float(joined.mean()), spread if spread > 0 else 1.0)


def _rms(signals: Sequence[FloatArray]) -> float:
    value = float(np.sqrt(np.mean(np.square(np.concatenate(signals)))))
    return value if value > 0 else 1.0


LEAST = 1e-12
"""Singular value below which a direction of the functions is none."""


@dataclass(frozen=True)
class Landmarks:
    """Points of a cloud, each with a function that falls off around it.

    Parameters
    ----------
    points : ndarray, shape (k, m)
    whitening : ndarray, shape (k, k)
        Takes the functions to ones whose products give the kernel [1]_.

    References
    ----------
    .. [1] C. K. I. Williams, M. Seeger, "Using the Nystroem method to speed up kernel
       machines", Advances in Neural Information Processing Systems 13 (2001) 682-688.
    """

    points: FloatArray
    whitening: FloatArray

    @classmethod
    def among(cls, cloud: FloatArray, count: int) -> Landmarks:
        """Take so many points of a cloud, shape (n, m), by chance but always the same.

        Of a smaller cloud all of them.
        """
        chosen = np.random.default_rng(0).permutation(len(cloud))[:count]
        points = cloud[chosen]
        left, size, right = np.linalg.svd(_kernel(points, points))
        root = np.sqrt(np.maximum(size, LEAST))
        return cls(points, (left / root) @ right)

    def seen_from(self, places: FloatArray) -> FloatArray:
        """Give the functions at places, shape (n, m): shape (n, k)."""
        return np.asarray(_kernel(places, self.points) @ self.whitening.T)


def _kernel(a: FloatArray, b: FloatArray) -> FloatArray:
    """Give a Gaussian of the distance of each pair, of as many spreads as columns."""
    squares = np.sum(a**2, axis=1)[:, None] - 2 * a @ b.T + np.sum(b**2, axis=1)
    return np.asarray(np.exp(-np.maximum(squares, 0.0) / a.shape[1]))

"""A black box of the residual, judged on folds of the fit records.

It names nothing: it tells how much of the gap follows from input and simulated output
at all. It is judged on blocks of every record; an effect has to pay on whole records
where there are three or more. So the black box has the easier task: of sines of one
frequency a record it cannot guess the next frequency.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hystbench.blocks.linear import low_pass
from hystbench.gap.records.folds import Fold, make_folds
from hystbench.gap.records.scored_samples import Compared, ScoredSamples
from hystbench.operators import play, state_space
from hystbench.record import FloatArray, Record

#: Rows of all records together that are fitted: neighbouring samples say the same.
MOST_ROWS = 6000
#: Ridge penalties to choose from, per row of standardised columns; the largest leaves
#: next to nothing, where nothing carries over from one fold to another.
PENALTIES = np.geomspace(1e-7, 1e3, 6)
#: Amplitude or rate beyond the training records' largest by more is outside.
OUTSIDE_RATIO = 1.02
#: Lags in shortest sampling intervals: dense where dynamics are fast.
LAGS = (1, 2, 3, 4, 6, 8, 12, 16, 24, 32, 48, 64)
#: Low-passes from the shortest sampling interval to a third of the longest record.
LOW_PASSES = 8
#: Damped modes from three periods in the longest record to a fifth of the sampling
#: frequency.
MODES, DAMPING = 12, 0.15
#: Thresholds of play operators, as parts of the input's largest excursion.
THRESHOLDS = (0.05, 0.15, 0.3, 0.5, 0.75)
#: Widths over which a signal turns its sign, in its spreads: friction, dead zones.
TURN_WIDTHS = (0.03, 0.3, 1.0)
#: Points about which radial basis functions lie.
LANDMARKS = 80
#: Share by which two mean squares differ that are the same.
SAME_SHARE = 1e-9
#: Singular value below which a direction of these functions is none.
LEAST_SINGULAR = 1e-12


@dataclass(frozen=True, repr=False)
class BlackBox:
    """Nonlinear finite-impulse-response model of the residual, in free run.

    A ridge regression on what :class:`BoxInputs` gives. The measured output is not
    among the columns, so that it runs as freely as the simulator; nor is time: what the
    input does not explain, the black box cannot.

    Attributes
    ----------
    explained_on_folds : float or None
        Share of the residual's power above the floor that is gone on samples held
        out from the fit, or of all its power where the floor is what it leaves there;
        below zero where the black box makes it worse; None where there is no power
        above the floor.
    """

    signals: BoxInputs
    weights: FloatArray
    explained_on_folds: float | None
    input_range: tuple[float, float]
    largest_rate: float
    left_on_folds: float = np.inf
    """RMS of what it leaves on these samples, in the unit of the output."""

    @classmethod
    def fit(
        cls, compared: Sequence[Compared], folds: Sequence[Fold], floor_rms: float = 0.0
    ) -> BlackBox:
        """Fit to the residuals of the fit records.

        Parameters
        ----------
        compared : sequence of Compared
        folds : sequence of Fold
            Of the same records, in the same order.
        floor_rms : float
            Noise floor in output units.
        """
        records = [item.record for item in compared]
        rows = _rows(records)
        signals, table = BoxInputs.of(compared, rows)
        target = _taken([item.residual for item in compared], rows)
        held = [_taken(fold.validation, rows) for fold in folds]
        train = [_taken(fold.train, rows) for fold in folds]
        squares = np.stack(
            [
                np.square(
                    target[own, None] - table[own] @ ridges(table[of], target[of])
                ).mean(axis=0)
                for own, of in zip(held, train, strict=True)
            ]
        )
        # A fold's penalty is the one that does best on the other folds: its own samples
        # choose neither weights nor penalty by how well they are predicted.
        counts = np.array([np.sum(own) for own in held])
        best = [
            int(np.argmin(np.delete(squares, k, axis=0).mean(axis=0)))
            for k in range(len(folds))
        ]
        after = float(counts @ squares[np.arange(len(folds)), best] / counts.sum())
        before = float(np.mean(target**2))
        above = before - floor_rms**2
        if abs(floor_rms**2 / max(after, LEAST_SINGULAR) - 1.0) < SAME_SHARE:
            above = before  # a floor that it tells itself is no measure of it
        inputs = np.concatenate([record.u for record in records])
        return cls(
            signals,
            ridges(table, target)[:, int(np.argmin(squares.mean(axis=0)))],
            (before - after) / above if above > 0 else None,
            (float(inputs.min()), float(inputs.max())),
            max(_fastest(record) for record in records),
            float(np.sqrt(after)),
        )

    def predict(self, record: Record, simulated: FloatArray) -> FloatArray:
        """Predict the residual from the input and the simulated output alone.

        Returns
        -------
        ndarray, shape (n,)
            In the unit of the output.
        """
        signals = self.signals
        blocks = signals.columns(Compared(record, simulated), slice(None))
        weights = self.weights / signals.spreads
        ends = np.cumsum([block.shape[1] for block in blocks])
        # All columns in one would take twice the memory.
        predicted = np.full(len(record), -np.sum(signals.middles * weights))
        for block, part in zip(blocks, np.split(weights, ends[:-1]), strict=True):
            predicted += block @ part
        return predicted

    def outside(self, record: Record) -> tuple[str, ...]:
        """Tell in what a record lies outside the records that were fitted.

        Returns
        -------
        tuple of {"amplitude", "rate"}
            Empty where the black box interpolates.
        """
        low, high = self.input_range
        middle, half = (low + high) / 2, (high - low) / 2
        ways = []
        if float(np.abs(record.u - middle).max()) > OUTSIDE_RATIO * half:
            ways.append("amplitude")
        if _fastest(record) > OUTSIDE_RATIO * self.largest_rate:
            ways.append("rate")
        return tuple(ways)


def black_box(compared: Sequence[Compared], floor_rms: float) -> BlackBox:
    """Fit the black box to what the base leaves on the fit records."""
    folds = make_folds([item.record for item in compared], whole=False)
    return BlackBox.fit(compared, folds, floor_rms)


@dataclass(frozen=True)
class BoxInputs:
    """What the black box sees: past and present of input and simulated output.

    References
    ----------
    .. [1] C. K. I. Williams, M. Seeger, "Using the Nystroem method to speed up kernel
       machines", Advances in Neural Information Processing Systems 13 (2001) 682-688.
    """

    input: tuple[float, float]
    simulated: tuple[float, float]
    """Middle and spread of each over the records that fit."""
    rates: tuple[float, float]
    """RMS of the time derivatives of both, per second of the scaled signals."""
    excursion: float
    """Largest absolute value of the scaled input."""
    step: float
    longest: float
    """Shortest sampling interval and longest record, in seconds."""
    landmarks: FloatArray = field(default_factory=lambda: np.zeros((0, 5)))
    """Shape (k, 5). Points about which radial basis functions lie, of the few signals
    that everything nonlinear is made of."""
    whitening: FloatArray | None = None
    """Shape (k, k). Takes these functions to ones whose products give the kernel
    [1]_."""
    middles: FloatArray | float = 0.0
    spreads: FloatArray | float = 1.0
    """Shape (m,). Of the columns over the rows that fit."""

    @classmethod
    def of(
        cls, compared: Sequence[Compared], rows: Sequence[Any]
    ) -> tuple[BoxInputs, FloatArray]:
        """Choose scales and landmarks by the records that fit; give their table too."""
        records = [item.record for item in compared]
        u, s = [x.u for x in records], [item.simulated for item in compared]
        scales = [_scale(np.concatenate(each)) for each in (u, s)]
        slopes = [
            [np.gradient(x, record.dt) for x, record in zip(each, records, strict=True)]
            for each in (u, s)
        ]
        rates = [
            _never_zero(float(np.sqrt(np.mean(np.concatenate(each) ** 2))) / spread)
            for each, (_, spread) in zip(slopes, scales, strict=True)
        ]
        middle, spread = scales[0]
        found = cls(
            scales[0],
            scales[1],
            (rates[0], rates[1]),
            max(float(np.abs(each - middle).max()) for each in u) / spread,
            min(record.dt for record in records),
            max(record.dt * len(record) for record in records),
        )
        pairs = list(zip(compared, rows, strict=True))
        cloud = np.concatenate([found.state(*pair) for pair in pairs])
        chosen = np.random.default_rng(0).permutation(len(cloud))[:LANDMARKS]
        found = replace(found, landmarks=cloud[chosen])
        left, size, right = np.linalg.svd(found.near_landmarks(cloud[chosen]))
        root = np.sqrt(np.maximum(size, LEAST_SINGULAR))
        found = replace(found, whitening=(left / root) @ right)
        raw = np.concatenate([np.hstack(found.columns(*pair)) for pair in pairs])
        middles, spreads = raw.mean(axis=0), raw.std(axis=0)
        middles[-1] = 0.0  # the last column is a constant
        spreads[spreads == 0] = 1.0
        raw -= middles
        raw /= spreads
        return replace(found, middles=middles, spreads=spreads), raw

    def columns(self, compared: Compared, rows: Any) -> list[FloatArray]:
        """Give all columns: linear in the past, and nonlinear in the present.

        Parameters
        ----------
        compared : Compared
        rows : ndarray of int or slice
            Which samples.

        Returns
        -------
        list of ndarray, shape (rows, m) each
            The last is a constant.
        """
        dt = compared.record.dt
        u, s = self._scaled(compared)
        position = np.arange(len(u))[rows]
        lines: list[FloatArray] = []
        for signal in (u, s):
            lines += [_lagged(signal, lag * self.step / dt, position) for lag in LAGS]
        times = np.geomspace(
            self.step, max(self.longest / 3, 2 * self.step), LOW_PASSES
        )
        for signal in (u, s, u**2):
            lines += [low_pass(signal, dt, tau, signal[0])[rows] for tau in times]
        for frequency in np.geomspace(3 / self.longest, 0.2 / self.step, MODES):
            lines += [part[rows] for part in ringing(s, dt, float(frequency))]
        plays = play(u, self.excursion * np.array(THRESHOLDS))
        state = self.state(compared, rows)
        first, second = np.triu_indices(state.shape[1])
        return [
            np.array(lines).T,
            *(np.tanh(state / width) for width in TURN_WIDTHS),
            plays[rows],
            state[:, first] * state[:, second],
            self.near_landmarks(state),
            np.ones((len(state), 1)),
        ]

    def near_landmarks(self, state: FloatArray) -> FloatArray:
        """Give a Gaussian of the distance from each landmark, shape (rows, k)."""
        points = self.landmarks
        squares = np.sum(state**2, axis=1)[:, None] + np.sum(points**2, axis=1)
        apart = np.maximum(squares - 2 * state @ points.T, 0.0)
        seen = np.asarray(np.exp(-apart / state.shape[1]))
        return seen if self.whitening is None else seen @ self.whitening.T

    def _scaled(self, compared: Compared) -> tuple[FloatArray, FloatArray]:
        (at, spread), (s_at, s_spread) = self.input, self.simulated
        return (compared.record.u - at) / spread, (compared.simulated - s_at) / s_spread

    def state(self, compared: Compared, rows: Any) -> FloatArray:
        """Give input, output, their rates and one play, shape (rows, 5)."""
        dt = compared.record.dt
        u, s = self._scaled(compared)
        middle = play(u, [0.3 * self.excursion])
        rates = [
            np.gradient(x, dt) / r for x, r in zip((u, s), self.rates, strict=True)
        ]
        return np.column_stack([x[rows] for x in (u, s, *rates, middle[:, 0])])


def ridges(table: FloatArray, target: FloatArray) -> FloatArray:
    """Give the weights of each penalty, shape (m, penalties).

    The least ``|target - table w|^2 + rows penalty |w|^2``, from the eigenvectors of
    ``table^T table``.
    """
    sizes, vectors = np.linalg.eigh(table.T @ table)
    along = vectors.T @ (table.T @ target)
    held = np.maximum(sizes, 0.0)[:, None] + len(table) * PENALTIES
    return np.asarray(vectors @ (along[:, None] / held))


def _rows(records: Sequence[Record]) -> list[NDArray[np.intp]]:
    """Choose measured rows, one at random in each of equal stretches of a record.

    A regular step could beat with a period and miss parts of the loop.
    """
    total = sum(int(np.sum(record.counted)) for record in records)
    shares = [int(np.sum(record.counted)) / total for record in records]
    return [
        ScoredSamples.of([record], max(1, round(MOST_ROWS * share))).positions[0]
        for record, share in zip(records, shares, strict=True)
    ]


def _taken(signals: Sequence[Any], rows: Sequence[Any]) -> Any:
    """Join the chosen rows of one signal a record."""
    return np.concatenate([x[row] for x, row in zip(signals, rows, strict=True)])


def _scale(values: FloatArray) -> tuple[float, float]:
    return float(values.mean()), _never_zero(float(values.std()))


def _never_zero(value: float) -> float:
    return value if value > 0 else 1.0


def _lagged(signal: FloatArray, lag: float, position: NDArray[np.intp]) -> FloatArray:
    """Take a signal some samples ago; before the record it rests where it begins."""
    if lag == int(lag):
        return signal[np.maximum(position - int(lag), 0)]
    return np.asarray(np.interp(position - lag, np.arange(len(signal)), signal))


def ringing(signal: FloatArray, dt: float, frequency_hz: float) -> list[FloatArray]:
    """Pass through a damped mode: two signals a quarter period apart.

    They are the parts of ``z(k) = p z(k-1) + (1 - |p|) v(k)`` with the mode's pole p.
    """
    pole = np.exp((-DAMPING + 1j) * 2 * np.pi * frequency_hz * dt)
    turn = np.array([[pole.real, -pole.imag], [pole.imag, pole.real]])
    drive = np.array([1 - abs(pole), 0.0])
    return [state_space(turn, drive, turn[k], float(drive[k]), signal) for k in (0, 1)]


def _fastest(record: Record) -> float:
    """Largest rate of the input, in its unit per second; a lone jump does not count."""
    return float(np.quantile(np.abs(np.gradient(record.u, record.dt)), 0.995))

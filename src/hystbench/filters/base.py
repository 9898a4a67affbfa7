"""What all adaptive filters share: the LMS loop, its results and its bound.

An adaptive filter predicts ``y(k) = w(k)' H(k)`` (Eq. 13), compares with what the
plant gave, ``e(k) = d(k) - y(k)``, and corrects ``w(k+1) = w(k) + 2 mu e(k) H(k)``
(Eq. 18). The error is a priori: the prediction does not know ``d(k)``. Filters
differ in the regressor ``H`` alone, so a new one is one file with one method.
"""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import ClassVar

import numpy as np
from numpy.typing import ArrayLike

from hystbench import kernels
from hystbench.errors import InputError
from hystbench.filters.bound import Bound, eigenvalue_bound
from hystbench.record import FloatArray

CHUNK = 32000
"""Samples filtered at a time: what is made of them stays in the processor's cache."""

ROWS = 2048
"""Samples whose regressors are held at a time."""

MAX_ORDER = 4095
"""Highest order: the kernels keep a regressor on the stack."""

MOST_CORRECTION = 1.7
"""Most that one update may correct of an error where a margin is asked for.

Beyond 2 the LMS of Eq. 18 is unstable while its regressor moves little; see
:meth:`AdaptiveFilter.correction`. Errors at that edge are those of an incipient
instability. 1.7 leaves 15 %.
"""

FILTERS: dict[str, type[AdaptiveFilter]] = {}
"""Every filter by its name."""


@dataclass(frozen=True)
class State:
    """What a filter carries from one chunk of a signal to the next.

    Parameters
    ----------
    weights : ndarray
        Weights after the last update.
    past : ndarray, shape (history,)
        The last inputs, oldest first: as many as the filter looks back on.
    operators : ndarray
        Outputs of the play operators, by tap; empty for filters without.
    limit : float or None
        Error beyond which the filter has diverged; None for a million times
        ``largest``.
    largest : float
        Largest ``|d|`` so far.
    diverged : bool
        Whether it has; then it cannot go on.
    """

    weights: FloatArray
    past: FloatArray
    operators: FloatArray
    limit: float | None = None
    largest: float = 0.0
    diverged: bool = False


End = tuple[FloatArray, FloatArray]
"""Weights and outputs of the operators after a chunk."""


@dataclass(frozen=True)
class Result:
    """What an adaptive filter made of a record.

    Parameters
    ----------
    output, error : ndarray, shape (n,)
        Prediction y and a priori error ``e = d - y`` at each sample. They end before
        the sample at which the filter diverged.
    weights : ndarray
        Weights after the last sample; after divergence of no use, but finite.
    diverged_at : int or None
        First sample whose error was beyond the limit or not a number.
    state : State
        Where to go on with the next chunk.
    """

    output: FloatArray
    error: FloatArray
    weights: FloatArray
    diverged_at: int | None
    state: State


@dataclass(frozen=True, kw_only=True)
class AdaptiveFilter(ABC):
    """An adaptive filter with LMS weights.

    A subclass that is not abstract is in :data:`FILTERS` under its ``name``.

    Parameters
    ----------
    order : int
        Order N: the delay line has N + 1 taps, x(k) to x(k - N).
    step_size : float
        Convergence factor mu of Eq. 18.
    normalized : bool
        Divide each correction by ``regularization + H'H`` (normalized LMS).
    regularization : float
        Keeps that division from zero; in the unit of ``H'H``.
    x_before : float
        Input before the first sample.
    constant_tap : float
        A constant at the end of the regressor, with a weight of its own; zero for
        none, as in the paper. Its step size is ``step_size``.

    Raises
    ------
    InputError
        If a parameter is out of range.
    """

    name: ClassVar[str]

    order: int
    step_size: float
    normalized: bool = False
    regularization: float = 1e-6
    x_before: float = 0.0
    constant_tap: float = 0.0

    def __init_subclass__(cls) -> None:
        """Enter the filter in the registry."""
        if "name" in cls.__dict__:
            FILTERS[cls.name] = cls

    def __post_init__(self) -> None:
        """Refuse parameters out of range."""
        if not 0 <= self.order <= MAX_ORDER:
            raise InputError(f"order: {self.order} given, 0 to {MAX_ORDER} expected")
        positive("step_size", self.step_size)
        positive("regularization", self.regularization)
        if not np.isfinite(self.x_before):
            raise InputError(f"x_before: {self.x_before} is not a finite number")
        if not 0 <= self.constant_tap < np.inf:
            raise InputError(
                f"constant_tap: {self.constant_tap} given, zero or more expected"
            )

    @property
    def taps(self) -> int:
        """Length of the delay line, N + 1."""
        return self.order + 1

    @property
    def size(self) -> int:
        """Number of weights."""
        return self.taps + bool(self.constant_tap)

    @property
    def history(self) -> int:
        """Past inputs kept: the taps, rounded up to whole vectors of the kernels."""
        return kernels.padded(self.taps)

    @property
    def steps(self) -> FloatArray:
        """Step size of each weight."""
        return np.full(self.size, self.step_size)

    @abstractmethod
    def regressor(
        self, line: FloatArray, operators: FloatArray
    ) -> tuple[FloatArray, FloatArray]:
        """Give the regressor H at each sample of a chunk, without a constant tap.

        Parameters
        ----------
        line : ndarray, shape (history + n,)
            The inputs, oldest first: past ones, then those of the chunk. Sample k of
            the chunk is ``line[history + k]``.
        operators : ndarray
            Outputs of the operators before the chunk.

        Returns
        -------
        H : ndarray, shape (n, size)
            Regressors; a column less where there is a constant tap.
        operators : ndarray
            Outputs of the operators after the chunk.
        """

    def whole_regressor(
        self, line: FloatArray, operators: FloatArray
    ) -> tuple[FloatArray, FloatArray]:
        """Give what :meth:`regressor` gives, with the constant tap if there is one."""
        rows, operators = self.regressor(line, operators)
        if self.constant_tap:
            rows = np.hstack((rows, np.full((len(rows), 1), self.constant_tap)))
        return rows, operators

    def start(self, weights: ArrayLike | None = None) -> State:
        """Give the state before the first sample.

        Parameters
        ----------
        weights : array_like, shape (size,), optional
            Initial weights; zero by default.

        Raises
        ------
        InputError
            If there are not ``size`` finite weights.
        """
        w = np.zeros(self.size)
        if weights is not None:
            given = np.asarray(weights, dtype=np.float64)
            if given.shape != w.shape or not np.isfinite(given).all():
                raise InputError(
                    f"weights: {given.shape} given, {self.size} finite numbers expected"
                )
            w[:] = given
        past = np.empty(self.history)
        past.fill(self.x_before)
        return State(w, past, self._first_operators())

    def run(
        self,
        x: ArrayLike,
        d: ArrayLike,
        state: State | None = None,
        limit: float | None = None,
    ) -> Result:
        """Filter a record, or the next chunk of one.

        Chunk after chunk, each with the state of the one before, gives what the
        whole record gives at once. (The default limit knows of the chunks so far
        alone: a filter that comes near it in a quiet one may be told earlier that it
        has diverged.)

        Parameters
        ----------
        x, d : array_like, shape (n,)
            Input of the plant and its output.
        state : State, optional
            Where the chunk before ended; the start by default.
        limit : float, optional
            Magnitude of the error beyond which the filter has diverged. By default
            that of the chunk before, or a million times the largest ``|d|`` so far.

        Raises
        ------
        InputError
            If x and d differ in length, are not finite, the limit is not positive or
            the filter diverged in a chunk before.
        """
        (result,) = run_together([self], x, d, state, limit)
        return result

    def bound(self, x: ArrayLike) -> Bound:
        """Bound on the step size for an input, Eq. 19.

        The correlation matrix and its eigenvalues are BLAS's and LAPACK's work. Their
        last bits may depend on the library and on its threads: for the same bytes
        on any number of processors, set ``OPENBLAS_NUM_THREADS=1`` before NumPy is
        imported, as the command ``hystbench`` does.

        Parameters
        ----------
        x : array_like, shape (n,)
            Input, at least one sample.
        """
        return eigenvalue_bound(self._correlation(x), self.size)

    def largest_power(self, x: ArrayLike) -> float:
        """Largest ``H'H`` over an input; what :meth:`correction` takes.

        Parameters
        ----------
        x : array_like, shape (n,)
            Input, at least one sample.
        """
        largest = 0.0
        for rows in self.rows(x):
            largest = max(largest, float(np.einsum("ij,ij->i", rows, rows).max()))
        return largest

    def tap_rms(self, x: ArrayLike) -> float:
        """RMS over an input of the taps, the constant one aside."""
        total, count, operators = 0.0, 0, self._first_operators()
        for line in self._chunks(x):
            rows, operators = self.regressor(line, operators)
            taps = rows[:, : self.taps]
            total += float(np.einsum("ij,ij->", taps, taps))
            count += taps.size
        return math.sqrt(total / count)

    def rows(self, x: ArrayLike) -> Iterator[FloatArray]:
        """Give the regressors of an input, some samples at a time.

        Parameters
        ----------
        x : array_like, shape (n,)
            Input, at least one sample.

        Returns
        -------
        iterator of ndarray, shape (samples, size)
        """
        operators = self._first_operators()
        for line in self._chunks(x):
            rows, operators = self.whole_regressor(line, operators)
            yield rows

    def correction(self, power: float) -> float:
        """Share of an error that one update corrects, ``2 mu H'H``.

        After the update by Eq. 18 the error on the same regressor is one minus this
        share of what it was: it is gone at 1 and grows without end beyond 2. So a
        step size whose correction is above 2 at the largest power of a record is
        unstable while the regressor moves little from sample to sample. This holds
        for the plain LMS, not for the normalized one.

        Parameters
        ----------
        power : float
            ``H'H``, as :meth:`largest_power` gives it.
        """
        return 2 * self.step_size * power

    def _windows(self, line: FloatArray) -> FloatArray:
        """Taps at each sample, newest first, as a view of the line."""
        start = 1 + self.history - self.taps
        view = np.lib.stride_tricks.sliding_window_view(line[start:], self.taps)
        return view[:, ::-1]

    def _first_operators(self) -> FloatArray:
        return np.zeros(0)

    def _chunks(self, x: ArrayLike) -> Iterator[FloatArray]:
        """Delay line of chunk after chunk of an input: past inputs, then its own."""
        x, _ = _finite("x", x)
        if len(x) == 0:
            raise InputError("x: no samples")
        line = np.concatenate((np.full(self.history, self.x_before), x))
        for start in range(0, len(x), ROWS):
            yield line[start : start + self.history + ROWS]

    def _correlation(self, x: ArrayLike) -> FloatArray:
        """Mean of H H' over the input."""
        total, count = np.zeros((self.size, self.size)), 0
        for rows in self.rows(x):
            total += rows.T @ rows
            count += len(rows)
        return total / count

    def _adapt_all(
        self,
        filters: Sequence[AdaptiveFilter],
        line: FloatArray,
        d: FloatArray,
        ends: Sequence[End],
        limit: float,
        output: FloatArray,
        error: FloatArray,
        start: int,
    ) -> list[tuple[int, End]]:
        """Run the LMS loops of filters that differ in step size alone over a chunk.

        One after the other, where a filter has no kernel that takes them all.

        Parameters
        ----------
        output, error : ndarray, shape (filters, samples of the record)
            Written from ``start`` on.

        Returns
        -------
        list of (int, (ndarray, ndarray))
            What :meth:`_adapt` returns, of each.
        """
        part = slice(start, start + len(d))
        rows = zip(filters, ends, output[:, part], error[:, part], strict=True)
        return [item._adapt(line, d, *end, limit, y, e) for item, end, y, e in rows]

    def _adapt(
        self,
        line: FloatArray,
        d: FloatArray,
        weights: FloatArray,
        operators: FloatArray,
        limit: float,
        output: FloatArray,
        error: FloatArray,
    ) -> tuple[int, End]:
        """Run the LMS loop over a chunk, writing output and error.

        This works with any regressor. A filter whose kernel makes the regressor
        inside the loop has its own, or its own :meth:`_adapt_all`.

        Returns
        -------
        taken : int
            Samples before the filter diverged; all of them if it did not.
        weights, operators : ndarray
            Weights and outputs of the operators after them.
        """
        lanes, steps = kernels.pad(weights), kernels.pad(2 * self.steps)
        done = 0
        while done < len(d):
            part = slice(done, done + ROWS)
            chunk = line[done : done + self.history + ROWS]
            h, operators = self.whole_regressor(chunk, operators)
            rows = np.zeros((len(h), len(lanes)))
            rows[:, : self.size] = h
            signals = (d[part], limit, lanes, output[part], error[part])
            taken = self._rows(rows, len(lanes), steps, *signals)
            done += taken
            if taken < len(h):
                break
        return done, (lanes[: self.size].copy(), operators)

    def _rows(
        self,
        rows: FloatArray,
        stride: int,
        steps: FloatArray,
        d: FloatArray,
        limit: float,
        weights: FloatArray,
        output: FloatArray,
        error: FloatArray,
    ) -> int:
        vectors = len(weights) // kernels.WIDTH
        numbers = (self._kernel_regularization(), limit)
        arrays = (weights, output, error)
        sizes = (len(d), vectors)
        signals = (rows, stride, d, steps)
        return kernels.call("hb_lms_rows", *sizes, *signals, *numbers, *arrays)

    def _kernel_regularization(self) -> float:
        # the kernels take a negative one for the plain LMS
        return self.regularization if self.normalized else -1.0


def run_together(
    filters: Sequence[AdaptiveFilter],
    x: ArrayLike,
    d: ArrayLike,
    state: State | None = None,
    limit: float | None = None,
) -> list[Result]:
    """Run filters that differ in step size alone, each as it would run by itself.

    Filters of play operators go through one call of the kernel a chunk; once some
    have diverged, neighbours that have not stay together.

    Parameters
    ----------
    filters : sequence of AdaptiveFilter
        At least one.
    x, d, state, limit
        As for :meth:`AdaptiveFilter.run`.

    Returns
    -------
    list of Result
        Their outputs and errors are rows of one array each.

    Raises
    ------
    InputError
        If there is no filter, if they differ in more than the step size, and as for
        :meth:`AdaptiveFilter.run`.
    """
    if not filters:
        raise InputError("filters: none given, at least one expected")
    first = filters[0]
    if len(filters) > 1:
        _refuse_unlike(filters)
    x, _ = _finite("x", x)
    d, largest = _finite("d", d)
    if len(x) != len(d):
        raise InputError(f"d: {len(d)} samples given, x has {len(x)}")
    state = state or first.start()
    if state.diverged:
        raise InputError("state: the filter has diverged; expected one that goes on")
    largest = max(largest, state.largest)
    kept = state.limit if limit is None else limit
    limit = 1e6 * (largest or 1.0) if kept is None else kept
    positive("limit", limit)
    count, past = len(filters), state.past
    output, error = np.empty((count, len(d))), np.empty((count, len(d)))
    ends: list[End] = [(state.weights, state.operators)] * count
    pasts, done = [past] * count, [0] * count
    for start in range(0, len(d), CHUNK):
        part = slice(start, start + CHUNK)
        line = np.concatenate((past, x[part]))
        past = line[-first.history :].copy()
        for row in _neighbours([samples == start for samples in done]):
            own = range(count)[row]
            signals = (output[row], error[row], start)
            found = first._adapt_all(
                filters[row], line, d[part], ends[row], limit, *signals
            )
            for k, (taken, end) in zip(own, found, strict=True):
                done[k] += taken
                ends[k], pasts[k] = end, past
    whole = math.isfinite(kernels.largest(np.concatenate([w for w, _ in ends])))
    results = []
    for k, (weights, operators) in enumerate(ends):
        diverged_at = done[k] if done[k] < len(d) else None
        if not whole and not np.isfinite(weights).all():
            # overflow in the last update of all: the next prediction would show it
            diverged_at = done[k]
            weights = np.nan_to_num(weights)
        diverged = diverged_at is not None
        end_state = State(weights, pasts[k], operators, kept, largest, diverged)
        used = slice(done[k])
        results.append(
            Result(output[k, used], error[k, used], weights, diverged_at, end_state)
        )
    return results


def but_step_size(item: AdaptiveFilter) -> dict[str, object]:
    """Give what must be the same of filters that are run together.

    Settings count by value; those without a hash, as arrays, by identity.
    """
    values = {key: value for key, value in vars(item).items() if key != "step_size"}
    return {"filter": type(item)} | {key: _hashed(v) for key, v in values.items()}


def _hashed(value: object) -> object:
    try:
        hash(value)
    except TypeError:
        return id(value)
    return value


def _refuse_unlike(filters: Sequence[AdaptiveFilter]) -> None:
    one = but_step_size(filters[0])
    for number, item in enumerate(filters[1:], 1):
        other = but_step_size(item)
        if one != other:
            keys = (key for key in one | other if one.get(key) != other.get(key))
            raise InputError(
                f"filters: number {number} has another {next(keys)} than number 0; "
                "run together, they may differ in step_size alone"
            )


def _neighbours(going: Sequence[bool]) -> list[slice]:
    """Give the runs of neighbours that are all going."""
    bounded = [False, *going, False]
    edges = [k for k in range(len(going) + 1) if bounded[k] != bounded[k + 1]]
    return [slice(*pair) for pair in zip(edges[::2], edges[1::2], strict=True)]


def positive(name: str, value: float) -> None:
    """Refuse a parameter that is not a positive finite number."""
    if not 0 < value < np.inf:
        raise InputError(f"{name}: {value} given, a positive number expected")


def _finite(name: str, values: ArrayLike) -> tuple[FloatArray, float]:
    """Give a vector of finite numbers, as the kernels want it, and the largest."""
    array = np.asarray(values, dtype=np.float64, order="C")
    if array.ndim != 1:
        raise InputError(f"{name}: {array.ndim} dimensions given, 1 expected")
    largest = kernels.largest(array)
    if not math.isfinite(largest):
        place = int(np.flatnonzero(~np.isfinite(array))[0])
        raise InputError(f"{name}: sample {place} is {array[place]}")
    return array, largest

"""What all adaptive filters share: the LMS loop, its results and its bound.

An adaptive filter predicts ``y(k) = w(k)' H(k)`` (Eq. 13), compares with what the
plant gave, ``e(k) = d(k) - y(k)``, and corrects ``w(k+1) = w(k) + 2 mu e(k) H(k)``
(Eq. 18). The error is a priori: the prediction does not know ``d(k)``. Filters
differ in the regressor ``H`` alone, so a new one is one file with one method.
"""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np
from numpy.typing import ArrayLike

from hystbench import kernels
from hystbench.errors import InputError
from hystbench.filters.bound import Bound, correlation, eigenvalue_bound
from hystbench.filters.keys import keys_of
from hystbench.filters.state import Chunk, End, Result, State, finite, positive
from hystbench.filters.together import run_together
from hystbench.record import FloatArray, Record

ROWS = 2048
"""Samples whose regressors are held at a time."""

MAX_ORDER = 4095
"""Highest order: the kernels keep a regressor on the stack."""


@dataclass(frozen=True, kw_only=True)
class AdaptiveFilter(ABC):
    """An adaptive filter with LMS weights.

    A subclass that is not abstract is a filter that config.yaml can name: inside
    hystbench by its file, outside by an entry point. A field of it that is declared
    with :func:`hystbench.filters.keys.number` or :func:`hystbench.filters.keys.choice`
    is a key of config.yaml.

    Parameters
    ----------
    order : int
        Order N: the delay line has N + 1 taps, x(k) to x(k - N).
    step_size : float
        Convergence factor mu of Eq. 18.
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
    """Name in config.yaml and in every result."""
    label: ClassVar[str]
    """What figures and tables call it."""
    step_sizes: ClassVar[Mapping[str, str]] = {"mu": "step_size"}
    """Step sizes by their names in config.yaml and results, each with its field."""
    takes_envelopes: ClassVar[bool] = False
    """Whether it has envelope functions, which Algorithm 1 may have identified."""

    order: int
    step_size: float
    x_before: float = 0.0
    constant_tap: float = 0.0

    def __post_init__(self) -> None:
        """Refuse parameters out of range."""
        if not 0 <= self.order <= MAX_ORDER:
            raise InputError(f"order: {self.order} given, 0 to {MAX_ORDER} expected")
        positive("step_size", self.step_size)
        if not np.isfinite(self.x_before):
            raise InputError(f"x_before: {self.x_before} is not a finite number")
        if not 0 <= self.constant_tap < np.inf:
            raise InputError(
                f"constant_tap: {self.constant_tap} given, zero or more expected"
            )
        for key in keys_of(type(self)).values():
            key.check(key.field, getattr(self, key.field))

    @classmethod
    def options(
        cls,
        settings: Mapping[str, Any],
        record: Record,
        identified: Mapping[str, Any] | None,
    ) -> dict[str, Any]:
        """Give what the filter itself needs beside order, step sizes and input before.

        Parameters
        ----------
        settings : mapping
            Those of the job; they hold the filter's own keys.
        record : Record
            The record that is to be filtered.
        identified : mapping or None
            Result of Algorithm 1, where it is asked for.

        Returns
        -------
        dict
            By field: of each of the filter's own keys the value that is set.
        """
        return {key.field: settings[name] for name, key in keys_of(cls).items()}

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

    def start(self) -> State:
        """Give the state before the first sample: all weights are zero."""
        past = np.full(self.history, self.x_before, dtype=np.float64)
        return State(np.zeros(self.size), past, self.first_operators())

    def run(self, x: ArrayLike, d: ArrayLike, state: State | None = None) -> Result:
        """Filter a record, or the next chunk of one.

        Chunk after chunk, each with the state of the one before, gives what the
        whole record gives at once. (The limit of divergence knows of the chunks so
        far alone: a filter that comes near it in a quiet one may be told earlier that
        it has diverged.)

        Parameters
        ----------
        x, d : array_like, shape (n,)
            Input of the plant and its output.
        state : State, optional
            Where the chunk before ended; the start by default.

        Raises
        ------
        InputError
            If x and d differ in length, are not finite, or the filter diverged in a
            chunk before.
        """
        return run_together([self], x, d, state)[0]

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
        return eigenvalue_bound(correlation(self.rows(x)), self.size)

    def step_bounds(self, x: ArrayLike) -> dict[str, float]:
        """Bound of Eq. 19, 1 / tr R, on each step size for an input, by its name.

        A filter with several step sizes says what bounds each of them.
        """
        return {"mu": self.bound(x).bound}

    def largest_power(self, x: ArrayLike) -> float:
        """Largest ``H'H`` over an input; what :meth:`correction` takes.

        Parameters
        ----------
        x : array_like, shape (n,)
            Input, at least one sample.
        """
        return max(
            float(np.einsum("ij,ij->i", rows, rows).max()) for rows in self.rows(x)
        )

    def tap_rms(self, x: ArrayLike) -> float:
        """RMS over an input of the taps, the constant one aside."""
        total, count, operators = 0.0, 0, self.first_operators()
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
        operators = self.first_operators()
        for line in self._chunks(x):
            rows, operators = self.whole_regressor(line, operators)
            yield rows

    def correction(self, power: float) -> float:
        """Share of an error that one update corrects, ``2 mu H'H``.

        After the update by Eq. 18 the error on the same regressor is one minus this
        share of what it was: it is gone at 1 and grows without end beyond 2. So a
        step size whose correction is above 2 at the largest power of a record is
        unstable while the regressor moves little from sample to sample.

        Parameters
        ----------
        power : float
            ``H'H``, as :meth:`largest_power` gives it.
        """
        return 2 * self.step_size * power

    def windows(self, line: FloatArray) -> FloatArray:
        """Taps at each sample, newest first, as a view of the line."""
        start = 1 + self.history - self.taps
        view = np.lib.stride_tricks.sliding_window_view(line[start:], self.taps)
        return view[:, ::-1]

    def first_operators(self) -> FloatArray:
        """Outputs of the operators before the first sample; none by default."""
        return np.zeros(0)

    def _chunks(self, x: ArrayLike) -> Iterator[FloatArray]:
        """Delay line of chunk after chunk of an input: past inputs, then its own."""
        x, _ = finite("x", x)
        if len(x) == 0:
            raise InputError("x: no samples")
        line = np.concatenate((np.full(self.history, self.x_before), x))
        for start in range(0, len(x), ROWS):
            yield line[start : start + self.history + ROWS]

    def _adapt_all(
        self,
        filters: Sequence[AdaptiveFilter],
        chunk: Chunk,
        ends: Sequence[End],
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
        part = slice(start, start + len(chunk.d))
        rows = zip(filters, ends, output[:, part], error[:, part], strict=True)
        return [item._adapt(chunk, end, y, e) for item, end, y, e in rows]

    def _adapt(
        self, chunk: Chunk, before: End, output: FloatArray, error: FloatArray
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
        weights, operators = before
        lanes, steps = kernels.pad(weights), kernels.pad(2 * self.steps)
        done = 0
        while done < len(chunk.d):
            part = slice(done, done + ROWS)
            line = chunk.line[done : done + self.history + ROWS]
            h, operators = self.whole_regressor(line, operators)
            rows = np.zeros((len(h), len(lanes)))
            rows[:, : self.size] = h
            signals = (chunk.d[part], chunk.limit, lanes, output[part], error[part])
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
        arrays = (weights, output, error)
        sizes = (len(d), vectors)
        signals = (rows, stride, d, steps)
        return kernels.call("hb_lms_rows", *sizes, *signals, limit, *arrays)

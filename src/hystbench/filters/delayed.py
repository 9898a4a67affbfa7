"""Delayed adaptive filter: the linear transversal filter, the paper's Figure 1."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from hystbench import kernels
from hystbench.filters.base import AdaptiveFilter, State
from hystbench.record import FloatArray


@dataclass(frozen=True, kw_only=True)
class DelayedFilter(AdaptiveFilter):
    """Linear adaptive filter, ``H_i(k) = x(k - i)`` for i = 0 to N.

    Parameters are those of :class:`hystbench.filters.base.AdaptiveFilter`.

    References
    ----------
    Widrow and Stearns, Adaptive Signal Processing, Prentice-Hall, 1985.
    """

    name: ClassVar[str] = "delayed"

    def regressor(
        self, line: FloatArray, operators: FloatArray
    ) -> tuple[FloatArray, FloatArray]:
        """Give the delay line at each sample, newest first."""
        windows = np.lib.stride_tricks.sliding_window_view(line[1:], self.taps)
        return windows[:, ::-1], operators

    def _adapt(
        self, line: FloatArray, d: FloatArray, state: State, limit: float
    ) -> tuple[FloatArray, FloatArray, FloatArray, FloatArray]:
        # rows are windows of the line itself, one sample apart, oldest first
        weights = kernels.pad_front(state.weights[::-1])
        steps = kernels.pad_front(2 * self.steps)
        spare = len(weights) - self.taps
        rows = np.concatenate((np.zeros(spare), line[1:])) if spare else line[1:]
        output, error = np.empty(len(d)), np.empty(len(d))
        done = self._rows(rows, 1, steps, d, limit, weights, output, error)
        tail = weights[spare:][::-1].copy()
        return output[:done], error[:done], tail, state.operators

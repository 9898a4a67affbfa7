"""Delayed adaptive filter: the linear transversal filter, the paper's Figure 1."""

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from hystbench import kernels
from hystbench.filters.base import AdaptiveFilter
from hystbench.filters.state import Chunk, End
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
    label: ClassVar[str] = "delayed filter"

    def regressor(
        self, line: FloatArray, operators: FloatArray
    ) -> tuple[FloatArray, FloatArray]:
        """Give the delay line at each sample, newest first."""
        return self.windows(line), operators

    def _adapt(
        self, chunk: Chunk, before: End, output: FloatArray, error: FloatArray
    ) -> tuple[int, End]:
        if self.constant_tap:  # no column of the line
            return super()._adapt(chunk, before, output, error)
        (line, d, limit), (weights, operators) = chunk, before
        # rows are windows of the line itself, one sample apart, oldest first
        lanes = kernels.pad_front(weights[::-1])
        steps = np.zeros(len(lanes))
        steps[-self.taps :] = 2 * self.step_size
        taken = self._rows(line[1:], 1, steps, d, limit, lanes, output, error)
        return taken, (lanes[-self.taps :][::-1].copy(), operators)

"""What the filters of play operators share: an operator on each tap."""

from abc import abstractmethod
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Literal, get_args

import numpy as np

from hystbench import kernels
from hystbench.errors import refuse_unknown
from hystbench.filters.base import AdaptiveFilter
from hystbench.filters.keys import choice
from hystbench.filters.state import Chunk, End, positive
from hystbench.operators import FORMS, Form, follow_direction
from hystbench.record import FloatArray, Record

InitialState = Literal["zero", "settled"]


@dataclass(frozen=True, kw_only=True)
class PlayFilter(AdaptiveFilter):
    """Adaptive filter whose regressor is play operators of rising thresholds.

    Parameters
    ----------
    amplitude : float
        Largest magnitude of the input, from which the thresholds follow (Eq. 10).
    form : {"eq12", "eq4"}
        Equation by which the operators move.
    initial_state : {"zero", "settled"}
        Outputs of the operators before the first sample: zero, or where Eq. 4 puts
        them from zero when they see ``x_before``.
    """

    amplitude: float
    form: Form = "eq12"
    initial_state: InitialState = choice(
        "outputs of the operators before the first sample",
        get_args(InitialState),
        default="zero",
    )

    @classmethod
    def options(
        cls,
        settings: Mapping[str, Any],
        record: Record,
        identified: Mapping[str, Any] | None,
    ) -> dict[str, Any]:
        """Give its own keys, and the amplitude: that of the record if none is set."""
        amplitude = settings.get("amplitude", float(np.abs(record.u).max()))
        own = super().options(settings, record, identified)
        return own | {"amplitude": amplitude}

    def __post_init__(self) -> None:
        """Refuse parameters out of range."""
        super().__post_init__()
        positive("amplitude", self.amplitude)
        refuse_unknown(self.form, FORMS, f"form: {self.form!r} unknown")

    @property
    @abstractmethod
    def thresholds(self) -> FloatArray:
        """Threshold of each operator."""

    @property
    def along_line(self) -> bool:
        """Whether operator i reads tap i; otherwise all read x(k)."""
        return True

    @abstractmethod
    def envelopes(self, x: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Left and right envelope functions of the input, in arrays of their own."""

    def regressor(
        self, line: FloatArray, operators: FloatArray
    ) -> tuple[FloatArray, FloatArray]:
        """Give the outputs of the operators at each sample, by tap."""
        left, right, r, state = self._lanes(line, operators)
        count, vectors = len(line) - self.history, len(r) // kernels.WIDTH
        rows = np.empty((count, len(r)))
        envelopes = (left, right, int(self.along_line))
        kernels.call("hb_play_rows", count, vectors, *envelopes, r, state, rows)
        return rows[:, ::-1][:, : self.taps], state[::-1][: self.taps].copy()

    def first_operators(self) -> FloatArray:
        """Outputs of the operators before the first sample, by tap."""
        zero = np.zeros(self.taps)
        if self.initial_state == "zero":
            return zero
        left, right = self.envelopes(np.array([self.x_before]))
        r = self.thresholds
        return np.maximum(right - r, np.minimum(left + r, zero))

    def _lanes(
        self, line: FloatArray, operators: FloatArray
    ) -> tuple[FloatArray, FloatArray, FloatArray, FloatArray]:
        """Envelopes of the line, thresholds and states, as the kernels want them.

        Lanes run from the oldest tap to the newest, so that a window of the line is
        read as it lies. An operator in the padding never leaves zero.
        """
        r = kernels.pad_front(self.thresholds[::-1], np.inf)
        state = kernels.pad_front(operators[::-1])
        left, right = self.envelopes(line)
        if self.form == "eq12":
            follow_direction(line, left, right)
        first = 1 if self.along_line else self.history
        return left[first:], right[first:], r, state

    def _adapt_all(
        self,
        filters: Sequence[AdaptiveFilter],
        chunk: Chunk,
        ends: Sequence[End],
        output: FloatArray,
        error: FloatArray,
        start: int,
    ) -> list[tuple[int, End]]:
        if self.constant_tap:  # the kernel has none
            return super()._adapt_all(filters, chunk, ends, output, error, start)
        # All have seen the same input: they share envelopes and operators so far.
        left, right, r, state = self._lanes(chunk.line, ends[0][1])
        count = len(filters)
        states = np.tile(state, (count, 1))
        lanes = np.array([kernels.pad_front(weights[::-1]) for weights, _ in ends])
        steps = np.array([2 * item.step_size for item in filters])
        taken = np.empty(count)
        kernels.call(
            "hb_lms_play",
            *(count, len(chunk.d), len(r) // kernels.WIDTH),
            *(left, right, int(self.along_line), chunk.d, r),
            *(steps, chunk.limit),
            *(states, lanes),
            *(output.reshape(-1)[start:], error.reshape(-1)[start:]),
            *(output.shape[1], taken),
        )
        used = slice(-self.taps, None)
        after = [
            (weights[used][::-1].copy(), operators[used][::-1].copy())
            for weights, operators in zip(lanes, states, strict=True)
        ]
        return list(zip([int(samples) for samples in taken], after, strict=True))

"""What is fitted, and what a fit gives."""

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from hystbench.blocks.wrapping import HystereticBlock
from hystbench.model import Model
from hystbench.record import FloatArray, Record


@dataclass(frozen=True)
class EffectFit:
    """An effect fitted to records."""

    effect: str
    output: FloatArray
    """Shape (n,). With the effect, over all samples of all records, one after the
    other."""
    mean_square: float
    """Mean square of the residual, over the same."""
    freedom: int
    """Parameters fitted."""
    values: dict[str, float]
    """Values of the block's parameters; empty where there is no block."""
    predict: Callable[[Record], FloatArray]
    """Output for another record. What is new in every record (a phase, a path) is
    unknown there and left out."""


class Task:
    """A base model and the records to fit.

    Parameters
    ----------
    model : Model
        Its blocks take the input as band-limited unless they say otherwise.
    records : sequence of Record
    """

    def __init__(self, model: Model, records: Sequence[Record]) -> None:
        self.model = model.with_hold("band-limited")
        self.records = tuple(records)

    @cached_property
    def measured(self) -> FloatArray:
        """All outputs, one after the other."""
        return np.concatenate([record.y for record in self.records])

    @cached_property
    def base(self) -> FloatArray:
        """The base's output on all records."""
        return self.output(self.model)

    def output(self, model: Model) -> FloatArray:
        """Give a model's output on all records."""
        return np.concatenate(
            [model.simulate(record.u, record.dt) for record in self.records]
        )

    @cached_property
    def hysteresis(self) -> int | None:
        """Place of the hysteresis in the chain."""
        places = [
            number
            for number, block in enumerate(self.model.chain)
            if isinstance(block, HystereticBlock)
        ]
        return places[0] if places else None

    @cached_property
    def reach(self) -> float:
        """Largest magnitude of the input."""
        return max(float(np.abs(record.u).max()) for record in self.records)

    @cached_property
    def rate(self) -> float:
        """Largest rate of the input."""
        return max(
            float(np.abs(np.gradient(record.u, record.dt)).max())
            for record in self.records
        )

    @cached_property
    def size(self) -> float:
        """Largest magnitude of the measured output."""
        return float(np.abs(self.measured).max())

    @cached_property
    def step(self) -> float:
        """Shortest sampling interval."""
        return min(record.dt for record in self.records)

    @cached_property
    def span(self) -> float:
        """Longest record in seconds."""
        return max(record.dt * len(record) for record in self.records)


def through(steps: Iterable[Any], y: FloatArray, record: Record) -> FloatArray:
    """Send a signal through steps of a chain, one after the other."""
    for step in steps:
        y = step.simulate(y, record.u, record.dt)
    return y

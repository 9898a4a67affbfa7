"""A model beside the records it is fitted to, with what lies beside its chain."""

from __future__ import annotations

import numpy as np

from hystbench.gap.fitting.state import ModelState
from hystbench.gap.records.scored_samples import Compared
from hystbench.gap.simulation.simulation import Simulation
from hystbench.record import FloatArray


def compared_records(state: ModelState) -> list[Compared]:
    """Simulate a model on its records, in free run, with what lies beside it."""
    outputs = Simulation(state.chain, state.records, state.hold, fine=True).output
    offsets = _beside_signals(state) if state.beside else None
    return [
        Compared(record, y if offsets is None else y + offsets[k])
        for k, (record, y) in enumerate(zip(state.records, outputs, strict=True))
    ]


def _beside_signals(state: ModelState) -> list[FloatArray]:
    """Give what lies beside, over whole records, as the scored samples fit it."""
    amplitudes = state.beside_amplitudes
    signals = [np.zeros(len(record)) for record in state.records]
    first = 0
    for beside, values in state.beside:
        for k, record in enumerate(state.records):
            shapes = beside.columns(record, values, beside.order)
            count = shapes.shape[1]
            signals[k] += shapes @ amplitudes[first : first + count]
            first += count
    return signals

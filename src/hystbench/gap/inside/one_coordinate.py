"""Linear models of one coordinate where a fit begins: masses, and an impedance."""

from __future__ import annotations

import itertools
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from hystbench.blocks.base import Block
from hystbench.blocks.gain import Gain
from hystbench.blocks.held import Hold
from hystbench.blocks.impedance import NUMBERS, Impedance
from hystbench.blocks.mechanism import Mechanism, free_starts
from hystbench.blocks.starts import possible_starts
from hystbench.gap.fitting.state import Free, ModelState
from hystbench.gap.records.scored_samples import ScoredSamples
from hystbench.quantities import Quantities
from hystbench.record import FloatArray, Record

FREQUENCIES = 24
"""Natural frequencies at which a mass on a spring is begun."""
RATIOS = (0.01, 0.05, 0.2, 0.7, 2.0)
"""Damping ratios of each."""
BEGUN = 3
"""Starts that are fitted, the best ones of the grid."""
MOTIONS = ("position", "velocity", "acceleration")


def one_coordinate(
    records: tuple[Record, ...], quantities: Quantities, hold: Hold
) -> Iterator[ModelState]:
    """Give linear models of one coordinate, with all their numbers free, begun.

    Parameters
    ----------
    records : tuple of Record
    quantities : Quantities
        What the device takes and gives: a force that makes a motion is a mass with a
        spring and one without; a motion that makes a force is an impedance. Where the
        causality is not known, a mass with each of the motions as its output.
    hold : {"zero-order", "linear", "band-limited"}
    """
    if quantities.causality == "motion to force":
        if quantities.input in ("position", "velocity"):
            yield impedance(records, quantities.input, hold)
        return
    if quantities.causality == "storage":
        return
    known = quantities.output in MOTIONS
    for output in (quantities.output,) if known else MOTIONS:
        yield from masses(records, output, hold)


def impedance(records: tuple[Record, ...], moved: str, hold: Hold) -> ModelState:
    """Give the impedance that fits best: its force is linear in its numbers."""
    sample = ScoredSamples.of(records)
    columns = sample.take([Impedance.columns(moved, hold, r.u, r.dt) for r in records])
    wanted = sample.take([record.y for record in records])
    values = solved(columns, wanted).tolist()
    numbers: dict[str, Any] = dict(zip(NUMBERS, values, strict=True))
    block = Impedance(**numbers, input=moved, hold=hold)
    return _state((block,), records, hold, {0: NUMBERS})


def masses(
    records: tuple[Record, ...], output: str, hold: Hold
) -> Iterator[ModelState]:
    """Give masses on springs, begun where a grid says, and a free mass.

    At each natural frequency and damping ratio the gain and an offset of the output are
    solved for.
    """
    span, step = _span_and_step(records)
    grid = np.geomspace(2 * np.pi / span, 0.8 * np.pi / step, FREQUENCIES)
    about: Any = {"output": output, "hold": hold}
    units = (
        Mechanism(mass=1.0, damping=2 * ratio * w, stiffness=w**2, start=start, **about)
        for start, w, ratio in itertools.product(_starts(records), grid, RATIOS)
    )
    ones = np.ones(len(ScoredSamples.of(records)))
    own = {0: ("mass", "damping", "stiffness"), 1: ("offset",)}
    for _, unit, gain, offset in _solved_for(units, records, lambda _: ones)[:BEGUN]:
        chain = (_times(unit, gain), Gain(value=1.0, offset=offset))
        yield _state(chain, records, hold, own)
    if output != "acceleration":
        yield from free_masses(records, output, hold)


def free_masses(
    records: tuple[Record, ...], output: str, hold: Hold
) -> Iterator[ModelState]:
    """Give a mass without a spring, begun at the rate of decay that fits best.

    A constant force is solved for as well as the gain.
    """
    windows = any(record.decay_s is not None for record in records)
    allowed = ("rest",) if windows else free_starts(output)
    starts = [own for own in _starts(records) if own in allowed]
    span, step = _span_and_step(records)
    rates = np.geomspace(0.3 / span, 0.3 / step, FREQUENCIES)
    about: Any = {"output": output, "hold": hold}
    units = (
        Mechanism(mass=1.0, damping=rate, stiffness=0.0, start=start, **about)
        for start, rate in itertools.product(starts, rates)
    )

    sample = ScoredSamples.of(records)

    def pushed(unit: Mechanism) -> FloatArray:
        return sample.take([unit.driven(np.ones(len(r)), r.dt, ()) for r in records])

    for _, unit, gain, bias in _solved_for(units, records, pushed)[:1]:
        block = replace(_times(unit, gain), bias=bias / abs(gain))
        yield _state((block,), records, hold, {0: ("mass", "damping", "bias")})


def _solved_for(
    units: Iterable[Mechanism],
    records: tuple[Record, ...],
    beside: Callable[[Mechanism], FloatArray],
) -> list[tuple[float, Mechanism, float, float]]:
    """Find how many times each mechanism moves, and another signal beside it.

    Each comes with the mean square that is left, its gain and that of the other signal;
    the best first.
    """
    sample = ScoredSamples.of(records)
    wanted = sample.take([record.y for record in records])
    found = []
    for unit in units:
        motion = sample.take([unit.driven(r.u, r.dt, ()) for r in records])
        columns = np.column_stack([motion, beside(unit)])
        gain, other = solved(columns, wanted).tolist()
        rest = float(np.mean((wanted - columns @ [gain, other]) ** 2))
        if gain != 0.0 and np.isfinite(rest):
            found.append((rest, unit, gain, other))
    return sorted(found, key=lambda item: item[0])


def _span_and_step(records: Sequence[Record]) -> tuple[float, float]:
    """Give the longest duration and the shortest sampling interval."""
    span = max(record.dt * len(record) for record in records)
    return span, min(record.dt for record in records)


def _times(unit: Mechanism, gain: float) -> Mechanism:
    """Give a mechanism that moves so many times as far as one of mass one."""
    size = 1.0 / abs(gain)
    return replace(
        unit,
        mass=size,
        damping=unit.damping * size,
        stiffness=unit.stiffness * size,
        gain=float(np.sign(gain)),
    )


def _starts(records: Sequence[Record]) -> Sequence[str]:
    """Give the starts that hosts are begun with.

    Where periods were left out the first sample is in the middle of a motion.
    """
    signals = [x for record in records for x in (record.u, record.y)]
    little = all(abs(x[0]) < 0.02 * np.max(np.abs(x)) for x in signals)
    at_rest = little and not all(item.repeats for item in records)
    return ("rest",) if at_rest else possible_starts(records)


def _state(
    chain: tuple[Block, ...],
    records: tuple[Record, ...],
    hold: Hold,
    own: dict[int, tuple[str, ...]],
) -> ModelState:
    free = tuple(Free(k, name) for k, names in own.items() for name in names)
    return ModelState(chain, records, ScoredSamples.of(records), free=free, hold=hold)


def solved(columns: FloatArray, wanted: FloatArray) -> FloatArray:
    """Least squares with the columns scaled alike; zeros where one is not finite."""
    if not np.all(np.isfinite(columns)):
        return np.zeros(columns.shape[1])
    sizes = np.maximum(np.sqrt(np.mean(columns**2, axis=0)), 1e-300)
    found = np.linalg.lstsq(columns / sizes, wanted, rcond=1e-10)[0] / sizes
    return np.asarray(found)

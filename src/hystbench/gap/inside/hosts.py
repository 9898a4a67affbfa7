"""Linear hosts: what forces can act inside of, fitted without any of them.

Where the base was identified from the records, hosts are fitted to them too. A base
that a user gives stands for itself: a host takes its place only if it simulates the
same, as a mass on a spring does in whatever way it was written.
"""

from __future__ import annotations

import itertools
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from functools import lru_cache
from typing import Any

import numpy as np

from hystbench.blocks.base import Block
from hystbench.blocks.gain import Gain
from hystbench.blocks.held import Hold
from hystbench.blocks.impedance import NUMBERS, Impedance
from hystbench.blocks.input_delay import InputDelay
from hystbench.blocks.mechanism import Mechanism, free_starts
from hystbench.blocks.starts import possible_starts
from hystbench.blocks.transfer_function import TransferFunction
from hystbench.gap.bases.orders import HIGHEST
from hystbench.gap.cache import records_digest
from hystbench.gap.fitting.least_squares import QUICK, Fitted, fitted
from hystbench.gap.fitting.score import Score
from hystbench.gap.fitting.state import Free, ModelState
from hystbench.gap.inside.modes import frequency_of, modes, shows_a_pole
from hystbench.gap.inside.stores import in_other_order, stores
from hystbench.gap.inside.two_masses import further_modes_of, two_masses
from hystbench.gap.records.scored_samples import ScoredSamples, rms
from hystbench.gap.thresholds import PAYS, UNNAMED_SHARE
from hystbench.quantities import Quantities
from hystbench.record import FloatArray, Record

FREQUENCIES = 24
"""Natural frequencies at which a mass on a spring is begun."""
RATIOS = (0.01, 0.05, 0.2, 0.7, 2.0)
"""Damping ratios of each."""
BEGUN = 3
"""Starts that are fitted, the best ones of the grid."""
MOTIONS = ("position", "velocity", "acceleration")
STORES = {1: "a store stands", 2: "two stores in series stand"}
"""How many are tried, and how that is told."""
TRIED = 2
"""Modes of a base in which forces are tried, those that need it most."""


@dataclass(frozen=True)
class Host:
    """A linear model that forces may act inside of.

    Parameters
    ----------
    alone : ModelState
        What the gap is counted from.
    fitted : Fitted
        The same, its numbers fitted to the records: what forces are put in.
    words : str
        How it stands in place of the base.
    other : ModelState, optional
        What forces are put in instead: as good while linear, and not fitted, as a fit
        would come back.
    """

    alone: ModelState
    fitted: Fitted
    words: str
    other: ModelState | None = None


def hosts(
    start: ModelState, quantities: Quantities, identified: bool, score: Score
) -> Iterator[Host]:
    """Give the linear models that forces are tried in.

    Parameters
    ----------
    start : ModelState
        The base on the fit records.
    quantities : Quantities
        What the device takes and gives.
    identified : bool
        Whether the base was identified from the records.
    score : Score
    """
    delay = start.chain[0]
    if identified and isinstance(delay, InputDelay):
        for host in hosts(_behind(start), quantities, identified, score):
            state = _in_front(delay, start, host.fitted.state)
            alone = _in_front(delay, start, host.alone)
            yield replace(host, alone=alone, fitted=replace(host.fitted, state=state))
        # A force that is not linear turns the phase: it may be what looked like timing.
        yield from hosts(_without_timing(start), quantities, identified, score)
        return
    if identified and quantities.causality in ("storage", "unknown"):
        noise = float(np.sqrt(score.floor))
        for count, words in STORES.items():
            begun = stores(start.records, start.hold, noise, count)
            best = best_host(list(begun), score)
            if best is None:
                continue
            words = f"{words} in place of the base"
            yield Host(best.state, best, words)
            for other in in_other_order(best.state):
                yield Host(best.state, best, words, other)
    moves = shows_a_pole(start) or quantities.causality == "motion to force"
    if identified and moves and not of_many_modes(start):
        begun = one_coordinate(start.records, quantities, start.hold)
        best = best_host(list(begun), score)
        if best is not None and is_seen_moving(best.state):
            words = "a model of one coordinate stands in place of the linear base"
            yield Host(best.state, best, words)
            yield from _loose(best.state, score, words)
            yield from _of_two(best, further_modes_of(start), score)
    if not identified:
        same = same_as(start, quantities)
        if same is not None:
            words = (
                "a model of one coordinate that simulates the same stands for the base"
            )
            yield Host(same, fitted(same, score), words)
    if quantities.causality not in ("force to motion", "unknown"):
        return
    known = quantities.output in MOTIONS
    split = modes(start, quantities.output if known else "position", identified)
    for mode in itertools.islice(split, TRIED):
        best, block = fitted(mode, score), mode.chain[0]
        assert isinstance(block, Mechanism)  # noqa: S101  (for the type checker)
        words = (
            f"the base's mode at {frequency_of(block):.3g} Hz is a mechanism of its own"
        )
        yield Host(best.state if identified else mode, best, words)


def best_host(states: Sequence[ModelState], score: Score) -> Fitted | None:
    """Fit linear hosts, the likely ones to the end; give the one that scores least.

    What it gives as its output may also have a share of the next derivative (a zero).
    """
    if not states:
        return None
    quick = [fitted(state, score, QUICK) for state in states]
    best = fitted(min(quick, key=lambda item: item.score).state, score)
    block, free = best.state.chain[0], best.state.free
    if isinstance(block, Mechanism) and block.output != "force":
        with_zero = replace(best.state, free=(*free, Free(0, "blend")))
        best = min(best, fitted(with_zero, score), key=lambda item: item.score)
    return best


def _loose(state: ModelState, score: Score, words: str) -> Iterator[Host]:
    """Give a mass without a spring, where another mass was fitted to its acceleration.

    A loose mass under a drag or a friction looks like one on a soft spring whose output
    has a share of the velocity: a force begins far from itself there. It comes last, as
    a friction that gives way before it slides is a spring to it.
    """
    block = state.chain[0]
    if not (isinstance(block, Mechanism) and block.output == "acceleration"):
        return
    for begun in free_masses(state.records, block.output, state.hold):
        alone = fitted(begun, score)
        yield Host(alone.state, alone, words)


def _of_two(one: Fitted, frequencies: Sequence[float], score: Score) -> Iterator[Host]:
    """Give a mass with another one attached, where that pays as an effect does."""
    state = one.state
    block = state.chain[0]
    if not isinstance(block, Mechanism):
        return
    loose = free_masses(state.records, block.output, state.hold)
    best = best_host(list(two_masses([state, *loose], frequencies)), score)
    if best is not None and best.score < one.score - PAYS:
        words = "a mass with another one attached stands in place of the linear base"
        yield Host(best.state, best, words)


def _behind(start: ModelState) -> ModelState:
    """Give a base without the timing of its input, on records that have it in time."""
    delay = start.chain[0]
    records = tuple(
        replace(item, u=delay.simulate(item.u, item.u, item.dt))
        for item in start.records
    )
    return replace(_without_timing(start), records=records).settled()


def _without_timing(start: ModelState) -> ModelState:
    """Give a base without the timing of its input, on the records as they are."""
    moved = {k: k - 1 for k in range(1, len(start.chain))}
    return start.rearranged(start.chain[1:], moved).settled()


def _in_front(delay: Block, start: ModelState, state: ModelState) -> ModelState:
    """Give a model of such records on those of a base, with the timing of its input."""
    moved = {k: k + 1 for k in range(len(state.chain))}
    behind = state.rearranged((delay, *state.chain), moved)
    return replace(behind, records=start.records).settled()


def is_seen_moving(state: ModelState) -> bool:
    """Tell whether a host's motion is slow enough for its records to show it.

    Of a mass whose poles both lie beyond the highest frequency of the samples only the
    static gain is seen. A force inside is then a static curve, which a chain has.
    """
    block = state.chain[0]
    if not isinstance(block, Mechanism):
        return True
    poles = np.roots([block.mass, block.damping, block.stiffness])
    step = min(record.dt for record in state.records)
    return bool(np.min(np.abs(poles)) < np.pi / step)


def of_many_modes(start: ModelState) -> bool:
    """Tell whether a base has more poles than a force can have bought it.

    Friction in one coordinate buys a linear model an order or two, not further modes
    that records held back ask for.
    """
    return any(
        isinstance(block, TransferFunction) and len(block.denominator) > HIGHEST + 1
        for block in start.chain
    )


def same_as(start: ModelState, quantities: Quantities) -> ModelState | None:
    """Give a model of one coordinate that simulates what a given base does.

    It may differ by as much of the gap as may stay unnamed. Of a base that a gain and
    an offset do as well there is none: nothing moves in it.
    """
    simulated = tuple(
        replace(record, y=y, simulated=None, interpolated=None)
        for record, y in zip(start.records, start.exact, strict=True)
    )
    most = UNNAMED_SHARE * float(np.mean(start.residual**2))
    u, wanted = (start.sample.take(x) for x in ([r.u for r in simulated], start.exact))
    static = np.column_stack([u, np.ones(len(u))])
    if np.mean((wanted - static @ _solved(static, wanted)) ** 2) < most:
        return None
    best = _coordinate_like(_ByContent(simulated), quantities, start.hold)
    if best is None or rms(best.state.residual) ** 2 > most:
        return None
    return replace(best.state, records=start.records, sample=start.sample).settled()


class _ByContent:
    """Records as a key: any others of the same content will do."""

    def __init__(self, records: tuple[Record, ...]) -> None:
        self.records, self.digest = records, records_digest(records)

    def __hash__(self) -> int:
        return hash(self.digest)

    def __eq__(self, other: object) -> bool:
        return isinstance(other, _ByContent) and self.digest == other.digest


@lru_cache(maxsize=1)
def _coordinate_like(
    simulated: _ByContent, quantities: Quantities, hold: Hold
) -> Fitted | None:
    """Fit a model of one coordinate to what a base simulates.

    That does not depend on what was measured: a second look, on records without their
    offsets, asks for the same one. Nothing of a simulation is noise.
    """
    records = simulated.records
    score = Score.plain(ScoredSamples.of(records), np.finfo(float).tiny)
    return best_host(list(one_coordinate(records, quantities, hold)), score)


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
    values = _solved(columns, wanted).tolist()
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
    found: list[tuple[float, tuple[Block, ...]]] = []
    sample = ScoredSamples.of(records)
    wanted = sample.take([record.y for record in records])
    starts = _starts(records)
    span = max(record.dt * len(record) for record in records)
    fastest = 0.8 * np.pi / min(record.dt for record in records)
    grid = np.geomspace(2 * np.pi / span, fastest, FREQUENCIES)
    for start, w, ratio in itertools.product(starts, grid, RATIOS):
        unit = Mechanism(
            mass=1.0,
            damping=2 * ratio * w,
            stiffness=w**2,
            output=output,
            start=start,
            hold=hold,
        )
        motion = sample.take([unit.driven(r.u, r.dt, ()) for r in records])
        columns = np.column_stack([motion, np.ones(len(motion))])
        gain, offset = _solved(columns, wanted).tolist()
        rest = float(np.mean((wanted - columns @ [gain, offset]) ** 2))
        if gain == 0.0 or not np.isfinite(rest):
            continue
        found.append((rest, (_times(unit, gain), Gain(value=1.0, offset=offset))))
    for _, chain in sorted(found, key=lambda item: item[0])[:BEGUN]:
        own = {0: ("mass", "damping", "stiffness"), 1: ("offset",)}
        yield _state(chain, records, hold, own)
    if output != "acceleration":
        yield from free_masses(records, output, hold)


def free_masses(
    records: tuple[Record, ...], output: str, hold: Hold
) -> Iterator[ModelState]:
    """Give a mass without a spring, begun at the rate of decay that fits best."""
    windows = any(record.decay_s is not None for record in records)
    allowed = ("rest",) if windows else free_starts(output)
    starts = [own for own in _starts(records) if own in allowed]
    sample = ScoredSamples.of(records)
    wanted = sample.take([record.y for record in records])
    span = max(record.dt * len(record) for record in records)
    step = min(record.dt for record in records)
    found = []
    rates = np.geomspace(0.3 / span, 0.3 / step, FREQUENCIES)
    for start, rate in itertools.product(starts, rates):
        unit = Mechanism(
            mass=1.0,
            damping=rate,
            stiffness=0.0,
            output=output,
            start=start,
            hold=hold,
        )
        ones = [np.ones(len(record)) for record in records]
        columns = np.column_stack(
            [
                sample.take([unit.driven(r.u, r.dt, ()) for r in records]),
                sample.take(
                    [
                        unit.driven(one, r.dt, ())
                        for one, r in zip(ones, records, strict=True)
                    ]
                ),
            ]
        )
        gain, bias = _solved(columns, wanted).tolist()
        rest = float(np.mean((wanted - columns @ [gain, bias]) ** 2))
        if gain != 0.0 and np.isfinite(rest):
            found.append((rest, replace(_times(unit, gain), bias=bias / abs(gain))))
    if found:
        _, block = min(found, key=lambda item: item[0])
        yield _state((block,), records, hold, {0: ("mass", "damping", "bias")})


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
    at_rest = _from_rest(records) and not all(item.repeats for item in records)
    return ("rest",) if at_rest else possible_starts(records)


def _from_rest(records: Sequence[Record]) -> bool:
    """Tell whether every record begins with little of its input and output."""

    def little(x: FloatArray) -> bool:
        return bool(abs(x[0]) < 0.02 * np.max(np.abs(x)))

    return all(little(record.u) and little(record.y) for record in records)


def _state(
    chain: tuple[Block, ...],
    records: tuple[Record, ...],
    hold: Hold,
    own: dict[int, tuple[str, ...]],
) -> ModelState:
    free = tuple(Free(k, name) for k, names in own.items() for name in names)
    return ModelState(chain, records, ScoredSamples.of(records), free=free, hold=hold)


def _solved(columns: FloatArray, wanted: FloatArray) -> FloatArray:
    """Least squares with the columns scaled alike; zeros where one is not finite."""
    if not np.all(np.isfinite(columns)):
        return np.zeros(columns.shape[1])
    sizes = np.maximum(np.sqrt(np.mean(columns**2, axis=0)), 1e-300)
    found = np.linalg.lstsq(columns / sizes, wanted, rcond=1e-10)[0] / sizes
    return np.asarray(found)

"""Linear hosts of one coordinate: begun, and fitted to records or to a simulation."""

from __future__ import annotations

import itertools
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import replace
from functools import lru_cache
from operator import itemgetter
from typing import Any

import numpy as np

from hystbench.blocks.base import Block
from hystbench.blocks.force import Motion
from hystbench.blocks.gain import Gain
from hystbench.blocks.held import Hold
from hystbench.blocks.impedance import NUMBERS, Impedance
from hystbench.blocks.mechanism import Mechanism, free_starts
from hystbench.blocks.starts import possible_starts, started
from hystbench.gap.cache import records_digest
from hystbench.gap.fitting.fit_each import fit_states
from hystbench.gap.fitting.least_squares import (
    QUICK,
    Fitted,
    fitted,
    fitted_to_the_end,
)
from hystbench.gap.fitting.score import Score
from hystbench.gap.fitting.state import Free, ModelState
from hystbench.gap.records.scored_samples import ScoredSamples
from hystbench.gap.thresholds import AS_GOOD
from hystbench.quantities import Quantities
from hystbench.record import FloatArray, Record

ZEROS = ("bias", "offset", "delay_s", "blend")
"""Numbers that are counted from a zero: a share of them says nothing."""


def best_host(states: Iterable[ModelState], score: Score) -> Fitted | None:
    """Fit linear hosts, the likely ones to the end; give the one that scores least.

    What it gives as its output may also have a share of the next derivative (a zero).
    """
    best = likeliest(states, score)
    if best is None:
        return None
    return min(best, with_a_zero(best, score), key=lambda item: item.score)


def likeliest(states: Iterable[ModelState], score: Score) -> Fitted | None:
    """Fit hosts a little, and the best two of them to the end; None without any."""
    begun = fit_states(lambda state: fitted(state, score, QUICK), list(states), QUICK)
    quick = sorted(begun, key=lambda item: item.score)
    done = (fitted_to_the_end(item.state, score) for item in quick)
    moving = (item for item in done if not _is_constant_pull(item.state))
    return min(itertools.islice(moving, 2), key=lambda item: item.score, default=None)


def _is_constant_pull(state: ModelState) -> bool:
    """Tell whether a spring pulls alike from the first sample of a record to the last.

    It then holds a mass that is begun in balance so far off that its motion is lost in
    rounding. A mass without a spring, and a constant force on it, do the same.
    """
    block = state.chain[0]
    if not isinstance(block, Mechanism) or block.stiffness == 0.0:
        return False
    if block.start == "rest":
        return False
    slowest, _ = block.rates(0.0, 0.0)
    return slowest * span_and_step(state.records)[0] < ROUNDED


def with_a_zero(best: Fitted, score: Score) -> Fitted:
    """Fit a host whose output also has a share of the next derivative."""
    block, free = best.state.chain[0], best.state.free
    zero = Free(0, "blend")
    if not (isinstance(block, Mechanism) and block.output != "force") or zero in free:
        return best
    return fitted(replace(best.state, free=(*free, zero)), score)


FREQUENCIES = 24
"""Natural frequencies at which a mass on a spring is begun."""
RATIOS = (0.01, 0.05, 0.2, 0.7, 2.0)
"""Damping ratios of each."""
BEGUN = 3
"""Starts that are fitted, the best ones of the grid."""
Begun = tuple[Mechanism, float, float]
"""A mechanism of a grid, how many times it moves, and another signal beside it."""
MOTIONS = ("position", "velocity", "acceleration")
ROUNDED = 1e-6
"""Share of itself by which what is no motion may change in a record."""


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
            yield best_impedance(records, quantities.input, hold)
        return
    if quantities.causality == "storage":
        return
    known = quantities.output in MOTIONS
    outputs = (quantities.output,) if known else MOTIONS
    yield from masses(records, outputs, hold)
    for output in outputs:
        if output != "acceleration":
            yield from free_masses(records, output, hold)


def best_impedance(records: tuple[Record, ...], moved: str, hold: Hold) -> ModelState:
    """Give the impedance that fits best: its force is linear in its numbers."""
    sample = ScoredSamples.of(records)
    columns = sample.take([Impedance.columns(moved, hold, r.u, r.dt) for r in records])
    wanted = sample.take([record.y for record in records])
    values = solved(columns, wanted).tolist()
    numbers: dict[str, Any] = dict(zip(NUMBERS, values, strict=True))
    block = Impedance(**numbers, input=moved, hold=hold)
    return _state((block,), records, hold, {0: NUMBERS})


def masses(
    records: tuple[Record, ...], outputs: Sequence[str], hold: Hold
) -> Iterator[ModelState]:
    """Give masses on springs, begun where a grid says, for each of some outputs.

    At each natural frequency and damping ratio the gain and an offset of the output are
    solved for.
    """
    span, step = span_and_step(records)
    grid = np.geomspace(2 * np.pi / span, 0.8 * np.pi / step, FREQUENCIES)
    units = (
        Mechanism(mass=1.0, damping=2 * ratio * w, stiffness=w**2, start=start)
        for start, w, ratio in itertools.product(_starts(records), grid, RATIOS)
    )
    ones = np.ones(len(ScoredSamples.of(records)))
    own = {0: ("mass", "damping", "stiffness"), 1: ("offset",)}
    for best in _solved_for(units, records, outputs, hold, lambda _: ones):
        for unit, gain, offset in best:
            chain = (_times(unit, gain), Gain(value=1.0, offset=offset))
            yield _state(chain, records, hold, own)


def free_masses(
    records: tuple[Record, ...], output: str, hold: Hold
) -> Iterator[ModelState]:
    """Give a mass without a spring, begun at the rate of decay that fits best.

    A constant force is solved for as well as the gain.
    """
    windows = any(record.decay_s is not None for record in records)
    allowed = ("rest",) if windows else free_starts(output)
    starts = [own for own in _starts(records) if own in allowed]
    span, step = span_and_step(records)
    rates = np.geomspace(0.3 / span, 0.3 / step, FREQUENCIES)
    about: Any = {"output": output, "hold": hold}
    units = (
        Mechanism(mass=1.0, damping=rate, stiffness=0.0, start=start, **about)
        for start, rate in itertools.product(starts, rates)
    )

    sample = ScoredSamples.of(records)

    def pushed(unit: Mechanism) -> FloatArray:
        return sample.take([unit.driven(np.ones(len(r)), r.dt, ()) for r in records])

    (best,) = _solved_for(units, records, (output,), hold, pushed)
    for unit, gain, bias in best[::BEGUN]:
        block = replace(_times(unit, gain), bias=bias / abs(gain))
        yield _state((block,), records, hold, {0: ("mass", "damping", "bias")})


def _solved_for(
    units: Iterable[Mechanism],
    records: tuple[Record, ...],
    outputs: Sequence[str],
    hold: Hold,
    beside: Callable[[Mechanism], FloatArray],
) -> list[list[Begun]]:
    """Find how many times each mechanism moves, and another signal beside it.

    Of each output the best ones: the mechanism, its gain and that of the other signal.
    Each record counts alike, as in a score: where a force inside shows in loud records,
    the linear part shows in quiet ones. One that stands still counts as the quietest.
    The last is the best of all samples together. A staircase apart, the input moves in
    straight lines here: near enough for a beginning.
    """
    sample = ScoredSamples.of(records)
    wanted = sample.take([record.y for record in records])
    weights = np.empty(len(wanted))
    sizes = [float(np.std(wanted[part])) for part in sample.slices]
    quietest = min((size for size in sizes if size > 0), default=1.0)
    for part, size in zip(sample.slices, sizes, strict=True):
        weights[part] = 1.0 / max(size, quietest)
    roughly: Any = {"hold": "linear" if hold == "band-limited" else hold}
    found: list[list[tuple[float, float, Begun]]] = [[] for _ in outputs]
    for unit in units:
        rough = replace(unit, **roughly)
        moved = [started(rough, r).motion(r.driven, r.dt, ()) for r in records]
        other = beside(unit)
        for output, own in zip(outputs, found, strict=True):
            shown: Any = {"output": output, "hold": hold}
            one = replace(unit, **shown)
            seen = [_seen(one, motion) for motion in moved]
            columns = np.column_stack([sample.take(seen), other])
            weighed = columns * weights[:, None]
            gain, more = solved(weighed, wanted * weights).tolist()
            left = (wanted - columns @ [gain, more]) * weights
            powers = [float(np.mean(left[part] ** 2)) for part in sample.slices]
            rest = float(np.mean((left / weights) ** 2))
            alike = float(np.sum(np.log(np.maximum(powers, 1e-300))))
            if gain != 0.0 and np.isfinite(rest):
                own.append((alike, rest, (one, gain, more)))
    return [
        [begun for *_, begun in sorted(own, key=itemgetter(0))[:BEGUN]]
        + [begun for *_, begun in sorted(own, key=itemgetter(1))[:1]]
        for own in found
    ]


def _seen(host: Mechanism, motion: Motion) -> FloatArray:
    """Give what is seen of a motion that meets no force inside."""
    if host.output == "force":
        return host.stiffness * motion.position + host.damping * motion.velocity
    found: FloatArray = getattr(motion, host.output)
    return found


def span_and_step(records: Sequence[Record]) -> tuple[float, float]:
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


def same_as(
    start: ModelState, quantities: Quantities, square: float
) -> ModelState | None:
    """Give a model of one coordinate that simulates what a given base does.

    It may differ by no more of the gap than two models that do the same. A zero and an
    offset are its own only where noise of that power does not hide what they do. Of a
    base that a gain and an offset do as well there is none: nothing moves in it.
    """
    simulated, most = as_simulated(start), most_missed(start)
    u, wanted = (start.sample.take(x) for x in ([r.u for r in simulated], start.exact))
    static = np.column_stack([u, np.ones(len(u))])
    moves = wanted - static @ solved(static, wanted)
    if np.mean(moves**2) < most:
        return None
    unseen = min(AS_GOOD * square, most)
    shown = [float(np.sum(moves[part] ** 2)) for part in start.sample.slices]
    one = _ByContent((simulated[int(np.argmax(shown))],))
    every, count = _ByContent(simulated), len(ScoredSamples.of(simulated))
    for with_zero, enough in ((False, unseen), (True, most)):
        # What the best model of one record misses there, one of all records does too.
        alone = _coordinate_like(one, quantities, start.hold, with_zero)
        if len(simulated) > 1 and missed(alone) > enough * count:
            continue
        best = _coordinate_like(every, quantities, start.hold, with_zero)
        if best is not None and missed(best) <= enough * count:
            same = _without_offset(best, unseen * count)
            return replace(same, records=start.records, sample=start.sample).settled()
    return None


def as_simulated(start: ModelState) -> tuple[Record, ...]:
    """Give records whose output is what the base simulates."""
    return tuple(
        replace(record, y=y, simulated=None, interpolated=None)
        for record, y in zip(start.records, start.exact, strict=True)
    )


def most_missed(start: ModelState) -> float:
    """Give the mean square by which two models differ that do the same."""
    return AS_GOOD * float(np.mean(start.residual**2))


def _without_offset(best: Fitted, allowed: float) -> ModelState:
    """Leave out the gain and the offset behind a model that does as well without."""
    state = best.state
    if not isinstance(state.chain[-1], Gain):
        return state
    last = len(state.chain) - 1
    plain = replace(
        state,
        chain=state.chain[:-1],
        free=tuple(free for free in state.free if free.block != last),
    ).settled()
    return plain if float(np.sum(plain.residual**2)) <= allowed else state


def missed(found: Fitted | None) -> float:
    """Sum the squares of what a model misses."""
    return np.inf if found is None else float(np.sum(found.state.residual**2))


class _ByContent:
    """Records as a key: any others of the same content will do."""

    def __init__(self, records: tuple[Record, ...]) -> None:
        self.records, self.digest = records, records_digest(records)

    def __hash__(self) -> int:
        return hash(self.digest)

    def __eq__(self, other: object) -> bool:
        return isinstance(other, _ByContent) and self.digest == other.digest


@lru_cache(maxsize=4)
def _coordinate_like(
    simulated: _ByContent, quantities: Quantities, hold: Hold, with_zero: bool
) -> Fitted | None:
    """Fit a model of one coordinate to what a base simulates.

    That does not depend on what was measured: a second look, on records without their
    offsets, asks for the same one. Nothing of a simulation is noise.
    """
    records = simulated.records
    score = Score.plain(ScoredSamples.of(records), np.finfo(float).tiny)
    if with_zero:
        plain = _coordinate_like(simulated, quantities, hold, False)
        return None if plain is None else with_a_zero(plain, score)
    return likeliest(one_coordinate(records, quantities, hold), score)

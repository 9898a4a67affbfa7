"""A model as far as it has come: its chain, what may be re-tuned, what lies beside."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from hystbench.blocks.attached import AttachedBlock
from hystbench.blocks.base import Block
from hystbench.blocks.held import Hold
from hystbench.blocks.structure import SHAPES
from hystbench.blocks.transfer_function import stable
from hystbench.errors import InputError
from hystbench.gap.effects.variant import Beside, Refused, Values
from hystbench.gap.fitting.added_signals import beside_columns
from hystbench.gap.fitting.held import Held
from hystbench.gap.records.scored_samples import ScoredSamples
from hystbench.gap.simulation.reshape import orthonormal, reshapings
from hystbench.gap.simulation.shared import shared
from hystbench.gap.simulation.simulation import Signals, Simulation
from hystbench.gap.thresholds import SHAPE
from hystbench.metrics import rms
from hystbench.record import FloatArray, Record


class Free(NamedTuple):
    """A number that a refit may change."""

    block: int
    parameter: str
    element: int | None = None
    tolerance: float | None = None
    """Expected size of a change from ``given``; None where nothing is known."""
    low: float = -np.inf
    high: float = np.inf
    refused: Refused = ""
    """Ends of its range at which the effect becomes another effect."""
    given: float | None = None
    """What it was given as."""


class Added(NamedTuple):
    """An effect that was added."""

    effect: str
    place: str
    form: str
    blocks: tuple[int, ...]
    """Places of its blocks in the chain; none for a signal beside it."""
    values: dict[str, float]
    """By parameter. A key such as ``3.gain`` is a number of the base, in block 3 of the
    chain; its value is the one before the effect was added."""
    charge: float
    replaced: Block | None = None
    """The chain's own block that it stands for."""
    smooths: bool = False
    """Whether blocks behind it took a staircase before it came."""
    was_free: tuple[Free, ...] = ()
    """Those of the numbers it changed in other blocks that were free before."""

    @property
    def old_numbers(self) -> dict[tuple[int, str], float]:
        """What the base's numbers that it changed were, by place and parameter."""
        parts = ((key.partition("."), old) for key, old in self.values.items())
        return {(int(k), name): old for (k, dot, name), old in parts if dot}

    @property
    def is_of_many_numbers(self) -> bool:
        """Tell whether it is a law of so many numbers that it does what others do."""
        return bool(self.blocks) and self.charge > MANY_NUMBERS


ROUNDING = 16 * float(np.finfo(float).eps)
"""Share of the output's rms: smaller changes are rounding."""
FORMS = (0.3, 0.6, 1.6, 3.0)
"""Factors on a number of an added effect: what other forms of it could do. They reach
half a decade down and up; what lies between does less."""
MANY_NUMBERS = 4
"""Most numbers that a law of a chain has if it is a single formula. A law of more is a
sum of plays or of elements that creep. It can imitate other effects, and no other forms
of it are considered."""


@dataclass(frozen=True, eq=False)
class ModelState:
    """A chain, the effects added to it, and what a refit may change."""

    chain: tuple[Block, ...]
    records: tuple[Record, ...]
    sample: ScoredSamples
    free: tuple[Free, ...] = ()
    added: tuple[Added, ...] = ()
    beside: tuple[tuple[Beside, Values], ...] = ()
    """Signals that the input does not explain."""
    hold: Hold = "band-limited"
    """How the input moves between samples."""
    correction: FloatArray | None = None
    """Shape (scored samples,). By how much the exact simulation is above the quick one.
    It changes little from candidate to candidate; :meth:`settled` measures it anew."""
    expected: str = ""
    """Effect that the base was found together with, if any: it is refitted whatever a
    first trial tells, as slopes of a base that is far off without it tell little."""
    offered: tuple[str, ...] | None = None
    """Effects that may be added; all by default."""

    @cached_property
    def simulation(self) -> Simulation:
        """The chain on the records, simulated quickly."""
        return shared(self.chain, self.records, self.hold, "quick")

    def on(
        self, records: tuple[Record, ...], sample: ScoredSamples, rows: NDArray[Any]
    ) -> ModelState:
        """Give the state on less: the rows are the scored samples that are left."""
        lacks = None if self.correction is None else self.correction[rows]
        return replace(self, records=records, sample=sample, correction=lacks)

    @cached_property
    def exact(self) -> Signals:
        """The chain's output, simulated in short steps."""
        return shared(self.chain, self.records, self.hold, "fine").output

    def settled(self) -> ModelState:
        """Measure ``correction`` anew."""
        lacks = self.sample.take(self.exact) - self.sample.take(self.simulation.output)
        return replace(self, correction=lacks)

    @cached_property
    def residual(self) -> FloatArray:
        """Scored samples of measured minus simulated, without what lies beside."""
        return self.reference - self.sample.take(self.simulation.output)

    @cached_property
    def reference(self) -> FloatArray:
        """Scored samples that a quick simulation is taken off, to give a residual."""
        lacks = self.correction
        return self.measured if lacks is None else self.measured - lacks

    @cached_property
    def measured(self) -> FloatArray:
        """Scored samples of the measured output."""
        return self.sample.take([record.y for record in self.records])

    @property
    def freedom(self) -> float:
        """Parameters that are charged: those of effects, and shapes at a joint."""
        shapes = sum(free.parameter in SHAPES for free in self.free)
        return sum(item.charge for item in self.added) + shapes

    @property
    def has_shape(self) -> bool:
        """Whether another shape of the base's hysteresis was added."""
        return any(item.effect == SHAPE for item in self.added)

    @property
    def paths(self) -> frozenset[str]:
        """Effects that are a path of each record's own."""
        return frozenset(one.effect for one, values in self.beside if not values)

    @cached_property
    def places_added(self) -> frozenset[int]:
        """Places of the blocks that the added effects have in the chain."""
        return frozenset(place for item in self.added for place in item.blocks)

    @cached_property
    def tangents(self) -> FloatArray:
        """How the output changes with each free number, shape (scored samples, k)."""
        return self.tangents_of(range(len(self.free)))

    def tangents_of(self, numbers: Iterable[int]) -> FloatArray:
        """Compute those of some free numbers alone."""
        columns = [self._tangent(k, self.steps[k]) for k in numbers]
        return _stack(columns, len(self.sample))

    def _tangent(self, k: int, step: float) -> FloatArray:
        try:
            change = self._change(k, step)
        except InputError:  # beyond what the block accepts, so the other way
            step = -step
            # A pole at the very edge crosses it both ways: it is put back.
            change = self._change(k, step, reflected=True)
        if not rms(change) >= ROUNDING * rms(self._simulated):
            # As of a play that never moves: divided by its step, it would look like
            # something, and any weight would do. Nor does what runs away tell a slope.
            return np.zeros(len(change))
        return change / step

    @cached_property
    def other_forms(self) -> FloatArray:
        """What other forms of the added effects could do, roughly.

        The output with a number of an effect far from its value, less the output as it
        is: how a law of another sharpness or of another order differs.
        """
        columns = []
        for item in self.added:
            own = [k for k, free in enumerate(self.free) if free.block in item.blocks]
            for k in own if len(own) <= MANY_NUMBERS else ():
                value = self.value(self.free[k])
                for factor in FORMS:
                    try:
                        column = self._change(k, (factor - 1) * value)
                    except InputError:
                        continue  # outside what the block accepts: no form of it
                    if np.all(np.isfinite(column)):  # else it runs away: no form of it
                        columns.append(column)
        return _stack(columns, len(self.sample))

    @cached_property
    def wrong_shape(self) -> FloatArray:
        """Basis of what reshaping the hysteresis could do, shape (scored samples, k).

        Orthonormal.
        """
        return orthonormal(reshapings(self.simulation, self.sample))

    @cached_property
    def held(self) -> Held:
        """What holds free numbers of a tolerance: they are known to be as given, about.

        A number that is off by its tolerance costs one, as by one standard error.
        """
        known = [(f.tolerance, f.given) for f in self.free]
        stiffness = [0.0 if t is None or g is None else t**-2.0 for t, g in known]
        moved = [0.0 if x.given is None else self.value(x) - x.given for x in self.free]
        return Held(np.array(stiffness), np.array(moved))

    @cached_property
    def moved_charge(self) -> float:
        """Charge for how far numbers are from what they were given as."""
        return float(self.held.stiffness @ self.held.moved**2)

    @cached_property
    def beside_columns(self) -> FloatArray:
        """Scored samples of the shapes beside, of every record on its own."""
        return _stack(self._beside_each, len(self.sample))

    @cached_property
    def _beside_each(self) -> list[FloatArray]:
        return [
            beside_columns(self.records, self.sample, *item) for item in self.beside
        ]

    def by_signal(self, amplitudes: NDArray[Any]) -> list[NDArray[Any]]:
        """Share the amplitudes of all shapes beside out: (records, k) a signal."""
        ends = np.cumsum([columns.shape[1] for columns in self._beside_each], dtype=int)
        parts = np.split(amplitudes, ends)[:-1]
        return [own.reshape(len(self.records), -1) for own in parts]

    @cached_property
    def beside_amplitudes(self) -> FloatArray:
        """Amplitudes of the shapes beside that fit the residual best."""
        found = np.zeros(self.beside_columns.shape[1])
        for part in self.sample.slices:  # no column is shared by two records
            columns = self.beside_columns[part]
            own = columns.any(axis=0)
            rest = self.residual[part]
            # Columns nearer to each other than that are one but for rounding.
            found[own] = np.linalg.lstsq(columns[:, own], rest, rcond=1e-10)[0]
        return found

    def share(self, other: ModelState, square: float, gap: float) -> float:
        """Give the share of a gap that this state takes beyond another.

        ``square`` is the mean square of the noise, ``gap`` that of the gap above it.
        """
        return (other.power(square) - self.power(square)) / gap

    @cached_property
    def squares(self) -> FloatArray:
        """Mean squares of what it leaves, by record."""
        return np.array([np.mean(self.left[part] ** 2) for part in self.sample.slices])

    @cached_property
    def left(self) -> FloatArray:
        """Scored samples of what it leaves, with what lies beside it."""
        beside = self.beside_columns @ self.beside_amplitudes if self.beside else 0.0
        return self.residual - beside

    def power(self, square: float) -> float:
        """Mean square of the residual above the floor, of the records alike."""
        return float(np.mean(self.squares)) - square

    def gap(self, square: float) -> float:
        """Give its power as a gap that shares are taken of: the noise's at least."""
        return max(self.power(square), square)

    @cached_property
    def steps(self) -> tuple[float, ...]:
        """A small change of each free number, inside its bounds."""
        return tuple(self._step(free) for free in self.free)

    def value(self, free: Free) -> float:
        """Give a free number."""
        value = getattr(self.chain[free.block], free.parameter)
        return float(value if free.element is None else value[free.element])

    def range_of(self, free: Free) -> tuple[float, float]:
        """Give the least and the largest value that a free number may have."""
        about = self.chain[free.block].parameters()[free.parameter]
        return max(about.low, free.low), min(about.high, free.high)

    def moved(self, changes: dict[int, float], reflected: bool = False) -> ModelState:
        """Give the state with some free numbers changed by so much; as :meth:`at`."""
        values = {k: self.value(self.free[k]) + x for k, x in changes.items()}
        return self.at(values, reflected)

    def at(self, values: dict[int, float], reflected: bool = False) -> ModelState:
        """Give the state with other values of some free numbers, inside bounds.

        Parameters
        ----------
        values : dict of int to float
            By place in ``free``.
        reflected : bool
            Whether poles that cross the imaginary axis are put back as far before it.

        Raises
        ------
        InputError
            If a block does not take its numbers together.
        """
        new: dict[int, dict[str, Any]] = {}
        for k, wanted in values.items():
            free = self.free[k]
            block, own = self.chain[free.block], new.setdefault(free.block, {})
            low, high = self.range_of(free)
            value = min(max(float(wanted), low), high)
            if free.element is None:
                own[free.parameter] = value
            else:
                numbers = list(own.get(free.parameter, getattr(block, free.parameter)))
                numbers[free.element] = value
                own[free.parameter] = tuple(numbers)
        for own in new.values():
            if reflected and "denominator" in own:
                own["denominator"] = stable(own["denominator"])
        return self.with_values(new)

    def with_values(self, values: Mapping[int, Mapping[str, Any]]) -> ModelState:
        """Give the state with other numbers in its blocks, by place."""
        return self.with_blocks(
            {k: replace(self.chain[k], **own) for k, own in values.items()}
        )

    def with_blocks(self, blocks: Mapping[int, Block]) -> ModelState:
        """Give the state with other blocks at some places of its chain."""
        chain = tuple(blocks.get(k, block) for k, block in enumerate(self.chain))
        return replace(self, chain=chain)

    def _change(self, k: int, by: float, reflected: bool = False) -> FloatArray:
        """How the output changes where one free number is another."""
        start = self.free[k].block
        while isinstance(self.chain[start], AttachedBlock):
            start -= 1
        chain = self.moved({k: by}, reflected).chain
        after = self.simulation.tail(start, chain[start:])
        return self.sample.take(after) - self._simulated

    @cached_property
    def _simulated(self) -> FloatArray:
        return self.reference - self.residual

    def _step(self, free: Free) -> float:
        value = self.value(free)
        # Far above rounding, and so small that the output changes in proportion.
        size = 1e-3 * abs(value) or 1e-6
        # A tolerance may leave less room than that.
        size = min(size, (free.high - free.low) / 4)
        return -size if value + size > self.range_of(free)[1] else size


def _stack(columns: Sequence[FloatArray], rows: int) -> FloatArray:
    return np.column_stack(columns) if columns else np.zeros((rows, 0))

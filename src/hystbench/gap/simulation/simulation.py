"""A chain of blocks on records: signals before every block, kept."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from functools import cached_property, lru_cache
from typing import Any, ClassVar, Literal, cast

import numpy as np

from hystbench.blocks.attached import AttachedBlock, attached, through_near
from hystbench.blocks.base import Block
from hystbench.blocks.curve import SHORT_STEPS, finer
from hystbench.blocks.force import Driven, Dynamics
from hystbench.blocks.gain import Gain
from hystbench.blocks.held import HeldBlock, Hold
from hystbench.blocks.input_delay import InputDelay
from hystbench.blocks.linear import LinearBlock
from hystbench.blocks.mechanism import Mechanism
from hystbench.blocks.starts import started
from hystbench.blocks.stiffness_hardening import StiffnessHardening
from hystbench.blocks.store import Store
from hystbench.blocks.structure import Structure
from hystbench.blocks.superposed import Superposed
from hystbench.blocks.wrapping import Wrappable, Wrapped, WrappingBlock
from hystbench.gap.simulation.memory import may_have_hysteresis
from hystbench.record import FloatArray, Record

Signals = tuple[FloatArray, ...]
"""One signal a record."""
COMMUTE = (LinearBlock, Dynamics, Gain, InputDelay)
"""Blocks that commute with what is linear: without forces inside all of them do."""
Steps = Literal["plain", "quick", "fine"]
"""Steps of time: those of the samples, or others.

- Quick ones are straight lines where a block takes a band-limited signal: a tenth of
  the time, and near enough to compare candidates by.
- Fine ones are shorter through the hysteresis where the input is band-limited, so that
  turning points between samples are met: what the chain says of physics, without the
  error of its own steps.
"""


@dataclass(frozen=True, eq=False)
class Simulation:
    """A chain on records; what is computed once is kept."""

    chain: tuple[Block, ...]
    records: tuple[Record, ...]
    hold: Hold = "band-limited"
    """How the input moves between samples."""
    steps: Steps = "plain"
    """Which steps of time are taken."""

    def at(self, place: int) -> Signals:
        """Signals before a block, or behind the last; what is attached is run with it.

        Before a wrapping block stands the output of what it wraps, without it.
        """
        if place not in self._at:
            start = place - 1
            while isinstance(self.chain[start], AttachedBlock):
                start -= 1
            signals = self.run(self.chain[start:place], self.at(start))
            for z in signals:
                z.setflags(write=False)  # so that what it is made of can be kept
            self._at[place] = signals
        return self._at[place]

    def driving(self, place: int) -> Signals:
        """Signals that enter a block, or the block that it is attached to."""
        while isinstance(self.chain[place], AttachedBlock):
            place -= 1
        return self.at(place)

    @cached_property
    def _at(self) -> dict[int, Signals]:
        return {0: tuple(record.driven for record in self.records)}

    @cached_property
    def output(self) -> Signals:
        """The chain's output."""
        if self.steps == "quick":
            return self.at(len(self.chain))
        return self.run(self.chain, self.at(0))

    def tail(self, start: int, blocks: Sequence[Block]) -> Signals:
        """Simulate other blocks from ``start`` on, in place of those in the chain."""
        return self.run(blocks, self.at(start))

    def run(self, blocks: Sequence[Block], signals: Signals) -> Signals:
        """Send signals through blocks, from rest."""
        found = list(signals)
        finely = self.steps == "fine" and self.hold == LIMITED
        for places in self._begun_alike(blocks):
            records = [self.records[k] for k in places]
            own = tuple(signals[k] for k in places)
            dts = [record.dt for record in records]
            for step in self._begun(blocks, records[0]):
                if hasattr(step, "simulate_records"):
                    own = tuple(step.simulate_records(own, dts))
                    continue
                own = tuple(
                    self._sent(step, z, record, finely)
                    for z, record in zip(own, records, strict=True)
                )
            for k, z in zip(places, own, strict=True):
                found[k] = z
        return tuple(found)

    def _begun_alike(self, blocks: Sequence[Block]) -> Iterable[list[int]]:
        """Give the places of records on which blocks begin alike."""
        repeating = any(getattr(block, "start", "") == "repeating" for block in blocks)
        alike: dict[bool, list[int]] = {}
        for k, record in enumerate(self.records):
            alike.setdefault(repeating and record.repeats, []).append(k)
        return alike.values()

    def _begun(self, blocks: Sequence[Block], record: Record) -> list[Any]:
        """Give the steps of blocks as they begin on a record."""
        return self._steps([started(block, record) for block in blocks])

    def _sent(self, step: Any, z: FloatArray, record: Record, finely: bool) -> Any:
        """Send one signal through one step."""
        if finely and (isinstance(step, Wrapped) or step.hysteretic):
            return _finely(step, z, record.dt, SHORT_STEPS)
        if self.steps == "quick" and _takes_short_steps(step):
            return _finely(step, z, record.dt, QUICK_STEPS)
        return self._known(step, z).simulate(z, record.u, record.dt)

    def _steps(self, blocks: Sequence[Block]) -> list[Any]:
        if self.steps == "plain":
            return attached(blocks)
        quick = self.steps == "quick"
        wanted = [cast(Block, _quick(block)) for block in blocks] if quick else blocks
        pieces = LONG_PIECES if quick else PIECES
        return [
            step.in_pieces(pieces) if isinstance(step, Driven | Superposed) else step
            for step in attached(wanted)
        ]

    def near(self, chains: Sequence[Sequence[Block]]) -> tuple[FloatArray, ...]:
        """Simulate the chain and others near it: the same blocks, other numbers.

        What is alike is simulated once; no block may be a hysteresis that others wrap.

        Returns
        -------
        tuple of ndarray, shape (n, 1 + chains)
            One a record: the chain's own output first.
        """
        found: dict[int, FloatArray] = {}
        for places in self._begun_alike(self.chain):
            records = [self.records[k] for k in places]
            steps = [self._begun(chain, records[0]) for chain in (self.chain, *chains)]
            us, dts = zip(
                *((record.driven, record.dt) for record in records), strict=True
            )
            every = zip(*through_near(steps, us, dts), strict=True)
            found.update(zip(places, map(np.column_stack, every), strict=True))
        return tuple(found[k] for k in range(len(self.records)))

    def _known(self, step: Block | Wrapped, z: FloatArray) -> Block | Wrapped:
        """Put in what the chain's own hysteresis gives for a signal, if it is wrapped.

        Another shape of it is tried in many ways, each of which would run it again.
        """
        if not isinstance(step, Wrapped) or z.flags.writeable:
            return step
        inner = step.inner
        if isinstance(inner, Wrapped):
            return Wrapped(cast(Wrapped, self._known(inner, z)), step.by)
        if all(inner is not cast(Wrappable, block) for block in self.chain):
            return step
        known = self._outputs.setdefault((id(z), inner), _Known(inner, z))
        return Wrapped(known, step.by)

    @cached_property
    def _outputs(self) -> dict[tuple[int, Wrappable], _Known]:
        return {}

    @cached_property
    def hysteresis(self) -> int | None:
        """Place of the hysteresis in the chain, if it has one."""
        for k, block in enumerate(self.chain):
            if block.hysteretic:
                return k
        return None

    @cached_property
    def loop(self) -> int | None:
        """Place of what makes the loop: the hysteresis, or what may hold one unseen."""
        held = [
            k
            for k, block in enumerate(self.chain)
            if may_have_hysteresis(block, self.records)
        ]
        if self.hysteresis is not None:
            held.append(self.hysteresis)
        return max(held, default=None)

    @cached_property
    def behind_hysteresis(self) -> int:
        """Place behind the hysteresis and what wraps it; 0 without a hysteresis.

        Or behind a simulator that may hold one.
        """
        if self.loop is None:
            return 0
        k = self.loop + 1
        while k < len(self.chain) and isinstance(self.chain[k], WrappingBlock):
            k += 1
        return k

    @property
    def behind_material(self) -> int:
        """Place behind the hysteresis and the material's curves that follow it.

        Without a hysteresis, behind the last block that does not commute with what is
        linear: a simulator of somebody's own, or a curve of the drive or the material.
        """
        k = self.behind_hysteresis
        while k < len(self.chain) and self.chain[k].place == "material":
            k += 1
        if self.loop is not None:
            return k
        bends = (
            place + 1
            for place, block in enumerate(self.chain)
            if block.place not in ("mechanics", "sensor")
            and not isinstance(block, HeldBlock | Gain)
        )
        return max(bends, default=0)

    @property
    def behind_linear(self) -> int:
        """Place behind the material for what is linear and passes its input on.

        Linear blocks commute. Only a staircase must not come to it: a part of what it
        gives would be a staircase, the rest smooth, and no block behind takes both. So
        it stands behind the first linear block that smooths, or the first mechanism
        with the forces inside.
        """
        k = self.behind_material
        for place in range(k, len(self.chain)):
            block = self.chain[place]
            inside = isinstance(block, AttachedBlock)
            if not inside and self.hold_at(k) != "zero-order":
                break
            if not (inside or isinstance(block, COMMUTE)):
                break
            k = place + 1
        return k

    @property
    def behind_mechanics(self) -> int:
        """Place behind the last block that is not the sensor's."""
        k = len(self.chain)
        while k and self.chain[k - 1].place == "sensor":
            k -= 1
        return k

    def hold_at(self, place: int) -> Hold:
        """Tell how the signal before a block moves between samples.

        A staircase is smooth behind the first block that is dynamic.
        """
        before = self.chain[:place]
        smooth = any(isinstance(item, HeldBlock) and item.smooths for item in before)
        return "linear" if self.hold == "zero-order" and smooth else self.hold

    @property
    def step(self) -> float:
        """Shortest sampling interval, in seconds."""
        return min(record.dt for record in self.records)

    @property
    def span(self) -> float:
        """Longest record, in seconds."""
        return max(record.dt * len(record) for record in self.records)

    @property
    def shortest(self) -> float:
        """Shortest record, in seconds."""
        return min(record.dt * len(record) for record in self.records)

    def largest(self, place: int) -> float:
        """Largest size of the signal before a block."""
        return float(max(np.abs(z).max() for z in self.at(place)))

    def middle_and_half(self, place: int) -> tuple[float, float]:
        """Middle of the range of the signal before a block, and half of its width."""
        low = min(float(z.min()) for z in self.at(place))
        high = max(float(z.max()) for z in self.at(place))
        return (low + high) / 2, (high - low) / 2

    def fastest(self) -> float:
        """Largest rate of the input, in its unit a second."""
        return max(record.fastest for record in self.records)


class _Known:
    """A hysteresis that keeps what it gave for one input."""

    def __init__(self, inner: Wrappable, v: FloatArray) -> None:
        self.inner, self.v = inner, v
        self.output: FloatArray | None = None

    def grow(
        self, v: FloatArray, u: FloatArray, dt: float, growth: FloatArray | None
    ) -> FloatArray:
        """Compute the output, or give it."""
        if growth is not None or v is not self.v:
            return self.inner.grow(v, u, dt, growth)
        if self.output is None:
            self.output = self.inner.grow(v, u, dt, None)
            self.output.setflags(write=False)
        return self.output

    def check_growth(self) -> None:
        """Refuse as the hysteresis does."""
        self.inner.check_growth()


@dataclass(frozen=True)
class _InLongSteps:
    """A mode that is not linear, in steps that are near enough for a comparison."""

    mode: StiffnessHardening
    hysteretic: ClassVar = False

    def simulate(self, z: FloatArray, u: FloatArray, dt: float) -> FloatArray:
        """Integrate the mode."""
        return self.mode.integrated(z, dt, LONG_STEP)


@lru_cache(maxsize=1024)
def _quick(block: Block) -> Block | _InLongSteps:
    if isinstance(block, StiffnessHardening):
        return _InLongSteps(block)
    # The drive's blocks are the first: what they miss would pass for an effect. A mode
    # that is not linear answers to it in ways that no correction makes up for.
    if not isinstance(block, HeldBlock) or isinstance(block, NOT_LINEAR):
        return block
    if block.place == "drive" or not block.smooths:
        return block
    return replace(block, hold="linear") if block.holding == LIMITED else block


LIMITED = "band-limited"
NOT_LINEAR = (Mechanism, Structure, Store, StiffnessHardening)
LONG_STEP = 0.3
"""Radians of a mode in a step, by which a ten-thousandth of its phase is missed."""
PIECES, LONG_PIECES = 2, 0.25
"""Steps in place of each where forces act inside, fine and quick: what a step misses
goes with its square."""
QUICK_STEPS = 2
"""Steps of an interval for hysteresis that depends on the rate, where quick."""


def _takes_short_steps(step: Block | Wrapped) -> bool:
    """Tell whether hysteresis takes short steps by itself."""
    if not isinstance(step, Wrapped):
        return False
    by = step.by
    return (isinstance(by, HeldBlock) and by.holding == LIMITED) or (
        isinstance(step.inner, Wrapped) and _takes_short_steps(step.inner)
    )


def _finely(step: Block | Wrapped, z: FloatArray, dt: float, factor: int) -> FloatArray:
    """Simulate hysteresis, which does not look at the model's input, in short steps."""
    v = finer(z, factor)
    return _plain(step).simulate(v, v, dt / factor)[::factor].copy()


def _plain(step: Block | Wrapped) -> Block | Wrapped:
    """Let what takes shorter steps by itself take those that it is given."""
    if isinstance(step, Wrapped):
        inner = cast(Wrappable, _plain(cast(Block, step.inner)))
        if "hold" in step.by.parameters():
            straight: dict[str, Any] = {"hold": "linear"}
            return Wrapped(inner, replace(step.by, **straight))
        return Wrapped(inner, step.by)
    return step

"""Blocks that change the block before them in the chain instead of a signal."""

from abc import abstractmethod
from collections.abc import Sequence
from typing import Any, ClassVar, Protocol

from hystbench.blocks.base import Block
from hystbench.errors import InputError, placed
from hystbench.record import FloatArray


class Simulated(Protocol):
    """What a signal passes: a block, or one together with what is attached to it."""

    def simulate(self, z: FloatArray, u: FloatArray, dt: float) -> FloatArray:
        """Compute the output, as :meth:`Block.simulate` does."""


Signals = Sequence[FloatArray]
"""One signal a record."""
Others = Sequence[tuple[Any, FloatArray]]
"""Steps with numbers near those of another one, each with what enters it."""
OthersOnRecords = Sequence[tuple[Any, Signals]]
"""The same, with what enters it of every record."""


class AttachedBlock(Block):
    """A block that has no output of its own: it belongs to the block before it.

    In the chain it follows a block that it can be attached to, or another one that is.
    """

    hosts: ClassVar[str]
    """What it can be attached to, for messages."""

    @abstractmethod
    def attach(self, before: Any) -> Simulated:
        """Give what the signal passes: what stands before, with this block attached.

        Raises
        ------
        InputError
            If this block cannot be attached to that one.
        """

    def simulate(self, z: FloatArray, u: FloatArray, dt: float) -> FloatArray:
        """Refuse: alone the block has no output."""
        raise InputError(f"{self.name}: expected {self.hosts} before it")


def sent(step: Any, signals: Signals, us: Signals, dts: Sequence[float]) -> Signals:
    """Send a signal of each record through a step, all at once where it takes that.

    Parameters
    ----------
    step : Simulated
    signals, us : sequence of ndarray
        By record, those of :meth:`Block.simulate`.
    dts : sequence of float
        Sampling intervals in seconds.
    """
    if hasattr(step, "simulate_records"):
        return tuple(step.simulate_records(signals, dts))
    every = zip(signals, us, dts, strict=True)
    return tuple(step.simulate(*record) for record in every)


def near(
    step: Any,
    signals: Signals,
    us: Signals,
    dts: Sequence[float],
    others: OthersOnRecords,
) -> list[Signals]:
    """Simulate a step of a chain, and others of its kind with numbers near.

    For derivatives: one that is equal and has the same input is not simulated again,
    and a mechanism moves all others along its own way.

    Parameters
    ----------
    step, signals, us, dts
        Those of :func:`sent`.
    others : sequence of (Simulated, sequence of ndarray)
        Each with its own signals.

    Returns
    -------
    list of sequence of ndarray
        The outputs of the step, then those of the others.
    """
    moved = [own is not signals or other != step for other, own in others]
    changed = [pair for pair, new in zip(others, moved, strict=True) if new]
    if hasattr(step, "near_records"):
        y, *found = step.near_records(signals, dts, changed)
    elif hasattr(step, "near"):
        of_records = [
            step.near(z, us[k], dts[k], [(other, own[k]) for other, own in changed])
            for k, z in enumerate(signals)
        ]
        y, *found = zip(*of_records, strict=True)
    else:
        y, *found = (sent(x, z, us, dts) for x, z in ((step, signals), *changed))
    rest = iter(found)
    return [y, *(next(rest) if new else y for new in moved)]


def through_near(
    chains: Sequence[Sequence[Any]], us: Signals, dts: Sequence[float]
) -> list[Signals]:
    """Send a model's inputs through chains of the same steps with numbers near.

    Parameters
    ----------
    chains : sequence of sequence of Simulated
        The first is the one that the others are near.
    us : sequence of ndarray, shape (n,)
        By record.
    dts : sequence of float
        Sampling intervals in seconds.

    Returns
    -------
    list of sequence of ndarray, shape (n,)
        The outputs of each.
    """
    signals = [us] * len(chains)
    for step, *others in zip(*chains, strict=True):
        z, *own = signals
        signals = near(step, z, us, dts, [*zip(others, own, strict=True)])
    return signals


def attached(chain: Sequence[Block]) -> list[Any]:
    """Join every block of a chain with what is attached to it.

    Returns
    -------
    list of Block or what :meth:`AttachedBlock.attach` gives
        What the signal passes, in its order.

    Raises
    ------
    InputError
        With the place of a block that has nothing to be attached to.
    """
    steps: list[Any] = []
    for position, block in enumerate(chain):
        if not isinstance(block, AttachedBlock):
            steps.append(block)
            continue
        before = steps.pop() if steps else None
        with placed(f"chain: block {position + 1} ({block.name}): "):
            steps.append(block.attach(before))
    return steps

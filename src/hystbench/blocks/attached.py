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


Others = Sequence[tuple[Any, FloatArray]]
"""Steps with numbers near those of another one, each with what enters it."""


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


def near(
    step: Any, z: FloatArray, u: FloatArray, dt: float, others: Others
) -> list[FloatArray]:
    """Simulate a step of a chain, and others of its kind with numbers near.

    For derivatives: one that is equal and has the same input is not simulated again,
    and a mechanism moves all others along its own way.

    Parameters
    ----------
    step : Simulated
    z, u, dt
        Those of :meth:`Block.simulate`.
    others : sequence of (Simulated, ndarray)
        Each with its own z.

    Returns
    -------
    list of ndarray
        The output of the step, then those of the others.
    """
    moved = [own is not z or other != step for other, own in others]
    changed = [pair for pair, new in zip(others, moved, strict=True) if new]
    if hasattr(step, "near"):
        y, *found = step.near(z, u, dt, changed)
    else:
        y, *found = (x.simulate(own, u, dt) for x, own in ((step, z), *changed))
    rest = iter(found)
    return [y, *(next(rest) if new else y for new in moved)]


def through_near(
    chains: Sequence[Sequence[Any]], u: FloatArray, dt: float
) -> list[FloatArray]:
    """Send a model's input through chains of the same steps with numbers near.

    Parameters
    ----------
    chains : sequence of sequence of Simulated
        The first is the one that the others are near.
    u : ndarray, shape (n,)
    dt : float
        Sampling interval in seconds.

    Returns
    -------
    list of ndarray, shape (n,)
        The output of each.
    """
    signals = [u] * len(chains)
    for step, *others in zip(*chains, strict=True):
        z, *own = signals
        signals = near(step, z, u, dt, [*zip(others, own, strict=True)])
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

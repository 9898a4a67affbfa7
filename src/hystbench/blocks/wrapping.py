"""Hysteresis, and blocks that change the hysteresis before them instead of a signal."""

from __future__ import annotations

from abc import abstractmethod
from dataclasses import dataclass
from typing import Any, Protocol

from hystbench.blocks.attached import AttachedBlock
from hystbench.blocks.base import Block
from hystbench.errors import InputError
from hystbench.record import FloatArray

Growth = FloatArray | None
"""Factor on all thresholds at each sample, shape (n,); None for one."""


class Wrappable(Protocol):
    """Hysteresis that a block can wrap: a block, or one that is wrapped already."""

    def grow(
        self, v: FloatArray, u: FloatArray, dt: float, growth: Growth
    ) -> FloatArray:
        """Compute the output with all thresholds times ``growth``.

        Parameters
        ----------
        v : ndarray, shape (n,)
            What enters the hysteresis.
        u, dt
            As for :meth:`Block.simulate`.
        growth : ndarray, shape (n,), or None
            Factor on the thresholds at each sample; None for one.
        """

    def check_growth(self) -> None:
        """Refuse by InputError if there are no thresholds that can grow."""


class HystereticBlock(Block):
    """Hysteresis, which a :class:`WrappingBlock` may follow.

    That of play operators is a :class:`PlayBlock`.
    """

    hysteretic = True

    def grow(
        self, v: FloatArray, u: FloatArray, dt: float, growth: Growth
    ) -> FloatArray:
        """Compute the output; thresholds that grow are refused."""
        if growth is not None:
            self.check_growth()
        return self.simulate(v, u, dt)

    def check_growth(self) -> None:
        """Refuse: without thresholds none can grow."""
        raise InputError(
            f"'{self.name}' has no thresholds that could grow; "
            "expected 'gpi' or 'hysteresis', or the form 'excess-field'"
        )


class PlayBlock(HystereticBlock):
    """Hysteresis of play operators, whose thresholds can grow."""

    @abstractmethod
    def grow(
        self, v: FloatArray, u: FloatArray, dt: float, growth: Growth
    ) -> FloatArray:
        """Compute the output with all thresholds times ``growth``."""

    def simulate(self, z: FloatArray, u: FloatArray, dt: float) -> FloatArray:
        """Compute the output with thresholds as they are."""
        return self.grow(z, u, dt, None)

    def check_growth(self) -> None:
        """Accept."""


class WrappingBlock(AttachedBlock):
    """A block that changes the hysteresis before it, not a signal.

    In the chain it follows the hysteretic block or another wrapping block; both
    together are one :class:`Wrapped` step.
    """

    hosts = "hysteresis"

    def attach(self, before: Any) -> Wrapped:
        """Wrap the hysteresis before."""
        if not isinstance(before, HystereticBlock | Wrapped):
            from hystbench.blocks import registry  # late: it imports every block

            known = (key for key, item in registry().items() if item.hysteretic)
            raise InputError(
                f"expected hysteresis just before it ({', '.join(known)}), "
                f"got {getattr(before, 'name', 'none')}"
            )
        return Wrapped(before, self)

    def check_inner(self, inner: Wrappable) -> None:
        """Refuse hysteresis that the block cannot wrap; a subclass raises."""

    @abstractmethod
    def wrap(
        self, inner: Wrappable, v: FloatArray, u: FloatArray, dt: float, growth: Growth
    ) -> FloatArray:
        """Compute the output of the hysteresis as the block changes it.

        Parameters
        ----------
        inner : Wrappable
            What is wrapped.
        v, u, dt, growth
            As for :meth:`Wrappable.grow`; growth comes from a block further out.

        Returns
        -------
        ndarray, shape (n,)
        """


@dataclass(frozen=True)
class Wrapped:
    """A hysteretic block together with a block that wraps it."""

    inner: Wrappable
    by: WrappingBlock

    def __post_init__(self) -> None:
        """Let the wrapping block look at what it wraps."""
        self.by.check_inner(self.inner)

    def simulate(self, z: FloatArray, u: FloatArray, dt: float) -> FloatArray:
        """Compute the output, as :meth:`Block.simulate` does."""
        return self.by.wrap(self.inner, z, u, dt, None)

    def grow(
        self, v: FloatArray, u: FloatArray, dt: float, growth: Growth
    ) -> FloatArray:
        """Compute the output with all thresholds times ``growth``."""
        return self.by.wrap(self.inner, v, u, dt, growth)

    def check_growth(self) -> None:
        """Refuse if what is inside has no thresholds that can grow."""
        self.inner.check_growth()

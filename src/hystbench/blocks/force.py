"""Forces that act inside a ``mechanism``: what each of their blocks says."""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, ClassVar, NamedTuple, Protocol

import numpy as np

from hystbench import kernels
from hystbench.blocks.attached import AttachedBlock
from hystbench.blocks.step import Sampling, Step
from hystbench.errors import InputError
from hystbench.record import FloatArray

KINDS = (
    *("stiffness", "sinh", "stop", "friction"),
    *("drag", "hysteretic", "gravity", "slider", "smooth"),
)
"""Laws of the kernel, by the number that they have in kernels/forces.c."""
ROW = 6
"""Numbers of a row of the kernel."""


class Motion(NamedTuple):
    """How a coordinate moves, shape (n,) each."""

    position: FloatArray
    velocity: FloatArray
    acceleration: FloatArray
    force: FloatArray
    """Sum of the forces inside."""


class Host(Protocol):
    """A block with a coordinate: ``mechanism`` or ``impedance``."""

    name: ClassVar[str]

    def driven(self, z: FloatArray, dt: float, forces: tuple[Force, ...]) -> FloatArray:
        """Compute the output with forces inside."""

    def driven_near(
        self,
        z: FloatArray,
        dt: float,
        forces: tuple[Force, ...],
        others: Sequence[Any],
    ) -> list[FloatArray]:
        """Compute the output, then that of each other host, input and forces."""

    def driven_step(self, sampling: Sampling, forces: tuple[Force, ...]) -> Step:
        """Say what it does at one sample with forces inside."""


@dataclass(frozen=True)
class Force(AttachedBlock):
    """A force against the motion of the mechanism before it in the chain.

    It depends on the position q and the velocity q', and may remember a distance.
    """

    place: ClassVar = "inside"
    hosts: ClassVar = "mechanism or impedance"

    @abstractmethod
    def law(self) -> tuple[str, tuple[float, ...]]:
        """Give the kernel's law, one of :data:`KINDS`, and its numbers."""

    @property
    def stiffest(self) -> float:
        """Stiffness of a contact, which asks for shorter steps; zero without one."""
        return 0.0

    def numbers(self) -> tuple[float, ...]:
        """Give the row of the kernel: the law's number, then its own and zeros."""
        kind, own = self.law()
        return (float(KINDS.index(kind)), *own, *(0.0,) * (ROW - 1 - len(own)))

    def attach(self, before: Any) -> Driven:
        """Let the force act inside the mechanism before."""
        if isinstance(before, Driven):
            return Driven(before.host, (*before.forces, self))
        if not hasattr(before, "driven"):
            raise InputError(
                "expected mechanism or impedance just before it, or another force "
                f"inside one, got {getattr(before, 'name', 'none')}"
            )
        return Driven(before, (self,))


def rows(forces: tuple[Force, ...]) -> FloatArray:
    """Give the kernel's rows of some forces, shape (forces, 6)."""
    numbers = np.array([item.numbers() for item in forces], dtype=np.float64)
    return numbers.reshape(len(forces), ROW)


def exported(forces: tuple[Force, ...]) -> dict[str, Any]:
    """Give the constants of a step that stand for forces; it remembers one each.

    Without a force there is a row of zeros, as C has no empty arrays.
    """
    numbers = rows(forces).ravel() if forces else np.zeros(ROW)
    return {"count": len(forces), "forces": numbers}


def against(
    forces: tuple[Force, ...], position: FloatArray, velocity: FloatArray
) -> FloatArray:
    """Compute the sum of forces against a motion; none remembers one before it.

    Parameters
    ----------
    forces : tuple of Force
    position, velocity : ndarray, shape (n,)

    Returns
    -------
    ndarray, shape (n,)
    """
    found = np.zeros(len(position))
    memory = np.zeros(len(forces))
    kernels.call(
        "hb_forces",
        len(position),
        len(forces),
        rows(forces),
        memory,
        position,
        velocity,
        found,
    )
    return found


@dataclass(frozen=True)
class Driven:
    """A mechanism or an impedance together with the forces inside it."""

    host: Host
    forces: tuple[Force, ...]

    hysteretic: ClassVar[bool] = False
    name: ClassVar[str] = "mechanism"

    def simulate(self, z: FloatArray, u: FloatArray, dt: float) -> FloatArray:
        """Compute the output, as :meth:`Block.simulate` does."""
        return self.host.driven(z, dt, self.forces)

    def near(
        self,
        z: FloatArray,
        u: FloatArray,
        dt: float,
        others: Sequence[tuple[Driven, FloatArray]],
    ) -> list[FloatArray]:
        """Compute the output, and those of others with numbers near."""
        every = [(other.host, own, other.forces) for other, own in others]
        return self.host.driven_near(z, dt, self.forces, every)

    def step(self, sampling: Sampling) -> Step:
        """Say what both do at one sample, as :meth:`Block.step` does."""
        return self.host.driven_step(sampling, self.forces)

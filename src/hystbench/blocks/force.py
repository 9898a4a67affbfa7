"""Forces that act inside dynamics: what each of their blocks says."""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any, ClassVar, NamedTuple

import numpy as np

from hystbench import kernels
from hystbench.blocks.attached import AttachedBlock, OthersOnRecords, Signals
from hystbench.blocks.held import HeldBlock
from hystbench.blocks.step import Sampling, Step
from hystbench.errors import InputError
from hystbench.record import FloatArray

LAWS = (
    *("stiffness", "sinh", "stop", "friction"),
    *("drag", "hysteretic", "gravity", "slider", "smooth", "relaxation"),
    *("attached", "lugre", "faster", "saturating"),
)
"""Laws of the kernel, by the number that they have in the enum of kernels/forces.c."""
ROW = 7
"""Numbers of a row of the kernel."""


class Motion(NamedTuple):
    """How a coordinate moves, shape (n,) each."""

    position: FloatArray
    velocity: FloatArray
    acceleration: FloatArray
    force: FloatArray
    """Sum of the forces inside."""


class Dynamics(HeldBlock):
    """A block whose motion meets forces: a mechanism, a structure or an impedance."""

    def check_meets_forces(self) -> None:
        """Raise InputError if no force can act inside."""

    @abstractmethod
    def outputs(
        self,
        signals: Signals,
        dts: Sequence[float],
        forces: tuple[Force, ...],
        others: OthersOnRecords,
        pieces: float = 1.0,
    ) -> list[Signals]:
        """Compute the output with forces inside, and those of others with numbers near.

        Parameters
        ----------
        signals : sequence of ndarray, shape (n,)
            What drives it, by record.
        dts : sequence of float
            Sampling intervals in seconds.
        forces : tuple of Force
        others : sequence of (Driven, sequence of ndarray)
            Each with what drives it.
        pieces : float
            Steps in place of each that a simulation takes by itself.

        Returns
        -------
        list of sequence of ndarray, shape (n,)
            Its own by record, then those of each of the others; NaN from where one has
            run away.
        """

    @abstractmethod
    def motion(
        self, z: FloatArray, dt: float, forces: tuple[Force, ...], pieces: float = 1.0
    ) -> Motion:
        """Compute how the coordinate moves in one record."""

    @abstractmethod
    def driven_step(self, sampling: Sampling, forces: tuple[Force, ...]) -> Step:
        """Say what it does at one sample with forces inside."""

    def driven(
        self, z: FloatArray, dt: float, forces: tuple[Force, ...], pieces: float = 1.0
    ) -> FloatArray:
        """Compute the output with forces inside; NaN from where it has run away."""
        return self.outputs((z,), (dt,), forces, (), pieces)[0][0]

    def simulate(self, z: FloatArray, u: FloatArray, dt: float) -> FloatArray:
        """Compute the output without a force inside."""
        return self.driven(z, dt, ())

    def simulate_records(self, signals: Signals, dts: Sequence[float]) -> Signals:
        """Compute the outputs of many records without a force inside."""
        return Driven(self).simulate_records(signals, dts)

    def near_records(
        self, signals: Signals, dts: Sequence[float], others: OthersOnRecords
    ) -> list[Signals]:
        """Compute the outputs, and those of others near, without a force inside."""
        every = [(Driven(host), own) for host, own in others]
        return Driven(self).near_records(signals, dts, every)

    def step(self, sampling: Sampling) -> Step:
        """Say what it does at one sample without a force inside."""
        return self.driven_step(sampling, ())


class Force(AttachedBlock, place="inside"):
    """A force against the motion of the dynamics before it in the chain.

    It depends on the position q and the velocity q', and may remember a distance.
    """

    hosts = "mechanism, impedance or structure"

    law: ClassVar[str]
    """The kernel's law, one of :data:`LAWS`; the line of a subclass says it."""

    def __init_subclass__(cls, law: str = "", **about: Any) -> None:
        """Keep the law that the line of a class says."""
        super().__init_subclass__(**about)
        if law:
            cls.law = law

    def numbers(self) -> tuple[float, ...] | FloatArray:
        """Give the numbers of the law: the block's own, unless a subclass has others.

        Of a force that is the sum of several of one law, the numbers of each, a row for
        each.
        """
        return tuple(getattr(self, name) for name in self.parameters())

    @property
    def stiffest(self) -> float:
        """Stiffness of a contact, which asks for shorter steps; zero without one."""
        return 0.0

    @property
    def swings(self) -> float:
        """How fast it swings by itself, in rad/s, which steps must resolve."""
        return 0.0

    @property
    def slope(self) -> float:
        """Stiffness of a smooth force at q = 0, where that is part of its law."""
        return 0.0

    def rows(self) -> FloatArray:
        """Give rows of the kernel: the law's number, then its own and zeros."""
        own = np.atleast_2d(np.asarray(self.numbers(), dtype=np.float64))
        found = np.zeros((len(own), ROW))
        found[:, 0] = LAWS.index(self.law)
        found[:, 1 : 1 + own.shape[1]] = own
        return found

    def attach(self, before: Any) -> Any:
        """Let the force act inside the mechanism before."""
        if hasattr(before, "taking"):
            return before.taking(self)
        if not isinstance(before, Dynamics):
            raise InputError(
                "expected mechanism, impedance or structure just before it, or another "
                f"force inside one, got {getattr(before, 'name', 'none')}"
            )
        before.check_meets_forces()
        return Driven(before, (self,))


def rows(forces: tuple[Force, ...]) -> FloatArray:
    """Give the kernel's rows of some forces, shape (rows, 7); one or more a force."""
    return np.vstack([np.zeros((0, ROW)), *(item.rows() for item in forces)])


def less_stiff(numbers: FloatArray, slope: float) -> FloatArray:
    """Give rows of forces that are less by a linear spring, which their host has."""
    row = np.zeros((1, ROW))
    row[0, [0, 3]] = LAWS.index("stiffness"), -slope
    return np.vstack([numbers, row])


def exported(numbers: FloatArray) -> tuple[dict[str, Any], int]:
    """Give the constants of a step that stand for forces, and how many it remembers.

    Without a force there is a row of zeros and one memory, as C has no empty arrays.
    """
    count = len(numbers)
    own = numbers.ravel() if count else np.zeros(ROW)
    return {"count": count, "forces": own}, max(count, 1)


def against(
    forces: tuple[Force, ...], position: FloatArray, velocity: FloatArray, dt: float
) -> FloatArray:
    """Compute the sum of forces against a motion; none remembers one before it.

    Parameters
    ----------
    forces : tuple of Force
    position, velocity : ndarray, shape (n,)
    dt : float
        Between two samples, in seconds.

    Returns
    -------
    ndarray, shape (n,)
    """
    found, numbers = np.zeros(len(position)), rows(forces)
    kernels.call(
        "hb_forces",
        len(position),
        dt,
        len(numbers),
        numbers,
        np.zeros(len(numbers)),
        position,
        velocity,
        found,
    )
    return found


@dataclass(frozen=True)
class Driven:
    """Dynamics together with the forces inside them."""

    host: Dynamics
    forces: tuple[Force, ...] = ()
    pieces: float = 1.0

    hysteretic = False
    name: ClassVar[str] = "mechanism"

    def taking(self, force: Force) -> Driven:
        """Let another force act beside those that are there."""
        return replace(self, forces=(*self.forces, force))

    def in_pieces(self, pieces: float) -> Driven:
        """Take so many steps in place of each."""
        return replace(self, pieces=pieces)

    def simulate(self, z: FloatArray, u: FloatArray, dt: float) -> FloatArray:
        """Compute the output, as :meth:`Block.simulate` does."""
        return self.host.driven(z, dt, self.forces, self.pieces)

    def simulate_records(self, signals: Signals, dts: Sequence[float]) -> Signals:
        """Compute the outputs of many records at once: of short ones that is faster."""
        return self.near_records(signals, dts, ())[0]

    def near_records(
        self, signals: Signals, dts: Sequence[float], others: OthersOnRecords
    ) -> list[Signals]:
        """Compute the outputs, and those of others with numbers near."""
        return self.host.outputs(signals, dts, self.forces, others, self.pieces)

    def step(self, sampling: Sampling) -> Step:
        """Say what both do at one sample, as :meth:`Block.step` does."""
        return self.host.driven_step(sampling, self.forces)

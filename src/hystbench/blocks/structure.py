"""Block ``structure``: modes of a structure, and forces at one place of it."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from math import sqrt
from typing import Any

import numpy as np

from hystbench import kernels
from hystbench.blocks.attached import Signals
from hystbench.blocks.base import Block
from hystbench.blocks.force import Driven, Force, exported, rows
from hystbench.blocks.forced import ForcedDynamics, tables_of
from hystbench.blocks.parameter import TINY, choice, number, numbers
from hystbench.blocks.starts import PASTS
from hystbench.blocks.step import Sampling, Step, lines_of
from hystbench.errors import InputError
from hystbench.record import FloatArray

SHAPES = ("drive", "joint")
"""Shapes of modes that no linear record tells: where it is driven, where forces act."""
OUTPUTS = ("position", "velocity", "acceleration")
_SHAPE = "Q^0.5 U^-0.5 s^-1"


def _of_each(unit: str, meaning: str, **about: Any) -> Any:
    return numbers(unit, meaning, as_many_as="stiffness", **about)


class Structure(ForcedDynamics, name="structure", place="base"):
    """Modes q_i of unit mass, and forces F at one place x, the joint, that they move.

    ``q_i'' + c_i q_i' + k_i q_i = drive_i z - joint_i F(x, x')`` with ``x = sum of
    joint_i q_i``: the modes feel each other by the forces alone, which follow in the
    chain. The output is ``sum of modal_constant_i / drive_i (q_i + blend_i q_i')``, or
    a derivative of it, and ``direct z`` [1]_.

    ``drive_i`` and ``joint_i`` are the shape of a mode, scaled for a unit mass, where
    the input acts and where the forces act. ``modal_constant_i`` is ``drive_i`` times
    the shape at the sensor. A mode that does not move the joint has a ``joint_i`` of
    zero. Without any ``joint`` the block is linear, and no force can act inside.

    The work of a force at the joint is the energy that all modes lose, so a passive one
    never gives energy. It is integrated as a ``mechanism`` is.

    References
    ----------
    .. [1] D. J. Ewins, Modal Testing: Theory, Practice and Application, 2nd ed.,
       Research Studies Press, 2000, chapter 2.
    """

    reference = "Ewins, Modal Testing (2000)"

    stiffness: tuple[float, ...] = numbers(
        "1/s^2", "k of each mode, the square of its natural frequency in rad/s", TINY
    )
    damping: tuple[float, ...] = _of_each("1/s", "c of each mode", low=0.0)
    modal_constant: tuple[float, ...] = _of_each(
        "Q/(U s^2)", "shape of each mode at the drive times that at the sensor"
    )
    drive: tuple[float, ...] = _of_each(
        _SHAPE, "shape of each mode at the drive", low=TINY
    )
    joint: tuple[float, ...] = _of_each(
        _SHAPE, "shape of each mode at the joint", optional=True
    )
    blend: tuple[float, ...] = _of_each(
        "s or 1/s",
        "share of each mode's velocity in the output; of its acceleration, where the "
        "output is the velocity",
        optional=True,
    )
    direct: float = number("Y/U", "what passes at once", default=0.0)
    output: str = choice("what the output is", OUTPUTS, "position")

    @classmethod
    def from_mapping(cls, values: Mapping[str, Any]) -> Block:
        """Make a structure, as :meth:`Block.from_mapping` does.

        A mode keeps its motion where all its shapes change sign.
        """
        given = values.get("drive")
        for k, shape in enumerate(given if isinstance(given, list | tuple) else ()):
            if isinstance(shape, int | float) and shape < 0.0:
                raise InputError(
                    f"drive[{k}]: {shape:g}; expected more than 0: turn the sign of "
                    f"the whole mode, drive[{k}] and joint[{k}]; modal_constant stays"
                )
        return super().from_mapping(values)

    def check(self) -> None:
        """Refuse a joint that no mode moves."""
        if self.joint and not any(self.joint):
            raise InputError("joint: all zero; expected one mode or more that moves it")

    def check_meets_forces(self) -> None:
        """Refuse forces where no joint is given."""
        if not self.joint:
            raise InputError(
                "structure: joint: expected a number of each mode, for the force there"
            )

    @property
    def at_joint(self) -> FloatArray:
        """Shape of each mode at the joint; zeros without one."""
        return np.array(self.joint or (0.0,) * len(self.stiffness))

    @property
    def receptance(self) -> float:
        """How far a unit of force moves the joint at rest."""
        return float(np.sum(self.at_joint**2 / np.array(self.stiffness)))

    def rates(self, contact: float, shown: float) -> tuple[float, float]:
        """Give how fast modes of the joint swing, alone and in contact.

        Alone the fastest that samples show, or the fastest of all if they show none.
        """
        joint = self.at_joint
        every = np.sqrt(np.array(self.stiffness)[joint != 0.0])
        fastest = float(np.max(every, initial=0.0))
        alone = float(np.max(every[every <= shown], initial=0.0))
        return alone or fastest, sqrt(fastest**2 + contact * float(joint @ joint))

    def _moved(
        self,
        every: Sequence[Driven],
        drives: Sequence[Signals],
        dt: float,
        of_first: FloatArray | None = None,
    ) -> list[Signals]:
        """Move near motions through records, which have three samples or as many.

        What moves as the first one does shows another output of the same motion: most
        numbers of an output move nothing.
        """
        hosts: list[Any] = [each.host for each in every]
        moves = [
            (host.moving, each.forces, *map(id, own))
            for host, each, own in zip(hosts, every, drives, strict=True)
        ]
        alike = [k for k, key in enumerate(moves) if key == moves[0]]
        others = [k for k, key in enumerate(moves) if key != moves[0]]
        places = [0, *others]
        moved = [hosts[k] for k in places]
        laws = np.array([rows(every[k].forces) for k in places])
        driven = self.lines(every[0], [drives[k] for k in places], dt)
        starts = np.zeros((len(moved), len(driven.ends), 2 * len(self.stiffness)))
        for k, host in enumerate(moved):
            rested = host._balances(driven.before[k], laws[k])
            starts[k, :, : len(self.stiffness)] = rested
        tables = _tables(moved, driven.step / driven.parts)
        shown = np.array([host.weights() for host in moved])
        if of_first is not None:
            return driven.move(driven.values, tables, laws, starts, shown, of_first)
        asked = np.array([hosts[k].weights() for k in alike])
        found = driven.move(driven.values, tables, laws, starts, shown, asked)
        return [found[k] for k in np.argsort([*alike, *others])]

    @property
    def moving(self) -> tuple[Any, ...]:
        """What its modes depend on; the output has more numbers."""
        return self.stiffness, self.damping, self.drive, self.joint

    @property
    def modes(self) -> tuple[tuple[float, float, float], ...]:
        """Mass, damping and stiffness of each."""
        every = zip(self.damping, self.stiffness, strict=True)
        return tuple((1.0, damping, stiffness) for damping, stiffness in every)

    def _of_motion(self, forces: tuple[Force, ...]) -> FloatArray:
        """Give the weights of the joint's motion and of the forces there."""
        joint, count = self.at_joint, len(self.stiffness)
        found = np.zeros((4, 2 * count + 2))
        found[0, :count] = found[1, count:-2] = joint
        found[2] = joint @ self._accelerations
        found[3, -2] = 1.0
        return found

    @property
    def _accelerations(self) -> FloatArray:
        """Weights in q'' of each mode, shape (modes, 2 modes + 2)."""
        own = -np.diag(self.stiffness), -np.diag(self.damping)
        return np.column_stack([*own, -self.at_joint, np.array(self.drive)])

    def weights(self) -> FloatArray:
        """Give the weights of q and q' of all modes, of F and of what drives."""
        count = len(self.stiffness)
        sensor = np.array(self.modal_constant) / np.array(self.drive)
        blend = np.array(self.blend or (0.0,) * count)
        position, velocity = np.zeros((2, count, 2 * count + 2))
        position[:, :count], velocity[:, count:-2] = np.eye(count), np.eye(count)
        derivatives = (position, velocity, self._accelerations)
        order = OUTPUTS.index(self.output)
        # Beside an acceleration a share of the velocity, as a mechanism has it.
        other = derivatives[order + 1 if order < 2 else 1]
        weights = sensor @ derivatives[order] + (sensor * blend) @ other
        weights[-1] += self.direct
        return np.asarray(weights)

    def _balances(self, before: FloatArray, laws: FloatArray) -> FloatArray:
        """Find where the springs hold what drives it, next to where modes alone do.

        Shape (records, modes), of what drove each record before.
        """
        driven, held = self._rests()
        if not len(laws) or self.start == "rest":
            return np.outer(before, driven)
        spring = 1.0 / self.receptance
        alone = before * float(self.at_joint @ driven)
        found = np.empty(len(before))
        for k, place in enumerate(alone.tolist()):
            x, memory = np.zeros(1), np.zeros(len(laws))
            about = spring, place * spring, len(laws), laws, memory, x
            kernels.call("hb_settle", *about)
            found[k] = x[0]
        return np.outer(before, driven) - np.outer((alone - found) * spring, held)

    def _rests(self) -> FloatArray:
        """Give q of all modes under a unit of what drives it, and of force.

        Zeros where it begins at rest.
        """
        shapes = np.array([self.drive, self.at_joint])
        return np.asarray(shapes / np.array(self.stiffness) * (self.start != "rest"))

    def driven_step(self, sampling: Sampling, forces: tuple[Force, ...]) -> Step:
        """Move the modes over the interval that has passed."""
        lines = lines_of(self.holding, sampling)
        line = sampling.dt / lines.segments
        parts = self.parts(line, forces)
        inside, memory = exported(rows(forces))
        count = len(self.stiffness)
        constants = {
            "modes": count,
            **lines.constants,
            "parts": parts,
            "h": line / parts,
            "table": _tables([self], line / parts).ravel(),
            "shown": self.weights(),
            "rests": self._rests().ravel(),
            "spring": 1.0 / self.receptance if forces and self.start != "rest" else 0.0,
            **inside,
        }
        states = {
            "motion": 2 * count,
            "before": 2 * count,
            "memory": memory,
            **lines.states,
        }
        past = PASTS.get(self.start, "")
        return Step("structure", constants, states, past=past, **lines.told)


def _tables(hosts: Sequence[Structure], dt: float) -> FloatArray:
    """Give the kernel's table of each structure, for a part of dt."""
    drive, joint = np.array([[x.drive, x.at_joint] for x in hosts]).swapaxes(0, 1)
    return tables_of([host.modes for host in hosts], drive, joint, dt)

"""Block ``impedance``: the force that a given motion takes."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from hystbench.blocks.base import Block
from hystbench.blocks.force import Force, Motion, against, exported
from hystbench.blocks.parameter import HUGE, choice, number
from hystbench.blocks.step import Sampling, Step, about_sample, foretold
from hystbench.record import FloatArray

INPUTS = ("position", "velocity")
RATE = (
    np.array(
        [[0, 0, -18, 24, -6], [0, -4, -6, 12, -2], [1, -8, 0, 8, -1]], dtype=np.float64
    )
    / 12
)
"""Weights of five samples for the rate at the third of them, per sample: of a record's
first sample, by the parabola through three; of its second, by the cubic through four;
and of all others but the last two, for which these are turned round."""
CURVATURE = (
    np.array(
        [[0, 0, 12, -24, 12], [0, 12, -24, 12, 0], [-1, 16, -30, 16, -1]],
        dtype=np.float64,
    )
    / 12
)
"""The same for the second derivative."""


@dataclass(frozen=True)
class Impedance(Block):
    """Force of a device that is moved: ``y = m q'' + c q' + k q + F(q, q') + bias``.

    F is the sum of the forces that follow it in the chain. The input is the position q,
    or the velocity, which is then integrated by the trapezoidal rule. Rates are
    taken from five samples, to the fourth order in the sampling interval [2]_: second
    differences of three make the force of a mass too small by 1 % at 18 samples a
    period, which looks like another force.

    References
    ----------
    .. [1] P. Gardonio, M. J. Brennan, "On the origins and development of mobility and
       impedance methods in structural dynamics", Journal of Sound and Vibration 249
       (2002) 557-573.
    .. [2] B. Fornberg, "Generation of finite difference formulas on arbitrarily spaced
       grids", Mathematics of Computation 51 (1988) 699-706.
    """

    name: ClassVar = "impedance"
    place: ClassVar = "base"
    reference: ClassVar = "Gardonio, Brennan, J. Sound Vib. 249 (2002)"

    mass: float = number("Y s^2/U", "m", -HUGE, HUGE)
    damping: float = number("Y s/U", "c, of a viscous force", -HUGE, HUGE)
    stiffness: float = number("Y/U", "k", -HUGE, HUGE)
    bias: float = number("Y", "constant force", -HUGE, HUGE, 0.0)
    input: str = choice("what the input is", INPUTS, "position")

    def simulate(self, z: FloatArray, u: FloatArray, dt: float) -> FloatArray:
        """Compute the force without one that is not linear."""
        return self.driven(z, dt, ())

    def driven(self, z: FloatArray, dt: float, forces: tuple[Force, ...]) -> FloatArray:
        """Compute the force.

        Parameters
        ----------
        z : ndarray, shape (n,)
            The motion.
        dt : float
            Sampling interval in seconds.
        forces : tuple of Force

        Returns
        -------
        ndarray, shape (n,)
        """
        motion = self.motion(z, dt, forces)
        return (
            self.mass * motion.acceleration
            + self.damping * motion.velocity
            + self.stiffness * motion.position
            + motion.force
            + self.bias
        )

    def step(self, sampling: Sampling) -> Step:
        """Take rates from the curve through the newest samples."""
        return self.driven_step(sampling, ())

    def driven_step(self, sampling: Sampling, forces: tuple[Force, ...]) -> Step:
        """Do so with forces inside."""
        points, ahead, dt = sampling.curve_points, sampling.ahead, sampling.dt
        constants = {
            "mass": self.mass,
            "damping": self.damping,
            "stiffness": self.stiffness,
            "bias": self.bias,
            "velocity": int(self.input == "velocity"),
            "dt": dt,
            "points": points,
            "ahead": ahead,
            "rate": np.ravel([about_sample(row, points, ahead) for row in RATE]) / dt,
            "curvature": np.ravel(
                [about_sample(row, points, ahead) for row in CURVATURE]
            )
            / dt**2,
            **exported(forces),
        }
        memory = max(len(forces), 1)
        states = {"place": 2, "memory": memory, "history": 1 + points}
        return Step(
            "impedance",
            constants,
            states,
            forward=True,
            rates=2,
            differs=foretold(RATE[-1], points, ahead),
        )

    def motion(self, z: FloatArray, dt: float, forces: tuple[Force, ...]) -> Motion:
        """Give the motion and the forces that it meets, as for :meth:`driven`."""
        q = v = np.ascontiguousarray(z, dtype=np.float64)
        if self.input == "position":
            v = _rate(q, dt)
        elif len(z):
            q = np.concatenate([[0.0], np.cumsum((z[1:] + z[:-1]) / 2 * dt)])
        curved = _curvature(q, dt) if self.input == "position" else _rate(v, dt)
        return Motion(q, v, curved, against(forces, q, v))


def _rate(x: FloatArray, dt: float) -> FloatArray:
    if len(x) < RATE.shape[1]:
        return np.gradient(x, dt) if len(x) > 1 else np.zeros(len(x))
    return _from_five(x, RATE, -RATE) / dt


def _curvature(x: FloatArray, dt: float) -> FloatArray:
    return _from_five(x, CURVATURE, CURVATURE) / dt**2


def _from_five(x: FloatArray, begun: FloatArray, ended: FloatArray) -> FloatArray:
    """Weigh each sample and its neighbours; ``ended`` is of the record turned round."""
    count = begun.shape[1]
    if len(x) < count:
        return np.zeros(len(x))
    weighed = np.empty(len(x))
    weighed[2:-2] = np.correlate(x, begun[-1], mode="valid")
    for k in (0, 1):
        weighed[k] = begun[k, 2 - k :] @ x[: 3 + k]
        weighed[-1 - k] = ended[k, 2 - k :] @ x[: -4 - k : -1]
    return weighed

"""Block ``impedance``: the force that a given motion takes."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from hystbench.blocks.base import Block
from hystbench.blocks.force import Force, Motion, against, exported
from hystbench.blocks.parameter import HUGE, choice, number
from hystbench.blocks.step import (
    Sampling,
    Step,
    foretold,
    sample_curvature,
    sample_rate,
)
from hystbench.record import FloatArray

INPUTS = ("position", "velocity")


@dataclass(frozen=True)
class Impedance(Block):
    """Force of a device that is moved: ``y = m q'' + c q' + k q + F(q, q') + bias``.

    F is the sum of the forces that follow it in the chain. The input is the position q,
    or the velocity, which is then integrated by the trapezoidal rule. Rates are central
    differences, one-sided at the ends.

    References
    ----------
    .. [1] P. Gardonio, M. J. Brennan, "On the origins and development of mobility and
       impedance methods in structural dynamics", Journal of Sound and Vibration 249
       (2002) 557-573.
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
            "rate": sample_rate(points, ahead) / dt,
            "curvature": sample_curvature(points, ahead) / dt**2,
            **exported(forces),
        }
        memory = max(len(forces), 1)
        states = {"place": 2, "memory": memory, "history": 1 + points}
        told = foretold(points, ahead)
        return Step(
            "impedance", constants, states, forward=True, rates=True, differs=told
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
    return np.gradient(x, dt) if len(x) > 1 else np.zeros(len(x))


def _curvature(x: FloatArray, dt: float) -> FloatArray:
    """Second central difference, that of the next sample at each end."""
    if len(x) < 3:
        return np.zeros(len(x))
    inner = (x[2:] - 2 * x[1:-1] + x[:-2]) / dt**2
    return np.concatenate([inner[:1], inner, inner[-1:]])

"""Block ``impedance``: the force that a given motion takes."""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial
from math import factorial
from typing import Any, ClassVar

import numpy as np

from hystbench.blocks.band_limited import coarser, finer
from hystbench.blocks.force import Force, Motion, against, exported
from hystbench.blocks.held import HeldBlock
from hystbench.blocks.parameter import HUGE, choice, number
from hystbench.blocks.step import (
    Sampling,
    Step,
    about_sample,
    foretold,
    smooth_curve,
    through_samples,
)
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
FINER = 8
"""Steps in a sampling interval of a band-limited motion: friction reverses between
samples, and what of its jump is below half the sampling rate is right to a percent."""


@dataclass(frozen=True)
class Impedance(HeldBlock):
    """Force of a device that is moved: ``y = m q'' + c q' + k q + F(q, q') + bias``.

    F is the sum of the forces that follow it in the chain. The input is the position q,
    or the velocity, which is then integrated by the trapezoidal rule. Rates are
    taken from five samples, to the fourth order in the sampling interval [2]_: second
    differences of three make the force of a mass too small by 1 % at 18 samples a
    period, which looks like another force. A band-limited motion is taken eight times
    finer, and of F what passes a low-pass filter at half the sampling rate: what an
    instrument records that samples without aliasing. ``zero-order`` is as ``linear``.

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

    @classmethod
    def parts(cls, moved: str, hold: str = "default") -> dict[str, Impedance]:
        """Give a block for each number, with that at one and the others at zero.

        The force of any impedance is the sum of theirs, times its numbers.
        """
        names = ("mass", "damping", "stiffness", "bias")
        zero: dict[str, Any] = dict.fromkeys(names, 0.0)
        zero |= {"input": moved, "hold": hold}
        return {name: cls(**{**zero, name: 1.0}) for name in names}

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
        if self.holding == "band-limited":
            rate, curvature = (
                np.tile(through_samples(points, partial(_derivative, k), -ahead), 3)
                for k in (1, 2)
            )
            way = through_samples(points, lambda m: (-1.0) ** m / (m + 1), -ahead)
            told = smooth_curve(points, ahead)
            told += "" if ahead > 1 else f"; {foretold(RATE[-1], points, ahead)}"
            if forces:
                told += "; takes its forces at samples alone, without a low-pass filter"
        else:
            rate, curvature = (
                np.ravel([about_sample(row, points, ahead) for row in rows])
                for rows in (RATE, CURVATURE)
            )
            way = np.zeros(points)
            way[ahead : ahead + 2] = 0.5
            told = foretold(RATE[-1], points, ahead)
        constants = {
            "mass": self.mass,
            "damping": self.damping,
            "stiffness": self.stiffness,
            "bias": self.bias,
            "velocity": int(self.input == "velocity"),
            "points": points,
            "ahead": ahead,
            "rate": rate / dt,
            "curvature": curvature / dt**2,
            "way": way * dt,
            **exported(forces),
        }
        memory = max(len(forces), 1)
        states = {"place": 1, "memory": memory, "history": 1 + points}
        return Step(
            "impedance",
            constants,
            states,
            forward=True,
            rates=2,
            differs=told,
        )

    def motion(self, z: FloatArray, dt: float, forces: tuple[Force, ...]) -> Motion:
        """Give the motion and the forces that it meets, as for :meth:`driven`."""
        fine = FINER if self.holding == "band-limited" and len(z) > 2 else 1
        x = finer(z, fine) if fine > 1 else np.ascontiguousarray(z, dtype=np.float64)
        dt /= fine
        if self.input == "position":
            q, v, curved = x, _rate(x, dt), _curvature(x, dt)
        else:
            way = np.cumsum((x[1:] + x[:-1]) / 2 * dt)
            q, v, curved = (
                np.concatenate([np.zeros(min(len(x), 1)), way]),
                x,
                _rate(x, dt),
            )
        force = against(forces, q, v)
        if fine > 1:
            force = coarser(force, fine) if forces else force[::fine]
        return Motion(q[::fine], v[::fine], curved[::fine], force)


def _derivative(order: int, power: int) -> float:
    """Give a derivative of ``t^power`` at zero."""
    return float(factorial(order)) if power == order else 0.0


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

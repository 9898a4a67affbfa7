"""Block ``stiffness-hardening``: a mode whose spring stiffens with its displacement."""

import numpy as np

from hystbench import kernels
from hystbench.blocks.curve import held_lines
from hystbench.blocks.held import HeldBlock
from hystbench.blocks.parameter import number
from hystbench.blocks.step import Sampling, Step, lines_of
from hystbench.record import FloatArray

STEP = 0.1
"""Phase of the stiffened mode, in radians."""


class StiffnessHardening(HeldBlock, name="stiffness-hardening", place="mechanics"):
    """Duffing's oscillator beside a rigid path; it replaces a linear ``resonance``.

    ``y = (1 - p) z + p x`` with ``x'' + 2 zeta wn x' + wn^2 (x + coefficient x^3) =
    wn^2 z``, from rest. With a coefficient of zero it is ``resonance``. Integrated by
    the classical Runge-Kutta method in steps of at most 0.1 radian of the stiffened
    mode. A band-limited input is taken as straight lines on a grid twice as fine.

    A negative coefficient softens the spring. Where such a mode runs away, the output
    is NaN from there on, as there is none.

    References
    ----------
    .. [1] I. Kovacic, M. J. Brennan (eds.), The Duffing Equation: Nonlinear Oscillators
       and their Behaviour, Wiley, 2011.
    """

    coefficient: float = number("1/Y^2", "weight of the cube")
    frequency_hz: float = number("Hz", "undamped frequency wn / 2 pi", 1e-3, 1e6)
    damping_ratio: float = number("-", "zeta, share of critical damping", 1e-5, 10.0)
    participation: float = number(
        "-",
        "p, static share; negative: out of phase with the rest",
        -10.0,
        10.0,
    )

    def simulate(self, z: FloatArray, u: FloatArray, dt: float) -> FloatArray:
        """Integrate the mode."""
        return self.integrated(z, dt, STEP)

    def integrated(self, z: FloatArray, dt: float, step: float) -> FloatArray:
        """Integrate the mode in steps of at most so many radians of it."""
        v, fine = held_lines(z, self.holding)
        x = np.empty(len(v))
        kernels.call(
            "hb_hardening",
            len(v),
            2 * np.pi * self.frequency_hz * dt / fine,
            self.damping_ratio,
            self.coefficient,
            float(self.holding != "zero-order"),
            step,
            v,
            x,
        )
        return (1 - self.participation) * z + self.participation * x[::fine]

    def step(self, sampling: Sampling) -> Step:
        """Integrate the mode over the interval that has passed."""
        lines = lines_of(self.holding, sampling)
        constants = {
            "participation": self.participation,
            "phase": 2 * np.pi * self.frequency_hz * sampling.dt / lines.segments,
            "damping": self.damping_ratio,
            "coefficient": self.coefficient,
            **lines.constants,
        }
        states = {"mode": 2, **lines.states}
        return Step("stiffness_hardening", constants, states, **lines.told)

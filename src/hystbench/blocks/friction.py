"""Block ``friction``: a force against the motion that the input is."""

import numpy as np

from hystbench.blocks.base import Block
from hystbench.blocks.curve import CENTRAL, about_sample
from hystbench.blocks.parameter import TINY, number
from hystbench.blocks.step import Sampling, Step, foretold
from hystbench.record import FloatArray


class Friction(Block, name="friction", place="mechanics"):
    """Coulomb friction, smoothed: ``y = z + coulomb tanh((du/dt) / velocity_scale)``.

    For models with motion in and force out. The velocity is a central difference of
    the model's input, one-sided at the ends.

    References
    ----------
    .. [1] B. Armstrong-Helouvry, P. Dupont, C. Canudas de Wit, "A survey of models,
       analysis tools and compensation methods for the control of machines with
       friction", Automatica 30 (1994) 1083-1138.
    """

    coulomb: float = number("Y", "force at high velocity")
    velocity_scale: float = number(
        "U/s", "velocity at which 76 % of it are there", TINY
    )

    def simulate(self, z: FloatArray, u: FloatArray, dt: float) -> FloatArray:
        """Add the friction."""
        velocity = np.gradient(u, dt)
        return z + self.coulomb * np.tanh(velocity / self.velocity_scale)

    def step(self, sampling: Sampling) -> Step:
        """Take the rate from the curve through the input's newest samples."""
        points = max(sampling.points, sampling.late + 2)
        constants = {
            **self.constants("coulomb", "velocity_scale"),
            "points": points,
            "rate": about_sample(CENTRAL, points, sampling.late) / sampling.dt,
        }
        history = {"history": 1 + points}
        return Step(
            "friction",
            constants,
            history,
            watches=True,
            gains=1,
            rates=1,
            differs=foretold(CENTRAL, points, sampling.late),
        )

"""Block ``sensor-noise``: white noise of the displacement sensor."""

from dataclasses import replace

import numpy as np

from hystbench.blocks.base import Block
from hystbench.blocks.parameter import number
from hystbench.blocks.step import Sampling, Step, polynomial
from hystbench.record import FloatArray


class SensorNoise(Block, name="sensor-noise", place="sensor"):
    """White Gaussian noise of zero mean added to the output.

    Without a random generator a model adds nothing here: that is the mean.

    References
    ----------
    .. [1] A. J. Fleming, "A review of nanometer resolution position sensors",
       Sensors and Actuators A 190 (2013) 106-126.
    """

    rms: float = number("Y", "standard deviation of a sample", 0.0)

    def simulate(self, z: FloatArray, u: FloatArray, dt: float) -> FloatArray:
        """Return ``z`` as it is."""
        return z

    def draw(self, n: int, rng: np.random.Generator) -> FloatArray:
        """Draw independent normal samples."""
        return rng.normal(0.0, self.rms, n)

    def step(self, sampling: Sampling) -> Step:
        """Pass the signal on: code that is exported adds no noise."""
        return replace(polynomial(0.0, 1.0), differs="adds no noise")

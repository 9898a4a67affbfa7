"""Block ``mains-pickup``: a tone that the input does not explain."""

import numpy as np

from hystbench.blocks.base import Block
from hystbench.blocks.parameter import number, numbers
from hystbench.blocks.step import Sampling, Step
from hystbench.record import FloatArray


class MainsPickup(Block, name="mains-pickup", place="sensor"):
    """Hum of the mains: ``y = z + sum_h amplitude_h sin(2 pi h f t + phase_h)``.

    h counts from 1, the fundamental; t is 0 at the first sample of each record.

    References
    ----------
    .. [1] H. W. Ott, Electromagnetic Compatibility Engineering, Wiley, 2009.
    """

    frequency_hz: float = number("Hz", "f, of the fundamental", 1e-3, 1e6)
    amplitudes: tuple[float, ...] = numbers("Y", "one a harmonic")
    phases: tuple[float, ...] = numbers(
        "rad", "one a harmonic", -1e3, 1e3, as_many_as="amplitudes"
    )

    def simulate(self, z: FloatArray, u: FloatArray, dt: float) -> FloatArray:
        """Add the hum."""
        angle = 2 * np.pi * self.frequency_hz * dt * np.arange(len(z))
        y = z.copy()
        both = zip(self.amplitudes, self.phases, strict=True)
        for harmonic, (amplitude, phase) in enumerate(both, start=1):
            y += amplitude * np.sin(harmonic * angle + phase)
        return y

    def step(self, sampling: Sampling) -> Step:
        """Count the samples."""
        constants = {
            "cycles": self.frequency_hz * sampling.dt,
            "harmonics": len(self.amplitudes),
            **self.constants("amplitudes", "phases"),
        }
        return Step("mains_pickup", constants, {"count": 1})

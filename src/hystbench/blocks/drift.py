"""Block ``drift``: the zero wanders slowly."""

import numpy as np

from hystbench.blocks.base import Block
from hystbench.blocks.parameter import number, numbers
from hystbench.blocks.step import Sampling, Step
from hystbench.errors import InputError
from hystbench.record import FloatArray


class Drift(Block, name="drift", place="sensor"):
    """Slow motion of the zero: ``y = z + slope t + path(t)``.

    Time t starts at 0 in each record. The path starts at zero and goes in straight
    lines through values at evenly spaced times, the last at the record's last sample.
    A zero error at the start is no drift: ``calibration-error`` has it as its offset.

    References
    ----------
    .. [1] A. J. Fleming, "A review of nanometer resolution position sensors",
       Sensors and Actuators A 190 (2013) 106-126: drift of sensors.
    """

    slope: float = number("Y/s", "steady rate")
    path: tuple[float, ...] = numbers(
        "Y", "values at evenly spaced times, the last at the end", optional=True
    )

    def simulate(self, z: FloatArray, u: FloatArray, dt: float) -> FloatArray:
        """Add the drift."""
        place = np.arange(len(z))
        y = z + self.slope * dt * place
        if self.path:
            knots = np.linspace(0.0, max(len(z) - 1, 1), len(self.path) + 1)
            y += np.interp(place, knots, (0.0, *self.path))
        return y

    def step(self, sampling: Sampling) -> Step:
        """Count the samples; a path keeps its last value after its record's end.

        Raises
        ------
        InputError
            If there is a path and nobody says how long its record is.
        """
        if self.path and sampling.duration_s is None:
            raise InputError(
                "drift: path: spread over one record, whose length is not known here; "
                "expected --duration, or a model without the path"
            )
        path, spacing = np.array((0.0, *self.path)), 1.0
        if self.path and sampling.duration_s is not None:
            spacing = sampling.duration_s / sampling.dt / len(self.path)
        constants = {
            "slope": self.slope * sampling.dt,
            "spacing": spacing,
            "values": len(path),
            "path": path,
        }
        return Step("drift", constants, {"count": 1})

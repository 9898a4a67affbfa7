"""What stands before and behind a machine, where no actuator has it."""

import numpy as np

from hystbench.challenge import kernels
from hystbench.challenge.plant.kind import Parameters, Reach
from hystbench.challenge.plant.machine import FINE
from hystbench.record import FloatArray


def bent(y: FloatArray, p: Parameters, r: Reach) -> FloatArray:
    """Bend the sensor's scale by a square and a cube."""
    z = y / r.output
    return np.asarray(y * (1.0 + p["quadratic"] * z + p["cubic"] * z**2))


def strained(y: FloatArray, p: Parameters, r: Reach) -> FloatArray:
    """Read beside it the strain of a glued foil, which goes with the square and slips.

    A play of the square over the largest output: a butterfly whose wings are no line.
    """
    square = (y / r.output) ** 2
    carried = kernels.run("hc_joint", p["half_width"], over=square)
    return np.asarray(y + p["weight"] * r.output * (square - carried))


def flood_wave(u: FloatArray, p: Parameters, r: Reach) -> FloatArray:
    """Let water run down an open channel: much of it comes sooner than little.

    Of a wide channel the speed of a wave goes with the flow to the power 2/5 (Manning's
    friction). Delays are those beyond the largest flow's; a wave that is overtaken is
    lost in the other's front.
    """
    flow = np.clip(u / r.force, 0.05, 1.0)
    late = FINE * p["delay"] * (flow**-0.4 - 1.0)
    step = np.arange(len(u), dtype=np.float64)
    arrival = np.maximum.accumulate(step + late)
    return np.asarray(np.interp(step, arrival, u))

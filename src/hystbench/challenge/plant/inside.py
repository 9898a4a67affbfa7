"""What can be hidden in a machine: forces inside, and curves before and behind it.

The effects and their forces stand in ``inside.yaml``.
"""

import sys

import numpy as np

from hystbench.challenge.plant.kind import Parameters, Reach, read_kinds
from hystbench.record import FloatArray


def dead_zone(u: FloatArray, p: Parameters, r: Reach) -> FloatArray:
    """Give no force near zero."""
    width = p["half_width"] * r.force
    return np.asarray(np.sign(u) * np.maximum(np.abs(u) - width, 0.0))


def clip(u: FloatArray, p: Parameters, r: Reach) -> FloatArray:
    """Limit the force."""
    limit = p["limit"] * r.force
    return np.asarray(np.clip(u, -limit, limit))


def bent(y: FloatArray, p: Parameters, r: Reach) -> FloatArray:
    """Bend the sensor's scale by a square and a cube."""
    z = y / r.output
    return np.asarray(y * (1.0 + p["quadratic"] * z + p["cubic"] * z**2))


IN_MACHINE, APART = read_kinds("inside.yaml", sys.modules[__name__])
MACHINES = ("mass-spring", "free-mass", "pendulum", "impedance", "tank")


def hidden_in(family: str) -> tuple[str, ...]:
    """Give the names of what can be hidden in a family of machines."""
    return tuple(name for name, kind in IN_MACHINE.items() if family in kind.families)

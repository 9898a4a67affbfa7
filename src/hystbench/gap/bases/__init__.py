"""Bases: the simulator that disagrees with the measurements, given or identified."""

from hystbench.gap.bases.gpi import identified_gpi
from hystbench.gap.bases.linear import Linear, identified_linear

__all__ = ["Linear", "identified_gpi", "identified_linear"]

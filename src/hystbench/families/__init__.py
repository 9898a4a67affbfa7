"""Twins of other families: another hysteresis in the place of the twin's.

A twin made of generalized play operators favours a filter made of them. Here its block
``gpi`` gives way to Preisach or Jiles-Atherton hysteresis, fitted to the twin's own
slow loop and to the RMS displacements that the paper's tables imply for the calibration
signals. The dynamics stay.
"""

from hystbench.families.fit import FamilyFit, fit_family
from hystbench.families.kinds import FAMILIES, Family, Unknown
from hystbench.families.task import ASYMMETRY, OFFSET, Task

__all__ = [
    "ASYMMETRY",
    "FAMILIES",
    "OFFSET",
    "Family",
    "FamilyFit",
    "Task",
    "Unknown",
    "fit_family",
]

"""The families: what is free in the hysteresis of each."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace

from hystbench.blocks.base import Block
from hystbench.blocks.jiles_atherton import LARGEST_COUPLING, JilesAtherton
from hystbench.blocks.preisach import Preisach

CLUSTERS = 3
"""Clusters of relays: in trials one left 1.7 % of the loop, two 1.2, three 0.3 to 1."""

Values = Mapping[str, float]


@dataclass(frozen=True)
class Unknown:
    """A number that the fit may choose.

    Parameters
    ----------
    name : str
        A parameter of the family's block, or ``block.parameter`` in the rest.
    low, high : float
        Bounds.
    logarithmic : bool
        Whether the search moves in the logarithm.
    unit : {"U", "Y", "Y/U", "-"}
        What the bounds count in until they are scaled: the largest input, the swing of
        the output, their ratio, or one.
    """

    name: str
    low: float
    high: float
    logarithmic: bool = False
    unit: str = "-"

    def value(self, place: float) -> float:
        """Give the value at a place from 0 to 1 between the bounds."""
        if self.logarithmic:
            return float(self.low * (self.high / self.low) ** place)
        return self.low + place * (self.high - self.low)

    def place(self, value: float) -> float:
        """Give the place of a value, for bounds that are not logarithmic."""
        return (value - self.low) / (self.high - self.low)

    def scaled(self, largest: float, swing: float) -> Unknown:
        """Give the bounds in units of the model's input and output."""
        by = {"U": largest, "Y": swing, "Y/U": swing / largest, "-": 1.0}[self.unit]
        return replace(self, low=self.low * by, high=self.high * by, unit="-")


@dataclass(frozen=True)
class Family:
    """A kind of hysteresis.

    Parameters
    ----------
    name : str
        Of its block.
    unknowns : tuple of Unknown
    block : callable
        Makes the block from the unknowns' values and the largest input.
    derived : mapping of str to str
        Parameters that are not fitted, and where they come from.
    """

    name: str
    unknowns: tuple[Unknown, ...]
    block: Callable[[Values, float], Block]
    derived: Mapping[str, str]


def preisach(values: Values, largest: float) -> Block:
    """Make the block ``preisach``; its relays reach 5 % beyond the largest input."""
    lists = {
        key: [values[f"{key}[{i}]"] for i in range(CLUSTERS)] for key in PREISACH_LISTS
    }
    limit = float(f"{1.05 * largest:.4g}")
    return Preisach.from_mapping(
        {"limit": limit, "reversible": values["reversible"], **lists}
    )


def jiles_atherton(values: Values, largest: float) -> Block:
    """Make the block ``jiles-atherton``; its coupling is a share of the shape."""
    share = {"coupling": float(f"{values['coupling'] * values['shape']:.6g}")}
    return JilesAtherton(**{**values, **share})


PREISACH_LISTS = {
    "weights": (1e-3, 3.0, True, "Y"),
    "centres": (-1.0, 1.0, False, "U"),
    "centre_spreads": (0.1, 3.0, True, "U"),
    "half_widths": (0.0, 1.0, False, "U"),
    "half_width_spreads": (0.05, 1.0, True, "U"),
}
FAMILIES = {
    "preisach": Family(
        "preisach",
        (
            Unknown("reversible", 1e-3, 1.0, True, "Y/U"),
            *(
                Unknown(f"{key}[{i}]", *about)
                for i in range(CLUSTERS)
                for key, about in PREISACH_LISTS.items()
            ),
        ),
        preisach,
        {"limit": "5 % beyond the largest input of the calibration signals."},
    ),
    "jiles-atherton": Family(
        "jiles-atherton",
        (
            Unknown("saturation", 0.3, 30.0, True, "Y"),
            Unknown("shape", 0.05, 10.0, True, "U"),
            Unknown("coupling", 0.0, 0.97 * LARGEST_COUPLING),
            Unknown("pinning", 0.01, 3.0, True, "U"),
            Unknown("reversibility", 0.0, 1.0),
            Unknown("bias", -2.0, 2.0, False, "U"),
        ),
        jiles_atherton,
        {},
    ),
}

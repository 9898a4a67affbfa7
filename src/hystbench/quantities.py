"""What physical quantities a device takes and gives, and which causes the other."""

from dataclasses import dataclass
from typing import Literal, get_args

from hystbench.errors import InputError, nearest
from hystbench.units import NONE, alike, plain

Quantity = Literal[
    "position",
    "velocity",
    "acceleration",
    "force",
    "voltage",
    "current",
    "temperature",
    "level",
    "none-known",
]
Causality = Literal["force to motion", "motion to force", "storage", "unknown"]

QUANTITIES: tuple[Quantity, ...] = get_args(Quantity)

#: What a unit measures where nobody says otherwise. An angle counts as a position, a
#: torque as a force.
_OF_UNITS: dict[str, Quantity] = {
    "m": "position",
    "rad": "position",
    "m/s": "velocity",
    "rad/s": "velocity",
    "m/s^2": "acceleration",
    "rad/s^2": "acceleration",
    "N": "force",
    "N*m": "force",
    "V": "voltage",
    "A": "current",
    "K": "temperature",
}
_MOTION = ("position", "velocity", "acceleration")
#: What drives a device: a voltage or a current makes a force in it.
_DRIVE = ("force", "voltage", "current")
#: What fills a store: heat or a liquid.
_STORED = ("level", "temperature")
#: What a transducer gives in the place of any other quantity.
_SIGNALS = ("voltage", "current", "none-known")


@dataclass(frozen=True)
class Quantities:
    """What a device takes and gives."""

    input: Quantity = "none-known"
    output: Quantity = "none-known"

    @property
    def causality(self) -> Causality:
        """Which causes the other: a force a motion, a motion a force, or a store fills.

        A voltage or a current in and a motion out is a force that makes a motion. A
        level or a temperature as output is a store. Anything else is unknown, two
        voltages among them.
        """
        if self.output in _STORED:
            return "storage"
        if self.input in _DRIVE and self.output in _MOTION:
            return "force to motion"
        if self.input in _MOTION and self.output == "force":
            return "motion to force"
        return "unknown"


NONE_KNOWN = Quantities()
"""Quantities of a device of which nothing is told."""


def angle_in(unit: str) -> str:
    """Give the unit of the angle whose motion a unit measures: rad, deg or neither."""
    names = {"rad": "rad", "deg": "deg", "°": "deg"}
    of = plain(unit)
    return next((names[name] for name in names if of.startswith(name)), "")


def quantity_of(place: str, unit: str, told: str | None = None) -> Quantity:
    """Tell what a channel measures, from its unit and what is said of it.

    Parameters
    ----------
    place : str
        Where the channel stands, for the message.
    unit : str
    told : str, optional
        The quantity as the user gives it. A unit of a signal (V, A, or none that is
        known) may stand for any quantity, a length also for a level.

    Raises
    ------
    InputError
        If the unit is none, the quantity has no such name, or the unit measures
        another one.
    """
    found: Quantity = "none-known"
    if plain(unit) not in NONE:
        reference = alike(f"{place}: unit", unit, _OF_UNITS)
        found = _OF_UNITS[reference] if reference else "none-known"
    if told is None:
        return found
    if told not in QUANTITIES:
        raise InputError(f"{place}: quantity: {told!r}; {nearest(told, QUANTITIES)}")
    if found not in (*_SIGNALS, told) and (found, told) != ("position", "level"):
        also = " or level" if found == "position" else ""
        raise InputError(
            f"{place}: quantity: {told!r}, but its unit {unit!r} is one of {found}; "
            f"expected {found}{also}"
        )
    return told

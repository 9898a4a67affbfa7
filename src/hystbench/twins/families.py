"""Twins of other families: another hysteresis in the place of the twin's.

A twin made of generalized play operators favours a filter made of them. Here its block
``gpi`` gives way to Preisach or Jiles-Atherton hysteresis, fitted to the twin's own
slow loop and to the RMS displacements that the paper's tables imply for the calibration
signals. The dynamics stay.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace

import numpy as np

from hystbench.blocks.base import Block
from hystbench.blocks.jiles_atherton import LARGEST_COUPLING, JilesAtherton
from hystbench.blocks.preisach import Preisach
from hystbench.errors import InputError
from hystbench.measurement import measure
from hystbench.metrics import relative_error
from hystbench.model import Model
from hystbench.record import FloatArray
from hystbench.signals import Signal
from hystbench.twins.search import Unknown, Values

CLUSTERS = 3
"""Clusters of relays: in trials one left 1.7 % of the loop, two 1.2, three 0.3 to 1."""
THINNING = 40
"""Of the slow record every 40th sample is fitted."""
OFFSET = "calibration-error.offset"
ASYMMETRY = "asymmetry.coefficient"


@dataclass(frozen=True)
class Family:
    """A kind of hysteresis.

    Parameters
    ----------
    name : str
        Of its block.
    unknowns : tuple of Unknown
        Bounds in units of the largest input (``U``), of the swing of the output
        (``Y``), of their ratio (``Y/U``) or of one.
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
    "weights": ("Y", 1e-3, 3.0, True),
    "centres": ("U", -1.0, 1.0, False),
    "centre_spreads": ("U", 0.1, 3.0, True),
    "half_widths": ("U", 0.0, 1.0, False),
    "half_width_spreads": ("U", 0.05, 1.0, True),
}
FAMILIES = {
    "preisach": Family(
        "preisach",
        (
            Unknown("reversible", "Y/U", 1e-3, 1.0, True),
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
            Unknown("saturation", "Y", 0.3, 30.0, True),
            Unknown("shape", "U", 0.05, 10.0, True),
            Unknown("coupling", "-", 0.0, 0.97 * LARGEST_COUPLING),
            Unknown("pinning", "U", 0.01, 3.0, True),
            Unknown("reversibility", "-", 0.0, 1.0),
            Unknown("bias", "U", -2.0, 2.0),
        ),
        jiles_atherton,
        {},
    ),
}


def scaled(unknown: Unknown, largest: float, swing: float) -> Unknown:
    """Give an unknown with its bounds in units of the model's input and output."""
    by = {"U": largest, "Y": swing, "Y/U": swing / largest, "-": 1.0}[unknown.unit]
    low, high = unknown.low * by, unknown.high * by
    return replace(unknown, low=low, high=high, unit="-")


@dataclass(frozen=True)
class FamilyTask:
    """What a family is fitted to.

    Parameters
    ----------
    model : Model
        The twin; its chain starts with its one ``gpi``.
    loop : Signal
        The slow signal whose loop is to be kept.
    signals : tuple of Signal
        The calibration signals.
    rms : tuple of float
        The RMS displacement of each, as the tables imply it.
    seed : int
        Of the sensor noise, as for ``hystbench measure``, and of the starts.

    Raises
    ------
    InputError
        If the chain is another.
    """

    model: Model
    loop: Signal
    signals: tuple[Signal, ...]
    rms: tuple[float, ...]
    seed: int

    def __post_init__(self) -> None:
        """Refuse a chain without a ``gpi`` to replace or an offset to fit."""
        names = [block.name for block in self.model.chain]
        if names[0] != "gpi" or names.count("gpi") > 1:
            raise InputError(
                f"{self.model.name}: chain: {', '.join(names)} given, expected one "
                "'gpi', at its start"
            )
        self.model.value(OFFSET)

    @property
    def largest(self) -> float:
        """Largest magnitude of all inputs."""
        every = (self.loop, *self.signals)
        return max(float(np.abs(each.u).max()) for each in every)

    def unknowns(self, family: Family) -> tuple[Unknown, ...]:
        """Give the family's unknowns, then those of the rest of the chain."""
        swing = float(np.ptp(self.gpi_loop))
        own = [scaled(item, self.largest, swing) for item in family.unknowns]
        rest = [Unknown(OFFSET, "-", -swing, swing)]
        if ASYMMETRY in self.model.parameter_names():
            rest.append(Unknown(ASYMMETRY, "-", -0.5 / swing, 0.5 / swing))
        return (*own, *rest)

    def twin(self, family: Family, values: Values) -> Model:
        """Put the family's block in the place of ``gpi``."""
        own = {key: value for key, value in values.items() if "." not in key}
        block = family.block(own, self.largest)
        return replace(
            self.model,
            name=f"{self.model.name}-{family.name}",
            chain=(block, *self.model.chain[1:]),
            free=(),
            provenance={},
        ).with_values({key: values[key] for key in values if "." in key})

    @property
    def gpi_loop(self) -> FloatArray:
        """Output of the twin's hysteresis alone for the thinned slow signal."""
        u = self.loop.u[::THINNING]
        return self.model.chain[0].simulate(u, u, THINNING * self.loop.dt)

    def loop_of(self, twin: Model) -> FloatArray:
        """Output of a whole twin without noise for the slow signal, thinned."""
        return twin.simulate(self.loop.u, self.loop.dt)[::THINNING]

    def rms_errors(self, twin: Model) -> FloatArray:
        """RMS of each signal's record over the implied one, minus one."""
        settings = {"seed": self.seed, "input_zero_error": 0.0, "input_noise": 0.0}
        records = [measure(each, twin, settings, twin.name) for each in self.signals]
        found = [np.sqrt(np.mean(record.y**2)) for record in records]
        return np.array(found) / self.rms - 1

    def loop_error(self, twin: Model) -> float:
        """Relative error of a twin's slow loop against that of the task's model."""
        loop = self.loop_of(self.model)
        return relative_error(self.loop_of(twin) - loop, loop)

    def number(self, name: str) -> float:
        """Give a parameter of the model that is a number."""
        value = self.model.value(name)
        if not isinstance(value, float):
            raise TypeError(f"{name} is no number")
        return value

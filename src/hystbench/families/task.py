"""What a family is fitted to, and how near a twin comes to it."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from hystbench.errors import InputError
from hystbench.families.kinds import Family, Unknown, Values
from hystbench.measurement import measure
from hystbench.metrics import relative_error
from hystbench.model import Model
from hystbench.record import FloatArray
from hystbench.signals import Signal

THINNING = 40
"""Of the slow record every 40th sample is fitted."""
OFFSET = "calibration-error.offset"
ASYMMETRY = "asymmetry.coefficient"


@dataclass(frozen=True)
class Task:
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
        Of the sensor noise, as for ``hystbench job measure``, and of the starts.

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
        own = [item.scaled(self.largest, swing) for item in family.unknowns]
        rest = [Unknown(OFFSET, -swing, swing)]
        if ASYMMETRY in self.model.parameter_names():
            rest.append(Unknown(ASYMMETRY, -0.5 / swing, 0.5 / swing))
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

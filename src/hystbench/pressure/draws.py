"""The random sum drawn many times: one draw of its phases is a lottery.

Each draw has its own phases and its own noise. Beside the reading of config.yaml other
numbers of sines are run, so that what a reading changes can be seen.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from statistics import median
from typing import Any

import numpy as np

from hystbench.compare.draws import Draw
from hystbench.pressure.fits import run_rdgpi
from hystbench.pressure.runs import (
    Settings,
    draw_signals,
    filter_jobs,
    measure_twin,
    run_records,
)
from hystbench.pressure.twins import Twin
from hystbench.published import Pair
from hystbench.rdgpi import RateDependentGPI


def run_draws(
    twin: Twin,
    settings: Settings,
    identified: Mapping[str, Any],
    rdgpi: RateDependentGPI | None,
) -> list[Draw]:
    """Run all models on each draw of the random sum, for each number of sines.

    Parameters
    ----------
    twin : Twin
    settings : mapping
        ``signal`` (its name), ``definition`` and ``common`` as of ``hystbench
        signal``, ``measure``, ``filters``, ``draws`` (how many) and ``other_sines``.
    identified : mapping
        Result of Algorithm 1, for identified envelopes.
    rdgpi : RateDependentGPI or None
        The identified RDGPI model.
    """
    name = settings["signal"]
    ((kind, given),) = settings["definition"].items()
    found = []
    for sines in (given["sines"], *settings["other_sines"]):
        definition = {kind: {**given, "sines": sines}}
        job = {name: {"definition": definition, "common": settings["common"]}}
        for draw in range(settings["draws"]):
            signals = draw_signals(job, draw).values()
            records = measure_twin(twin, signals, settings["measure"], draw)
            rms = float(np.sqrt(np.mean(records[name].y ** 2)))
            runs = dict(run_rdgpi(rdgpi, records))
            for model, own in filter_jobs(settings).items():
                runs |= run_records(model, own, records, identified)
            found += [
                Draw(sines, draw, model, run.error("mse"), run.error("re"), rms)
                for (_, model), run in runs.items()
            ]
    return found


@dataclass(frozen=True)
class Reading:
    """What a number of sines gives: the median and the range over the draws."""

    sines: int
    quantity: str
    published: float
    median: float
    low: float
    high: float

    @property
    def ratio(self) -> float:
        """The median over the published one."""
        return self.median / self.published


def readings(
    draws: Sequence[Draw], published: Sequence[Pair], implied_rms: float
) -> list[Reading]:
    """Sum the draws up: RMS displacement, then the MSE of each model.

    Parameters
    ----------
    draws : sequence of Draw
    published : sequence of Pair
        The paper's errors on the signal.
    implied_rms : float
        RMS displacement (um) that they imply.
    """
    found = []
    printed = {pair.model: pair.mse.value for pair in published}
    for sines in dict.fromkeys(each.sines for each in draws):
        mine = [each for each in draws if each.sines == sines]
        parts = {"RMS displacement (um)": (implied_rms, {d.draw: d.rms for d in mine})}
        for model in dict.fromkeys(each.model for each in mine):
            own = {d.draw: d.mse for d in mine if d.model == model}
            parts[f"MSE of {model} (um^2)"] = (printed[model], own)
        found += [
            Reading(
                sines,
                quantity,
                wanted,
                median(values.values()),
                min(values.values()),
                max(values.values()),
            )
            for quantity, (wanted, values) in parts.items()
        ]
    return found

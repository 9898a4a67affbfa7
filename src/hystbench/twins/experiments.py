"""Experiments that the paper leaves open: step sizes, zero error, noise and phases.

On each twin the claims are judged in the configured experiment and in others that are
drawn. A step size never goes beyond the stability margin of the calibration: an
experimenter would have seen that filter grow without end.
"""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from hystbench.adaptive import make_filter
from hystbench.filters import MOST_CORRECTION
from hystbench.published import FILTERS
from hystbench.record import Record
from hystbench.twins.runs import Settings


@dataclass(frozen=True)
class TwinExperiment:
    """What is changed in an experiment."""

    seed: int
    """Draw of the noise and of the random sum's phases; 0 is the configured one."""
    steps: dict[str, float]
    """Factor on the step sizes of each filter."""
    zero: float
    noise: float
    """Factors on the zero error and on the noise of the recorded input."""

    def measured(self, settings: Settings) -> dict[str, Any]:
        """Give the settings of the measurement with zero error and noise changed."""
        factors = {"input_zero_error": self.zero, "input_noise": self.noise}
        return dict(settings) | {
            key: factor * settings[key] for key, factor in factors.items()
        }


CONFIGURED = TwinExperiment(0, dict.fromkeys(FILTERS, 1.0), 1.0, 1.0)
"""The experiment of config.yaml."""


def experiments(design: Settings, place: int) -> list[TwinExperiment]:
    """Draw the other experiments of a twin.

    Parameters
    ----------
    design : mapping
        ``members`` (how many), ``step_factors``, ``zero_factors``, ``noise_factors``.
    place : int
        Which twin it is: each has draws of its own.
    """
    found = []
    for number in range(1, design["members"] + 1):
        rng = np.random.default_rng([place, number])
        drawn = rng.choice(design["step_factors"], len(FILTERS))
        found.append(
            TwinExperiment(
                seed=place * design["members"] + number,
                steps=dict(zip(FILTERS, map(float, drawn), strict=True)),
                zero=float(rng.choice(design["zero_factors"])),
                noise=float(rng.choice(design["noise_factors"])),
            )
        )
    return found


def within_margin(
    model: str,
    job: Settings,
    factor: float,
    records: Iterable[Record],
    identified: Mapping[str, Any],
) -> dict[str, Any]:
    """Scale a filter's step sizes, but not beyond the margin on any of some records."""
    most = 0.0
    for record in records:
        adaptive = make_filter(model, job, record, identified)
        most = max(most, adaptive.correction(adaptive.largest_power(record.u)))
    times = min(factor, MOST_CORRECTION / most) if most else factor
    steps = {name: times * mu for name, mu in job["convergence_factor"].items()}
    return {**job, "convergence_factor": steps}

"""The naive ranker: every effect by plain least squares, an information criterion.

For each effect a bounded fit on the fit records; the least of squared error over the
noise's power plus ``k log(n)`` is named first. The base is never reshaped, every sample
counts, and one effect is named: what a careful beginner would do.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np

from hystbench.entrants.task import Named, noise_rms, read, write
from hystbench.refit import Fitted, Task, effects, fit


def solve(dataset: Path, model: Path, out: Path) -> None:
    """Name the effect of the least criterion, if it is below the base's own.

    Parameters
    ----------
    dataset, model, out : Path
        As every solver's.
    """
    given = read(dataset, model)
    task = Task(given.model, given.fit)
    noise = noise_rms(given)
    found = [item for name in effects() if (item := fit(task, name)) is not None]
    scored = sorted((criterion(item, task, noise), item.effect) for item in found)
    samples = len(task.measured)
    base = samples * float(np.mean((task.base - task.measured) ** 2)) / noise**2
    least, best = scored[0]
    if least >= base:
        write(given, [], "no-gap", "No effect pays.", given.base, out)
        return
    chosen = next(item for item in found if item.effect == best)
    # differences of the criterion as log-odds, as is usually done
    weights = np.exp(-0.5 * (np.array([score for score, _ in scored]) - least))
    ties = tuple(name for score, name in scored[1:] if score - least < np.log(samples))
    named = Named(best, float(weights[0] / weights.sum()), ties)
    write(given, [named], "named", "Least criterion.", chosen.predict, out)


def criterion(found: Fitted, task: Task, noise: float) -> float:
    """Squared error over the noise's power, plus the log of samples a parameter."""
    samples = len(task.measured)
    return samples * found.mean_square / noise**2 + found.freedom * float(
        np.log(samples)
    )

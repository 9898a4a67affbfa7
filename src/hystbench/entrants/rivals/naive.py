"""``naive``: every effect by plain least squares, as a careful beginner would.

Each effect gets a bounded fit on the fit records. The one with the least of squared
error over the noise's power plus ``k log(n)`` is named. What it explains is taken off
the records, and the same is done with what is left, as long as the criterion falls. The
base is never reshaped, and all samples count.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from hystbench.entrants.rivals.base import (
    Answer,
    Given,
    NamedEffect,
    PythonSolver,
    noise_rms,
)
from hystbench.plain_fits import EffectFit, Task, effects, fit
from hystbench.record import FloatArray, Record

MOST_EFFECTS = 4
"""Effects that are named, at most."""


class NaiveRanker(PythonSolver):
    """Names effects of the least criterion, one after the other, while it falls."""

    name = "naive"

    def answer(self, given: Given) -> Answer:
        """Name what pays."""
        task, noise = Task(given.model, given.fit), noise_rms(given)
        taken: list[tuple[NamedEffect, EffectFit]] = []
        while len(taken) < MOST_EFFECTS:
            found = best(task, noise, {named.name for named, _ in taken})
            if found is None:
                break
            taken.append(found)
            task = without(task, found[1])

        def predict(record: Record) -> FloatArray:
            base = given.base(record)
            return base + sum(fitted.predict(record) - base for _, fitted in taken)

        if not taken:
            return Answer(predict, "no-gap", "No effect pays.")
        names = [named for named, _ in taken]
        return Answer(predict, "named", "Least criterion.", names)


def best(
    task: Task, noise: float, known: set[str]
) -> tuple[NamedEffect, EffectFit] | None:
    """Fit every effect that is not named yet; none where the base alone does better."""
    names = [name for name in effects() if name not in known]
    found = [item for name in names if (item := fit(task, name)) is not None]
    scored = sorted((criterion(item, task, noise), item.effect) for item in found)
    samples = len(task.measured)
    base = samples * float(np.mean((task.base - task.measured) ** 2)) / noise**2
    least, name = scored[0]
    if least >= base:
        return None
    chosen = next(item for item in found if item.effect == name)
    # differences of the criterion as log-odds, as is usually done
    weights = np.exp(-0.5 * (np.array([score for score, _ in scored]) - least))
    ties = tuple(name for score, name in scored[1:] if score - least < np.log(samples))
    return NamedEffect(name, float(weights[0] / weights.sum()), ties), chosen


def without(task: Task, found: EffectFit) -> Task:
    """Take what an effect explains off the records."""
    ends = np.cumsum([len(record) for record in task.records])[:-1]
    parts = np.split(task.measured - (found.output - task.base), ends)
    records = [
        replace(record, y=y) for record, y in zip(task.records, parts, strict=True)
    ]
    return Task(task.model, records)


def criterion(found: EffectFit, task: Task, noise: float) -> float:
    """Squared error over the noise's power, plus the log of samples a parameter."""
    samples = len(task.measured)
    return samples * found.mean_square / noise**2 + found.freedom * float(
        np.log(samples)
    )

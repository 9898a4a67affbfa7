"""The rivals of the gap's solver: what a careful beginner would do, and what luck does.

Each gives an :class:`Answer` to what is :class:`Given`; gap.json is written of it.

The naive ranker tries every effect by plain least squares. For each a bounded fit on
the fit records; the least of squared error over the noise's power plus ``k log(n)`` is
named. What it explains is taken off the records, and the same is done with what is
left, as long as the criterion falls. The base is never reshaped, and all samples count.
"""

import hashlib
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from hystbench.dataset import load_dataset
from hystbench.files import write_json
from hystbench.metrics import rms
from hystbench.model import Model, load_model
from hystbench.plain_fits import EffectFit, Task, effects, fit
from hystbench.record import FloatArray, Record

#: Predicts the output of a record.
Predict = Callable[[Record], FloatArray]
MOST_EFFECTS = 4
"""Effects that are named, at most."""


@dataclass(frozen=True)
class Given:
    """A dataset and the model it is held against."""

    name: str
    model: Model
    fit: tuple[Record, ...]
    hold_out: tuple[Record, ...]
    model_file: Path = Path()
    """Where the model was read."""

    def base(self, record: Record) -> FloatArray:
        """Give the base's output."""
        return self.model.simulate(record.u, record.dt)


@dataclass(frozen=True)
class NamedEffect:
    """An effect that a rival names."""

    name: str
    confidence: float
    cannot_be_told_from: tuple[str, ...] = ()


@dataclass(frozen=True)
class Answer:
    """What a rival says of a dataset."""

    predict: Predict
    """The model that is to close the gap, for the hold-out records."""
    verdict: str = "unnamed"
    reason: str = "Nothing is named."
    named: Sequence[NamedEffect] = ()
    """In their order."""


def read(dataset: Path, model: Path) -> Given:
    """Read what a solver gets.

    Raises
    ------
    InputError
        If a file is not what it should be.
    """
    about = load_dataset(dataset)
    records = [about.read(name) for name in about.record_files]
    return Given(
        about.name,
        load_model(model).with_hold(about.input_hold),
        tuple(record for record in records if record.use == "fit"),
        tuple(record for record in records if record.use == "hold-out"),
        model,
    )


def noise_rms(given: Given) -> float:
    """Estimate the noise from repeated periods; from the residual where none repeat."""
    squares, count = 0.0, 0
    for record in given.fit:
        period = record.period_samples
        # the first period holds the switch-on
        whole = len(record) // period - 1 if period else 0
        if whole >= 2 and period:
            repeats = record.y[-whole * period :].reshape(whole, period)
            squares += float(np.sum((repeats - repeats.mean(axis=0)) ** 2))
            count += (whole - 1) * period
    if count:
        return float(np.sqrt(squares / count))
    return rms(*(record.y - given.base(record) for record in given.fit))


def write(given: Given, answer: Answer, out: Path) -> None:
    """Write gap.json into a folder."""
    before = rms(*(record.y - given.base(record) for record in given.hold_out))
    with np.errstate(over="ignore", invalid="ignore"):
        left = rms(*(record.y - answer.predict(record) for record in given.hold_out))
    floor = noise_rms(given)
    repeats = any(r.period_samples for r in (*given.fit, *given.hold_out))
    method = "repeats" if repeats else "upper-bound"
    above = before**2 - floor**2
    # A model that runs away on a record closes nothing.
    after = left if np.isfinite(left) else None
    explained: float | None = 0.0
    if after is not None:
        explained = (before**2 - after**2) / above if above > 0 else None
    effects = [
        {
            "name": item.name,
            "place": "",
            "parameters": {},
            "confidence": item.confidence,
            "cannot_be_told_from": list(item.cannot_be_told_from),
        }
        for item in answer.named
    ]
    content: dict[str, Any] = {
        "dataset": given.name,
        "model": given.model.name,
        "unit": given.model.output.unit,
        "verdict": answer.verdict,
        "reason": answer.reason,
        "effects": effects,
        "where": [],
        "gap": {
            "before": before,
            "after": after,
            "noise_floor": floor,
            "floor_method": method,
            "explained": explained,
        },
        "ranking": [],
        "next_experiment": None,
    }
    write_json(out / "gap.json", content)


def naive(given: Given) -> Answer:
    """Name effects of the least criterion, one after the other, while it falls."""
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
    return Answer(predict, "named", "Least criterion.", [named for named, _ in taken])


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


def any_name(given: Given) -> Answer:
    """Draw a name, or no-gap, from the bytes of the model file: the same each time.

    What luck alone scores.
    """
    content = given.model_file.read_bytes()
    seed = int.from_bytes(hashlib.sha256(content).digest()[:8], "big")
    random = np.random.default_rng(seed)
    names = [*effects(), None]
    chosen = names[int(random.integers(len(names)))]
    if chosen is None:
        return Answer(given.base, "no-gap", "Drawn.")
    named = [NamedEffect(chosen, 1.0 / len(names))]
    return Answer(given.base, "named", "Drawn.", named)


RIVALS: dict[str, Callable[[Given], Answer]] = {"naive": naive, "random": any_name}
"""What each rival answers, by its name."""

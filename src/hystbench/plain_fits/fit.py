"""Fits of one effect, each kind in its own way."""

from collections.abc import Callable, Iterable, Sequence

import numpy as np

from hystbench.blocks.attached import attached
from hystbench.blocks.rate_dependent_hysteresis import FORMS
from hystbench.model import Model
from hystbench.operators import play
from hystbench.plain_fits.search import search
from hystbench.plain_fits.table import PLACE_IN_CHAIN, next_to, place_of, searched_of
from hystbench.plain_fits.task import EffectFit, Task, through
from hystbench.record import FloatArray, Record

#: Plays that stand for hysteresis of any shape.
PLAYS = 10
#: Frequencies that a mains tone is looked for at, in Hz.
MAINS = np.concatenate([np.linspace(49.8, 50.2, 17), np.linspace(59.8, 60.2, 17)])


def fit(task: Task, effect: str) -> EffectFit | None:
    """Fit one effect; None where it makes no sense in the chain.

    Parameters
    ----------
    task : Task
    effect : str
        Name of the vocabulary.
    """
    if effect in ("hysteresis", "hysteresis-shape"):
        return _fit_plays(task, effect)
    if effect == "mains-pickup":
        tones = [_fit_beside(task, effect, f, _tones) for f in MAINS]
        return min(tones, key=lambda item: item.mean_square)
    if effect == "drift":
        return _fit_beside(task, effect, 0.0, _slow)
    place = place_of(task, effect)
    if place is None:
        return None
    searched = searched_of(task, effect)
    if effect == "rate-dependent-hysteresis":
        forms = [search(task, effect, place, searched, form) for form in FORMS]
        return min(forms, key=lambda item: item.mean_square)
    return search(task, effect, place, searched)


def effects() -> tuple[str, ...]:
    """Name all effects that :func:`fit` knows."""
    return (*PLACE_IN_CHAIN, "hysteresis", "hysteresis-shape", "mains-pickup", "drift")


def within_noise(
    model: Model,
    records: Sequence[Record],
    names: Iterable[str],
    reference: str,
    floor: float,
    noise_rms: float,
) -> tuple[str, ...]:
    """Give the effects that fit records as well as the true one, but for the noise.

    Parameters
    ----------
    model : Model
    records : sequence of Record
    names : iterable of str
    reference : str
        The effect that is there: it needs no proof.
    floor : float
        Mean square that the true effect leaves: noise, and the base's own error.
    noise_rms : float
        An effect is within the noise if it leaves no more than this above the floor,
        in mean squares.
    """
    task = Task(model, records)
    return tuple(
        name
        for name in names
        if name == reference or _leaves(task, name) <= floor + noise_rms**2
    )


def _leaves(task: Task, name: str) -> float:
    found = fit(task, name) if name in effects() else None
    return np.inf if found is None else found.mean_square


def _fit_plays(task: Task, effect: str) -> EffectFit | None:
    """Add plays of the input, and their squares, where the hysteresis is."""
    if (effect == "hysteresis") != (task.hysteresis is None):
        return None
    place = next_to(task, task.hysteresis or 0)
    rest = attached(task.model.chain[place:])
    thresholds = np.linspace(0.0, 0.9 * task.reach, PLAYS)

    def columns(record: Record) -> FloatArray:
        plays = play(np.ascontiguousarray(record.u), thresholds).T
        signals = map(np.ascontiguousarray, np.concatenate([plays, plays**2]))
        return np.stack([through(rest, y, record) for y in signals], axis=1)

    design = np.concatenate([columns(record) for record in task.records])
    missing = task.measured - task.base
    weights = np.linalg.lstsq(design, missing)[0]
    return EffectFit(
        effect,
        task.base + design @ weights,
        float(np.mean((missing - design @ weights) ** 2)),
        design.shape[1],
        {},
        lambda record: (
            task.model.simulate(record.u, record.dt) + columns(record) @ weights
        ),
    )


def _fit_beside(
    task: Task,
    effect: str,
    value: float,
    columns: Callable[[Record, float], FloatArray],
) -> EffectFit:
    """Add to each record a signal of its own that the input does not explain."""
    parts, freedom, start = [], 0, 0
    for record in task.records:
        stop = start + len(record)
        missing = record.y - task.base[start:stop]
        design = columns(record, value)
        parts.append(design @ np.linalg.lstsq(design, missing)[0])
        freedom += design.shape[1]
        start = stop
    output = task.base + np.concatenate(parts)
    return EffectFit(
        effect,
        output,
        float(np.mean((output - task.measured) ** 2)),
        freedom + (value != 0.0),
        {"frequency_hz": value} if value else {},
        lambda record: task.model.simulate(record.u, record.dt),
    )


def _tones(record: Record, frequency_hz: float) -> FloatArray:
    angle = 2.0 * np.pi * frequency_hz * record.time
    waves = [part for k in (1, 2, 3) for part in (np.sin(k * angle), np.cos(k * angle))]
    return np.stack(waves, axis=1)


def _slow(record: Record, _: float) -> FloatArray:
    time = record.time / max(record.time[-1], record.dt)
    return np.stack([time**k for k in range(1, 5)], axis=1)

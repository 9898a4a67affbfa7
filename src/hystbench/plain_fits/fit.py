"""Fits of one effect, each kind in its own way."""

from collections.abc import Callable, Iterable, Mapping, Sequence

import numpy as np

from hystbench.blocks import block_class
from hystbench.blocks.attached import attached
from hystbench.blocks.base import Block
from hystbench.blocks.held import HeldBlock
from hystbench.blocks.rate_dependent_hysteresis import FORMS
from hystbench.blocks.wrapping import WrappingBlock
from hystbench.model import Model
from hystbench.operators import play
from hystbench.plain_fits.table import (
    PLACE_IN_CHAIN,
    PROPORTIONAL_TO,
    next_to,
    place_of,
    searched_of,
)
from hystbench.plain_fits.task import EffectFit, Task, through
from hystbench.record import FloatArray, Record

#: Evaluations of a search from one start, Jacobians not counted.
EVALUATIONS = 8
#: Starts that a search descends from, the best of those that there are.
DESCENTS = 2
_LISTS = ("magnitudes", "time_constants_s")
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
    if effect == "rate-dependent-hysteresis":
        forms = [_search(task, effect, place, form) for form in FORMS]
        return min(forms, key=lambda item: item.mean_square)
    return _search(task, effect, place)


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


def _chain(
    task: Task, effect: str, place: int, values: Mapping[str, float], form: str = ""
) -> tuple[Block, ...]:
    chain = list(task.model.chain)
    block = block_class(effect)
    given: dict[str, object] = {
        key: (value,) if key in _LISTS else value for key, value in values.items()
    }
    if issubclass(block, HeldBlock):
        given["hold"] = "band-limited"
    if form:
        given["form"] = form
    if effect == "stiffness-hardening" and place < len(chain):
        mode = chain[place].to_mapping()
        chain[place] = block.from_mapping({**mode, **given})
    else:
        chain.insert(place, block.from_mapping(given))
    return tuple(chain)


def _search(task: Task, effect: str, place: int, form: str = "") -> EffectFit:
    """Fit the parameters of an effect's block to all records at once.

    ``place`` is that of the block in the chain, ``form`` one of several of its own.
    """
    from scipy.optimize import least_squares  # late: imported by jobs that fit only

    searched = searched_of(task, effect)
    names, items = list(searched), list(searched.values())
    before = _before(task, place, block_class(effect))

    def values(x: FloatArray) -> dict[str, float]:
        return {
            name: item.outer(v) for name, item, v in zip(names, items, x, strict=True)
        }

    def residual(x: FloatArray) -> FloatArray:
        chain = _chain(task, effect, place, values(x), form)
        error = _behind(task, chain, place, before) - task.measured
        # a mode that ran away has no output; the search is to turn back
        return np.nan_to_num(error, nan=task.size, posinf=task.size, neginf=-task.size)

    low = np.array([item.inner(item.low) for item in items])
    high = np.array([item.inner(item.high) for item in items])
    starts = [
        np.clip(
            [
                item.inner(item.starts[min(number, len(item.starts) - 1)])
                for item in items
            ],
            low,
            high,
        )
        for number in range(max(len(item.starts) for item in items))
    ]
    if effect in PROPORTIONAL_TO:
        number = names.index(PROPORTIONAL_TO[effect])
        starts = _scaled(task, starts, number, residual, low[number], high[number])
    found = [
        least_squares(
            residual, x, bounds=(low, high), max_nfev=EVALUATIONS, diff_step=1e-4
        )
        for x in starts[:DESCENTS]
    ]
    best = min(found, key=lambda item: float(item.cost))
    chosen = values(best.x)
    chain = _chain(task, effect, place, chosen, form)
    model = Model("fitted", task.model.input, task.model.output, chain)
    return EffectFit(
        effect,
        residual(best.x) + task.measured,
        2.0 * float(best.cost) / len(task.measured),
        len(names),
        chosen,
        lambda record: model.simulate(record.u, record.dt),
    )


def _scaled(
    task: Task,
    starts: list[FloatArray],
    number: int,
    residual: Callable[[FloatArray], FloatArray],
    low: float,
    high: float,
) -> list[FloatArray]:
    """Solve at each start for the parameter that scales the effect; the best first."""
    missing = task.measured - task.base
    rated = []
    for x in starts:
        added = residual(x) + missing
        square = float(added @ added) or 1.0
        factor = float(added @ missing) / square
        scaled = x.copy()
        scaled[number] = np.clip(factor * x[number], low, high)
        rated.append((factor**2 * square, tuple(scaled)))
    return [np.array(x) for _, x in sorted(rated, reverse=True)]


def _before(task: Task, place: int, block: type[Block]) -> list[FloatArray] | None:
    """Signals that enter a block, which do not change with its parameters."""
    if place == 0 or issubclass(block, WrappingBlock):
        return None
    head = Model("head", task.model.input, task.model.output, task.model.chain[:place])
    return [head.simulate(record.u, record.dt) for record in task.records]


def _behind(
    task: Task, chain: tuple[Block, ...], place: int, before: list[FloatArray] | None
) -> FloatArray:
    if before is None:
        model = Model("whole", task.model.input, task.model.output, chain)
        return task.output(model)
    rest = attached(chain[place:])
    entered = zip(before, task.records, strict=True)
    return np.concatenate([through(rest, y, record) for y, record in entered])

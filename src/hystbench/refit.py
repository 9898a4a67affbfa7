"""Plain fits of single effects to records: bounded least squares, and nothing more.

For each effect of the vocabulary one block at one place in the chain, fitted to all
records at once by the squared error from a few starts. No reshaping of the base, no
folds, no joint fits. It is what the naive rival goes by, and the judge's own way to
see whether an effect fits data within their noise.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from hystbench.blocks import registry
from hystbench.blocks.attached import AttachedBlock, attached
from hystbench.blocks.base import Block
from hystbench.blocks.held import HeldBlock
from hystbench.blocks.rate_dependent_hysteresis import FORMS
from hystbench.blocks.wrapping import HystereticBlock, WrappingBlock
from hystbench.model import Model
from hystbench.operators import play
from hystbench.record import FloatArray, Record

#: Evaluations of a search from one start, Jacobians not counted.
EVALUATIONS = 8
#: Starts that a search descends from, the best of those that there are.
DESCENTS = 2
#: Frequencies that a mode is looked for at, over the records' band.
MODES = 60
#: Plays that stand for hysteresis of any shape.
PLAYS = 10
#: Frequencies that a mains tone is looked for at, in Hz.
MAINS = np.concatenate([np.linspace(49.8, 50.2, 17), np.linspace(59.8, 60.2, 17)])


@dataclass(frozen=True)
class Fitted:
    """An effect fitted to records.

    Parameters
    ----------
    effect : str
    output : ndarray, shape (n,)
        With the effect, over all samples of all records, one after the other.
    mean_square : float
        Of the residual, over the same.
    freedom : int
        Parameters fitted.
    values : dict of str to float
        Of the block's parameters; empty where there is no block.
    predict : callable
        Output for another record. What is new in every record (a phase, a path) is
        unknown there and left out.
    """

    effect: str
    output: FloatArray
    mean_square: float
    freedom: int
    values: dict[str, float]
    predict: Callable[[Record], FloatArray]


@dataclass(frozen=True)
class Searched:
    """One parameter of a search: bounds, starts, and whether its sign is known."""

    low: float
    high: float
    starts: tuple[float, ...]

    @property
    def logarithmic(self) -> bool:
        """Whether the search goes by the logarithm."""
        return self.low > 0.0

    def inner(self, value: float) -> float:
        """Give what the search varies."""
        return float(np.log(value) if self.logarithmic else value / self.high)

    def outer(self, varied: float) -> float:
        """Give the parameter's value, within its bounds."""
        value = np.exp(varied) if self.logarithmic else varied * self.high
        return float(np.clip(value, self.low, self.high))


class Task:
    """A base model and the records to fit.

    Parameters
    ----------
    model : Model
        Its blocks take the input as band-limited unless they say otherwise.
    records : sequence of Record
    """

    def __init__(self, model: Model, records: Sequence[Record]) -> None:
        self.model = model.with_hold("band-limited")
        self.records = tuple(records)

    @cached_property
    def measured(self) -> FloatArray:
        """All outputs, one after the other."""
        return np.concatenate([record.y for record in self.records])

    @cached_property
    def base(self) -> FloatArray:
        """The base's output on all records."""
        return self.output(self.model)

    def output(self, model: Model) -> FloatArray:
        """Give a model's output on all records."""
        return np.concatenate(
            [model.simulate(record.u, record.dt) for record in self.records]
        )

    @cached_property
    def hysteresis(self) -> int | None:
        """Place of the hysteresis in the chain."""
        places = [
            number
            for number, block in enumerate(self.model.chain)
            if isinstance(block, HystereticBlock)
        ]
        return places[0] if places else None

    @cached_property
    def reach(self) -> float:
        """Largest magnitude of the input."""
        return max(float(np.abs(record.u).max()) for record in self.records)

    @cached_property
    def rate(self) -> float:
        """Largest rate of the input."""
        return max(
            float(np.abs(np.gradient(record.u, record.dt)).max())
            for record in self.records
        )

    @cached_property
    def size(self) -> float:
        """Largest magnitude of the measured output."""
        return float(np.abs(self.measured).max())

    @cached_property
    def step(self) -> float:
        """Shortest sampling interval."""
        return min(record.dt for record in self.records)

    @cached_property
    def span(self) -> float:
        """Longest record in seconds."""
        return max(record.dt * len(record) for record in self.records)


def fit(task: Task, effect: str) -> Fitted | None:
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
    place = _place(task, effect)
    if place is None:
        return None
    searched = _searched(task, effect)
    if effect == "rate-dependent-hysteresis":
        forms = [_search(task, effect, place, searched, form) for form in FORMS]
        return min(forms, key=lambda item: item.mean_square)
    return _search(task, effect, place, searched)


def effects() -> tuple[str, ...]:
    """Name all effects that :func:`fit` knows."""
    return (*_PLACES, "hysteresis", "hysteresis-shape", "mains-pickup", "drift")


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


# Where an effect acts: before the chain, just behind the hysteresis, or at its end.
_PLACES = {
    "input-delay": "start",
    "drive-lag": "start",
    "eddy-diffusion": "start",
    "drive-saturation": "start",
    "slew-limit": "start",
    "dead-zone": "start",
    "asymmetry": "material",
    "saturation": "material",
    "rate-dependent-hysteresis": "material",
    "resonance": "end",
    "stiffness-hardening": "mode",
    "friction": "end",
    "backlash": "end",
    "creep": "end",
    "thermal-drift": "end",
    "sensor-lag": "end",
    "sensor-nonlinearity": "end",
    "calibration-error": "end",
}


def _place(task: Task, effect: str) -> int | None:
    where, end = _PLACES[effect], len(task.model.chain)
    if where == "material":
        if task.hysteresis is None:
            return None if effect == "rate-dependent-hysteresis" else _next(task, 0)
        return _next(task, task.hysteresis)
    if where == "mode":
        names = [block.name for block in task.model.chain]
        return names.index("resonance") if "resonance" in names else end
    return 0 if where == "start" else end


def _next(task: Task, place: int) -> int:
    """Give the place behind a block and all that is attached to it."""
    chain = task.model.chain
    behind = place + 1
    while behind < len(chain) and isinstance(chain[behind], AttachedBlock):
        behind += 1
    return behind


def _searched(task: Task, effect: str) -> dict[str, Searched]:
    """Bounds and starts: from the records alone, and what physics allows."""
    step, span, reach, size = task.step, task.span, task.reach, task.size
    quick = Searched(step / 10, 100 * step, (step, 10 * step))
    small = Searched(-0.3 / size, 0.3 / size, (0.01 / size,))
    slow = Searched(span / 200, span, (span / 50, span / 8))
    share = Searched(-1.0, 1.0, (0.02,))
    mode = {
        "frequency_hz": Searched(2.0 / span, 0.45 / step, _frequencies(step)),
        "damping_ratio": Searched(1e-3, 0.3, (0.05,)),
        "participation": Searched(-1.0, 1.0, (0.1,)),
    }
    table: dict[str, dict[str, Searched]] = {
        "input-delay": {"delay_s": quick},
        "drive-lag": {"time_constant_s": quick},
        "eddy-diffusion": {"time_constant_s": quick},
        "drive-saturation": {"limit": Searched(reach / 10, reach, (0.8 * reach,))},
        "slew-limit": {"rate": Searched(task.rate / 100, task.rate, (task.rate / 3,))},
        "dead-zone": {"half_width": Searched(reach / 1e3, reach / 3, (reach / 30,))},
        "asymmetry": {"coefficient": small},
        "saturation": {"level": Searched(size / 2, 50 * size, (2 * size,))},
        "rate-dependent-hysteresis": {
            "coefficient": Searched(
                1e-4 * task.rate**-0.75,
                10.0 * task.rate**-0.75,
                (0.01 * task.rate**-0.75, 0.1 * task.rate**-0.75),
            ),
            "exponent": Searched(0.3, 1.5, (0.75,)),
        },
        "resonance": mode,
        "stiffness-hardening": {
            "coefficient": Searched(
                -1.0 / size**2, 3.0 / size**2, (1e-3 / size**2, 0.1 / size**2)
            )
        },
        "friction": {
            "coulomb": Searched(-0.2 * size, 0.2 * size, (0.01 * size,)),
            "velocity_scale": Searched(task.rate / 1e4, task.rate, (task.rate / 100,)),
        },
        "backlash": {"half_width": Searched(size / 1e4, size / 5, (size / 100,))},
        "creep": {"magnitudes": share, "time_constants_s": slow},
        "thermal-drift": {
            "coefficient": Searched(-size / reach**2, size / reach**2, (1e-2 * size,)),
            "time_constant_s": slow,
        },
        "sensor-lag": {"time_constant_s": quick},
        "sensor-nonlinearity": {
            "quadratic": small,
            "cubic": Searched(-0.3 / size**2, 0.3 / size**2, (1e-3 / size**2,)),
        },
        "calibration-error": {
            "gain": Searched(0.5, 1.5, (1.0,)),
            "offset": Searched(-0.2 * size, 0.2 * size, (0.0,)),
        },
    }
    has_mode = any(block.name == "resonance" for block in task.model.chain)
    if effect == "stiffness-hardening" and not has_mode:
        table[effect] |= mode
    return table[effect]


def _frequencies(step: float) -> tuple[float, ...]:
    """Spread evenly in their logarithm over two decades below the highest."""
    return tuple(float(f) for f in np.geomspace(0.0045 / step, 0.45 / step, MODES))


#: The parameter that the effect is proportional to.
_LINEAR = {
    "resonance": "participation",
    "friction": "coulomb",
    "creep": "magnitudes",
    "thermal-drift": "coefficient",
}
_LISTS = ("magnitudes", "time_constants_s")


def _chain(
    task: Task, effect: str, place: int, values: Mapping[str, float], form: str = ""
) -> tuple[Block, ...]:
    chain = list(task.model.chain)
    block = registry()[effect]
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


def _search(
    task: Task,
    effect: str,
    place: int,
    searched: Mapping[str, Searched],
    form: str = "",
) -> Fitted:
    from scipy.optimize import least_squares  # late: imported by jobs that fit only

    names = list(searched)
    items = list(searched.values())
    before = _before(task, place, registry()[effect])

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
    if effect in _LINEAR:
        number = names.index(_LINEAR[effect])
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
    return Fitted(
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
    out = []
    for record, signal in zip(task.records, before, strict=True):
        y = signal
        for step in attached(chain[place:]):
            y = step.simulate(y, record.u, record.dt)
        out.append(y)
    return np.concatenate(out)


def _fit_plays(task: Task, effect: str) -> Fitted | None:
    """Add plays of the input, and their squares, where the hysteresis is."""
    if (effect == "hysteresis") != (task.hysteresis is None):
        return None
    place = _next(task, task.hysteresis or 0)
    rest = attached(task.model.chain[place:])
    thresholds = np.linspace(0.0, 0.9 * task.reach, PLAYS)

    def columns(record: Record) -> FloatArray:
        plays = play(np.ascontiguousarray(record.u), thresholds)[0].T
        plays = np.concatenate([plays, plays**2])
        out = []
        for signal in plays:
            y = np.ascontiguousarray(signal)
            for step in rest:
                y = step.simulate(y, record.u, record.dt)
            out.append(y)
        return np.stack(out, axis=1)

    design = np.concatenate([columns(record) for record in task.records])
    missing = task.measured - task.base
    weights = np.linalg.lstsq(design, missing)[0]
    return Fitted(
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
) -> Fitted:
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
    return Fitted(
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

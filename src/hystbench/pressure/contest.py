"""The fair contest: each filter with its own best step size.

Two protocols. ``held-out``: one step size for all signals, chosen where the geometric
mean of the MSE over the calibration's signals is least, scored on the others.
``best``: for each signal the step size with the least MSE on it, as the paper's
"many experiments" may have chosen. LMS and normalized LMS have the same grid.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import product
from typing import Any, Literal

import numpy as np

from hystbench.adaptive import make_filter, step_bounds, step_names
from hystbench.errors import InputError
from hystbench.filters import AdaptiveFilter, run_many
from hystbench.metrics import mean_square_error
from hystbench.pressure.runs import (
    Settings,
    draw_signals,
    filter_jobs,
    measure_twin,
)
from hystbench.pressure.twins import Twin
from hystbench.record import FloatArray, Record

Algorithm = Literal["LMS", "NLMS"]
ALGORITHMS: tuple[Algorithm, ...] = ("LMS", "NLMS")
Protocol = Literal["held-out", "best"]

BATCH = 32
"""Runs held in memory at a time."""


@dataclass(frozen=True)
class Entry:
    """Error of a filter in the contest.

    Parameters
    ----------
    twin, family : str
    algorithm : {"LMS", "NLMS"}
    protocol : {"held-out", "best"}
    signal, model : str
    fractions : tuple of float
        Its step sizes as fractions of their bounds.
    steps : dict of str to float
        Its step sizes.
    at_edge : bool
        Whether one of them is at an end of the grid, so that a better one may lie
        beyond.
    mse : float
        Infinite where it diverged: the worst there is.
    rank : int
        1 for the least MSE of the filters; filters with the same one share a rank.
    """

    twin: str
    family: str
    algorithm: Algorithm
    protocol: Protocol
    signal: str
    model: str
    fractions: tuple[float, ...]
    steps: dict[str, float]
    at_edge: bool
    mse: float
    rank: int


@dataclass(frozen=True)
class Grid:
    """MSE of one filter at each step size (rows) on each signal (columns)."""

    fractions: list[tuple[float, ...]]
    steps: list[dict[str, float]]
    signals: list[str]
    mse: FloatArray

    def chosen(self, signals: Iterable[str]) -> int:
        """Find the step size with the least geometric mean MSE over signals.

        One that diverges on any of them has an infinite mean. Of equal ones the
        smallest is taken, so that where all diverge it is the smallest of all.
        """
        columns = [self.signals.index(signal) for signal in signals]
        return int(np.argmin(geometric_mean(self.mse[:, columns])))


def geometric_mean(mse: FloatArray) -> FloatArray:
    """Geometric mean along the last axis; infinite where an entry is."""
    with np.errstate(divide="ignore"):
        return np.asarray(np.exp(np.log(mse).mean(axis=-1)))


def hold_contest(twin: Twin, settings: Settings) -> list[Entry]:
    """Run all filters on a twin with all step sizes, and let each take its best.

    Parameters
    ----------
    twin : Twin
    settings : mapping
        ``signals``, ``asked``, ``measure`` and ``filters`` as for
        :func:`hystbench.pressure.ensemble.run_ensemble`; ``calibrated``, the signals
        on which step sizes are chosen; ``fractions``, the grid; and
        ``regularization_share`` of tr[R], for the normalized LMS.

    Raises
    ------
    InputError
        If none of the signals is one of the calibration's.
    """
    asked = {name: settings["signals"][name] for name in settings["asked"]}
    signals = draw_signals(asked, 0)
    records = measure_twin(twin, signals.values(), settings["measure"], 0)
    chosen_on = [name for name in records if name in set(settings["calibrated"])]
    if not chosen_on:
        raise InputError(
            "contest: no signal to choose a step size on; expected one of "
            f"{', '.join(settings['calibrated'])} among the signals"
        )
    entries: list[Entry] = []
    for algorithm in ALGORITHMS:
        grids = {
            model: run_grid(
                make_filter(model, job, records[chosen_on[0]]),
                algorithm,
                records,
                chosen_on,
                settings["fractions"],
                settings["regularization_share"],
            )
            for model, job in filter_jobs(settings).items()
        }
        for entry in _entries(grids, chosen_on):
            about: dict[str, Any] = {"twin": twin.name, "family": twin.family}
            entries.append(Entry(**about, algorithm=algorithm, **entry))
    return entries


def run_grid(
    adaptive: AdaptiveFilter,
    algorithm: Algorithm,
    records: Mapping[str, Record],
    calibrated: Sequence[str],
    fractions: Sequence[float],
    regularization_share: float,
) -> Grid:
    """Run a filter with each step size of the grid on each record.

    The bound of a step size is the smallest of 1/tr[R] over the calibrated records;
    for the normalized LMS it is 1.
    """
    all_bounds = [step_bounds(adaptive, records[name].u) for name in calibrated]
    bounds = {name: min(each[name] for each in all_bounds) for name in all_bounds[0]}
    if algorithm == "NLMS":
        trace = sum(1 / bound for bound in bounds.values())
        share = regularization_share * trace
        adaptive = replace(adaptive, normalized=True, regularization=share)
        bounds = dict.fromkeys(bounds, 1.0)
    grid = list(product(sorted(fractions), repeat=len(bounds)))
    steps = [
        {
            name: part * bound
            for part, (name, bound) in zip(parts, bounds.items(), strict=True)
        }
        for parts in grid
    ]
    own = step_names(adaptive.name)
    filters = [
        _with_steps(adaptive, {own[name]: mu for name, mu in step.items()})
        for step in steps
    ]
    columns = [mean_square_errors(filters, record) for record in records.values()]
    # A row lies in one piece, by which the order of its sum in the mean is fixed.
    mse = np.ascontiguousarray(np.array(columns).T)
    return Grid(grid, steps, list(records), mse)


def mean_square_errors(
    filters: Sequence[AdaptiveFilter], record: Record
) -> list[float]:
    """Run filters on a record; infinite where one diverged.

    All of one record: filters that differ in step size alone are then run together.
    """
    errors = []
    for start in range(0, len(filters), BATCH):
        batch = ((f, record.u, record.y) for f in filters[start : start + BATCH])
        for result in run_many(batch, workers=1):
            finite = result.diverged_at is None
            errors.append(mean_square_error(result.error) if finite else math.inf)
    return errors


def _with_steps(adaptive: AdaptiveFilter, steps: Mapping[str, Any]) -> AdaptiveFilter:
    return replace(adaptive, **steps)


def _entries(
    grids: Mapping[str, Grid], calibrated: Sequence[str]
) -> Iterable[dict[str, Any]]:
    """Score both protocols, all filters signal by signal."""
    signals = next(iter(grids.values())).signals
    fixed = {model: grid.chosen(calibrated) for model, grid in grids.items()}
    for signal in signals:
        column = signals.index(signal)
        best = {model: grid.chosen([signal]) for model, grid in grids.items()}
        protocols: list[tuple[Protocol, dict[str, int]]] = [("best", best)]
        if signal not in calibrated:
            protocols.insert(0, ("held-out", fixed))
        for protocol, rows in protocols:
            mse = {m: float(grids[m].mse[row, column]) for m, row in rows.items()}
            for model, row in rows.items():
                grid = grids[model]
                edges = {grid.fractions[0][0], grid.fractions[-1][0]}
                yield {
                    "protocol": protocol,
                    "signal": signal,
                    "model": model,
                    "fractions": grid.fractions[row],
                    "steps": grid.steps[row],
                    "at_edge": bool(edges & set(grid.fractions[row])),
                    "mse": mse[model],
                    "rank": 1 + sum(other < mse[model] for other in mse.values()),
                }


@dataclass(frozen=True)
class Ranking:
    """Whether the paper's ranking survives under one protocol.

    Parameters
    ----------
    twin, family, algorithm, protocol : str
    signals : int
        Signals that were scored.
    gpo_first : int
        Signals on which the GPO filter alone has the least MSE.
    not_first : dict of str to str
        The others, each with the filter that is first, or "none" where more share it.
    pairs, pairs_as_published : int
        Pairs of filters under one signal, and those in the order of the paper's MSE.
    mean : dict of str to float
        Geometric mean of the MSE over the signals by filter.
    """

    twin: str
    family: str
    algorithm: Algorithm
    protocol: Protocol
    signals: int
    gpo_first: int
    not_first: dict[str, str]
    pairs: int
    pairs_as_published: int
    mean: dict[str, float]


def rank(
    entries: Sequence[Entry], published: Mapping[tuple[str, str], float]
) -> list[Ranking]:
    """Sum the contest up by twin, algorithm and protocol.

    Parameters
    ----------
    entries : sequence of Entry
    published : mapping
        The paper's MSE by signal and filter; pairs that it does not have are not
        counted.
    """
    keys = dict.fromkeys((e.twin, e.family, e.algorithm, e.protocol) for e in entries)
    found = []
    for key in sorted(keys, key=lambda k: (k[3] == "best",)):
        mine = [
            e for e in entries if (e.twin, e.family, e.algorithm, e.protocol) == key
        ]
        by_signal: dict[str, dict[str, float]] = {}
        for entry in mine:
            by_signal.setdefault(entry.signal, {})[entry.model] = entry.mse
        first = {signal: _first(mse) for signal, mse in by_signal.items()}
        pairs = [
            (mse[a] < mse[b]) == (published[s, a] < published[s, b])
            and mse[a] != mse[b]
            for s, mse in by_signal.items()
            for i, a in enumerate(mse)
            for b in list(mse)[i + 1 :]
            if (s, a) in published and (s, b) in published
        ]
        models = dict.fromkeys(entry.model for entry in mine)
        found.append(
            Ranking(
                *key,
                signals=len(by_signal),
                gpo_first=sum(name == "gpo" for name in first.values()),
                not_first={s: name for s, name in first.items() if name != "gpo"},
                pairs=len(pairs),
                pairs_as_published=sum(pairs),
                mean={
                    model: float(
                        geometric_mean(
                            np.array([mse[model] for mse in by_signal.values()])
                        )
                    )
                    for model in models
                },
            )
        )
    return found


def _first(mse: Mapping[str, float]) -> str:
    least = min(mse.values())
    first = [model for model, value in mse.items() if value == least]
    return first[0] if len(first) == 1 else "none"

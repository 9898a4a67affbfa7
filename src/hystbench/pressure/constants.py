"""What a constant does to the ranking: a zero error of the input, a constant tap.

None of the paper's filters has a weight for a constant. So the constants of operators,
input and displacement must be made of the other taps, and the filter that can do that
best leads. Here the constant of the recorded input is varied, and each filter is given
a constant tap.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import combinations
from typing import Any

from hystbench.pressure.runs import (
    Settings,
    draw_signals,
    filter_jobs,
    measure_twin,
    run_records,
)
from hystbench.pressure.twins import Twin


@dataclass(frozen=True)
class Constant:
    """The ranking with one constant.

    Parameters
    ----------
    twin, family : str
    zero_error : float
        Constant on the recorded input (A).
    constant_tap : float
        Size of the constant tap beside the RMS of the others; zero for none.
    configured : bool
        Whether both are as in config.yaml.
    mse : dict
        MSE (um^2) by signal and filter; infinite where it diverged.
    published : mapping
        The paper's.
    """

    twin: str
    family: str
    zero_error: float
    constant_tap: float
    configured: bool
    mse: dict[tuple[str, str], float]
    published: Mapping[tuple[str, str], float]

    @property
    def signals(self) -> list[str]:
        """Signals that were run."""
        return list(dict.fromkeys(signal for signal, _ in self.mse))

    @property
    def first(self) -> dict[str, str]:
        """Filter with the least MSE by signal."""
        return {
            signal: min(
                (model for name, model in self.mse if name == signal),
                key=lambda model: self.mse[signal, model],
            )
            for signal in self.signals
        }

    @property
    def gpo_first(self) -> int:
        """Signals on which the GPO filter has the least MSE."""
        return sum(model == "gpo" for model in self.first.values())

    def pairs(self, signals: Sequence[str]) -> tuple[int, int]:
        """Pairs of filters under one of some signals in the paper's order, and all."""
        agree = total = 0
        for signal in signals:
            models = [model for name, model in self.mse if name == signal]
            for one, other in combinations(models, 2):
                cells = (signal, one), (signal, other)
                ours = [self.mse[cell] for cell in cells]
                theirs = [self.published[cell] for cell in cells]
                total += 1
                agree += ours[0] != ours[1] and (ours[0] < ours[1]) == (
                    theirs[0] < theirs[1]
                )
        return agree, total

    def mean(self, model: str) -> float:
        """Geometric mean of a filter's MSE over the signals (um^2)."""
        logs = [math.log(self.mse[signal, model]) for signal in self.signals]
        return math.exp(sum(logs) / len(logs))

    @property
    def diverged(self) -> int:
        """Runs that diverged."""
        return sum(math.isinf(value) for value in self.mse.values())


def vary_constants(
    twin: Twin,
    settings: Settings,
    identified: Mapping[str, Any] | None,
    published: Mapping[tuple[str, str], float],
) -> list[Constant]:
    """Run the filters with each zero error, and with each constant tap.

    Parameters
    ----------
    twin : Twin
    settings : mapping
        ``signals`` (definitions), ``measure``, ``filters``, ``zero_errors`` and
        ``constant_taps``.
    identified : mapping or None
        Result of Algorithm 1, for identified envelopes.
    published : mapping
        The paper's MSE by signal and filter.
    """
    signals = draw_signals(settings["signals"], 0)
    usual = settings["measure"]["input_zero_error"]
    jobs = filter_jobs(settings)
    if not jobs:
        return []
    tap = next(iter(jobs.values()))["constant_tap"]
    cases = [(zero, tap) for zero in sorted({*settings["zero_errors"], usual})]
    cases += [(usual, each) for each in settings["constant_taps"] if each != tap]
    found = []
    for zero, size in cases:
        measured = {**settings["measure"], "input_zero_error": zero}
        records = measure_twin(twin, signals.values(), measured, 0)
        mse: dict[tuple[str, str], float] = {}
        for model, job in jobs.items():
            changed = {**job, "constant_tap": size}
            runs = run_records(model, changed, records, identified or {})
            mse |= {cell: run.error("mse") for cell, run in runs.items()}
        ordered = {
            (signal, model): mse[signal, model] for signal in records for model in jobs
        }
        configured = (zero, size) == (usual, tap)
        found.append(
            Constant(twin.name, twin.family, zero, size, configured, ordered, published)
        )
    return found

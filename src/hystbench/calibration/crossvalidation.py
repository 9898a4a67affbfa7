"""Judging a choice by leaving one calibration signal out at a time."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from hystbench.calibration.fit import Fit, Tell
from hystbench.calibration.objective import Objective
from hystbench.calibration.targets import Target


@dataclass(frozen=True)
class LeftOut:
    """How a twin that never saw a signal does on it.

    Parameters
    ----------
    signal : str
    log10_ratio : dict of str to float
        log10 of our MSE over the published, by filter.
    rms_error : float
        Our RMS displacement over the implied, minus one.
    """

    signal: str
    log10_ratio: dict[str, float]
    rms_error: float


def leave_one_out(
    objective: Objective,
    targets: tuple[Target, ...],
    find: Callable[[tuple[Target, ...]], Fit],
    *,
    tell: Tell = lambda line: None,
) -> tuple[LeftOut, ...]:
    """Fit without each signal in turn and look at the signal left out.

    Parameters
    ----------
    objective : Objective
    targets : tuple of Target
    find : callable
        Fits a twin to the targets that it is given, and knows nothing of the others:
        neither its starts nor anything else in it may come from a fit to them.
    tell : callable
        Told one line after each signal.
    """
    found = []
    for target in targets:
        fit = find(tuple(item for item in targets if item is not target))
        cells = objective.at(fit.values).cells(fit.values, [target.signal])
        ratios = {
            model: float(np.log10(mse / target.mse[model]))
            for model, mse in cells.mse[target.signal].items()
        }
        rms_error = cells.rms[target.signal] / target.rms - 1
        found.append(LeftOut(target.signal, ratios, rms_error))
        told = ", ".join(f"{model} {ratio:+.3f}" for model, ratio in ratios.items())
        tell(f"without {target.signal}: {told}, rms {100 * rms_error:+.1f} %")
    return tuple(found)

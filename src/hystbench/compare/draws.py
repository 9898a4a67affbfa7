"""Errors over many draws of the random sum, read and summed up."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from statistics import median

from hystbench.compare.rows import read_items
from hystbench.published import Metric


@dataclass(frozen=True)
class Draw:
    """Errors of a model on one draw of the random sum; infinite where it diverged.

    Parameters
    ----------
    signal : str
    sines, draw : int
        Number of its sines, and which draw; 0 is the configured one.
    model : str
    mse, re : float
    rms : float
        RMS displacement of the record (um).
    """

    signal: str
    sines: int
    draw: int
    model: str
    mse: float
    re: float
    rms: float


@dataclass(frozen=True)
class Drawn:
    """What the draws of one signal say, by model and metric.

    Parameters
    ----------
    errors : mapping
        Errors over the draws, by model and metric.
    rms : tuple of float
        RMS displacements (um) over the draws.
    """

    errors: Mapping[tuple[str, Metric], tuple[float, ...]]
    rms: tuple[float, ...]

    @property
    def count(self) -> int:
        """How many draws there are."""
        return len(self.rms)

    def median(self, model: str, metric: Metric) -> float:
        """Median of an error over the draws."""
        return median(self.errors[model, metric])


def read_draws(path: str | Path) -> dict[str, Drawn]:
    """Read the draws of the configured number of sines, the file's first, by signal."""
    draws = read_items(path, Draw)
    found: dict[str, Drawn] = {}
    for signal in dict.fromkeys(each.signal for each in draws):
        own = [each for each in draws if each.signal == signal]
        own = [each for each in own if each.sines == own[0].sines]
        errors: dict[tuple[str, Metric], list[float]] = {}
        for each in own:
            errors.setdefault((each.model, "mse"), []).append(each.mse)
            errors.setdefault((each.model, "re"), []).append(each.re)
        rms = {each.draw: each.rms for each in own}
        found[signal] = Drawn(
            {key: tuple(values) for key, values in errors.items()},
            tuple(rms.values()),
        )
    return found

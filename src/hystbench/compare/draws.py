"""Errors over many draws of the random sum, read and summed up."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import astuple, dataclass
from pathlib import Path
from statistics import median

from hystbench.compare.rows import finite_or_infinite, read_rows
from hystbench.files import write_csv
from hystbench.published import Metric

COLUMNS = ("signal", "sines", "draw", "model", "mse", "re", "rms")


@dataclass(frozen=True)
class Draw:
    """Errors of a model on one draw of the random sum; infinite where it diverged.

    Parameters
    ----------
    sines, draw : int
        Number of its sines, and which draw; 0 is the configured one.
    model : str
    mse, re : float
    rms : float
        RMS displacement of the record (um).
    """

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


def write_draws(signal: str, draws: Iterable[Draw], path: Path) -> None:
    """Write a row for each draw and model; a diverged run has no error."""
    rows = []
    for each in draws:
        values = [None if v == float("inf") else v for v in astuple(each)]
        rows.append([signal, *values])
    write_csv(path, COLUMNS, rows)


def read_draws(path: str | Path) -> dict[str, Drawn]:
    """Read the draws of the configured number of sines, the file's first, by signal."""
    rows = read_rows(path, COLUMNS)
    found: dict[str, Drawn] = {}
    for signal in dict.fromkeys(row["signal"] for row in rows):
        own = [row for row in rows if row["signal"] == signal]
        own = [row for row in own if row["sines"] == own[0]["sines"]]
        errors: dict[tuple[str, Metric], list[float]] = {}
        metrics: tuple[Metric, ...] = ("mse", "re")
        for number, row in enumerate(own, 1):
            for metric in metrics:
                value = finite_or_infinite(row[metric], path, number)
                errors.setdefault((row["model"], metric), []).append(value)
        rms = {row["draw"]: float(row["rms"]) for row in own}
        found[signal] = Drawn(
            {key: tuple(values) for key, values in errors.items()},
            tuple(rms.values()),
        )
    return found

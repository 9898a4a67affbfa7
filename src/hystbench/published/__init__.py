"""The numbers of the paper as printed: its error tables and what its text states.

Source: "Modeling of Rate-Dependent Hysteresis Using a GPO-Based Adaptive Filter"
(Zhang and Ma), Tables 1-4 and Section 4. Its measured data are not public.
"""

from __future__ import annotations

import csv
import re
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from decimal import Decimal
from functools import cache
from importlib.resources import files
from typing import Any, Literal

from hystbench.yaml_files import parse_yaml

Metric = Literal["mse", "re"]
METRICS: tuple[Metric, ...] = ("mse", "re")
FILTERS = ("gpo", "backlash", "volterra", "delayed")
MODELS = (*FILTERS, "rdgpi")


@dataclass(frozen=True)
class Interval:
    """A closed interval of real numbers."""

    low: float
    high: float

    @property
    def middle(self) -> float:
        """The number in its middle."""
        return (self.low + self.high) / 2

    def meets(self, other: Interval) -> bool:
        """Tell whether the two share a point."""
        return self.low <= other.high and other.low <= self.high

    def __str__(self) -> str:
        return f"{self.low:.4f} to {self.high:.4f}"


@dataclass(frozen=True)
class Printed:
    """A number with its digits as printed."""

    text: str

    @property
    def value(self) -> float:
        """The number."""
        return float(self.text)

    @property
    def interval(self) -> Interval:
        """All numbers that round to these digits: half a unit in the last place."""
        number = Decimal(self.text)
        exponent = number.as_tuple().exponent
        if not isinstance(exponent, int):
            raise ValueError(f"{self.text!r} is not a finite number")
        half = Decimal(5).scaleb(exponent - 1)
        return Interval(float(number - half), float(number + half))


@dataclass(frozen=True)
class Pair:
    """The MSE (um^2) and the RE that the paper prints for one signal and model."""

    table: int
    signal: str
    model: str
    mse: Printed
    re: Printed

    def printed(self, metric: Metric) -> Printed:
        """Give the MSE or the RE."""
        return self.mse if metric == "mse" else self.re

    @property
    def rms(self) -> Interval:
        """RMS displacement (um) that the pair implies: sqrt(MSE) / RE.

        RE = sqrt(sum e^2 / sum d^2), so MSE / RE^2 = mean(d^2), whatever the model.
        """
        mse, re_ = self.mse.interval, self.re.interval
        return Interval(mse.low**0.5 / re_.high, mse.high**0.5 / re_.low)


def read_text(name: str) -> str:
    """Read a file of this package."""
    return files(__package__).joinpath(name).read_text(encoding="utf-8")


def read_csv(name: str) -> list[dict[str, str]]:
    """Read the rows of a table of this package."""
    return list(csv.DictReader(read_text(name).splitlines()))


@cache
def load_errors() -> tuple[Pair, ...]:
    """Read the 62 pairs: Tables 1-3 (52 of filters) and Table 4 (10 of the RDGPI)."""
    return tuple(
        _pair(row, int(row["table"]), row["signal"], row["model"])
        for row in read_csv("errors.csv")
    )


@cache
def load_table4_gpo() -> tuple[Pair, ...]:
    """Read the GPO column of Table 4, which repeats Tables 1-3 under other labels."""
    return tuple(
        _pair(row, 4, row["label"], "gpo") for row in read_csv("table4_gpo.csv")
    )


def _pair(row: Mapping[str, str], table: int, signal: str, model: str) -> Pair:
    errors = Printed(row["mse_um2"]), Printed(row["relative_error"])
    return Pair(table, signal, model, *errors)


@dataclass(frozen=True)
class Moment:
    """A time of the chirp and the frequency that the paper gives for it."""

    time_s: float
    frequency_hz: float


@dataclass(frozen=True)
class Text:
    """What the text of the paper states in numbers; see ``text.yaml``."""

    stroke_um: float
    sampling_hz: float
    amplitude_a: float
    sine_frequencies_hz: tuple[float, ...]
    order_sweep_hz: float
    order_sweep_knee: int
    filter_length: int
    identification_hz: float
    envelope: dict[str, float]
    chirp_from_hz: float
    chirp_to_hz: float
    chirp_minimum: Moment
    chirp_resonance: Moment
    sums: dict[str, dict[float, float]]
    random_band_of_nyquist: tuple[float, float]
    random_level: float

    @property
    def chirp_rates(self) -> list[float]:
        """Sweep rate (Hz/s) that each of the two moments implies."""
        moments = (self.chirp_minimum, self.chirp_resonance)
        return [(m.frequency_hz - self.chirp_from_hz) / m.time_s for m in moments]


@cache
def load_text() -> Text:
    """Read the numbers of the text."""
    content: dict[str, Any] = parse_yaml(read_text("text.yaml"), "text.yaml")
    for key in ("chirp_minimum", "chirp_resonance"):
        content[key] = Moment(**content[key])
    for key in ("sine_frequencies_hz", "random_band_of_nyquist"):
        content[key] = tuple(content[key])
    return Text(**content)


def in_order(models: Iterable[str]) -> list[str]:
    """Put models in the order of the paper's tables, others behind them by name."""
    there = set(models)
    own = [model for model in MODELS if model in there]
    return own + sorted(there.difference(own))


def signals(pairs: Iterable[Pair], *tables: int) -> tuple[str, ...]:
    """List the signals in the order of the tables, each once; of some tables or all."""
    known = (p.signal for p in pairs if not tables or p.table in tables)
    return tuple(dict.fromkeys(known))


def sine_frequency(signal: str) -> float | None:
    """Read the frequency in Hz off the name of a sine, as ``sine-010hz``."""
    match = re.fullmatch(r"sine-(\d+)hz", signal)
    return float(match[1]) if match else None


def sines(pairs: Iterable[Pair]) -> dict[str, float]:
    """Give the frequencies in Hz of the sines of the tables, rising."""
    told = {signal: sine_frequency(signal) for signal in signals(pairs)}
    found = {signal: hz for signal, hz in told.items() if hz is not None}
    return dict(sorted(found.items(), key=lambda sine: sine[1]))

"""What each record is like: rate, jitter, period, clipping, delay, noise, levels."""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from hystbench.dataset import Dataset
from hystbench.errors import InputError
from hystbench.gap.records.scored_samples import Compared
from hystbench.gap.records.usable import IF_REAL, check_usable
from hystbench.inspection.input_summary import (
    InputSummary,
    cannot_be_bridged,
    summary_of,
)
from hystbench.periods import find_period, repeats
from hystbench.record import FloatArray, Record, Use
from hystbench.units import seconds

FINEST, WHOLE = 13, 1e-3
"""Decimals of a time that are looked at, and what still counts as a whole number."""
LATE_SAMPLES = 1.0
"""Samples by which a record is late against the others, worth telling."""
DELAY_SHARE = 0.5
"""Least share of what the base leaves of a record: the delay is then what is wrong with
it."""
ONE_RATE = 0.9
"""Share of a slope's power that goes with its direction: all of a triangle's, .81 of a
sine's. There a loop of another width moves the output as a delay does."""
SURE = 3.0
"""Standard errors of that difference."""
NORMAL_MEDIAN = 0.6745
"""Median size of a normal variable, in standard deviations."""
LEAST_OTHERS = 4
"""Records at least that the one is held against."""
STRETCHES = 20
"""Stretches of a record whose delays are compared: model error is not white."""


@dataclass(frozen=True)
class Facts:
    """One record in a few numbers."""

    name: str
    use: Use
    samples: int
    dt: float
    """Sampling interval in seconds."""
    jitter: float | None
    """Rms of the steps of time about their mean, as a share of it; None without a
    column of time."""
    tick_s: float | None
    """What times are rounded to, in seconds, where that is all of the jitter."""
    period: int | None
    """Samples, as the dataset says or as it was found."""
    declared: bool
    """Whether the dataset says it."""
    repeats: bool
    """Whether the input repeats itself so."""
    input: InputSummary
    low: float
    high: float
    """Range of the output."""
    stuck: str
    """What looks stuck or clipped, in words; empty where nothing does."""
    missing: int
    """Samples that were interpolated, in time, input or output."""
    bridged_too_far: bool
    """Whether a gap of the input is longer than a straight line can stand for."""
    delay_s: float
    delay_error_s: float
    """Delay of the output behind that of the base, and its standard error."""
    delay_share: float
    """Share of the power that the base leaves which goes with the delay."""

    @property
    def periods(self) -> float:
        """Periods in the record; 0 where it has none."""
        return self.samples / self.period if self.period else 0.0


def facts_of(dataset: Dataset, item: Compared) -> Facts:
    """Look at one record.

    Parameters
    ----------
    dataset : Dataset
    item : Compared
        The record beside what the base of the check gives.
    """
    record = item.record
    file = dataset.record_files[record.name]
    given = record.period_samples
    delay, error, share = delay_of(item)
    jitter, tick, missing, too_far = _clock_and_missing(dataset, record)
    return Facts(
        record.name,
        record.use,
        len(record),
        record.dt,
        jitter,
        tick,
        given or find_period(record.u),
        given is not None,
        given is None or repeats(record.u, given),
        summary_of(record.u, record.dt),
        float(record.y.min()),
        float(record.y.max()),
        _stuck(file, record, dataset.stands_still(record.name)),
        missing,
        too_far,
        delay,
        error,
        share,
    )


def delay_of(item: Compared) -> tuple[float, float, float]:
    """Give by how much an output is behind a simulation, to first order, in seconds.

    ``d = -<r, s'> / <s', s'>`` with the residual r and the slope s' of the simulation.

    Returns
    -------
    delay : float
    error : float
        Standard error, from how it differs between stretches of the record.
    share : float
        Of the residual's power, that goes with it; none where a loop of another width
        would do the same.
    """
    behind = np.arange(len(item.record)) >= item.record.lead
    slope = np.gradient(item.simulated, item.record.dt)[behind]
    residual = item.residual[behind]
    residual = residual - residual.mean()
    top = np.array([float(part.sum()) for part in _parts(residual * slope)])
    bottom = np.array([float(part.sum()) for part in _parts(slope**2)])
    total = float(bottom.sum())
    if not total > 0:
        return 0.0, float("inf"), 0.0
    delay = -float(top.sum()) / total
    spread = (top + delay * bottom) / total
    share = float(top.sum()) ** 2 / total / max(float(residual @ residual), 1e-300)
    if np.mean(np.abs(slope)) ** 2 > ONE_RATE * np.mean(slope**2):
        share = 0.0
    return delay, float(np.sqrt(np.sum(spread**2))), share


def _parts(values: FloatArray) -> list[FloatArray]:
    return np.array_split(values, STRETCHES)


def late(facts: Sequence[Facts]) -> list[tuple[Facts, float]]:
    """Give the records that are late against what the others predict, and by how much.

    A loop of the wrong width is a phase that is the same at all rates, and a lag is one
    that grows with the rate: each record's phase, its delay times its rate, is held
    against a straight line over the rate through those of the others.
    """
    rates = np.array([item.input.relative_rate for item in facts])
    phases = rates * [item.delay_s for item in facts]
    found = []
    for k, item in enumerate(facts):
        others = np.arange(len(facts)) != k
        if np.count_nonzero(others) < LEAST_OTHERS:
            continue
        line = _middle_line(rates[others], phases[others])
        by = float(phases[k] - np.polyval(line, rates[k])) / rates[k]
        usual = np.median(np.abs(phases[others] - np.polyval(line, rates[others])))
        doubt = SURE * np.hypot(item.delay_error_s, usual / NORMAL_MEDIAN / rates[k])
        sure = abs(by) > max(LATE_SAMPLES * item.dt, doubt)
        if sure and item.delay_share > DELAY_SHARE:
            found.append((item, by))
    return found


def _middle_line(x: FloatArray, y: FloatArray) -> FloatArray:
    """Give the line of medians of Theil and Sen, which shrugs off a few far points."""
    i, j = np.triu_indices(len(x), 1)
    apart = np.abs(x[i] - x[j]) > 1e-3 * x.max()
    slopes = (y[i] - y[j])[apart] / (x[i] - x[j])[apart]
    slope = float(np.median(slopes)) if len(slopes) else 0.0
    return np.array([slope, float(np.median(y - slope * x))])


def _clock_and_missing(
    dataset: Dataset, record: Record
) -> tuple[float | None, float | None, int, bool]:
    """Give the jitter of a clock, what it is rounded to, and how many samples miss.

    Also whether a gap of the input is longer than a straight line can stand for.
    """
    about = dataset.about.get("time")
    if about is None and "missing" not in dataset.entry(record.name):
        return None, None, 0, False
    _, columns, rows = dataset.columns(record.name)
    columns.pop("simulated", None)
    values = {key: column.values[rows] for key, column in columns.items()}
    missing = int(np.count_nonzero(~np.all(np.isfinite([*values.values()]), axis=0)))
    too_far = bool(missing and cannot_be_bridged(values["input"]).any())
    if about is None:
        return None, None, missing, too_far
    second = seconds("time: unit", about["unit"])
    jitter = float(np.nanstd(np.diff(values["time"]))) * second / record.dt
    tick = _tick(values["time"])
    return jitter, None if tick is None else tick * second, missing, too_far


def _tick(time: FloatArray) -> float | None:
    """Give what the times of an even clock are rounded to; none if it is uneven."""
    places = np.flatnonzero(np.isfinite(time))
    there, count = time[places], places - places[0]
    even = there[0] + (there[-1] - there[0]) * count / count[-1]
    away = float(np.abs(there - even).max())
    # The last are the largest: of significant digits they have the fewest decimals.
    last = there[-max(len(there) // 10, 2) :]
    for digits in range(FINEST):
        tick = 10.0**-digits
        if np.abs(last / tick - np.round(last / tick)).max() < WHOLE:
            return tick if away <= 1.01 * tick else None
    return None


def _stuck(file: Path, record: Record, stands_still: Sequence[str]) -> str:
    """Say which channel looks stuck or clipped."""
    try:
        check_usable(file, record, stands_still)
    except InputError as error:
        said = str(error).removeprefix(f"{file}: ")
        for channel in ("input", "output"):
            said = said.removesuffix(IF_REAL.format(channel))
        return said
    return ""

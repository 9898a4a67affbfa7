"""The unexplained view: lone lines and slow paths that the input does not cause."""

from __future__ import annotations

from dataclasses import dataclass
from typing import cast

import numpy as np
from numpy.typing import NDArray

from hystbench.gap.floor import periodogram
from hystbench.gap.locate.coherence import take_coherence
from hystbench.gap.locate.coherence import told as told_coherence
from hystbench.gap.locate.distortion import Distortion, told_repeating
from hystbench.gap.locate.regression import (
    best,
    fit_by_record,
    fit_form,
    fitted_p_value,
    narrowest,
)
from hystbench.gap.locate.samples import Samples
from hystbench.gap.locate.spectra import HANN_INFLATION
from hystbench.gap.locate.view import View, number, percent
from hystbench.gap.once import shows_a_path
from hystbench.record import FloatArray

BoolArray = NDArray[np.bool_]

# Lines sought, at most; a mains line and its first harmonics.
LINES = 3
# Half-periods of the fastest drift within a record.
ORDERS = 4
# Bins of a periodogram over which its own level is read.
NEIGHBOURS = 48
# Variance of the mean over that of the median scaled to it, of exponential values.
MEDIAN_EFFICIENCY = float(np.log(2) ** 2)


@dataclass(frozen=True)
class Lines:
    """Lone lines of the residual.

    Parameters
    ----------
    frequencies : tuple of float
        In Hz, the strongest first.
    p_value : float
        Chance that white noise holds a line as strong as the strongest.
    """

    frequencies: tuple[float, ...]
    p_value: float


def unexplained_view(samples: Samples, distortion: Distortion | None) -> View:
    """Fit lone lines and drift, each record's own.

    A line must stand out in the residual, at one frequency in at least half of the
    records, where the input has none. For the p-value it must not be a harmonic of
    the input's strongest line either: distortion lies there. A drift has fewer
    half-periods in a record than the input has. The range is that of the line in Hz,
    or of time in s for a drift. The p-value is the smaller of the line's (Fisher's
    test) and the drift's (F test), doubled for the choice.
    """
    lines = find_lines(samples)
    drifts = {order: _drift_columns(samples, order) for order in (1, ORDERS)}
    drift = best([fit_by_record(samples, columns) for columns in drifts.values()])
    common = [np.ones_like(samples.time), samples.time * _shown(samples)]
    ramp = fit_form(samples, common)
    forms = {"a drift": best([drift, ramp])}
    if lines.frequencies:
        waves = [_wave_columns(samples, one) for one in lines.frequencies]
        count = len(waves)
        lined = [
            fit_by_record(
                samples, [column for wave in waves[:top] for column in wave], top
            )
            for top in range(1, count + 1)
        ]
        forms["a lone line"] = best(lined)
        both = [fit_by_record(samples, [*waves[0], *drifts[1]], 1)]
        forms["a lone line and a drift"] = best(both)
    kind = max(forms, key=lambda name: forms[name].saved)
    form = forms[kind]
    again = fit_form(samples, [form.fitted], searched=form.freedom - 1)
    form = best([form, again])
    share = samples.share(form.explained, form.freedom)
    test = fit_by_record(samples, drifts[ORDERS])
    p_value = min(1.0, 2 * min(lines.p_value, fitted_p_value(samples, test)))
    if kind == "a drift":
        start, end = narrowest(samples.time, form.fitted**2)
        axis, unit = "time in the record", "s"
        where = f"most of it between {number(start)} and {number(end)} s of a record"
    else:
        # A record tells a line from its neighbours by the inverse of its length.
        resolution = float(1 / np.min(samples.durations))
        first = lines.frequencies[0]
        start, end = max(first - resolution, 0.0), first + resolution
        axis, unit = "frequency", "Hz"
        told = number(first)
        where = f"at {told} Hz, between {number(start)} and {number(end)} Hz"
    return View(
        view="unexplained",
        axis=axis,
        start=start,
        end=end,
        unit=unit,
        share_of_gap_power=share,
        p_value=p_value,
        sentence=(
            f"{percent(share)} of the gap is {kind} that the input does not explain, "
            f"{where}.{told_coherence(take_coherence(samples))}"
            f"{told_repeating(distortion)}"
        ),
        saved=form.saved,
    )


def _drift_columns(samples: Samples, orders: int) -> list[FloatArray]:
    """Give cosines of half-periods, zero where the input is as slow.

    Each begins at zero: an offset from the first sample on is no drift. A record of one
    loop has none: whatever is slower than the loop could be the loop's own error.
    """
    duration = samples.durations[samples.record]
    slowest = np.array(
        [lowest_frequency(samples, i) for i in range(len(samples.compared))]
    )
    halves = np.maximum(samples.durations * slowest, 1.0)
    allowed = halves[samples.record] * _shown(samples)
    columns = []
    for order in range(1, orders + 1):
        wave = 1 - np.cos(np.pi * order * samples.time / duration)
        columns.append(np.where(order <= allowed, wave, 0.0))
    return columns


def _shown(samples: Samples) -> BoolArray:
    """Mark the samples of records that show a path beside what the input does."""
    shown = np.array([shows_a_path(item.record) for item in samples.compared])
    return cast(BoolArray, shown[samples.record])


def lowest_frequency(samples: Samples, index: int) -> float:
    """Give the frequency in Hz below which a hundredth of the input's power lies."""
    record = samples.compared[index].record
    power, frequency = periodogram(record.u, record.dt)
    total = np.cumsum(power[1:])
    return float(frequency[1:][np.searchsorted(total, 0.01 * total[-1])])


def _wave_columns(samples: Samples, frequency: float) -> list[FloatArray]:
    """Give cosine and sine of a frequency."""
    phase = 2 * np.pi * frequency * samples.time
    return [np.cos(phase), np.sin(phase)]


def find_lines(samples: Samples) -> Lines:
    """Find lone lines by the whitened periodograms of all records together."""
    top = min(0.5 / item.record.dt for item in samples.compared)
    step = 2.0 / float(np.min(samples.durations))
    cells = int(top / step)
    if cells < 4:
        return Lines((), 1.0)
    height = np.zeros(cells)
    seen = np.zeros(cells)
    bins, strongest = 0, 0.0
    peaks: list[tuple[FloatArray, FloatArray]] = []
    for item in samples.compared:
        dt = item.record.dt
        power, frequency = periodogram(item.residual, dt)
        cause, _ = periodogram(item.record.u, dt)
        white = power / _level(power)
        cell = np.minimum((frequency / step).astype(np.int64), cells)
        free = ~_input_lines(cause)
        free[:3] = False
        strength = np.zeros(cells + 1)
        np.maximum.at(strength, cell[free], white[free])
        height += np.log1p(strength[:cells])
        seen += strength[:cells] > 0
        peaks.append((frequency, np.where(free, white, 0.0)))
        tested = white[free & ~_harmonics(cause)]
        bins += len(tested)
        strongest = max(strongest, float(np.max(tested, initial=0.0)))
    count = len(samples.compared)
    mean = np.where(seen >= max(0.5 * count, 1), height / np.maximum(seen, 1), 0.0)
    found: list[float] = []
    for cell_index in np.argsort(-mean)[: 4 * LINES]:
        place = _refine(peaks, cell_index * step, (cell_index + 1) * step)
        if place is not None and all(abs(place - one) > 2 * step for one in found):
            found.append(place)
        if len(found) == LINES:
            break
    # A bin exceeds x times its level with probability exp(-x); as the level is itself
    # read off a few neighbours, the tail is that of F with 2 and 2 nu degrees.
    nu = NEIGHBOURS * MEDIAN_EFFICIENCY / HANN_INFLATION
    one = (1 + strongest / nu) ** -nu
    p_value = -np.expm1(bins * np.log1p(-min(one, 1 - 1e-12)))
    return Lines(tuple(found), float(np.clip(p_value, 0.0, 1.0)))


def _level(power: FloatArray) -> FloatArray:
    """Give the mean level of noise around each bin, by medians of blocks."""
    blocks = max(1, len(power) // NEIGHBOURS)
    edges = np.linspace(0, len(power), blocks + 1).astype(np.int64)
    short = int(np.diff(edges).min())
    medians = np.median(power[edges[:-1, np.newaxis] + np.arange(short)], axis=1)
    levels = np.log(np.maximum(medians / np.log(2), 1e-300))
    centres = 0.5 * (edges[:-1] + edges[1:])
    return cast(FloatArray, np.exp(np.interp(np.arange(len(power)), centres, levels)))


def _input_lines(cause: FloatArray) -> BoolArray:
    """Tell the bins in which the input has a line."""
    lone = (cause > 1e-5 * np.max(cause)) & (cause > 10 * _level(cause))
    return np.convolve(lone, np.ones(3), mode="same") > 0


def _harmonics(cause: FloatArray) -> BoolArray:
    """Tell the bins of harmonics of the input's strongest line."""
    strongest = int(np.argmax(cause[1:])) + 1
    order = np.arange(len(cause)) / strongest
    return np.abs(order - np.round(order)) * strongest < 2.5


def _refine(
    peaks: list[tuple[FloatArray, FloatArray]], low: float, high: float
) -> float | None:
    """Place a line between bins by parabolas through the peaks, the strong most."""
    places, weights = [], []
    for frequency, white in peaks:
        inside = np.flatnonzero((frequency >= low) & (frequency < high))
        if not len(inside):
            continue
        top = int(inside[np.argmax(white[inside])])
        if not 0 < top < len(white) - 1 or white[top] <= 0:
            continue
        left, mid, right = np.log(np.maximum(white[top - 1 : top + 2], 1e-300))
        bend = left - 2 * mid + right
        shift = 0.5 * (left - right) / bend if bend < 0 else 0.0
        places.append(frequency[top] + np.clip(shift, -0.5, 0.5) * frequency[1])
        weights.append(white[top])
    return float(np.average(places, weights=weights)) if places else None

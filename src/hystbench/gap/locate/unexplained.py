"""The unexplained view: lone lines and slow paths that the input does not cause."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from hystbench.gap.locate.forms import View, fit_form, named_or, narrowest
from hystbench.gap.locate.samples import ViewSamples
from hystbench.gap.records.nuisance import shows_a_path
from hystbench.record import FloatArray, Mask
from hystbench.sentences import shortly
from hystbench.spectra import line_below, periodogram

DRIFT, LINE = "a drift", "a lone line"
DRIFT_ORDERS = 4
"""Half-periods of the fastest drift within a record."""
LEVEL_BINS = 48
"""Bins of a periodogram over which its own level is read."""
HANN_VARIANCE = 35 / 18
"""What a Hann window does to the variance of a mean over bins: n sum w^4 over the
square of sum w^2."""
MEDIAN_EFFICIENCY = float(np.log(2) ** 2)
"""Variance of the mean over that of the median scaled to it, of exponential values."""
LINE_POWER = 1e-5
"""Least power of a line of the input, as a share of the strongest bin's."""
STANDS_OUT = 10.0
"""Times the level around it, that a line holds."""


def unexplained(samples: ViewSamples) -> View:
    """Fit a lone line and drift, each record's own.

    A line must stand out in the residual, at one frequency in at least half of the
    records, where the input has none. A drift has fewer half-periods in a record than
    the input has. The range is that of the line in Hz, or of time in s for a drift. The
    p-value is the smaller of the line's (Fisher's test) and the drift's (F test),
    doubled for the choice.
    """
    hertz, line_p = find_line(samples)
    paths = _drift_columns(samples)
    drift = fit_form(samples, DRIFT, paths, by_record=True)
    forms = [drift, fit_form(samples, DRIFT, paths[:1], by_record=True)]
    if hertz is not None:
        phase = 2 * np.pi * hertz * samples.time
        wave = [np.cos(phase), np.sin(phase)]
        forms += [
            fit_form(samples, words, columns, 1, by_record=True)
            for words, columns in ((LINE, wave), (f"{LINE} and {DRIFT}", wave + paths))
        ]
    form = named_or(samples, "unexplained", forms, [drift])
    if not form.named:
        form = replace(form, p_value=min(1.0, 2 * min(line_p, form.p_value)))
    named = [one.effect for one in samples.contributions if one.view == "unexplained"]
    slow = named == ["drift"] if form.named else form.words == DRIFT
    if slow or hertz is None:
        start, end = narrowest(samples.time, form.fitted**2)
        axis, unit, within = "time in the record", "s", "of a record"
    else:
        # A record tells a line from its neighbours by the inverse of its length.
        resolution = float(1 / np.min(samples.durations))
        start, end = max(hertz - resolution, 0.0), hertz + resolution
        axis, unit, within = "frequency", "Hz", f"at {shortly(hertz)} Hz"
    told = (
        f"is {form.words}, which the input does not explain, between {shortly(start)} "
        f"and {shortly(end)} {unit} {within}."
    )
    return form.seen("unexplained", axis, (start, end), unit, told)


def _drift_columns(samples: ViewSamples) -> list[FloatArray]:
    """Give cosines of half-periods, zero where the input is as slow.

    Each begins at zero: an offset from the first sample on is no drift. A record of one
    loop has none: whatever is slower than the loop could be the loop's own error.
    """
    ends = zip(samples.compared, samples.durations, samples.kept.slices, strict=True)
    duration, halves = np.empty_like(samples.time), np.empty_like(samples.time)
    for item, seconds, part in ends:
        power, frequency = periodogram(item.record.u, item.record.dt)
        slowest = frequency[1:][line_below(power[1:], 0.01)]
        duration[part], halves[part] = seconds, max(seconds * slowest, 1.0)
        halves[part] *= shows_a_path(item.record)
    return [
        np.where(
            order <= halves, 1 - np.cos(np.pi * order * samples.time / duration), 0.0
        )
        for order in range(1, DRIFT_ORDERS + 1)
    ]


def find_line(samples: ViewSamples) -> tuple[float | None, float]:
    """Find the lone line that stands out most, over the records together.

    Returns
    -------
    frequency : float or None
        In Hz; None where no record has a bin that is free.
    p_value : float
        Chance that white noise holds a line as strong as the strongest. A harmonic of
        the input's strongest line does not count: distortion lies there.
    """
    step = 2.0 / float(np.min(samples.durations))
    top = min(0.5 / item.record.dt for item in samples.compared)
    edges = np.arange(0.0, max(top, 2 * step), step)
    height, seen = np.zeros(len(edges)), np.zeros(len(edges))
    found, bins, strongest = [], 0, 0.0
    for item in samples.compared:
        power, at = periodogram(item.residual, item.record.dt)
        cause, _ = periodogram(item.record.u, item.record.dt)
        free = ~_lines_of(cause)
        free[:3] = False
        white = np.where(free, power / _level(power), 0.0)
        strength = np.zeros(len(edges))
        np.maximum.at(strength, np.searchsorted(edges, at, "right") - 1, white)
        height += np.log1p(strength)
        seen += strength > 0
        tested = white[free & ~_harmonics(cause)]
        bins, strongest = bins + len(tested), tested.max(initial=strongest)
        found.append((at, white))
    often = seen >= max(0.5 * len(samples.compared), 1)
    # A bin exceeds x times its level with probability exp(-x); as the level is itself
    # read off a few neighbours, the tail is that of F with 2 and 2 nu degrees.
    nu = LEVEL_BINS * MEDIAN_EFFICIENCY / HANN_VARIANCE
    one = min((1 + strongest / nu) ** -nu, 1 - 1e-12)
    p_value = float(np.clip(-np.expm1(bins * np.log1p(-one)), 0.0, 1.0))
    if not np.any(often):
        return None, p_value
    low = edges[np.argmax(np.where(often, height / np.maximum(seen, 1), 0.0))]
    at, white = (np.concatenate(each) for each in zip(*found, strict=True))
    near = (at >= low) & (at < low + step)
    # The strongest bins, weighted by their power, lie about the line.
    weights = np.where(near, white, 0.0) ** 2
    total = float(np.sum(weights))
    return (float(np.sum(weights * at) / total) if total > 0 else None), p_value


def _level(power: FloatArray) -> FloatArray:
    """Give the mean level of noise around each bin, by medians of blocks."""
    blocks = max(1, len(power) // LEVEL_BINS)
    size = -(-len(power) // blocks)
    first = np.linspace(0, len(power) - size, blocks).round().astype(int)
    medians = np.median(power[first[:, None] + np.arange(size)], axis=1)
    levels = np.log(np.maximum(medians / np.log(2), 1e-300))
    centres = first + size / 2
    return np.asarray(np.exp(np.interp(np.arange(len(power)), centres, levels)))


def _lines_of(cause: FloatArray) -> Mask:
    """Tell the bins in which the input has a line, and their neighbours."""
    lone = (cause > LINE_POWER * np.max(cause)) & (cause > STANDS_OUT * _level(cause))
    return np.convolve(lone, np.ones(3), mode="same") > 0


def _harmonics(cause: FloatArray) -> Mask:
    """Tell the bins of harmonics of the input's strongest line."""
    strongest = int(np.argmax(cause[1:])) + 1
    order = np.arange(len(cause)) / strongest
    return np.abs(order - np.round(order)) * strongest < 2.5

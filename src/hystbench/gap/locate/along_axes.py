"""Views along one axis: each is a general form that is fitted, a range and a sentence.

A form is what any function of the axis of a view could explain: columns for a least
squares fit of the residual. It is no law: laws are the effects', and where some are
named, what they add stands in its place.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from hystbench.blocks.curve import AHEAD
from hystbench.blocks.input_delay import later
from hystbench.blocks.linear import low_pass
from hystbench.gap.locate.forms import (
    FACTS,
    View,
    fit_form,
    hats,
    named_or,
    narrowest,
    narrowest_bins,
)
from hystbench.gap.locate.picture import (
    block_means,
    over_input,
    over_plane,
    over_records,
    over_time,
)
from hystbench.gap.locate.samples import ViewSamples
from hystbench.operators import play
from hystbench.record import FloatArray, Mask
from hystbench.sentences import percent, shortly

KNOTS = 9
"""Knots of a curve over an axis."""
ONE_SIDED_SHARE = 0.8
"""Share of what is explained on one side, or branch, for the other to be left out."""
THRESHOLDS = np.array([0.02, 0.05, 0.09, 0.13, 0.18, 0.24, 0.3, 0.37, 0.45, 0.54, 0.7])
"""Thresholds of play operators, as shares of the input's largest magnitude."""
RATE_EXPONENTS = (0.25, 0.5, 1.0)
"""Exponents of the rate."""
TIME_CONSTANTS = 4
"""Time constants, from a fifth of the slowest period to twice the longest record."""
DELAY_STARTS = 61
"""Delays that are tried, of both signs, before the best is refined."""
ROUGH_STRIDE = 4
"""One of so many samples of a view chooses a start."""
NEWTON_STEPS = 8
"""Steps of Gauss and Newton from there, at most."""
TOLERANCE = 1e-4
"""Share of a step between two starts to which a delay is found."""
LONGEST_PERIODS = 1.5
"""Longest shift in periods of the fastest input: a longer one is not told from a shift
by whole periods."""
QUIET = 1.5
"""Most power of a record's residual where the gap is not, in times of the noise's."""
RECORDS_TOLD = 3
"""Records that are told by name; of more, how many they are."""


def amplitude(samples: ViewSamples) -> View:
    """Fit a line and a curve over the input, and both over the simulated output."""
    axes = (("input", samples.input), ("output", samples.simulated))
    alike = "the same in rising and falling and at every rate"
    curves = [
        fit_form(samples, f"a {kind} over the {of}, {alike}", hats(values, knots))
        for kind, knots in (("line", 2), ("curve", KNOTS))
        for of, values in axes
    ]
    form = named_or(samples, "amplitude", curves)
    power = form.fitted**2
    above = _share_of(power, samples.input > 0)
    one_sided = max(above, 1 - above) > ONE_SIDED_SHARE
    axis = samples.input if one_sided else np.abs(samples.input)
    name = "input" if one_sided else "magnitude of the input"
    start, end = narrowest(axis, power)
    unit = samples.units[0]
    told = (
        f"is {form.words}; most of it lies where the {name} is between "
        f"{shortly(start)} and {shortly(end)} {unit}."
    )
    return form.seen("amplitude", name, (start, end), unit, told)


def branch(samples: ViewSamples) -> View:
    """Fit what no rate changes: a step where the input turns, play operators, squares.

    No loop of Preisach's is out of their reach, and with the squares none that is not
    alike for both signs.
    """
    u, direction = samples.input / samples.reach, samples.direction
    thresholds = THRESHOLDS * samples.reach
    signals = [play(item.record.u, thresholds) for item in samples.compared]
    plays = (samples.thinned(signals) / samples.reach).T
    alike, uneven = [u, direction, *plays], [np.ones_like(u), u**2, *plays[::2] ** 2]
    words = "the shape of the loop, at every rate alike"
    shapes = [fit_form(samples, words, each) for each in (alike, alike + uneven)]
    form = named_or(samples, "branch", shapes)
    rising = _share_of(form.fitted**2, direction > 0)
    told = (
        f"is {form.words}, {percent(rising)} of it while the input rises; it is "
        f"{shortly(float(np.mean(np.abs(form.fitted))))} {samples.units[1]} on average."
    )
    ends = (
        "falling" if rising < 1 - ONE_SIDED_SHARE else "rising",
        "rising" if rising > ONE_SIDED_SHARE else "falling",
    )
    return form.seen("branch", "branch", ends, "", told, over_input(samples))


def rate(samples: ViewSamples) -> View:
    """Fit odd powers of the rate, alone and by the input's magnitude."""
    top = max(float(np.max(np.abs(samples.speed))), 1e-300)
    speed, size = np.abs(samples.speed) / top, np.abs(samples.input) / samples.reach
    powers = [np.sign(samples.speed) * speed**exponent for exponent in RATE_EXPONENTS]
    wider = [power * factor for power in powers for factor in (1.0, size)]
    words = "a loop that widens with rate and amplitude"
    form = named_or(samples, "rate", [fit_form(samples, words, wider)])
    ends = narrowest(np.abs(samples.speed), form.fitted**2)
    unit = f"{samples.units[0]}/s"
    told = (
        f"is {form.words}; most of it lies where the input moves at "
        f"{shortly(ends[0])} to {shortly(ends[1])} {unit}."
    )
    axis, plane = "magnitude of the input's rate", over_plane(samples)
    return form.seen("rate", axis, ends, unit, told, *([plane] if plane else []))


def slow_time(samples: ViewSamples) -> View:
    """Fit low-passed output (as creep is) and square of the input (as heat is)."""
    longest = float(np.max(samples.durations))
    shortest = min(0.2 / float(np.min(samples.main_frequencies)), longest)
    times = np.geomspace(shortest, 2 * longest, TIME_CONSTANTS)
    slow = [
        column
        for signals in (
            [item.simulated for item in samples.compared],
            [item.record.u**2 for item in samples.compared],
        )
        for column in _passed(samples, signals, times)
    ]
    words = "like creep and heat together"
    form = named_or(samples, "slow-time", [fit_form(samples, words, slow)])
    ends = narrowest(samples.time, form.fitted**2)
    told = (
        f"follows the input with a memory, {form.words}; most of it lies between "
        f"{shortly(ends[0])} and {shortly(ends[1])} s."
    )
    axis, drawn = "time in the record", over_time(samples)
    return form.seen("slow-time", axis, ends, "s", told, drawn)


def _passed(
    samples: ViewSamples, signals: list[FloatArray], times: FloatArray
) -> list[FloatArray]:
    """Send a signal of each record, averaged between samples, through lags."""
    stride = samples.stride
    means = [block_means(signal, stride) for signal in signals]
    steps = [item.record.dt * stride for item in samples.compared]
    rows = list(zip(means, steps, samples.kept.positions, strict=True))
    return [
        np.concatenate([low_pass(x, dt, tau)[at // stride] for x, dt, at in rows])
        for tau in times
    ]


def delay(samples: ViewSamples) -> View:
    """Shift the simulated output in time until it fits best.

    A delay of the input of a simulator that does not change with time is a delay of its
    output, hysteresis or not. The range is the delay's interval of 95 %, the gap
    counting as few facts. The p-value is that of the first-order term, -delay * dy/dt.
    """
    slopes = [np.gradient(item.simulated, item.record.dt) for item in samples.compared]
    slope = samples.thinned(slopes)
    first = fit_form(samples, "a small delay", [slope])
    shift, moved = fit_delay(samples)
    shifted = fit_form(samples, "a delay", [moved])
    form = named_or(samples, "delay", [shifted], [first])
    rest = max(samples.power - shifted.explained, 0.0)
    facts = min(FACTS, len(samples.residual))
    power = max(float(np.mean(slope**2)), 1e-300)
    margin = 2 * float(np.sqrt(rest / power / facts))
    told = (
        f"is a phase linear in frequency: the measurement comes "
        f"{shortly(1e3 * abs(shift))} ms {'late' if shift >= 0 else 'early'}, at every "
        "rate and amplitude."
    )
    ends = (shift - margin, shift + margin)
    return form.seen("delay", "delay", ends, "s", told)


def fit_delay(samples: ViewSamples) -> tuple[float, FloatArray]:
    """Find the delay in seconds, and what it changes: on a grid, then refined.

    Where a record begins and ends it is not known what a delay brings in: samples
    there do not count.
    """
    runs = [(item.simulated, item.record.dt) for item in samples.compared]
    longest = 4 * max(dt for _, dt in runs)
    most = max(LONGEST_PERIODS / float(np.max(samples.main_frequencies)), longest)
    inner = []
    for (signal, dt), at in zip(runs, samples.kept.positions, strict=True):
        ends = min(int(most / dt) + AHEAD, len(signal) // 4)
        inner.append((at >= ends) & (at < len(signal) - ends))
    counted = np.concatenate(inner)

    def roughly(shift: float) -> float:
        missed = 0.0
        for (signal, dt), at, part, own in zip(
            runs, samples.kept.positions, samples.kept.slices, inner, strict=True
        ):
            few = at[own][::ROUGH_STRIDE]
            late = np.interp(few - shift / dt, np.arange(len(signal)), signal)
            rest = samples.residual[part][own][::ROUGH_STRIDE] - (late - signal[few])
            missed += float(rest @ rest)
        return missed

    def change(shift: float) -> FloatArray:
        return samples.thinned(
            [later(signal, shift / dt) - signal for signal, dt in runs]
        )

    def missed(moved: FloatArray) -> float:
        return float(np.sum((samples.residual - moved)[counted] ** 2))

    starts = np.linspace(-most, most, DELAY_STARTS).tolist()
    step = 2 * most / (DELAY_STARTS - 1)
    fine = TOLERANCE * step

    def refined(shift: float) -> tuple[float, float, FloatArray]:
        low, high, moved = shift - step, shift + step, change(shift)
        for _ in range(NEWTON_STEPS):
            slope = (change(shift + fine) - moved)[counted] / fine
            power = float(slope @ slope) or np.inf
            there = shift + float(slope @ (samples.residual - moved)[counted]) / power
            there = float(np.clip(there, low, high))
            after, by = change(there), abs(there - shift)
            if missed(after) >= missed(moved):
                break
            shift, moved = there, after
            if by < fine:
                break
        return missed(moved), shift, moved

    # Where records hardly show a delay, the best one is near zero.
    found = [refined(shift) for shift in (0.0, min(starts, key=roughly))]
    _, shift, moved = min(found, key=lambda item: item[0])
    return shift, moved


def record(samples: ViewSamples) -> View:
    """Share the gap's power out among the records.

    The range is the fewest neighbouring records that hold four fifths of it. For the
    rank, the record that holds most is given a gain and an offset of its own: this
    view comes first where one record is off. The p-value is that of a gain and an
    offset of each record's own.
    """
    squares = samples.residual**2
    above = [float(np.sum(squares[x] - samples.noise)) for x in samples.kept.slices]
    shares = np.maximum(above, 0.0)
    total = float(np.sum(shares))
    shares = shares / total if total > 0 else np.full(len(shares), 1 / len(shares))
    first, last = narrowest_bins(shares)
    share = float(np.sum(shares[first : last + 1]))
    names = [item.record.name for item in samples.compared]
    columns = np.stack([samples.simulated, np.ones_like(samples.simulated)])
    own = fit_form(samples, "gains and offsets", list(columns), by_record=True)
    there = np.zeros(columns.shape[1])
    there[samples.kept.slices[int(np.argmax(shares))]] = 1.0
    single = fit_form(samples, "gain and offset", list(columns * there), searched=1)
    form = named_or(samples, "record", [single], [own])
    where = names[first] if first == last else f"{names[first]} to {names[last]}"
    parts = zip(names, samples.kept.slices, strict=True)
    quiet = [x for x, at in parts if np.mean(squares[at]) <= QUIET * samples.noise]
    alone = " and ".join(quiet)
    if len(quiet) > RECORDS_TOLD:
        alone = f"{len(quiet)} records, {quiet[0]} among them,"
    told = (
        f"lies in {last - first + 1} of {len(names)} records, {where}; a gain and an "
        f"offset of each record's own would take away {percent(own.share)}."
        + (f" It leaves {alone} alone." if quiet else "")
    )
    ends, drawn = (names[first], names[last]), over_records(names, shares)
    return replace(form, share=share).seen("record", "record", ends, "", told, drawn)


def _share_of(power: FloatArray, part: Mask) -> float:
    return float(np.sum(power[part])) / max(float(np.sum(power)), 1e-300)

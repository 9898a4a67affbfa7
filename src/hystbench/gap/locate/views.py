"""Views along one axis: each is a set of forms that are fitted, a range and a sentence.

A form is what any function of the axis of a view could explain: columns for a least
squares fit of the residual. Where effects are named, what they add stands in its place.
"""

from __future__ import annotations

import numpy as np

from hystbench.blocks.linear import low_pass
from hystbench.gap.locate.forms import (
    FACTS,
    fit_form,
    hats,
    named_or,
    narrowest,
    narrowest_bins,
)
from hystbench.gap.locate.over_axis import (
    NOT_OVER_PLANE,
    block_means,
    over_input,
    over_plane,
    over_records,
    over_time,
)
from hystbench.gap.locate.samples import ViewSamples
from hystbench.gap.locate.view import View, number, percent, view_of
from hystbench.operators import play
from hystbench.record import FloatArray, Mask

KNOTS = 9
"""Of a map over an axis."""
ONE_SIDED = 0.8
"""Share of what is explained on one side, or branch, for the other to be left out."""
THRESHOLDS = np.array([0.02, 0.05, 0.09, 0.13, 0.18, 0.24, 0.3, 0.37, 0.45, 0.54, 0.7])
"""Of play operators, as shares of the input's largest magnitude."""
EXPONENTS = (0.25, 0.5, 1.0)
"""Of the rate."""
TIMES = 7
"""Time constants that are tried."""
LOOKED_AT = 3000
"""Samples of all records together that choose among them."""
STARTS = 61
"""Delays that are tried, of both signs, before the best is refined."""
PERIODS = 1.5
"""Of the fastest input: further a shift is not told from those by whole periods."""
QUIET = 1.5
"""Of the noise's power, that a record's residual has where the gap is not."""
NAMED = 3
"""Records that are told by name; of more, how many they are."""


def amplitude(samples: ViewSamples) -> View:
    """Fit a gain with an offset, and maps over input and simulated output.

    The p-value is the smaller of those of the two maps, doubled for the choice.
    """
    s, one = samples.simulated, np.ones_like(samples.simulated)
    maps = [
        fit_form(samples, f"a map over the {of}", hats(values, KNOTS))
        for of, values in (("input", samples.input), ("output", s))
    ]
    cubic = [one, s, s**2, s**3]
    forms = [
        fit_form(samples, "an offset", [one]),
        fit_form(samples, "a gain error", [s, one]),
        fit_form(samples, "a cubic function of the output", cubic),
    ]
    form = named_or(samples, "amplitude", [*forms, *maps])
    power = form.fitted**2
    above = _share_of(power, samples.input > 0)
    one_sided = max(above, 1 - above) > ONE_SIDED
    axis = samples.input if one_sided else np.abs(samples.input)
    name = "input" if one_sided else "magnitude of the input"
    start, end = narrowest(axis, power)
    unit = samples.units[0]
    alike = "" if form.named else ", the same in rising and falling and at every rate"
    told = (
        f"is {form.words}{alike}; most of it lies where the {name} is between "
        f"{number(start)} and {number(end)} {unit}."
    )
    return view_of(samples, "amplitude", form, name, (start, end), unit, told, maps)


def branch(samples: ViewSamples) -> View:
    """Fit steps where the input turns and play operators, none of which knows a rate.

    The p-value is that of a step beside the play operators. No loop of Preisach's is
    out of their reach.
    """
    u, direction = samples.input / samples.reach, samples.direction
    thresholds = THRESHOLDS * samples.reach
    signals = [play(item.record.u, thresholds)[0] for item in samples.compared]
    plays = list((samples.thinned(signals) / samples.reach).T)
    shape = fit_form(samples, "the shape of the loop", [u, direction, *plays])
    steps = [direction, direction * u, direction * u**2]
    uneven = [np.ones_like(u), u, u**2, u**3, *plays, *(x**2 for x in plays[::2])]
    forms = [
        fit_form(samples, "a step between rising and falling", steps[:1]),
        fit_form(
            samples, "a step between the branches that depends on the input", steps
        ),
        shape,
        fit_form(samples, "the shape of an asymmetric loop", uneven),
    ]
    form = named_or(samples, "branch", forms)
    rising = _share_of(form.fitted**2, direction > 0)
    alike = "" if form.named else ", at every rate alike"
    told = (
        f"is {form.words}{alike}, {percent(rising)} of it while the input rises; it is "
        f"{number(float(np.mean(np.abs(form.fitted))))} {samples.units[1]} on average."
    )
    ends = (
        "falling" if rising < 1 - ONE_SIDED else "rising",
        "rising" if rising > ONE_SIDED else "falling",
    )
    picture = over_input(samples)
    return view_of(
        samples, "branch", form, "branch", ends, "", told, [shape], [picture]
    )


def rate(samples: ViewSamples) -> View:
    """Fit odd powers of the rate, alone and by the input's magnitude.

    The p-value is that of the odd powers.
    """
    top = max(float(np.max(np.abs(samples.speed))), 1e-300)
    speed, size = np.abs(samples.speed) / top, np.abs(samples.input) / samples.reach
    powers = [np.sign(samples.speed) * speed**exponent for exponent in EXPONENTS]
    wider = [power * factor for power in powers for factor in (1.0, size)]
    odd = fit_form(samples, "an odd function of the rate", powers)
    loop = fit_form(samples, "a loop that widens with rate and amplitude", wider)
    form = named_or(samples, "rate", [odd, loop])
    start, end = narrowest(np.abs(samples.speed), form.fitted**2)
    unit = f"{samples.units[0]}/s"
    told = (
        f"is {form.words}; most of it lies where the input moves at {number(start)} to "
        f"{number(end)} {unit}."
    )
    axis, plane = "magnitude of the input's rate", over_plane(samples)
    drawn = (plane,) if plane else ()
    lacks = () if plane else (NOT_OVER_PLANE,)
    ends = (start, end)
    return view_of(samples, "rate", form, axis, ends, unit, told, [odd], drawn, lacks)


def slow_time(samples: ViewSamples) -> View:
    """Fit low-passed output (creep) and low-passed square of the input (heat).

    The p-value is that of both together.
    """
    period = float(1 / np.min(samples.main_frequencies))
    longest = float(np.max(samples.durations))
    times = np.geomspace(min(0.2 * period, longest), 2 * longest, TIMES)
    crept = _passed(samples, [item.simulated for item in samples.compared], times)
    heated = _passed(samples, [item.record.u**2 for item in samples.compared], times)
    both = fit_form(samples, "creep and heat together", [*crept[1::2], *heated[1::2]])
    forms = [
        fit_form(samples, "creep", crept),
        fit_form(samples, "the square of the input, as heat does", heated),
        *(fit_form(samples, "creep", [each], searched=1) for each in crept),
        *(fit_form(samples, "heat", [each], searched=1) for each in heated),
        both,
    ]
    form = named_or(samples, "slow-time", forms)
    start, end = narrowest(samples.time, form.fitted**2)
    like = form.words if form.named else f"like {form.words}"
    told = (
        f"follows the input with a memory, {like}; most of it lies between "
        f"{number(start)} and {number(end)} s."
    )
    axis, drawn = "time in the record", [over_time(samples)]
    return view_of(
        samples, "slow-time", form, axis, (start, end), "s", told, [both], drawn
    )


def _passed(
    samples: ViewSamples, signals: list[FloatArray], times: FloatArray
) -> list[FloatArray]:
    """Send a signal of each record, averaged between samples, through lags."""
    stride = samples.stride
    means = [block_means(signal, stride) for signal in signals]
    steps = [item.record.dt * stride for item in samples.compared]
    rows = list(zip(means, steps, samples.places, strict=True))
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
    form = named_or(samples, "delay", [shifted])
    rest = max(samples.power - shifted.explained, 0.0)
    facts = min(FACTS, len(samples.residual))
    power = max(float(np.mean(slope**2)), 1e-300)
    margin = 2 * float(np.sqrt(rest / power / facts))
    told = (
        f"is a phase linear in frequency: the measurement comes "
        f"{number(1e3 * abs(shift))} ms {'late' if shift >= 0 else 'early'}, at every "
        "rate and amplitude."
    )
    ends = (shift - margin, shift + margin)
    return view_of(samples, "delay", form, "delay", ends, "s", told, [first])


def fit_delay(samples: ViewSamples) -> tuple[float, FloatArray]:
    """Find the delay in seconds, and what it changes: on a grid, then refined."""
    from scipy.interpolate import CubicSpline  # late: both take long to load
    from scipy.optimize import minimize_scalar

    paths = [CubicSpline(item.record.time, item.simulated) for item in samples.compared]

    def change(shifts: FloatArray, every: int = 1) -> FloatArray:
        """Give what shifts change, shape (shifts, samples)."""
        moved = [
            path(
                np.clip(samples.time[part][::every] - shifts[:, None], *path.x[[0, -1]])
            )
            - samples.simulated[part][::every]
            for path, part in zip(paths, samples.slices, strict=True)
        ]
        return np.hstack(moved)

    def missed(shifts: FloatArray, every: int = 1) -> FloatArray:
        rest = [samples.residual[part][::every] for part in samples.slices]
        away = np.concatenate(rest) - change(shifts, every)
        return np.asarray(np.einsum("ij,ij->i", away, away) / away.shape[1])

    def missed_by(shift: float) -> float:
        return float(missed(np.array([shift]))[0])

    longest = 4 * max(item.record.dt for item in samples.compared)
    most = max(PERIODS / float(np.max(samples.main_frequencies)), longest)
    # From zero on, which wins ties: a record that tells nothing has no delay.
    grid = np.linspace(-most, most, STARTS)
    grid = grid[np.argsort(np.abs(grid), kind="stable")]
    few = max(1, len(samples.residual) // LOOKED_AT)
    start, step = float(grid[np.argmin(missed(grid, few))]), 2 * most / (STARTS - 1)
    ends = (start - step, start + step)
    search = minimize_scalar(missed_by, bounds=ends, options={"xatol": 1e-4 * step})
    shift = float(search.x)
    shift = shift if missed_by(shift) < missed_by(0.0) else 0.0
    return shift, change(np.array([shift]))[0]


def record(samples: ViewSamples) -> View:
    """Share the gap's power out among the records.

    The range is the fewest neighbouring records that hold four fifths of it. For the
    rank, the record that holds most is given a gain and an offset of its own: this
    view comes first where one record is off. The p-value is that of a gain and an
    offset of each record's own.
    """
    squares = samples.residual**2
    above = [float(np.sum(squares[x] - samples.noise)) for x in samples.slices]
    shares = np.maximum(above, 0.0)
    total = float(np.sum(shares))
    shares = shares / total if total > 0 else np.full(len(shares), 1 / len(shares))
    first, last = narrowest_bins(shares)
    share = float(np.sum(shares[first : last + 1]))
    names = [item.record.name for item in samples.compared]
    columns = np.stack([samples.simulated, np.ones_like(samples.simulated)])
    own = fit_form(samples, "gains and offsets", list(columns), by_record=True)
    there = np.zeros(columns.shape[1])
    there[samples.slices[int(np.argmax(shares))]] = 1.0
    single = fit_form(samples, "gain and offset", list(columns * there), searched=1)
    where = names[first] if first == last else f"{names[first]} to {names[last]}"
    parts = zip(names, samples.slices, strict=True)
    quiet = [x for x, at in parts if np.mean(squares[at]) <= QUIET * samples.noise]
    alone = " and ".join(quiet)
    if len(quiet) > NAMED:
        alone = f"{len(quiet)} records, {quiet[0]} among them,"
    told = (
        f"lies in {last - first + 1} of {len(names)} records, {where}; a gain and an "
        f"offset of each record's own would take away {percent(own.share)}."
        + (f" It leaves {alone} alone." if quiet else "")
    )
    ends, drawn = (names[first], names[last]), [over_records(names, shares)]
    return view_of(
        samples, "record", single, "record", ends, "", told, [own], drawn, share=share
    )


def _share_of(power: FloatArray, part: Mask) -> float:
    return float(np.sum(power[part])) / max(float(np.sum(power)), 1e-300)

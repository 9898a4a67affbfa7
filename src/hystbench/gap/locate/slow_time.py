"""The slow-time view: what follows the input with a long memory: creep, heat."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from hystbench.blocks.linear import low_pass
from hystbench.gap.locate.forms import fit_form, named_or, narrowest, p_value_of
from hystbench.gap.locate.picture import Axis, Panel, Picture, series
from hystbench.gap.locate.samples import ViewSamples
from hystbench.gap.locate.view import View, number, percent
from hystbench.gap.records.residual import Compared
from hystbench.record import FloatArray

TIMES = 7
"""Time constants that are tried."""
BLOCKS = 25
"""Means of a record in the picture, at most."""


def slow_time(samples: ViewSamples) -> View:
    """Fit low-passed output (creep) and low-passed square of the input (heat).

    The p-value is that of both together.
    """
    period = float(1 / np.min(samples.main_frequencies))
    longest = float(np.max(samples.durations))
    times = np.geomspace(min(0.2 * period, longest), 2 * longest, TIMES)
    crept = _passed(samples, lambda item: item.simulated, times)
    heated = _passed(samples, lambda item: item.record.u**2, times)
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
    share = samples.share(form.explained, form.freedom)
    like = form.words if form.named else f"like {form.words}"
    return View(
        view="slow-time",
        axis="time in the record",
        start=start,
        end=end,
        unit="s",
        share_of_gap_power=share,
        p_value=p_value_of(samples, form, [both]),
        sentence=(
            f"{percent(share)} of the gap follows the input with a memory, {like}; "
            f"most of it lies between {number(start)} and {number(end)} s."
        ),
        saved=form.saved,
        named=form.named,
        pictures=(_picture(samples),),
    )


def _passed(
    samples: ViewSamples, of: Callable[[Compared], FloatArray], times: FloatArray
) -> list[FloatArray]:
    """Send a signal, averaged between samples, through lags."""
    means = [block_means(of(item), samples.stride) for item in samples.compared]
    steps = [item.record.dt * samples.stride for item in samples.compared]
    return [
        np.concatenate(
            [
                low_pass(mean, dt, tau)[places // samples.stride]
                for mean, dt, places in zip(means, steps, samples.places, strict=True)
            ]
        )
        for tau in times
    ]


def block_means(values: FloatArray, size: int) -> FloatArray:
    """Average blocks of as many samples each; the last may be shorter."""
    starts = np.arange(0, len(values), size)
    counts = np.diff(np.append(starts, len(values)))
    return np.add.reduceat(values, starts) / counts


def _picture(samples: ViewSamples) -> Picture:
    """Draw the mean residual over blocks of whole periods, record behind record."""
    lines, start = [], 0.0
    frequencies = samples.main_frequencies.tolist()
    for k, (item, frequency) in enumerate(
        zip(samples.compared, frequencies, strict=True)
    ):
        n, dt = len(item.record), item.record.dt
        period = item.record.period_samples or round(1 / max(frequency * dt, 1 / n))
        # Whole periods, so that what repeats cancels alike in every block.
        size = min(n, max(1, period) * max(1, -(-n // (BLOCKS * max(1, period)))))
        means = block_means(item.residual[: n // size * size], size)
        at = start + (np.arange(len(means)) + 0.5) * size * dt
        lines.append(series(("first", "second")[k % 2], at, means, item.record.name))
        start += len(means) * size * dt
    panel = Panel(
        Axis("time, record behind record", "s"),
        Axis("mean residual", samples.units[1]),
        tuple(lines),
        labelled_above=True,
    )
    words = "Mean of the residual over slow time, record behind record"
    return Picture("slow", words, (panel,))

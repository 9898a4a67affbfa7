"""The slow-time view: what follows the input with a long memory: creep, heat."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from hystbench.blocks.linear import low_pass
from hystbench.gap.compared import Compared
from hystbench.gap.locate.regression import (
    Form,
    best,
    fit_form,
    fitted_p_value,
    narrowest,
)
from hystbench.gap.locate.samples import Samples
from hystbench.gap.locate.view import View, number, percent
from hystbench.record import FloatArray

TIMES = 7


def slow_time_view(samples: Samples) -> View:
    """Fit low-passed output (creep) and low-passed square of the input (heat).

    The p-value is that of all of them together.
    """
    forms, times = slow_forms(samples)
    form = best(list(forms.values()))
    kind = next(name for name, one in forms.items() if one is form)
    start, end = narrowest(samples.time, form.fitted**2)
    share = samples.share(form.explained, form.freedom)
    return View(
        view="slow-time",
        axis="time in the record",
        start=start,
        end=end,
        unit="s",
        share_of_gap_power=share,
        p_value=fitted_p_value(samples, forms["creep and heat together"]),
        sentence=(
            f"{percent(share)} of the gap follows the input with a memory, like "
            f"{kind}; time constants from {number(times[0])} to {number(times[-1])} s "
            f"tried; most of it lies between {number(start)} and {number(end)} s."
        ),
        saved=form.saved,
    )


def slow_forms(samples: Samples) -> tuple[dict[str, Form], FloatArray]:
    """Fit every slow form that the input explains, by what it is in words."""
    period = float(1 / np.min(samples.main_frequencies))
    longest = float(np.max(samples.durations))
    times = np.geomspace(min(0.2 * period, longest), 2 * longest, TIMES)

    def passed(of: Callable[[Compared], FloatArray]) -> list[FloatArray]:
        means = [block_means(of(item), samples.stride) for item in samples.compared]
        steps = [item.record.dt * samples.stride for item in samples.compared]
        return [
            np.concatenate(
                [
                    low_pass(v, dt, tau)[places // samples.stride]
                    for v, dt, places in zip(means, steps, samples.places, strict=True)
                ]
            )
            for tau in times
        ]

    crept = passed(lambda item: item.simulated)
    heated = passed(lambda item: item.record.u**2)
    one = np.ones_like(samples.residual)
    forms = {
        "creep": best([fit_form(samples, [c], searched=1) for c in crept]),
        "creep of several time constants": fit_form(samples, crept),
        "the square of the input, as heat does": best(
            [fit_form(samples, [h], searched=1) for h in heated]
            + [fit_form(samples, [h, one], searched=1) for h in heated]
        ),
        "heat of several time constants": fit_form(samples, heated),
        "creep and heat together": fit_form(samples, [*crept[1::2], *heated[1::2]]),
    }
    return forms, times


def block_means(values: FloatArray, size: int) -> FloatArray:
    """Average blocks of as many samples each; the last may be shorter."""
    starts = np.arange(0, len(values), size)
    counts = np.diff(np.append(starts, len(values)))
    return np.add.reduceat(values, starts) / counts

"""The delay view: a phase that is linear in frequency."""

from __future__ import annotations

from functools import partial
from typing import cast

import numpy as np

from hystbench.gap.compared import Compared
from hystbench.gap.locate.regression import (
    FACTS,
    Form,
    best,
    fit_form,
    fitted_p_value,
    saved,
)
from hystbench.gap.locate.samples import Samples, derivative
from hystbench.gap.locate.view import View, number, percent
from hystbench.record import FloatArray

STEPS = 6


def delay_view(samples: Samples) -> View:
    """Shift the simulated output in time until it fits best.

    A delay of the input of a simulator that does not change with time is a delay of its
    output, hysteresis or not. The range is the delay's interval of 95 %, the gap
    counting as few facts. The p-value is that of the first-order term, -delay * dy/dt.
    """
    first = fit_form(samples, [samples.simulated_speed])
    delay, form = fit_delay(samples)
    share = samples.share(form.explained, 1)
    rest = max(samples.power - form.explained, 0.0)
    slope = max(float(np.mean(samples.simulated_speed**2)), 1e-300)
    facts = min(FACTS, len(samples.residual))
    margin = 2 * float(np.sqrt(rest / slope / facts))
    word = "late" if delay >= 0 else "early"
    return View(
        view="delay",
        axis="delay",
        start=delay - margin,
        end=delay + margin,
        unit="s",
        share_of_gap_power=share,
        p_value=fitted_p_value(samples, first),
        sentence=(
            f"{percent(share)} of the gap is a phase linear in frequency: the "
            f"measurement comes {number(1e3 * abs(delay))} ms {word}, at every rate "
            f"and amplitude."
        ),
        saved=form.saved,
    )


def fit_delay(samples: Samples) -> tuple[float, Form]:
    """Find the delay in seconds by Gauss-Newton steps from several starts.

    Returns
    -------
    delay : float
    form : Form
        With one free parameter.
    """
    target = samples.residual + samples.simulated
    speed = samples.simulated_speed
    mean_speed = max(float(np.mean(speed**2)), 1e-300)
    delay, shifted = 0.0, samples.simulated
    least = float(np.mean((target - shifted) ** 2))
    # Beyond a quarter of the fastest period a shift is no longer told from a phase.
    limit = 0.25 / float(np.max(samples.main_frequencies))
    limit = max(limit, 4 * max(item.record.dt for item in samples.compared))
    step = 1.0
    for _ in range(STEPS):
        moved = float(np.mean((shifted - target) * speed)) / mean_speed
        trial = float(np.clip(delay + step * moved, -limit, limit))
        tried = samples.thin(partial(_shift, delay=trial))
        error = float(np.mean((target - tried) ** 2))
        if error < least:
            if least - error < 1e-6 * least:
                delay, shifted, least = trial, tried, error
                break
            delay, shifted, least = trial, tried, error
        else:
            step *= 0.5
    explained = samples.power - least
    fitted = shifted - samples.simulated
    alone = Form(fitted, explained, 1, saved(samples, explained, 1))
    return delay, best([alone, fit_form(samples, [fitted], searched=1)])


def _shift(item: Compared, delay: float) -> FloatArray:
    """Delay the simulated output by cubic Hermite interpolation."""
    dt, values = item.record.dt, item.simulated
    n = len(values)
    slope = derivative(values, dt) * dt
    place = np.clip(np.arange(n) - delay / dt, 0.0, n - 1.0)
    left = np.minimum(place.astype(np.int64), n - 2)
    x = place - left
    a, b = values[left], values[left + 1]
    p, q = slope[left], slope[left + 1]
    chord = b - a
    bent = p + x * (3 * chord - 2 * p - q + x * (p + q - 2 * chord))
    return cast(FloatArray, a + x * bent)

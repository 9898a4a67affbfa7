"""The delay view: a phase that is linear in frequency."""

from __future__ import annotations

from typing import cast

import numpy as np
from numpy.typing import NDArray

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
from hystbench.gap.locate.spectra import Spectra
from hystbench.gap.locate.view import View, number, percent
from hystbench.record import FloatArray

# Delays that are tried first, and rounds of parabolas after that.
STARTS = 301
STEPS = 3


def delay_view(samples: Samples, spectra: Spectra) -> View:
    """Shift the simulated output in time until it fits best.

    A delay of the input of a simulator that does not change with time is a delay of its
    output, hysteresis or not. The range is the delay's interval of 95 %, the gap
    counting as few facts. The p-value is that of the first-order term, -delay * dy/dt.
    """
    first = fit_form(samples, [samples.simulated_speed])
    delay, form = fit_delay(samples, spectra)
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


def fit_delay(samples: Samples, spectra: Spectra) -> tuple[float, Form]:
    """Find the delay in seconds: by the cross-spectrum, then by parabolas in time.

    Returns
    -------
    delay : float
    form : Form
        With one free parameter.
    """
    slopes = [derivative(item.simulated, item.record.dt) for item in samples.compared]

    def shifted(delay: float) -> FloatArray:
        parts = zip(samples.compared, slopes, samples.places, strict=True)
        return np.concatenate(
            [_shift(item, slope, delay, places) for item, slope, places in parts]
        )

    target = samples.residual + samples.simulated
    # Beyond one and a half of the fastest period a shift is no longer told from
    # others that differ by whole periods.
    limit = 1.5 / float(np.max(samples.main_frequencies))
    limit = max(limit, 4 * max(item.record.dt for item in samples.compared))
    grid = np.linspace(-limit, limit, STARTS)
    turned = np.exp(2j * np.pi * np.outer(grid, spectra.frequency))
    likeness = np.real(turned @ (spectra.cross + spectra.simulated))
    # Zero wins ties: a record that tells nothing has no delay.
    delay = float(grid[np.argmax(likeness - 1e-9 * np.abs(likeness) * np.abs(grid))])
    step = float(grid[1] - grid[0])
    for _ in range(STEPS):
        places = np.array([delay - step, delay, delay + step])
        errors = [float(np.mean((target - shifted(one)) ** 2)) for one in places]
        bend = errors[0] - 2 * errors[1] + errors[2]
        if bend <= 0:
            break
        moved = 0.5 * step * (errors[0] - errors[2]) / bend
        delay += float(np.clip(moved, -step, step))
        step *= 0.3
    fitted = shifted(delay) - samples.simulated
    explained = samples.power - float(np.mean((samples.residual - fitted) ** 2))
    alone = Form(fitted, explained, 1, saved(samples, explained, 1))
    return delay, best([alone, fit_form(samples, [fitted], searched=1)])


def _shift(
    item: Compared, slope: FloatArray, delay: float, places: NDArray[np.intp]
) -> FloatArray:
    """Delay the simulated samples at some places by cubic Hermite interpolation."""
    dt, values = item.record.dt, item.simulated
    n = len(values)
    place = np.clip(places - delay / dt, 0.0, n - 1.0)
    left = np.minimum(place.astype(np.int64), n - 2)
    x = place - left
    a, p, q = values[left], slope[left] * dt, slope[left + 1] * dt
    chord = values[left + 1] - a
    bent = p + x * (3 * chord - 2 * p - q + x * (p + q - 2 * chord))
    return cast(FloatArray, a + x * bent)

"""The rate view: what grows with the speed of the input, nonlinearly."""

from __future__ import annotations

from typing import cast

import numpy as np
from scipy import signal

from hystbench.gap.compared import Compared
from hystbench.gap.locate.branch import plays
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

EXPONENTS = (0.25, 0.5, 1.0)
# Where a slew limit may begin, as shares of the greatest speed.
LIMITS = (0.15, 0.3, 0.5, 0.7)


def rate_view(samples: Samples) -> View:
    """Fit powers of the rate, loops that widen with it, and what exceeds a rate.

    The p-value is that of the odd map over the rate.
    """
    unit = f"{samples.compared[0].record.input.unit}/s"
    forms = rate_forms(samples)
    form = best(list(forms.values()))
    kind = next(name for name, one in forms.items() if one is form)
    speed = np.abs(samples.speed)
    start, end = narrowest(speed, form.fitted**2)
    share = samples.share(form.explained, form.freedom)
    return View(
        view="rate",
        axis="magnitude of the input's rate",
        start=start,
        end=end,
        unit=unit,
        share_of_gap_power=share,
        p_value=fitted_p_value(samples, forms["an odd map over the rate"]),
        sentence=(
            f"{percent(share)} of the gap is {kind}; most of it lies where the input "
            f"moves at {number(start)} to {number(end)} {unit}."
        ),
        saved=form.saved,
    )


def rate_forms(samples: Samples) -> dict[str, Form]:
    """Fit every form of the rate, by what it is in words."""
    top = max(float(np.max(np.abs(samples.speed))), 1e-300)
    speed = np.abs(samples.speed) / top
    sign = np.sign(samples.speed)
    powers = [sign * speed**exponent for exponent in EXPONENTS]
    size = np.abs(samples.input) / max(samples.reach, 1e-300)
    # What plays lag behind their input is the loop's width; here it grows with rate.
    widths = [(one - samples.input) / samples.reach for one in plays(samples)[::2]]
    widening = [
        fit_form(samples, [width * speed**exponent for width in widths], searched=1)
        for exponent in EXPONENTS
    ]
    powered = [fit_form(samples, [power], searched=1) for power in powers]
    return {
        "a power of the rate": best(powered),
        "an odd map over the rate": fit_form(samples, powers),
        "a loop that widens with the rate": best(widening),
        "a loop that widens with the rate and the amplitude": fit_form(
            samples, [power * f for power in powers for f in (1.0 + 0 * size, size)]
        ),
        "what exceeds a rate and is caught up later": _excess(samples, top),
    }


def _excess(samples: Samples, top: float) -> Form:
    """Fit the speed above a limit, remembered for a while: a slew limit's shape."""
    fastest = float(np.max(samples.main_frequencies))
    forms = []
    for limit in LIMITS:
        columns = [
            samples.thin(lambda item, a=limit, b=memory: _remembered(item, a * top, b))
            for memory in (0.03 / fastest, 0.1 / fastest, 0.3 / fastest)
        ]
        forms.append(fit_form(samples, columns, searched=1))
    return best(forms)


def _remembered(item: Compared, limit: float, memory: float) -> FloatArray:
    """Integrate the speed above a limit, forgetting it with a time constant."""
    dt = item.record.dt
    speed = np.gradient(item.record.u, dt)
    excess = speed - np.clip(speed, -limit, limit)
    keep = np.exp(-dt / memory)
    return cast(FloatArray, signal.lfilter([dt], [1.0, -keep], excess))

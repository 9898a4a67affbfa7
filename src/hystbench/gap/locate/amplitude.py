"""The amplitude view: what a static function of the input or the output explains."""

from __future__ import annotations

import numpy as np

from hystbench.gap.locate.regression import (
    Form,
    best,
    fit_form,
    fitted_p_value,
    hats,
    narrowest,
)
from hystbench.gap.locate.samples import Samples
from hystbench.gap.locate.view import View, number, percent
from hystbench.record import FloatArray

KNOTS = 9


def amplitude_view(samples: Samples) -> View:
    """Fit gain and offset, polynomials and maps over u and over the simulated output.

    The p-value is the smaller of those of the two maps, doubled for the choice.
    """
    forms = static_forms(samples)
    form = best(list(forms.values()))
    kind = next(name for name, one in forms.items() if one is form)
    power = form.fitted**2
    size = np.abs(samples.input)
    above = float(np.sum(power[samples.input > 0]))
    below = float(np.sum(power[samples.input < 0]))
    one_sided = max(above, below) > 0.8 * (above + below)
    axis = samples.input if one_sided else size
    start, end = narrowest(axis, power)
    name = "input" if one_sided else "magnitude of the input"
    unit = samples.compared[0].record.input.unit
    share = samples.share(form.explained, form.freedom)
    maps = [forms[f"a map over the {of}"] for of in ("input", "output")]
    p_value = min(1.0, 2 * min(fitted_p_value(samples, one) for one in maps))
    return View(
        view="amplitude",
        axis=name,
        start=start,
        end=end,
        unit=unit,
        share_of_gap_power=share,
        p_value=p_value,
        sentence=(
            f"{percent(share)} of the gap is {kind}, the same in rising and falling "
            f"and at every rate; most of it lies where the {name} is between "
            f"{number(start)} and {number(end)} {unit}."
        ),
        saved=form.saved,
    )


def static_forms(samples: Samples) -> dict[str, Form]:
    """Fit every static form, by what it is in words."""
    u = samples.input / samples.reach
    s = samples.simulated / max(float(np.max(np.abs(samples.simulated))), 1e-300)
    one = np.ones_like(u)
    return {
        "an offset": fit_form(samples, [one]),
        "a gain error": fit_form(samples, [s, one]),
        "a gain error of the input's part": fit_form(samples, [u, one]),
        "a quadratic function of the output": fit_form(samples, [one, s, s**2]),
        "an odd cubic function of the output": fit_form(samples, [one, s, s**3]),
        "a cubic function of the output": fit_form(samples, [one, s, s**2, s**3]),
        "a map over the input": fit_form(samples, hats(u, knots(u))),
        "a map over the output": fit_form(samples, hats(s, knots(s))),
    }


def knots(values: FloatArray, count: int = KNOTS) -> FloatArray:
    """Spread knots evenly over the values."""
    low, high = float(np.min(values)), float(np.max(values))
    return np.linspace(low, high if high > low else low + 1.0, count)

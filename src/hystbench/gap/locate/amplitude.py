"""The amplitude view: what a static function of the input or the output explains."""

from __future__ import annotations

import numpy as np

from hystbench.gap.locate.forms import fit_form, hats, named_or, narrowest, p_value_of
from hystbench.gap.locate.samples import ViewSamples
from hystbench.gap.locate.view import View, number, percent

KNOTS = 9
"""Of a map over an axis."""
ONE_SIDED = 0.8
"""Share of what is explained on one side of zero, for the side to be told."""


def amplitude(samples: ViewSamples) -> View:
    """Fit a gain with an offset, and maps over input and simulated output.

    The p-value is the smaller of those of the two maps, doubled for the choice.
    """
    s, one = samples.simulated, np.ones_like(samples.simulated)
    maps = [
        fit_form(samples, f"a map over the {of}", hats(values, KNOTS))
        for of, values in (("input", samples.input), ("output", s))
    ]
    powers = [one, s, s**2, s**3]
    forms = [
        fit_form(samples, "an offset", [one]),
        fit_form(samples, "a gain error", [s, one]),
        fit_form(samples, "a cubic function of the output", powers),
    ]
    form = named_or(samples, "amplitude", [*forms, *maps])
    power = form.fitted**2
    above = float(np.sum(power[samples.input > 0])) / max(float(np.sum(power)), 1e-300)
    one_sided = max(above, 1 - above) > ONE_SIDED
    axis = samples.input if one_sided else np.abs(samples.input)
    name = "input" if one_sided else "magnitude of the input"
    start, end = narrowest(axis, power)
    share = samples.share(form.explained, form.freedom)
    unit = samples.units[0]
    alike = "" if form.named else ", the same in rising and falling and at every rate"
    return View(
        view="amplitude",
        axis=name,
        start=start,
        end=end,
        unit=unit,
        share_of_gap_power=share,
        p_value=p_value_of(samples, form, maps),
        sentence=(
            f"{percent(share)} of the gap is {form.words}{alike}; most of it lies "
            f"where the {name} is between {number(start)} and {number(end)} {unit}."
        ),
        saved=form.saved,
        named=form.named,
    )

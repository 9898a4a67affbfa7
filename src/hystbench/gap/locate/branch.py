"""The branch view: what rising and falling inputs do differently, at any rate."""

from __future__ import annotations

import numpy as np

from hystbench.gap.locate.loops import take_loops, told
from hystbench.gap.locate.regression import Form, best, fit_form, fitted_p_value
from hystbench.gap.locate.samples import Samples
from hystbench.gap.locate.view import View, number, percent
from hystbench.operators import play
from hystbench.record import FloatArray

# Half-widths of a backlash, as shares of the simulated output's largest magnitude.
BACKLASH = (0.01, 0.02, 0.04, 0.07, 0.12, 0.2)
# Speeds over which friction turns, as shares of the greatest.
SOFTNESS = (0.0002, 0.0005, 0.001, 0.003, 0.01, 0.03, 0.1, 0.25)


def branch_view(samples: Samples) -> View:
    """Fit friction, backlash and play operators, none of which knows a rate.

    The p-value is that of friction beside the play operators.
    """
    forms = branch_forms(samples)
    form = best(list(forms.values()))
    kind = next(name for name, one in forms.items() if one is form)
    power = form.fitted**2
    rising = float(np.sum(power[samples.direction > 0]))
    rising /= max(float(np.sum(power)), 1e-300)
    start = "falling" if rising < 0.2 else "rising"
    end = "rising" if rising > 0.8 else "falling"
    share = samples.share(form.explained, form.freedom)
    unit = samples.compared[0].record.output.unit
    apart = float(np.mean(np.abs(form.fitted)))
    return View(
        view="branch",
        axis="branch",
        start=start,
        end=end,
        unit="",
        share_of_gap_power=share,
        p_value=fitted_p_value(samples, forms["the shape of the loop"]),
        sentence=(
            f"{percent(share)} of the gap is {kind}, at every rate alike, "
            f"{percent(rising)} of it while the input rises; it is {number(apart)} "
            f"{unit} on average.{told(take_loops(samples))}"
        ),
        saved=form.saved,
    )


def branch_forms(samples: Samples) -> dict[str, Form]:
    """Fit every form that tells rising from falling, by what it is in words."""
    u = samples.input / samples.reach
    direction = samples.direction
    loops = list(samples.plays / samples.reach)
    few = loops[1::2]
    top = max(float(np.max(np.abs(samples.speed))), 1e-300)
    soft = [
        fit_form(samples, [np.tanh(samples.speed / (share * top))], searched=1)
        for share in SOFTNESS
    ]
    slack = [fit_form(samples, [one], searched=1) for one in _slack(samples)]
    return {
        "a step between rising and falling": best(
            [fit_form(samples, [direction]), *soft]
        ),
        "a step between rising and falling that depends on the input": fit_form(
            samples, [direction, direction * u, direction * u**2]
        ),
        "a play at the output": best(slack),
        "the loop's width": fit_form(samples, [u, *few]),
        "the shape of the loop": fit_form(samples, [u, direction, *loops]),
        "the shape of an asymmetric loop": fit_form(
            samples, [np.ones_like(u), u, u**2, u**3, *loops, *[f**2 for f in few]]
        ),
    }


def _slack(samples: Samples) -> list[FloatArray]:
    """Give what a backlash of the simulated output would take away from it."""
    widths = np.array(BACKLASH) * float(np.max(np.abs(samples.simulated)))
    parts = []
    for item, places in zip(samples.compared, samples.places, strict=True):
        simulated = item.simulated
        lost = play(simulated, widths)[0] - simulated[:, np.newaxis]
        parts.append(lost[places])
    return list(np.ascontiguousarray(np.concatenate(parts).T))

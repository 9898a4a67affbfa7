"""The branch view: what rising and falling inputs do differently, at any rate."""

from __future__ import annotations

import numpy as np

from hystbench.gap.locate.forms import fit_form, named_or, p_value_of
from hystbench.gap.locate.picture import Axis, Panel, Picture, mean_in, series
from hystbench.gap.locate.samples import ViewSamples
from hystbench.gap.locate.view import View, number, percent
from hystbench.operators import play
from hystbench.record import FloatArray

THRESHOLDS = np.array([0.02, 0.05, 0.09, 0.13, 0.18, 0.24, 0.3, 0.37, 0.45, 0.54, 0.7])
"""Of play operators, as shares of the input's largest magnitude."""
ONE_SIDED = 0.8
"""Share of what is explained on one branch, for the other to be left out."""
CELLS = 40
"""Of the picture."""


def branch(samples: ViewSamples) -> View:
    """Fit steps where the input turns and play operators, none of which knows a rate.

    The p-value is that of a step beside the play operators.
    """
    u, direction = samples.input / samples.reach, samples.direction
    one, plays = np.ones_like(u), _plays(samples)
    shape = fit_form(samples, "the shape of the loop", [u, direction, *plays])
    steps = [direction, direction * u, direction * u**2]
    uneven = [one, u, u**2, u**3, *plays, *[each**2 for each in plays[::2]]]
    forms = [
        fit_form(samples, "a step between rising and falling", steps[:1]),
        fit_form(
            samples, "a step between the branches that depends on the input", steps
        ),
        shape,
        fit_form(samples, "the shape of an asymmetric loop", uneven),
    ]
    form = named_or(samples, "branch", forms)
    power = form.fitted**2
    rising = float(np.sum(power[direction > 0])) / max(float(np.sum(power)), 1e-300)
    share = samples.share(form.explained, form.freedom)
    alike = "" if form.named else ", at every rate alike"
    apart = float(np.mean(np.abs(form.fitted)))
    return View(
        view="branch",
        axis="branch",
        start="falling" if rising < 1 - ONE_SIDED else "rising",
        end="rising" if rising > ONE_SIDED else "falling",
        unit="",
        share_of_gap_power=share,
        p_value=p_value_of(samples, form, [shape]),
        sentence=(
            f"{percent(share)} of the gap is {form.words}{alike}, "
            f"{percent(rising)} of it while the input rises; it is {number(apart)} "
            f"{samples.units[1]} on average."
        ),
        saved=form.saved,
        named=form.named,
        pictures=(_picture(samples),),
    )


def _plays(samples: ViewSamples) -> list[FloatArray]:
    """Give play operators of the input: no loop of Preisach's is out of their reach."""
    thresholds = THRESHOLDS * samples.reach
    signals = [play(item.record.u, thresholds)[0] for item in samples.compared]
    return list((samples.thinned(signals) / samples.reach).T)


def _picture(samples: ViewSamples) -> Picture:
    """Draw the residual over the input, branch by branch."""
    u, residual = samples.input, samples.residual
    edges = np.linspace(
        float(u.min()), max(float(u.max()), u.min() + 1e-300), CELLS + 1
    )
    middle = 0.5 * (edges[1:] + edges[:-1])
    lines = [
        series(role, middle, mean_in(edges, u[way], residual[way]), role)
        for role, sign in (("rising", 1), ("falling", -1))
        for way in [samples.direction == sign]
    ]
    rms = series("noise", middle, np.sqrt(mean_in(edges, u, residual**2)), "rms")
    given, made = samples.units
    panel = Panel(Axis("input", given), Axis("mean residual", made), (*lines, rms))
    return Picture("over-input", "Mean residual over the input, by branch", (panel,))

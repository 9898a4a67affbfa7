"""The delay view: a phase that is linear in frequency."""

from __future__ import annotations

from functools import partial

import numpy as np

from hystbench.gap.locate.forms import FACTS, fit_form, named_or, p_value_of
from hystbench.gap.locate.samples import ViewSamples
from hystbench.gap.locate.view import View, number, percent
from hystbench.record import FloatArray

STARTS = 61
"""Delays that are tried, of both signs, before the best is refined."""
PERIODS = 1.5
"""Of the fastest input: further a shift is not told from those by whole periods."""


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
    share = samples.share(form.explained, form.freedom)
    return View(
        view="delay",
        axis="delay",
        start=shift - margin,
        end=shift + margin,
        unit="s",
        share_of_gap_power=share,
        p_value=p_value_of(samples, form, [first]),
        sentence=(
            f"{percent(share)} of the gap is a phase linear in frequency: the "
            f"measurement comes {number(1e3 * abs(shift))} ms "
            f"{'late' if shift >= 0 else 'early'}, at every rate and amplitude."
        ),
        saved=form.saved,
        named=form.named,
    )


def fit_delay(samples: ViewSamples) -> tuple[float, FloatArray]:
    """Find the delay in seconds, and what it changes: on a grid, then refined."""
    from scipy.interpolate import CubicSpline  # late: both take long to load
    from scipy.optimize import minimize_scalar

    paths = [CubicSpline(item.record.time, item.simulated) for item in samples.compared]
    times = [samples.time[part] for part in samples.slices]

    def change(shift: float) -> FloatArray:
        moved = [
            path(np.clip(at - shift, path.x[0], path.x[-1]))
            for path, at in zip(paths, times, strict=True)
        ]
        return np.concatenate(moved) - samples.simulated

    def missed(shift: float) -> float:
        return float(np.mean((samples.residual - change(shift)) ** 2))

    longest = 4 * max(item.record.dt for item in samples.compared)
    most = max(PERIODS / float(np.max(samples.main_frequencies)), longest)
    # From zero on, which wins ties: a record that tells nothing has no delay.
    grid = sorted(np.linspace(-most, most, STARTS).tolist(), key=abs)
    start, step = min(grid, key=missed), 2 * most / (STARTS - 1)
    ends = (start - step, start + step)
    search = partial(minimize_scalar, bounds=ends, options={"xatol": 1e-4 * step})
    found = float(search(missed).x)
    shift = found if missed(found) < missed(0.0) else 0.0
    return shift, change(shift)

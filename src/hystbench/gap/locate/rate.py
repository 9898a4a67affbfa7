"""The rate view: what grows with the speed of the input, nonlinearly."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

import numpy as np

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
from hystbench.operators import generalized_play, play
from hystbench.record import FloatArray

EXPONENTS = (0.25, 0.5, 1.0)
# Thresholds of a loop that widens, as shares of the input's largest magnitude, and by
# how much of themselves they grow at the greatest speed.
WIDTHS = (0.1, 0.25, 0.45, 0.7)
STRENGTHS = (0.3, 1.0, 3.0)
# Limits of the rate, as shares of the greatest; then, of the best of them.
LIMITS = (0.06, 0.12, 0.2, 0.32, 0.5, 0.75)
FINER = (0.75, 0.82, 0.9, 1.1, 1.2, 1.3)
# Samples of a piece and of its run-up, when records are cut to be limited at once.
PIECE = 512
RUN_UP = 128


def rate_view(samples: Samples) -> View:
    """Fit powers of the rate, loops that widen with it, and what exceeds a rate.

    The p-value is the smaller of two, doubled: that of the odd map over the rate, and
    that of the best form times the number of limits that were tried.
    """
    unit = f"{samples.compared[0].record.input.unit}/s"
    forms = rate_forms(samples)
    form = best(list(forms.values()))
    kind = next(name for name, one in forms.items() if one is form)
    speed = np.abs(samples.speed)
    start, end = narrowest(speed, form.fitted**2)
    share = samples.share(form.explained, form.freedom)
    mapped = fitted_p_value(samples, forms["an odd map over the rate"])
    tried = 2 * (len(LIMITS) + len(FINER))
    p_value = min(1.0, 2 * min(mapped, tried * fitted_p_value(samples, form)))
    return View(
        view="rate",
        axis="magnitude of the input's rate",
        start=start,
        end=end,
        unit=unit,
        share_of_gap_power=share,
        p_value=p_value,
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
    size = np.abs(samples.input) / samples.reach
    powered = [fit_form(samples, [power], searched=1) for power in powers]
    return {
        "a power of the rate": best(powered),
        "an odd map over the rate": fit_form(samples, powers),
        "a loop that widens with the rate": _widened(samples, top),
        "a loop that widens with the rate and the amplitude": fit_form(
            samples, [power * f for power in powers for f in (1.0 + 0 * size, size)]
        ),
        "what a limit of the rate leaves behind": _limited(samples, top),
    }


def _widened(samples: Samples, top: float) -> Form:
    """Fit plays whose thresholds grow with the rate, less those that do not grow.

    ``r (1 + strength (|du/dt| / top)^exponent)`` for a few of each; the weights of
    the thresholds are linear.
    """
    thresholds = np.array(WIDTHS) * samples.reach
    plain = [play(item.record.u, thresholds)[0].T for item in samples.compared]
    forms = []
    for exponent in EXPONENTS:
        for strength in STRENGTHS:
            run = partial(
                _widening,
                thresholds=thresholds,
                top=top,
                exponent=exponent,
                strength=strength,
            )
            parts = [
                (run(item) - own)[:, places]
                for item, own, places in zip(
                    samples.compared, plain, samples.places, strict=True
                )
            ]
            columns = list(np.concatenate(parts, axis=1))
            forms.append(fit_form(samples, columns, searched=2))
    return best(forms)


def _widening(
    item: Compared,
    thresholds: FloatArray,
    top: float,
    exponent: float,
    strength: float,
) -> FloatArray:
    """Give plays of growing thresholds, shape (thresholds, n)."""
    u = item.record.u
    speed = np.abs(np.gradient(u, item.record.dt)) / top
    growth = 1 + strength * speed**exponent
    found = np.empty((len(thresholds), len(u)))
    for row, threshold in enumerate(thresholds):
        half = threshold * growth
        grown, _ = generalized_play(u + half, u - half, [0.0])
        found[row] = grown[:, 0]
    return found


def _limited(samples: Samples, top: float) -> Form:
    """Fit what a limit of the rate leaves behind, of input, output and of both."""
    gain = float(np.max(np.abs(samples.simulated))) / samples.reach
    limits = np.array(LIMITS)
    found: list[Form] = []
    for _ in range(2):
        inward = _left_behind(samples, _input, top * limits)
        outward = _left_behind(samples, _simulated, gain * top * limits)
        forms = [
            best(
                [
                    fit_form(samples, [a], searched=1),
                    fit_form(samples, [b], searched=1),
                    fit_form(samples, [a, b], searched=1),
                ]
            )
            for a, b in zip(inward, outward, strict=True)
        ]
        found += forms
        nearest = int(np.argmax([form.saved for form in forms]))
        limits = limits[nearest] * np.array(FINER)
    return best(found)


def _input(item: Compared) -> FloatArray:
    return item.record.u


def _simulated(item: Compared) -> FloatArray:
    return item.simulated


def _left_behind(
    samples: Samples, of: Callable[[Compared], FloatArray], limits: FloatArray
) -> list[FloatArray]:
    """Give a slew-limited signal minus the signal, for each limit in units a second.

    The recursion runs over all limits and all pieces of all records at once; a piece
    begins with a run-up that is thrown away, long against the time a limiter lags.
    """
    pieces, owners = [], []
    for index, item in enumerate(samples.compared):
        values = of(item)
        count = -(-len(values) // PIECE)
        padded = np.pad(values, (RUN_UP, count * PIECE - len(values)), mode="edge")
        windows = np.lib.stride_tricks.sliding_window_view(padded, RUN_UP + PIECE)
        pieces.append(windows[::PIECE])
        owners += [index] * count
    path = np.ascontiguousarray(np.concatenate(pieces).T)[:, np.newaxis, :]
    dts = np.array([samples.compared[index].record.dt for index in owners])
    step = limits[:, np.newaxis] * dts
    state = np.repeat(path[0], len(limits), axis=0)
    behind = np.empty((PIECE, *state.shape))
    for row, target in enumerate(path):
        gap = target - state
        moved = np.minimum(np.maximum(gap, -step), step)
        state = state + moved
        if row >= RUN_UP:
            np.subtract(moved, gap, out=behind[row - RUN_UP])
    thinned = []
    for index, places in enumerate(samples.places):
        own = behind[:, :, np.array(owners) == index]
        whole = own.transpose(1, 2, 0).reshape(len(limits), -1)
        thinned.append(whole[:, places])
    return list(np.ascontiguousarray(np.concatenate(thinned, axis=1)))

"""An LMS filter on a record as the settings of a job ask for it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import Any

import numpy as np

from hystbench.envelope import PUBLISHED_ENVELOPE, Envelope
from hystbench.errors import InputError, nearest
from hystbench.filters import FILTERS, AdaptiveFilter, Result
from hystbench.record import FloatArray, Record
from hystbench.results import run_result

#: Step sizes of a filter in settings and results, and the filter's own names.
_STEP_NAMES = {"mu": "step_size"}
_VOLTERRA_STEP_NAMES = {
    "first_order": "step_size",
    "second_order": "second_order_step",
}


def step_names(model: str) -> dict[str, str]:
    """Names of a filter's step sizes in settings, and the filter's own for them."""
    return _VOLTERRA_STEP_NAMES if model == "volterra" else _STEP_NAMES


def make_filter(
    model: str,
    settings: Mapping[str, Any],
    record: Record,
    identified: Mapping[str, Any] | None = None,
    order: int | None = None,
) -> AdaptiveFilter:
    """Make a filter for a record.

    Parameters
    ----------
    model : str
        Name of the filter.
    settings : mapping
        Those of the job: ``order``, ``input_before``, ``constant_tap`` (as a multiple
        of the RMS of the other taps on the record), the filter's own, and either
        ``convergence_factor`` or ``fraction_of_bound``.
    record : Record
        Its input sets the bound, and the thresholds where no ``amplitude`` is set.
    identified : mapping, optional
        Result of Algorithm 1, for ``envelopes: identified``.
    order : int, optional
        Another order than that of the settings.

    Raises
    ------
    InputError
        If the filter is unknown, or identified envelopes are asked for but not given.
    """
    if model not in FILTERS:
        raise InputError(f"no filter {model!r}; {nearest(model, FILTERS)}")
    names = step_names(model)
    options: dict[str, Any] = {
        "order": settings["order"] if order is None else order,
        "x_before": settings["input_before"],
    }
    if model in ("gpo", "backlash"):
        amplitude = settings.get("amplitude", float(np.abs(record.u).max()))
        options |= {
            "amplitude": amplitude,
            "initial_state": settings["initial_state"],
        }
    if model == "gpo":
        options["form"] = settings["operator_form"]
        if settings["envelopes"] == "identified":
            if identified is None:
                raise InputError(
                    "envelopes: identified; expected the option --identified FILE"
                )
            options["envelope"] = Envelope.from_dict(identified["envelope"])
            options["amplitude"] = identified["amplitude"]
        else:
            options["envelope"] = PUBLISHED_ENVELOPE
    if model == "backlash":
        options["structure"] = settings["backlash_structure"]
    steps = settings.get("convergence_factor", dict.fromkeys(names, 1.0))
    options |= {own: float(steps[name]) for name, own in names.items()}
    adaptive = FILTERS[model](**options)
    if settings["constant_tap"]:
        size = settings["constant_tap"] * adaptive.tap_rms(record.u)
        adaptive = replace(adaptive, constant_tap=size)
    if "convergence_factor" in settings:
        return adaptive
    return with_fraction_of_bound(
        adaptive, record.u, dict.fromkeys(names, settings["fraction_of_bound"])
    )


def step_bounds(adaptive: AdaptiveFilter, x: FloatArray) -> dict[str, float]:
    """Bound of Eq. 19, 1 / tr R, on each step size of a filter for an input.

    Each part of the Volterra filter has the bound of its own part of R. Its traces
    are the means of ``s(k)`` and ``s(k)^2``, where s is the sum of the squared taps.
    """
    if adaptive.name != "volterra":
        return {"mu": adaptive.bound(x).bound}
    before = np.full(adaptive.taps, adaptive.x_before)
    total = np.cumsum(np.concatenate([before, x]) ** 2)
    power = total[adaptive.taps :] - total[: -adaptive.taps]
    first = power.mean() + adaptive.constant_tap**2
    traces = {"first_order": first, "second_order": (power**2).mean()}
    return {name: float(1 / trace) for name, trace in traces.items()}


def with_fraction_of_bound(
    adaptive: AdaptiveFilter, x: FloatArray, fractions: Mapping[str, float]
) -> AdaptiveFilter:
    """Set each step size of a filter to a fraction of its bound for an input."""
    bounds = step_bounds(adaptive, x)
    steps: dict[str, Any] = {
        own: fractions[name] * bounds[name]
        for name, own in step_names(adaptive.name).items()
    }
    return replace(adaptive, **steps)


def fraction_of_bound(adaptive: AdaptiveFilter, x: FloatArray) -> dict[str, float]:
    """Give each step size of a filter as a fraction of its bound for an input."""
    bounds = step_bounds(adaptive, x)
    names = step_names(adaptive.name)
    return {name: getattr(adaptive, own) / bounds[name] for name, own in names.items()}


def run_filter(
    adaptive: AdaptiveFilter, record: Record, settings: Mapping[str, Any]
) -> tuple[dict[str, Any], Result]:
    """Run a filter on a record and compute what is kept of it.

    Returns
    -------
    dict
        As :func:`hystbench.results.run_result`, and with the filter's order, step
        sizes, their bounds by Eq. 19, its largest correction, eigenvalues of R and
        final weights.
    Result
        Output and error at each sample.
    """
    model = adaptive.name
    result = adaptive.run(record.u, record.y)
    bound = adaptive.bound(record.u)
    steps = {name: getattr(adaptive, own) for name, own in step_names(model).items()}
    bounds = step_bounds(adaptive, record.u)
    kept = run_result(
        record,
        model,
        result.error,
        "one-step a priori",
        transient_fraction=settings["transient_fraction"],
        smoothing_fraction=settings["smoothing_fraction"],
        diverged=divergence(adaptive, record.u, result),
    )
    kept |= {
        "order": adaptive.order,
        "taps": adaptive.taps,
        "step_size": steps,
        "bound": bounds,
        # 2 mu max|H|^2: beyond 2 the recursion is unstable while H moves little.
        "largest_correction": adaptive.correction(adaptive.largest_power(record.u)),
        "eigenvalues": {
            "trace": bound.trace,
            "largest": bound.largest,
            "smallest": bound.smallest,
            "rank": bound.rank,
            "size": bound.size,
            "spread": finite_or_none(bound.spread),
            "spread_nonzero": finite_or_none(bound.spread_nonzero),
        },
        "weights": result.weights.tolist(),
    }
    return kept, result


def finite_or_none(value: float) -> float | None:
    """Infinity is no JSON number; an infinite spread is one that is not there."""
    return float(value) if np.isfinite(value) else None


def divergence(
    adaptive: AdaptiveFilter, x: FloatArray, result: Result
) -> dict[str, Any] | None:
    """Tell where a run diverged, with each step size beside its bound by Eq. 19.

    Returns
    -------
    dict or None
        ``sample`` and ``sentence``; None where it did not diverge.
    """
    if result.diverged_at is None:
        return None
    bounds = step_bounds(adaptive, x)
    names = step_names(adaptive.name)
    steps = {name: getattr(adaptive, own) for name, own in names.items()}
    told = ", ".join(
        f"{'mu' if name == 'mu' else 'mu of ' + name.replace('_', ' ')} = {step:.4g} "
        f"{'above' if step > bounds[name] else 'below'} 1/tr[R] = {bounds[name]:.4g}"
        for name, step in steps.items()
    )
    sentence = f"diverged at sample {result.diverged_at}, {told}"
    return {"sample": result.diverged_at, "sentence": sentence}

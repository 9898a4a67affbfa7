"""An LMS filter on a record as the settings of a job ask for it."""

from collections.abc import Mapping
from dataclasses import replace
from typing import Any

from hystbench.files import finite_or_none
from hystbench.filters import AdaptiveFilter, Result, filter_class
from hystbench.record import FloatArray, Record
from hystbench.results import run_result


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
    chosen = filter_class(model)
    names = chosen.step_sizes
    steps = settings.get("convergence_factor", dict.fromkeys(names, 1.0))
    options: dict[str, Any] = {
        "order": settings["order"] if order is None else order,
        "x_before": settings["input_before"],
        **{own: float(steps[name]) for name, own in names.items()},
        **chosen.options(settings, record, identified),
    }
    adaptive = chosen(**options)
    if settings["constant_tap"]:
        size = settings["constant_tap"] * adaptive.tap_rms(record.u)
        adaptive = replace(adaptive, constant_tap=size)
    if "convergence_factor" in settings:
        return adaptive
    return with_fraction_of_bound(
        adaptive, record.u, dict.fromkeys(names, settings["fraction_of_bound"])
    )


def steps_of(adaptive: AdaptiveFilter) -> dict[str, float]:
    """Give the step sizes of a filter by their names in settings and results."""
    return {name: getattr(adaptive, own) for name, own in adaptive.step_sizes.items()}


def with_steps(adaptive: AdaptiveFilter, steps: Mapping[str, float]) -> AdaptiveFilter:
    """Give a filter other step sizes, by their names in settings and results."""
    own: dict[str, Any] = {adaptive.step_sizes[name]: mu for name, mu in steps.items()}
    return replace(adaptive, **own)


def with_fraction_of_bound(
    adaptive: AdaptiveFilter, x: FloatArray, fractions: Mapping[str, float]
) -> AdaptiveFilter:
    """Set each step size of a filter to a fraction of its bound for an input."""
    bounds = adaptive.step_bounds(x)
    return with_steps(
        adaptive, {name: fractions[name] * bounds[name] for name in bounds}
    )


def fraction_of_bound(adaptive: AdaptiveFilter, x: FloatArray) -> dict[str, float]:
    """Give each step size of a filter as a fraction of its bound for an input."""
    bounds = adaptive.step_bounds(x)
    return {name: step / bounds[name] for name, step in steps_of(adaptive).items()}


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
    steps = steps_of(adaptive)
    bounds = adaptive.step_bounds(record.u)
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
    bounds = adaptive.step_bounds(x)
    steps = steps_of(adaptive)
    told = ", ".join(
        f"{'mu' if name == 'mu' else 'mu of ' + name.replace('_', ' ')} = {step:.4g} "
        f"{'above' if step > bounds[name] else 'below'} 1/tr[R] = {bounds[name]:.4g}"
        for name, step in steps.items()
    )
    sentence = f"diverged at sample {result.diverged_at}, {told}"
    return {"sample": result.diverged_at, "sentence": sentence}

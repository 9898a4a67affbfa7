"""Measures of the LMS algorithm, its step sizes, and the size of the filters."""

import math
from collections.abc import Sequence
from statistics import median
from typing import Any

from hystbench.compare.claims.claim import NotTestable, Numbers
from hystbench.compare.runs import ClaimEvidence, Run
from hystbench.order_errors import OrderError
from hystbench.published import FILTERS

ONE_STEP_SIZE = ("gpo", "backlash", "delayed")
"""Filters with one step size."""


def lms_runs(evidence: ClaimEvidence, models: Sequence[str] = FILTERS) -> list[Run]:
    """List the twin's runs of the adaptive filters.

    Raises
    ------
    NotTestable
        If there is none.
    """
    runs = [run for run in evidence.runs.values() if run.model in models]
    if not runs:
        raise NotTestable(f"not run: {' and '.join(models)}")
    return runs


def bound_and_eigenvalue(evidence: ClaimEvidence) -> Numbers:
    """Compare the bound of each run with its largest eigenvalue."""
    ratios = {
        f"{run.model} on {run.signal}": run.bound["mu"] * run.largest_eigenvalue
        for run in lms_runs(evidence, ONE_STEP_SIZE)
        if "mu" in run.bound and run.largest_eigenvalue is not None
    }
    if not ratios:
        raise NotTestable("no run tells its bound and its largest eigenvalue")
    nearest = max(ratios, key=lambda name: ratios[name])
    return {"ratio": ratios[nearest], "runs": len(ratios), "nearest": nearest}


def step_sizes(evidence: ClaimEvidence) -> Numbers:
    """Hold the edges of use against the bound and 1/max|H|^2; take times below them."""
    edges = evidence.edges
    if not edges:
        raise NotTestable("not run: a sweep of step sizes")
    inside = [edge for edge in edges if edge.fails_below_bound]
    ratios = [e.edge_over_power for e in edges if e.edge_over_power is not None]
    power = (
        f"the edges lie at {min(ratios):.2f} to {max(ratios):.2f} times 1/max|H|^2, "
        f"{sum(0.8 <= ratio <= 1.25 for ratio in ratios)} of {len(edges)} within 25 %"
        if ratios
        else "no edge was reached"
    )
    deepest = sorted(inside, key=lambda edge: edge.edge_over_trace or 0)[:3]
    told = ", ".join(
        f"{e.model} on {e.signal} at {e.edge:.3g} of {e.at_trace:.3g}" for e in deepest
    )
    trends = {}
    for model in FILTERS:
        own = [e.speed_trend for e in edges if e.model == model]
        known = [trend for trend in own if trend is not None]
        if known:
            trends[model] = median(known)
    return {
        "inside": len(inside),
        "edges": len(edges),
        "told": told,
        "power": power,
        "found": sum(edge.edge is not None for edge in edges),
        "trend": max(trends.values(), default=-math.inf),
        "trends": ", ".join(f"{model} {trend:.2f}" for model, trend in trends.items()),
    }


def orders(evidence: ClaimEvidence) -> Numbers:
    """List the orders of all runs of the four filters."""
    runs = lms_runs(evidence)
    found = sorted({run.order for run in runs if run.order is not None})
    models = [model for model in FILTERS if any(r.model == model for r in runs)]
    if len(models) < len(FILTERS):
        raise NotTestable(f"not run: all four filters, only {', '.join(models)}")
    told = ", ".join(map(str, found))
    return {"orders": len(found), "told": told, "runs": len(runs)}


def volterra(evidence: ClaimEvidence) -> Numbers:
    """Count the weights of the Volterra filter, and compare its two step sizes."""
    run = lms_runs(evidence, ("volterra",))[0]
    if run.order is None:
        raise NotTestable("the run of volterra does not tell its order")
    wanted, steps = run.order + 1 + (run.order + 1) ** 2, run.step_size
    return {
        "weights": run.weight_count,
        "order": run.order,
        "wanted": wanted,
        "sizes": len(set(steps.values())),
        "told": ", ".join(f"{name} {mu:g}" for name, mu in steps.items()),
    }


def other_weights(evidence: ClaimEvidence) -> Numbers:
    """Read order and weights of the other filters off the runs."""
    runs = lms_runs(evidence, ONE_STEP_SIZE)
    sizes = sorted(
        {(r.order, r.weight_count) for r in runs if r.order and r.weight_count}
    )
    order = evidence.text.filter_length
    return {
        "unlike": sizes != [(order, order + 1)],
        "sizes": "; ".join(f"order {n} with {count} weights" for n, count in sizes),
    }


def about_the_knee(evidence: ClaimEvidence) -> Numbers:
    """Tell how the MSE goes on to order 10 and beyond it; the worst filter counts.

    The order sweep is taken under each rule for the step size. The fall is the MSE at
    order 10 over that at the lowest order; the change, that for each order beyond
    order 10 over that below it.
    """
    knee = evidence.text.order_sweep_knee
    sweeps = (evidence.order_sweep, evidence.order_sweep_other)
    found = [_about(points, knee) for points in sweeps if points]
    if not found:
        raise NotTestable("not run: a sweep of orders")
    return {
        "fall": max(each["fall"] for each in found),
        "falls": "; ".join(each["falls"] for each in found),
        "change": max(each["change"] for each in found),
        "changes": "; ".join(each["changes"] for each in found),
    }


def _about(points: Sequence[OrderError], knee: int) -> dict[str, Any]:
    """Measure a sweep; each filter needs orders on both sides of the knee."""
    rule = f"mu {points[0].rule}: " if points[0].rule else ""
    starts, falls, slopes = {}, {}, {}
    for model in FILTERS:
        mse = {p.order: p.mse for p in points if p.model == model}
        if not mse or not (min(mse) < knee < max(mse) and knee in mse):
            raise NotTestable(f"not run: orders of {model} below, at and above {knee}")
        low, high = min(mse), max(mse)
        starts[model] = mse[low]
        falls[model] = _share(mse[knee], mse[low])
        slopes[model] = (
            (mse[low] - mse[knee]) / (knee - low),
            (mse[knee] - mse[high]) / (high - knee),
        )
    diverged = [model for model, start in starts.items() if math.isinf(start)]
    told = ", ".join(f"{model} {ratio:.3g}" for model, ratio in falls.items())
    rates = ", ".join(f"{m} {a:.3g} then {b:.3g}" for m, (a, b) in slopes.items())
    return {
        "fall": max(falls.values()),
        "falls": f"{rule}diverged at the lowest order: {', '.join(diverged)}"
        if diverged
        else f"{rule}MSE at order {knee} over MSE at the lowest order: {told}",
        "change": max(_share(abs(b), abs(a)) for a, b in slopes.values()),
        "changes": f"{rule}mean fall of the MSE for each order (um^2): {rates}",
    }


def _share(part: float, whole: float) -> float:
    """Divide; infinite where a run diverged, or where a part of nothing is left."""
    if not (math.isfinite(part) and math.isfinite(whole)):
        return math.inf
    if whole == 0:
        return math.inf if part else 0.0
    return part / whole

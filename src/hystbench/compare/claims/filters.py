"""Measures of the LMS algorithm, its step sizes, and the size of the filters."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from statistics import median

from hystbench.compare.beside import Edge
from hystbench.compare.claims.claim import NotTestable, Numbers, lms_runs
from hystbench.compare.evidence import ClaimEvidence
from hystbench.order_errors import OrderError
from hystbench.published import FILTERS

ONE_STEP_SIZE = ("gpo", "backlash", "delayed")
"""Filters with one step size."""
Curves = Mapping[str, Sequence[tuple[int, float]]]
"""Order and MSE of each filter, by rising order."""


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


def _edges(evidence: ClaimEvidence) -> tuple[Edge, ...]:
    if not evidence.edges:
        raise NotTestable("not run: a sweep of step sizes")
    return evidence.edges


def edges_and_bound(evidence: ClaimEvidence) -> Numbers:
    """Hold the measured edges against the bound, and against 1/max|H|^2."""
    edges = _edges(evidence)
    inside = [edge for edge in edges if edge.inside]
    ratios = [edge.edge / edge.at_power for edge in edges if edge.edge is not None]
    power = (
        f"the edges lie at {min(ratios):.2f} to {max(ratios):.2f} times 1/max|H|^2, "
        f"{sum(0.8 <= ratio <= 1.25 for ratio in ratios)} of {len(edges)} within 25 %"
        if ratios
        else "no edge was reached"
    )
    told = ", ".join(
        f"{e.model} on {e.signal} at {e.edge:.3g} of {e.at_trace:.3g}"
        for e in sorted(inside, key=lambda e: (e.edge or 0) / e.at_trace)[:3]
        if e.edge is not None
    )
    return {"inside": len(inside), "edges": len(edges), "told": told, "power": power}


def speed_below_edge(evidence: ClaimEvidence) -> Numbers:
    """Find an edge for each filter and signal, and a trend of the time below it."""
    edges = _edges(evidence)
    trends = {}
    for model in FILTERS:
        own = [e.speed_trend for e in edges if e.model == model]
        known = [trend for trend in own if trend is not None]
        if known:
            trends[model] = median(known)
    return {
        "found": sum(edge.edge is not None for edge in edges),
        "edges": len(edges),
        "trend": max(trends.values(), default=-math.inf),
        "told": ", ".join(f"{model} {trend:.2f}" for model, trend in trends.items()),
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


def volterra_weights(evidence: ClaimEvidence) -> Numbers:
    """Count the weights of the Volterra filter."""
    run = lms_runs(evidence, ("volterra",))[0]
    if run.order is None:
        raise NotTestable("the run of volterra does not tell its order")
    wanted = run.order + 1 + (run.order + 1) ** 2
    return {"weights": run.weight_count, "order": run.order, "wanted": wanted}


def other_weights(evidence: ClaimEvidence) -> Numbers:
    """Read order and weights of the other filters off the runs."""
    runs = lms_runs(evidence, ONE_STEP_SIZE)
    sizes = sorted(
        {(r.order, r.weight_count) for r in runs if r.order and r.weight_count}
    )
    order = evidence.text.filter_length
    return {
        "sizes": "; ".join(f"order {n} with {count} weights" for n, count in sizes),
        "wanted": f"order {order} with {order + 1} weights",
    }


def volterra_step_sizes(evidence: ClaimEvidence) -> Numbers:
    """Compare the two step sizes of the Volterra filter."""
    steps = lms_runs(evidence, ("volterra",))[0].step_size
    told = ", ".join(f"{name} {mu:g}" for name, mu in steps.items())
    return {"sizes": len(set(steps.values())), "told": told}


def fall_to_the_knee(evidence: ClaimEvidence) -> Numbers:
    """Take the MSE at order 10 over that at the lowest order, the largest."""
    return _under_each_rule(evidence, _fall)


def slopes_about_the_knee(evidence: ClaimEvidence) -> Numbers:
    """Take the MSE's change for each order beyond order 10 over that below it."""
    return _under_each_rule(evidence, _change)


def _under_each_rule(
    evidence: ClaimEvidence, measure: Callable[[Curves, int], tuple[float, str]]
) -> Numbers:
    """Measure the order sweep under each rule for the step size; the worst counts."""
    knee = evidence.text.order_sweep_knee
    found = {
        points[0].rule: measure(_curves(points, knee), knee)
        for points in (evidence.order_sweep, evidence.order_sweep_other)
        if points
    }
    if not found:
        raise NotTestable("not run: a sweep of orders")
    told = "; ".join(
        f"{f'mu {rule}: ' if rule else ''}{said}" for rule, (_, said) in found.items()
    )
    return {"worst": max(worst for worst, _ in found.values()), "told": told}


def _curves(points: Sequence[OrderError], knee: int) -> Curves:
    """Sort a sweep by order; each filter needs orders on both sides of the knee."""
    found: dict[str, list[tuple[int, float]]] = {}
    for point in sorted(points, key=lambda p: p.order):
        found.setdefault(point.model, []).append((point.order, point.mse))
    for model in FILTERS:
        own = [order for order, _ in found.get(model, [])]
        if not (own and own[0] < knee and knee in own and own[-1] > knee):
            raise NotTestable(f"not run: orders of {model} below, at and above {knee}")
    return {model: found[model] for model in FILTERS}


def _fall(curves: Curves, knee: int) -> tuple[float, str]:
    diverged = [model for model, points in curves.items() if math.isinf(points[0][1])]
    if diverged:
        return math.inf, f"diverged at the lowest order: {', '.join(diverged)}"
    falls = {
        model: _share(dict(points)[knee], points[0][1])
        for model, points in curves.items()
    }
    told = ", ".join(f"{model} {ratio:.3g}" for model, ratio in falls.items())
    said = f"MSE at order {knee} over MSE at the lowest order: {told}"
    return max(falls.values()), said


def _change(curves: Curves, knee: int) -> tuple[float, str]:
    rates = {model: _slopes(points, knee) for model, points in curves.items()}
    told = ", ".join(
        f"{model} {before:.3g} then {after:.3g}"
        for model, (before, after) in rates.items()
    )
    worst = max(_share(abs(after), abs(before)) for before, after in rates.values())
    return worst, f"mean fall of the MSE for each order (um^2): {told}"


def _slopes(points: Sequence[tuple[int, float]], knee: int) -> tuple[float, float]:
    """Mean fall of the MSE for each order up to the knee and beyond it."""
    middle = dict(points)[knee]
    (first, start), (last, end) = points[0], points[-1]
    return (start - middle) / (knee - first), (middle - end) / (last - knee)


def _share(part: float, whole: float) -> float:
    """Divide; infinite where a run diverged, or where a part of nothing is left."""
    if not (math.isfinite(part) and math.isfinite(whole)):
        return math.inf
    if whole == 0:
        return math.inf if part else 0.0
    return part / whole

"""Claims on the LMS algorithm, its step sizes, and the size of the filters."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from statistics import median

from hystbench.compare.claims.claim import (
    Finding,
    NotTestable,
    claim_on,
    lms_runs,
    untestable,
)
from hystbench.compare.edges import Edge
from hystbench.compare.evidence import Evidence, OrderPoint
from hystbench.published import FILTERS


@claim_on(
    "eq19-order",
    "1/tr[R] < 1/lambda_max",
    "Section 3.2, Eq. 19",
    "theory",
    "in every run of a filter with one step size",
)
def eq19_order(evidence: Evidence) -> Finding:
    """Compare the bound of each run with its largest eigenvalue."""
    ratios = {
        f"{run.model} on {run.signal}": run.bound["mu"] * run.largest_eigenvalue
        for run in lms_runs(evidence, ("gpo", "backlash", "delayed"))
        if "mu" in run.bound and run.largest_eigenvalue is not None
    }
    if not ratios:
        raise NotTestable("no run tells its bound and its largest eigenvalue")
    nearest = max(ratios, key=lambda name: ratios[name])
    return Finding(
        ratios[nearest] < 1,
        f"lambda_max / tr[R] is at most {ratios[nearest]:.6f} in {len(ratios)} runs "
        f"({nearest})",
    )


@claim_on(
    "eq19-convergence",
    "a step size 0 < mu < 1/tr[R] guarantees 'convergence of the coefficients in the "
    "mean'",
    "Section 3.2, Eq. 19",
    "theory",
    "the step sizes of each filter are raised on each signal until it is of no use: "
    "its error is as large as the displacement, or it diverges; no such edge lies "
    "inside the bound",
)
def eq19_convergence(evidence: Evidence) -> Finding:
    """Hold the measured edges against the bound."""
    edges = _edges(evidence)
    inside = [edge for edge in edges if edge.inside]
    ratios = [edge.edge / edge.at_power for edge in edges if edge.edge is not None]
    power = (
        f"the edges lie at {min(ratios):.2f} to {max(ratios):.2f} times 1/max|H|^2, "
        f"{sum(0.8 <= ratio <= 1.25 for ratio in ratios)} of {len(edges)} within 25 %"
        if ratios
        else "no edge was reached"
    )
    if not inside:
        return Finding(True, f"0 of {len(edges)} edges lie inside 1/tr[R]; {power}")
    told = ", ".join(
        f"{e.model} on {e.signal} at {e.edge:.3g} of {e.at_trace:.3g}"
        for e in sorted(inside, key=lambda e: (e.edge or 0) / e.at_trace)[:3]
        if e.edge is not None
    )
    return Finding(
        False,
        f"{len(inside)} of {len(edges)} edges lie inside 1/tr[R]: {told}; {power}",
    )


def _edges(evidence: Evidence) -> tuple[Edge, ...]:
    if not evidence.edges:
        raise NotTestable("not run: a sweep of step sizes")
    return evidence.edges


@claim_on(
    "mu-governs",
    "'The convergence factor governs the convergence speed and the stability'",
    "Sections 3.2 and 4",
    "theory",
    "stability: raised far enough, it makes each filter of no use on each signal; "
    "speed: up to half of that edge, the time until the smoothed error first is a "
    "tenth of the displacement (RMS) falls with it, rank correlation at most -0.5 in "
    "the median over the signals of each filter",
)
def mu_governs(evidence: Evidence) -> Finding:
    """Find an edge for each filter and signal, and a trend of the time below it."""
    edges = _edges(evidence)
    found = sum(edge.edge is not None for edge in edges)
    trends = {}
    for model in FILTERS:
        own = [e.speed_trend for e in edges if e.model == model]
        known = [trend for trend in own if trend is not None]
        if known:
            trends[model] = median(known)
    told = ", ".join(f"{model} {trend:.2f}" for model, trend in trends.items())
    return Finding(
        found == len(edges) and all(trend <= -0.5 for trend in trends.values()),
        f"{found} of {len(edges)} filters and signals have an edge; median rank "
        f"correlation of the convergence time with mu: {told}",
    )


convergence_speed = untestable(
    "convergence-speed",
    "the convergence speed of the GPO-based LMS depends on 'the eigenvalue spread' "
    "of R",
    "Section 3.2",
    "theory",
    "the smallest eigenvalues of R are rounding on these signals, so that no spread "
    "is known; and the paper gives no convergence time",
)


@claim_on(
    "same-order",
    "the four filters 'should have the same filter order of N'",
    "Section 4",
    "condition",
    basis="built-in",
)
def same_order(evidence: Evidence) -> Finding:
    """Compare the orders of all runs."""
    runs = lms_runs(evidence)
    orders = sorted({run.order for run in runs if run.order is not None})
    models = [model for model in FILTERS if any(r.model == model for r in runs)]
    if len(models) < len(FILTERS):
        raise NotTestable(f"not run: all four filters, only {', '.join(models)}")
    return Finding(
        len(orders) == 1,
        f"orders {', '.join(map(str, orders))} in {len(runs)} runs of all filters",
    )


@claim_on(
    "volterra-length",
    "the Volterra filter of order N has 'N + 1 + (N + 1)^2' weights",
    "Section 4",
    "condition",
    basis="built-in",
)
def volterra_length(evidence: Evidence) -> Finding:
    """Count the weights of the Volterra filter."""
    run = lms_runs(evidence, ("volterra",))[0]
    if run.order is None:
        raise NotTestable("the run of volterra does not tell its order")
    wanted = run.order + 1 + (run.order + 1) ** 2
    return Finding(
        run.weight_count == wanted,
        f"{run.weight_count} weights at order {run.order}; {wanted} claimed",
    )


@claim_on(
    "other-length",
    "'those of the other filters of the N-th-order was set at 30'",
    "Section 4",
    "condition",
    "the order N of the filters is 30, so that they have N + 1 weights (Eq. 13)",
    basis="built-in",
)
def other_length(evidence: Evidence) -> Finding:
    """Read order and weights off the runs."""
    runs = lms_runs(evidence, ("gpo", "backlash", "delayed"))
    sizes = sorted(
        {(r.order, r.weight_count) for r in runs if r.order and r.weight_count}
    )
    wanted = evidence.text.filter_length
    return Finding(
        sizes == [(wanted, wanted + 1)],
        "; ".join(f"order {n} with {count} weights" for n, count in sizes)
        + "; as length, 30 would be order 29",
    )


@claim_on(
    "volterra-two-step-sizes",
    "'there are different convergence factors for the first-order and second-order "
    "terms' of the Volterra filter",
    "Section 4",
    "condition",
    basis="built-in",
)
def volterra_two_step_sizes(evidence: Evidence) -> Finding:
    """Compare the two step sizes of the Volterra filter."""
    steps = lms_runs(evidence, ("volterra",))[0].step_size
    return Finding(
        len(set(steps.values())) > 1,
        ", ".join(f"{name} {mu:g}" for name, mu in steps.items()),
    )


def sweeps(evidence: Evidence) -> dict[str, dict[str, list[tuple[int, float]]]]:
    """Give the order sweep of each filter by rising order, under each rule for mu.

    Raises
    ------
    NotTestable
        If a filter is missing or the orders lie on one side of the knee alone.
    """
    found = {}
    for points in (evidence.order_sweep, evidence.order_sweep_other):
        if points:
            found[points[0].rule] = _sweep(points, evidence.text.order_sweep_knee)
    if not found:
        raise NotTestable("not run: a sweep of orders")
    return found


def _sweep(
    points: Sequence[OrderPoint], knee: int
) -> dict[str, list[tuple[int, float]]]:
    found: dict[str, list[tuple[int, float]]] = {}
    for point in sorted(points, key=lambda p: p.order):
        found.setdefault(point.model, []).append((point.order, point.mse))
    for model in FILTERS:
        orders = [order for order, _ in found.get(model, [])]
        if not (orders and orders[0] < knee and knee in orders and orders[-1] > knee):
            raise NotTestable(f"not run: orders of {model} below, at and above {knee}")
    return {model: found[model] for model in FILTERS}


def under_each_rule(
    evidence: Evidence, test: Callable[[dict[str, list[tuple[int, float]]]], Finding]
) -> Finding:
    """Judge the order sweep under each rule for the step size; all must hold."""
    found = {rule: test(curves) for rule, curves in sweeps(evidence).items()}
    told = "; ".join(
        f"{f'mu {rule}: ' if rule else ''}{one.evidence}" for rule, one in found.items()
    )
    return Finding(all(one.holds for one in found.values()), told)


def slopes(points: list[tuple[int, float]], knee: int) -> tuple[float, float]:
    """Mean fall of the MSE for each order up to the knee and beyond it."""
    by_order = dict(points)
    (first, start), (last, end) = points[0], points[-1]
    middle = by_order[knee]
    return (start - middle) / (knee - first), (middle - end) / (last - knee)


@claim_on(
    "order-sharp",
    "'the MSEs decrease sharply when the order of the filters is below 10', for all "
    "four",
    "Section 4, Figure 7",
    "result",
    "from the lowest order to order 10 the MSE of each filter falls by half or more, "
    "under both rules by which mu may follow the order",
    basis="held-out",
)
def order_sharp(evidence: Evidence) -> Finding:
    """Follow each filter up to order 10."""
    knee = evidence.text.order_sweep_knee
    return under_each_rule(evidence, lambda curves: _sharp(curves, knee))


def _sharp(curves: dict[str, list[tuple[int, float]]], knee: int) -> Finding:
    diverged = [model for model, points in curves.items() if math.isinf(points[0][1])]
    if diverged:
        return Finding(False, f"diverged at the lowest order: {', '.join(diverged)}")
    falls = {
        model: dict(points)[knee] / points[0][1] for model, points in curves.items()
    }
    told = ", ".join(f"{model} {ratio:.3g}" for model, ratio in falls.items())
    return Finding(
        all(math.isfinite(r) and r <= 0.5 for r in falls.values()),
        f"MSE at order {knee} over MSE at the lowest order: {told}",
    )


@claim_on(
    "order-slow",
    "when the order rises further 'the rate of change of the modeling error is very "
    "slow'",
    "Section 4, Figure 7",
    "result",
    "beyond order 10 the MSE of each filter changes per order by at most a tenth of "
    "what it did below, under both rules by which mu may follow the order",
    basis="held-out",
)
def order_slow(evidence: Evidence) -> Finding:
    """Compare the slopes on both sides of order 10."""
    knee = evidence.text.order_sweep_knee
    return under_each_rule(evidence, lambda curves: _slow(curves, knee))


def _slow(curves: dict[str, list[tuple[int, float]]], knee: int) -> Finding:
    rates = {m: slopes(points, knee) for m, points in curves.items()}
    told = ", ".join(
        f"{model} {before:.3g} then {after:.3g}"
        for model, (before, after) in rates.items()
    )
    return Finding(
        all(
            math.isfinite(before) and abs(after) <= abs(before) / 10
            for before, after in rates.values()
        ),
        f"mean fall of the MSE for each order (um^2): {told}",
    )


mu_by_experiment = untestable(
    "mu-by-experiment",
    "'Many experiments have been done to choose an appropriate' step size for each "
    "filter",
    "Section 4",
    "condition",
    "the step sizes are not printed",
)
low_complexity = untestable(
    "low-complexity",
    "LMS 'can reduce computational complexity, which is attractive for online "
    "implementation'",
    "Section 3.2",
    "theory",
    "the paper names nothing to compare with, and gives no cost",
)
low_frequency_cause = untestable(
    "low-frequency-cause",
    "the small errors at low frequency are 'mainly because' the GPO parameters are "
    "identified with low-frequency data",
    "Section 4",
    "result",
    "a cause; it needs filters whose parameters were identified at high frequency",
)

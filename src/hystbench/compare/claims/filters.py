"""Claims on the LMS algorithm, its step sizes, and the size of the filters."""

from __future__ import annotations

import math

from hystbench.compare.claims.claim import (
    Finding,
    NotTestable,
    claim_on,
    lms_runs,
    untestable,
)
from hystbench.compare.claims.statistics import rank_correlation
from hystbench.compare.evidence import Evidence, Run
from hystbench.published import FILTERS

FEWEST = 4
"""Runs below which a trend is not judged."""


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


def within_bound(run: Run) -> bool:
    """Tell whether every step size of a run is inside Eq. 19."""
    return all(mu < run.bound[name] for name, mu in run.step_size.items())


@claim_on(
    "eq19-convergence",
    "a step size 0 < mu < 1/tr[R] guarantees 'convergence of the coefficients in the "
    "mean'",
    "Section 3.2, Eq. 19",
    "theory",
    "no run within the bound diverged, which is a sign of convergence in the mean and "
    "not the same; runs above it are told but not judged",
)
def eq19_convergence(evidence: Evidence) -> Finding:
    """Count the diverged runs within the bound."""
    runs = [run for run in lms_runs(evidence) if run.bound]
    inside = [run for run in runs if within_bound(run)]
    above = [run for run in runs if not within_bound(run)]
    if not inside:
        raise NotTestable("no run has its step sizes within the bound")
    diverged = [run for run in inside if run.diverged]
    said = (
        f"{len(diverged)} of {len(inside)} runs within the bound diverged, and "
        f"{sum(run.diverged is not None for run in above)} of {len(above)} above it"
    )
    if diverged:
        said += f"; {diverged[0].model} on {diverged[0].signal} {diverged[0].diverged}"
    return Finding(not diverged, said)


@claim_on(
    "convergence-speed",
    "the convergence speed of the GPO-based LMS depends on 'the eigenvalue spread' "
    "of R",
    "Section 3.2",
    "theory",
    "over the signals, the time after which the smoothed squared error stays below "
    "twice its end rises with the spread over nonzero eigenvalues: rank correlation "
    "of 0.5 or more",
)
def convergence_speed(evidence: Evidence) -> Finding:
    """Set settling times against eigenvalue spreads."""
    found = [
        (run.spread, run.convergence_s)
        for run in lms_runs(evidence, ("gpo",))
        if run.spread is not None and run.convergence_s is not None
    ]
    if len(found) < FEWEST:
        raise NotTestable(
            f"not run: {FEWEST} finite runs of gpo, there are {len(found)}"
        )
    spreads, times = [spread for spread, _ in found], [time for _, time in found]
    trend = rank_correlation(spreads, times)
    return Finding(
        trend >= 0.5,
        f"spreads of {min(spreads):.3g} to {max(spreads):.3g}, convergence times of "
        f"{min(times):.3g} to {max(times):.3g} s; rank correlation {trend:.2f} over "
        f"{len(found)} signals",
    )


@claim_on(
    "same-order",
    "the four filters 'should have the same filter order of N'",
    "Section 4",
    "condition",
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
)
def volterra_two_step_sizes(evidence: Evidence) -> Finding:
    """Compare the two step sizes of the Volterra filter."""
    steps = lms_runs(evidence, ("volterra",))[0].step_size
    return Finding(
        len(set(steps.values())) > 1,
        ", ".join(f"{name} {mu:g}" for name, mu in steps.items()),
    )


def sweep(evidence: Evidence) -> dict[str, list[tuple[int, float]]]:
    """Give the order sweep of each filter by rising order.

    Raises
    ------
    NotTestable
        If a filter is missing or the orders lie on one side of the knee alone.
    """
    knee = evidence.text.order_sweep_knee
    found: dict[str, list[tuple[int, float]]] = {}
    for point in sorted(evidence.order_sweep, key=lambda p: p.order):
        found.setdefault(point.model, []).append((point.order, point.mse))
    for model in FILTERS:
        orders = [order for order, _ in found.get(model, [])]
        if not (orders and orders[0] < knee and knee in orders and orders[-1] > knee):
            raise NotTestable(f"not run: orders of {model} below, at and above {knee}")
    return {model: found[model] for model in FILTERS}


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
    "from the lowest order to order 10 the MSE of each filter falls by half or more",
)
def order_sharp(evidence: Evidence) -> Finding:
    """Follow each filter up to order 10."""
    knee = evidence.text.order_sweep_knee
    curves = sweep(evidence)
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
    "what it did below",
)
def order_slow(evidence: Evidence) -> Finding:
    """Compare the slopes on both sides of order 10."""
    knee = evidence.text.order_sweep_knee
    rates = {m: slopes(points, knee) for m, points in sweep(evidence).items()}
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


mu_governs = untestable(
    "mu-governs",
    "'The convergence factor governs the convergence speed and the stability'",
    "Sections 3.2 and 4",
    "theory",
    "not run: a sweep of step sizes",
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

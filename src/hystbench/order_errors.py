"""Error of each filter against its order (Figure 7)."""

import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Any

from hystbench.adaptive import (
    divergence,
    fraction_of_bound,
    make_filter,
    with_fraction_of_bound,
)
from hystbench.filters import AdaptiveFilter, run_many
from hystbench.metrics import mean_square_error
from hystbench.record import Record


@dataclass(frozen=True)
class OrderError:
    """MSE of a filter at an order (Figure 7), infinite where it diverged.

    ``status`` tells how it ended, ``rule`` how the step size follows the order.
    """

    model: str
    order: int
    mse: float
    status: str = "finite"
    rule: str = ""


def filters_by_order(
    record: Record,
    settings: Mapping[str, Any],
    identified: Mapping[str, Any] | None = None,
) -> list[AdaptiveFilter]:
    """Make each filter for a record at each order.

    tr[R] grows with the order, so that a constant convergence factor nears Eq. 19's
    bound; ``same-fraction-of-bound`` keeps it as far from it as at the usual order.

    Parameters
    ----------
    record : Record
    settings : mapping
        ``orders``, ``convergence_factor`` (how it follows the order) and
        ``filters``, each filter's own settings.
    identified : mapping, optional
        As for :func:`hystbench.adaptive.make_filter`.
    """
    same_fraction = settings["convergence_factor"] == "same-fraction-of-bound"
    filters = []
    for model, job in settings["filters"].items():
        usual = make_filter(model, job, record, identified)
        fractions = fraction_of_bound(usual, record.u) if same_fraction else {}
        for order in settings["orders"]:
            adaptive = make_filter(model, job, record, identified, order)
            if same_fraction:
                adaptive = with_fraction_of_bound(adaptive, record.u, fractions)
            filters.append(adaptive)
    return filters


def order_errors(
    record: Record, filters: Iterable[AdaptiveFilter], threads: int = 1, rule: str = ""
) -> list[OrderError]:
    """Run filters on a record, so many at once."""
    listed = list(filters)
    results = run_many(((each, record.u, record.y) for each in listed), threads)
    found = []
    for each, result in zip(listed, results, strict=True):
        told = divergence(each, record.u, result)
        mse = math.inf if told else mean_square_error(result.error)
        status = told["sentence"] if told else "finite"
        found.append(OrderError(each.name, each.order, mse, status, rule))
    return found

"""``hystbench job order-sweep``: error against order (Figure 7)."""

from hystbench.compare.rows import names_of, or_empty, write_fields
from hystbench.options import In, Json, Out, Settings, command
from hystbench.order_errors import OrderError, filters_by_order, order_errors
from hystbench.record import load_record

#: How the step size follows the order: each rule, and the other one.
OTHER = {
    "constant": "same-fraction-of-bound",
    "same-fraction-of-bound": "constant",
}


@command
def order_sweep(
    record: In,
    *,
    identified: Json | None = None,
    settings: Settings,
    threads: int = 1,
    out: Out,
    other: Out,
) -> None:
    """Run each filter on RECORD at each order, under both rules for the step size."""
    measured = load_record(record)
    rule = settings["convergence_factor"]
    for path, name in ((out, rule), (other, OTHER[rule])):
        chosen = settings | {"convergence_factor": name}
        filters = filters_by_order(measured, chosen, identified)
        found = order_errors(measured, filters, threads, name)
        write_fields(path, names_of(OrderError), found, or_empty)

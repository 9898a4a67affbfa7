"""``hystbench job order-sweep``: error against order (Figure 7)."""

from __future__ import annotations

from dataclasses import astuple
from pathlib import Path
from typing import Any

import click

from hystbench import options
from hystbench.files import write_csv
from hystbench.order_errors import filters_by_order, order_errors
from hystbench.record import load_record

COLUMNS = ["model", "order", "mse", "status", "rule"]
#: How the step size follows the order: each rule, and the other one.
OTHER = {
    "constant": "same-fraction-of-bound",
    "same-fraction-of-bound": "constant",
}


@click.command()
@click.argument("record", type=options.FILE)
@options.identified
@options.settings
@click.option("--threads", type=int, default=1, help="Filters to run at once.")
@options.out
@click.option(
    "--other", type=options.NEW_FILE, required=True, help="Other rule's file."
)
def order_sweep(
    record: Path,
    identified: dict[str, Any] | None,
    settings: dict[str, Any],
    threads: int,
    out: Path,
    other: Path,
) -> None:
    """Run each filter on RECORD at each order, under both rules for the step size."""
    measured = load_record(record)
    rule = settings["convergence_factor"]
    for path, name in ((out, rule), (other, OTHER[rule])):
        chosen = settings | {"convergence_factor": name}
        filters = filters_by_order(measured, chosen, identified)
        found = order_errors(measured, filters, threads)
        write_csv(path, COLUMNS, [(*astuple(each), name) for each in found])

"""``hystbench order-sweep``: error against order (Figure 7)."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import click

from hystbench import options
from hystbench.adaptive import (
    fraction_of_bound,
    make_filter,
    with_fraction_of_bound,
)
from hystbench.files import write_csv
from hystbench.filters import run_many
from hystbench.metrics import mean_square_error
from hystbench.record import load_record

COLUMNS = ["model", "order", "mse", "status"]


@click.command()
@click.argument("record", type=options.FILE)
@options.identified
@options.settings
@click.option("--threads", type=int, default=1, help="Filters to run at once.")
@options.out
def order_sweep(
    record: Path,
    identified: Path | None,
    settings: dict[str, Any],
    threads: int,
    out: Path,
) -> None:
    """Run each filter on RECORD at each order.

    tr[R] grows with the order, so that a constant convergence factor nears Eq. 19's
    bound; ``same-fraction-of-bound`` keeps it as far from it as at the usual order.
    """
    measured = load_record(record)
    cells = [
        (model, order) for model in settings["filters"] for order in settings["orders"]
    ]
    filters = []
    for model, order in cells:
        job = settings["filters"][model]
        adaptive = make_filter(model, job, measured, identified, order)
        if settings["convergence_factor"] == "same-fraction-of-bound":
            usual = make_filter(model, job, measured, identified)
            fractions = fraction_of_bound(usual, measured.u)
            adaptive = with_fraction_of_bound(adaptive, measured.u, fractions)
        filters.append(adaptive)
    results = run_many(((each, measured.u, measured.y) for each in filters), threads)
    rows: list[list[Any]] = []
    for (model, order), result in zip(cells, results, strict=True):
        if result.diverged_at is None:
            rows.append([model, order, mean_square_error(result.error), "finite"])
        else:
            told = f"diverged at sample {result.diverged_at}"
            rows.append([model, order, None, told])
    write_csv(out, COLUMNS, rows)

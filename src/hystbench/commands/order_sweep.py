"""``hystbench order-sweep``: error against order (Figure 7)."""

from __future__ import annotations

from dataclasses import astuple
from pathlib import Path
from typing import Any

import click

from hystbench import options
from hystbench.files import write_csv
from hystbench.order_errors import filters_by_order, order_errors
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
    """Run each filter on RECORD at each order."""
    measured = load_record(record)
    filters = filters_by_order(measured, settings, identified)
    found = order_errors(measured, filters, threads)
    write_csv(out, COLUMNS, map(astuple, found))

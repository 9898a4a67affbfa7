"""``hystbench order-sweep``: error against order (Figure 7)."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import click

from hystbench import options
from hystbench.adaptive import make_filter
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
    """Run each filter on RECORD at each order."""
    measured = load_record(record)
    cells = [
        (model, order) for model in settings["filters"] for order in settings["orders"]
    ]
    filters = [
        make_filter(model, settings["filters"][model], measured, identified, order)
        for model, order in cells
    ]
    results = run_many(((each, measured.u, measured.y) for each in filters), threads)
    rows: list[list[Any]] = []
    for (model, order), result in zip(cells, results, strict=True):
        if result.diverged_at is None:
            rows.append([model, order, mean_square_error(result.error), "finite"])
        else:
            told = f"diverged at sample {result.diverged_at}"
            rows.append([model, order, None, told])
    write_csv(out, COLUMNS, rows)

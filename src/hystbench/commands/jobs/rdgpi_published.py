"""``hystbench job rdgpi-published``: the RDGPI model with the published values."""

from __future__ import annotations

from pathlib import Path

import click

from hystbench import options
from hystbench.files import write_csv
from hystbench.metrics import mean_square_error, relative_error
from hystbench.rdgpi import PUBLISHED_RDGPI
from hystbench.record import load_record

COLUMNS = ["signal", "error_kind", "mse", "re", "largest_output", "largest_reference"]


@click.command()
@click.argument("records", type=options.FILE, nargs=-1, required=True)
@options.out
def rdgpi_published(records: tuple[Path, ...], out: Path) -> None:
    """Simulate the published values, under our reading of the model, on RECORDS."""
    rows = []
    for path in records:
        record = load_record(path)
        output = PUBLISHED_RDGPI.simulate(record.u, record.dt)
        error = record.y - output
        rows.append(
            [
                record.name,
                "free-run simulation",
                mean_square_error(error),
                relative_error(error, record.y),
                float(abs(output).max()),
                float(abs(record.y).max()),
            ]
        )
    write_csv(out, COLUMNS, rows)

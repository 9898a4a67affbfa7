"""``hystbench job export-errors``: how far exported code is from the simulation."""

from __future__ import annotations

from pathlib import Path

import click

from hystbench import options
from hystbench.files import write_csv


@click.command()
@options.out
def export_errors(out: Path) -> None:
    """Measure exported code on typical cases, as a table (CSV).

    Rms errors as shares of the output's rms, by the options of hystbench export.
    """
    from hystbench.export.errors import table  # late: it runs

    rows = table()
    write_csv(out, list(rows[0]), (list(row.values()) for row in rows))

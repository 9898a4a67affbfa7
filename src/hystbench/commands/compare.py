"""``hystbench compare``: tables and claims, ours beside the published."""

from __future__ import annotations

from pathlib import Path

import click

from hystbench import options
from hystbench.compare import comparison


@click.command()
@click.option("--run", "runs", multiple=True, type=options.FILE, help="Run (JSON).")
@click.option("--record", "records", multiple=True, type=options.FILE, help="Record.")
@click.option("--order-sweep", type=options.FILE, help="Errors by order (CSV).")
@click.option("--envelopes", type=options.FILE, help="GPO errors by envelopes (CSV).")
@options.identified
@click.option("--out", type=options.NEW_FILE, required=True, help="Folder to write.")
def compare(
    runs: tuple[Path, ...],
    records: tuple[Path, ...],
    order_sweep: Path | None,
    envelopes: Path | None,
    identified: Path | None,
    out: Path,
) -> None:
    """Compare runs with the paper: cells, claims, audit, summary and tables."""
    comparison.compare(out, runs, records, order_sweep, identified, envelopes)

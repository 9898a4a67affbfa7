"""``hystbench job compare``: tables and claims, ours beside the published."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import click

from hystbench import options
from hystbench.compare import comparison
from hystbench.files import whole_folder


@click.command()
@click.option("--run", "runs", multiple=True, type=options.FILE, help="Run (JSON).")
@click.option("--record", "records", multiple=True, type=options.FILE, help="Record.")
@click.option("--order-sweep", type=options.FILE, help="Errors by order (CSV).")
@click.option("--order-sweep-other", type=options.FILE, help="By order, other rule.")
@click.option("--envelopes", type=options.FILE, help="GPO errors by envelopes (CSV).")
@click.option("--twin-errors", type=options.FILE, help="Errors by twin (CSV).")
@click.option("--twin-claims", type=options.FILE, help="Claims by twin (CSV).")
@click.option("--draws", type=options.FILE, help="Draws of the random sum (CSV).")
@click.option("--edges", type=options.FILE, help="Edges of the step sizes (CSV).")
@click.option("--constants", type=options.FILE, help="Ranking by constant (CSV).")
@options.identified_file
@options.settings
@options.out_folder
def compare(
    runs: tuple[Path, ...],
    records: tuple[Path, ...],
    settings: dict[str, Any],
    out: Path,
    **files: Path | None,
) -> None:
    """Compare runs with the paper: cells, claims, audit, summary and tables."""
    held_out = comparison.held_out_signals(settings["calibrated"])
    with whole_folder(out, comparison.WRITTEN) as fresh:
        comparison.compare(fresh, runs, records, held_out, **files)

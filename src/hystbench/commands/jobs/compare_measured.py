"""``hystbench job compare-measured``: errors on a measured dataset."""

from __future__ import annotations

from pathlib import Path

import click

from hystbench import options
from hystbench.compare import measured
from hystbench.files import whole_folder


@click.command()
@click.argument("dataset")
@click.option("--run", "runs", multiple=True, type=options.FILE, help="Run (JSON).")
@options.out_folder
def compare_measured(dataset: str, runs: tuple[Path, ...], out: Path) -> None:
    """Write the errors of all models on the records of DATASET."""
    with whole_folder(out, measured.WRITTEN) as fresh:
        measured.compare_measured(fresh, dataset, runs)

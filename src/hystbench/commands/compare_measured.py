"""``hystbench compare-measured``: errors on a measured dataset."""

from __future__ import annotations

from pathlib import Path

import click

from hystbench import options
from hystbench.compare import measured


@click.command()
@click.argument("dataset")
@click.option("--run", "runs", multiple=True, type=options.FILE, help="Run (JSON).")
@click.option("--out", type=options.NEW_FILE, required=True, help="Folder to write.")
def compare_measured(dataset: str, runs: tuple[Path, ...], out: Path) -> None:
    """Write the errors of all models on the records of DATASET."""
    measured.compare_measured(out, dataset, runs)

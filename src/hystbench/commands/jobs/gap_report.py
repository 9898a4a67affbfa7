"""``hystbench job gap-report``: the page of one dataset."""

from __future__ import annotations

from pathlib import Path

import click

from hystbench.gap.report import write_report


@click.command()
@click.argument("folder", type=click.Path(exists=True, file_okay=False, path_type=Path))
def gap_report(folder: Path) -> None:
    """Write report.html from what is in FOLDER."""
    write_report(folder)

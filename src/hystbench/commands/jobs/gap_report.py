"""``hystbench job gap-report``: the page of one dataset, and its part of others."""

from __future__ import annotations

from pathlib import Path

import click

from hystbench.gap.report import write_report
from hystbench.gap.report.tables import write_gallery


@click.command()
@click.argument("folder", type=click.Path(exists=True, file_okay=False, path_type=Path))
def gap_report(folder: Path) -> None:
    """Write report.html from what is in FOLDER.

    Beside it verdict.md, and model and residual as pictures (SVG, PNG).
    """
    write_report(folder)
    write_gallery(folder)

"""``hystbench tried``: what the calibration tried, as a table."""

from __future__ import annotations

from pathlib import Path

import click

from hystbench import options
from hystbench.calibration.choice import write_tried


@click.command()
@options.out
def tried(out: Path) -> None:
    """Write the structures that were tried and how each did, the chosen one marked."""
    write_tried(out)

"""``hystbench structures``: a table of the structures that were tried."""

from __future__ import annotations

from pathlib import Path

import click

from hystbench import options
from hystbench.calibration.structures import write_structures
from hystbench.files import read_json


@click.command()
@click.argument("tried", type=options.FILE, nargs=-1, required=True)
@click.option("--out", type=options.NEW_FILE, required=True)
def structures(tried: tuple[Path, ...], out: Path) -> None:
    """Write a row for each result in TRIED of ``hystbench structure``."""
    write_structures(out, [read_json(path) for path in tried])

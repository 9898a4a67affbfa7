"""``hystbench job structures``: a table of the structures that were tried."""

from __future__ import annotations

from pathlib import Path

import click

from hystbench import options
from hystbench.calibration.choice import write_choice, write_structures
from hystbench.files import read_json


@click.command()
@click.argument("tried", type=options.FILE, nargs=-1, required=True)
@options.out
@click.option(
    "--choice", type=options.NEW_FILE, required=True, help="What the rule chooses."
)
def structures(tried: tuple[Path, ...], out: Path, choice: Path) -> None:
    """Write a row for each result in TRIED of ``hystbench job structure``."""
    found = [read_json(path) for path in tried]
    write_structures(out, found)
    write_choice(choice, found)

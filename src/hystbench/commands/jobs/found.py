"""``hystbench job found``: the values that the calibration found, as a table."""

from __future__ import annotations

from pathlib import Path

import click

from hystbench import options
from hystbench.model import load_model
from hystbench.twins.run import write_found


@click.command()
@click.argument("twin", type=options.FILE)
@click.argument("others", type=options.FILE, nargs=-1)
@options.out
def found(twin: Path, others: tuple[Path, ...], out: Path) -> None:
    """Write the values found in TWIN, and their spread over the OTHERS as good."""
    write_found(out, load_model(twin), [load_model(path) for path in others])

"""``hystbench job tried``: what the calibration tried and found, as tables."""

from __future__ import annotations

from pathlib import Path

import click

from hystbench import options
from hystbench.calibration.first_round import write_tried
from hystbench.calibration.found import write_found
from hystbench.model import load_model


@click.command()
@click.argument("twin", type=options.FILE)
@click.argument("others", type=options.FILE, nargs=-1)
@click.option("--tried", "tried_file", type=options.NEW_FILE, required=True)
@click.option("--found", "found_file", type=options.NEW_FILE, required=True)
def tried(
    twin: Path, others: tuple[Path, ...], tried_file: Path, found_file: Path
) -> None:
    """Write what the first round tried, and the values found in TWIN.

    OTHERS are the equally good twins, for the spread of each value.
    """
    write_tried(tried_file)
    write_found(found_file, load_model(twin), [load_model(path) for path in others])

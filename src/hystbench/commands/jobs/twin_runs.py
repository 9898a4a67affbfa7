"""``hystbench job twin-runs``: one filter on several twins."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import click

from hystbench import options
from hystbench.files import read_json, write_json
from hystbench.twins.parts import run
from hystbench.twins.read import read_twins


@click.command()
@click.argument("twins", type=options.FILE, nargs=-1, required=True)
@click.option("--fits", type=options.FILE, required=True, help="Of twin-fits.")
@options.settings
@options.out
def twin_runs(
    twins: tuple[Path, ...], fits: Path, settings: dict[str, Any], out: Path
) -> None:
    """Run one filter on TWINS as configured."""
    write_json(out, run(read_twins(twins), settings, read_json(fits)))

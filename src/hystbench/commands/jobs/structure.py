"""``hystbench job structure``: try one structure on the calibration signals."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import click

from hystbench import options
from hystbench.calibration.structures import find_structure
from hystbench.calibration.trial import try_structure
from hystbench.files import write_json


@click.command()
@click.argument("name")
@options.settings
@options.out
def structure(name: str, settings: dict[str, Any], out: Path) -> None:
    """Fit the structure NAME to the calibration signals; leave each out in turn."""
    found = try_structure(
        find_structure(name),
        settings,
        tell=lambda line: click.echo(line, err=True),
    )
    write_json(out, found)

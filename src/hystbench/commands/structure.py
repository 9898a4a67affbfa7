"""``hystbench structure``: try one structure on the calibration signals."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import click

from hystbench import options
from hystbench.calibration.structures import find_structure, try_structure
from hystbench.files import write_json
from hystbench.model import load_model


@click.command()
@click.argument("name")
@click.option("--model", type=options.FILE, required=True, help="The chosen twin.")
@options.settings
@click.option("--out", type=options.NEW_FILE, required=True)
def structure(name: str, model: Path, settings: dict[str, Any], out: Path) -> None:
    """Refit the structure NAME from the chosen twin; leave each signal out in turn."""
    found = try_structure(
        find_structure(name),
        settings,
        load_model(model),
        tell=lambda line: click.echo(line, err=True),
    )
    write_json(out, found)

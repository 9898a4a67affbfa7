"""``hystbench job signal``: make an excitation signal."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import click

from hystbench import options
from hystbench.signals import make_signal


@click.command()
@click.argument("name")
@options.settings
@options.out
def signal(name: str, settings: dict[str, Any], out: Path) -> None:
    """Make the signal NAME from its definition in the settings."""
    make_signal(name, settings["definition"], settings["common"]).save(out)

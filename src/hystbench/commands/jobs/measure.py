"""``hystbench job measure``: simulate a model on a signal and record it."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import click

from hystbench import measurement, options
from hystbench.model import load_model
from hystbench.signals import load_signal


@click.command()
@click.argument("signal", type=options.FILE)
@click.option("--model", type=options.FILE, required=True, help="Model file (YAML).")
@options.settings
@options.out
def measure(signal: Path, model: Path, settings: dict[str, Any], out: Path) -> None:
    """Simulate a model on SIGNAL and write the record."""
    plant = load_model(model)
    measurement.measure(load_signal(signal), plant, settings, str(model)).save(out)

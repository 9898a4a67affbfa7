"""``hystbench job calibrate``: fit the twin and step sizes to the published tables."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import click

from hystbench import options
from hystbench.files import whole_folder
from hystbench.twins.plant import step_sizes
from hystbench.twins.run import run_calibration

WRITTEN = ("gma.yaml", "report.json", "uncertainty/gma-*.yaml")


@click.command()
@options.settings
@options.out_folder
def calibrate(settings: dict[str, Any], out: Path) -> None:
    """Fit the twin and one step size a filter to the calibration signals' errors.

    Writes ``gma.yaml``, ``uncertainty/`` with equally good twins and ``report.json``,
    and prints what belongs into config.yaml.
    """
    with whole_folder(out, WRITTEN) as fresh:
        best = run_calibration(settings, fresh, lambda line: click.echo(line, err=True))
    for model, steps in step_sizes(best.values).items():
        for key, value in steps.items():
            click.echo(
                f"config.yaml: filters: convergence_factor: {model}: {key}: {value:.6g}"
            )
    click.echo(f"config.yaml: twin: input_zero_error: {best.values['input zero']:.6g}")
    click.echo(f"config.yaml: twin: input_noise: {best.values['input noise']:.6g}")

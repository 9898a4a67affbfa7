"""``hystbench job calibrate``: fit the twin and step sizes to the published tables."""

import click

from hystbench.files import whole_folder
from hystbench.job import OutFolder, Settings, job
from hystbench.twins.plant import step_sizes
from hystbench.twins.run import run_calibration

WRITTEN = ("gma.yaml", "report.json", "uncertainty/gma-*.yaml")


@job
def calibrate(*, settings: Settings, out: OutFolder) -> None:
    """Fit the twin and one step size a filter to the calibration signals' errors.

    Writes ``gma.yaml``, ``uncertainty/`` with equally good twins and ``report.json``,
    and prints what belongs into config.yaml.
    """
    with whole_folder(out, WRITTEN) as fresh:
        best = run_calibration(settings, fresh, lambda line: click.echo(line, err=True))
    found = {
        f"filters: convergence_factor: {model}: {key}": value
        for model, steps in step_sizes(best.values).items()
        for key, value in steps.items()
    }
    found["twin: input_zero_error"] = best.values["input zero"]
    found["twin: input_noise"] = best.values["input noise"]
    for key, value in found.items():
        click.echo(f"config.yaml: {key}: {value:.6g}")

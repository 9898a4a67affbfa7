"""``hystbench job devices``: the paper's models on measured devices."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import click

from hystbench import options
from hystbench.dataset import load_dataset
from hystbench.devices.errors import DeviceError, device_errors
from hystbench.devices.tables import WRITTEN, read_gaps, write_devices
from hystbench.files import whole_folder


@click.command()
@click.argument("datasets", nargs=-1, required=True, type=options.DATASET)
@click.option(
    "--gaps", type=options.FILE, help="Summary of the gap on the same datasets (CSV)."
)
@options.settings
@options.out_folder
def devices(
    datasets: tuple[Path, ...], gaps: Path | None, settings: dict[str, Any], out: Path
) -> None:
    """Run the paper's five models on the hold-out records of DATASETS.

    Writes OUT/errors.csv, tables for the documentation, and what they come to.
    """
    with whole_folder(out, WRITTEN) as fresh:
        errors: list[DeviceError] = []
        for place in datasets:
            dataset = load_dataset(place)
            click.echo(f"dataset {dataset.name}", err=True)
            errors += device_errors(dataset, settings)
        write_devices(errors, read_gaps(gaps) if gaps else {}, fresh)

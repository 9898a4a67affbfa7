"""``hystbench job devices``: the paper's models on measured devices."""

import click

from hystbench.dataset import load_dataset
from hystbench.devices.errors import DeviceError, device_errors
from hystbench.devices.tables import WRITTEN, read_gaps, write_devices
from hystbench.files import whole_folder
from hystbench.job import DatasetFile, In, OutFolder, Settings, job


@job
def devices(
    datasets: tuple[DatasetFile, ...],
    *,
    gaps: In | None = None,
    settings: Settings,
    out: OutFolder,
) -> None:
    """Run the paper's five models on the hold-out records of DATASETS.

    Writes OUT/errors.csv, tables for the documentation, and what they come to. GAPS is
    the summary of the gap on the same datasets (CSV).
    """
    with whole_folder(out, WRITTEN) as fresh:
        errors: list[DeviceError] = []
        for place in datasets:
            dataset = load_dataset(place)
            click.echo(f"dataset {dataset.name}", err=True)
            errors += device_errors(dataset, settings)
        write_devices(errors, read_gaps(gaps) if gaps else {}, fresh)

"""``hystbench job compare-measured``: errors on a measured dataset."""

from hystbench.compare import measured
from hystbench.files import whole_folder
from hystbench.options import In, OutFolder, command


@command
def compare_measured(
    dataset: str, *, runs: tuple[In, ...] = (), out: OutFolder
) -> None:
    """Write the errors of all models on the records of DATASET."""
    with whole_folder(out, measured.WRITTEN) as fresh:
        measured.compare_measured(fresh, dataset, runs)

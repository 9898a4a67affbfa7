"""``hystbench job export-gap``: models of the gap as code, beside their simulation."""

from hystbench.dataset import load_dataset
from hystbench.files import write_csv
from hystbench.job import DatasetFile, In, Out, job
from hystbench.model import load_model


@job
def export_gap(*, cases: tuple[tuple[DatasetFile, In], ...], out: Out) -> None:
    """Export each model and feed it the dataset's hold-out records, as a table (CSV).

    A case is a dataset, and the model file that 'hystbench gap' wrote for it.
    Differences from the simulation are shares of the range of the simulated output.
    """
    from hystbench.export.compared import COLUMNS, row  # late: it runs

    rows = []
    for place, file in cases:
        dataset = load_dataset(place)
        held = [name for name in dataset.record_files if dataset.use(name) != "fit"]
        records = [dataset.read(name) for name in held]
        rows.append(row(dataset.name, load_model(file), records))
    write_csv(out, list(COLUMNS), ([row[key] for key in COLUMNS] for row in rows))

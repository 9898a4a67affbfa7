"""``hystbench load``: read and check one measured record."""

from hystbench import options
from hystbench.dataset import load_dataset
from hystbench.doubts import doubts
from hystbench.errors import refuse_unknown
from hystbench.options import DatasetFile, Out, command


@command
def load(dataset: DatasetFile, name: str, *, out: Out) -> None:
    """Read the record NAME of DATASET (a dataset.yaml or its folder).

    Warnings that concern it are shown; for them the other records are read too.
    """
    measured = load_dataset(dataset)
    refuse_unknown(name, measured.record_files, f"{dataset}: no record {name!r}")
    records = {other: measured.read(other) for other in measured.record_files}
    options.warn(doubts(measured, list(records.values()), name))
    records[name].save(out)

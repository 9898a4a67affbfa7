"""A dataset as a notebook shows it: its records, a table of samples, a picture."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING

from hystbench import dataset as files
from hystbench.errors import InputError, nearest
from hystbench.record import Record, column_name

if TYPE_CHECKING:
    import pandas as pd

    from hystbench.interface.picture import Picture

DRAWN = 8
"""Records of a picture, at most: more of them are not read."""


@dataclass(frozen=True, repr=False)
class ShownDataset(files.Dataset):
    """Measured records: what dataset.yaml says, and the samples once they are asked.

    ``dataset["name"]`` gives a record, ``for record in dataset`` each of them.
    """

    @cached_property
    def records(self) -> tuple[Record, ...]:
        """All records, read and checked."""
        return tuple(self.read(name) for name in self.record_files)

    def __getitem__(self, name: str) -> Record:
        """Give the record of a name.

        Raises
        ------
        InputError
            If there is none.
        """
        for record in self.records:
            if record.name == name:
                return record
        raise InputError(
            f"{self.path}: no record {name!r}; {nearest(name, self.record_files)}"
        )

    def __iter__(self) -> Iterator[Record]:
        """Give the records in their order."""
        return iter(self.records)

    def __len__(self) -> int:
        """Count the records."""
        return len(self.record_files)

    def __repr__(self) -> str:
        """Tell the channels with their units, and of each record what it is."""
        first = self.records[0]
        many = f"{len(self)} records" if len(self) > 1 else "1 record"
        lines = [
            f"Dataset {self.name}: {many}, {first.input.label} to {first.output.label}"
        ]
        wide = max(len(record.name) for record in self.records)
        for record in self.records:
            again = (
                f", repeats every {record.period_samples} samples"
                if record.period_samples
                else ""
            )
            lines.append(
                f"  {record.name:<{wide}}  {record.use:<8}  {len(record)} samples at "
                f"{1 / record.dt:.6g} Hz, {len(record) * record.dt:.4g} s{again}"
            )
        return "\n".join(lines)

    def to_frame(self) -> pd.DataFrame:
        """Give all samples in one table.

        Returns
        -------
        pandas.DataFrame
            A row a sample: ``record``, ``use``, ``time_s``, the input and the output,
            each named with its unit, and ``simulated`` where the dataset has it.
        """
        import pandas as pd  # late: it takes half a second

        frames = []
        for record in self.records:
            columns = {
                "record": record.name,
                "use": record.use,
                "time_s": record.time,
                column_name(record.input.name, record.input.unit): record.u,
                column_name(record.output.name, record.output.unit): record.y,
            }
            if record.simulated is not None:
                columns["simulated"] = record.simulated
            frames.append(pd.DataFrame(columns))
        return pd.concat(frames, ignore_index=True)

    def plot(self) -> Picture:
        """Draw each record: input and output over time, and output over input.

        Returns
        -------
        matplotlib.figure.Figure
        """
        from hystbench.interface.picture import drawn, records  # late: it draws

        shown = self.records[:DRAWN]
        return drawn(lambda axes: records(axes, shown), len(shown), 3, 1.9)


def load_dataset(path: str | Path) -> ShownDataset:
    """Read and check a dataset.yaml (its header and files; samples when asked).

    Parameters
    ----------
    path : str or Path
        The dataset.yaml, or the folder that holds it.

    Returns
    -------
    ShownDataset

    Raises
    ------
    InputError
        If the file, a key or a record's file is missing or wrong.
    """
    found = files.load_dataset(path)
    return ShownDataset(**vars(found))

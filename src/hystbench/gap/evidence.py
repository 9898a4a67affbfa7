"""What the gap workflow reads: fit records, hold-out records, how the input moves."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from hystbench.blocks.held import Hold
from hystbench.dataset import Dataset, load_dataset
from hystbench.errors import InputError
from hystbench.model import Model
from hystbench.record import Channel, Record, Use

STUCK = 0.05
"""Share of a record, and of the input's range, over which no output stands still."""


@dataclass(frozen=True)
class Evidence:
    """Records of one device.

    Parameters
    ----------
    name : str
    fit : tuple of Record
        What models are fitted to; folds of these decide what pays.
    hold_out : tuple of Record
        Read once, after everything is decided.
    hold : {"zero-order", "linear", "band-limited"}
        How the input moves between samples.
    noise_rms : float, optional
        As declared, in the output's unit.
    """

    name: str
    fit: tuple[Record, ...]
    hold_out: tuple[Record, ...]
    hold: Hold = "band-limited"
    noise_rms: float | None = None

    @property
    def input(self) -> Channel:
        """Name and unit of the input."""
        return (*self.fit, *self.hold_out)[0].input

    @property
    def output(self) -> Channel:
        """Name and unit of the output."""
        return (*self.fit, *self.hold_out)[0].output


def load_evidence(path: str | Path, use: Use | None = None) -> Evidence:
    """Read a dataset for the gap workflow.

    Parameters
    ----------
    path : str or Path
    use : {"fit", "hold-out"}, optional
        Read only these records; the files of the others are not opened.

    Raises
    ------
    InputError
        If a record cannot be used, or there is none to fit or none held out.
    """
    dataset = load_dataset(path)
    if not any(dataset.use(name) == "hold-out" for name in dataset.record_files):
        raise InputError(
            f"{dataset.path}: records: none has 'use: hold-out'; expected at least "
            "one, to show by how much the gap shrinks"
        )
    records = [
        dataset.read(name)
        for name in dataset.record_files
        if use in (None, dataset.use(name))
    ]
    fit = tuple(record for record in records if record.use == "fit")
    hold_out = tuple(record for record in records if record.use == "hold-out")
    for record in records:
        _check_usable(dataset, record)
    about = dataset.about
    hold: Hold = about["input"].get("hold", "band-limited")
    return Evidence(dataset.name, fit, hold_out, hold, about.get("noise_rms"))


def check_units(evidence: Evidence, model: Model, place: str) -> None:
    """Refuse a model whose units are not those of the records.

    Raises
    ------
    InputError
        Which unit, and what was expected.
    """
    for key, model_has, data_have in (
        ("input", model.input, evidence.input),
        ("output", model.output, evidence.output),
    ):
        if model_has.unit != data_have.unit:
            raise InputError(
                f"{place}: {key}: unit: {model_has.unit!r}; expected "
                f"{data_have.unit!r}, the unit of {evidence.name}'s {data_have.name}"
            )


def _check_usable(dataset: Dataset, record: Record) -> None:
    """Refuse a record whose output stands still while its input moves."""
    y, u = record.y, record.u
    changes = np.flatnonzero(np.diff(y) != 0)
    edges = np.concatenate([[0], changes + 1, [len(y)]])
    longest = int(np.argmax(np.diff(edges)))
    first, last = int(edges[longest]), int(edges[longest + 1])
    moved = float(np.ptp(u[first:last]))
    if last - first > STUCK * len(y) and moved > STUCK * float(np.ptp(u)):
        file = dataset.record_files[record.name]
        at_end = y[first] in (y.min(), y.max())
        raise InputError(
            f"{file}: row {first + 2}: {record.output.name} is {y[first]:g} "
            f"{record.output.unit} for {last - first} samples while the input moves; "
            f"expected a channel that is not {'clipped' if at_end else 'stuck'}"
        )

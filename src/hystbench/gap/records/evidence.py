"""What the gap workflow reads: fit records, hold-out records, how the input moves."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from hystbench.blocks.held import Hold
from hystbench.dataset import Dataset, load_dataset
from hystbench.device_kinds import DeviceKind
from hystbench.doubts import doubts
from hystbench.errors import InputError
from hystbench.gap.records import folds, nuisance
from hystbench.gap.records.continued import continued
from hystbench.gap.records.free_mass import decay_of_free_mass, windows
from hystbench.gap.records.unlike import unlike_the_others
from hystbench.gap.records.usable import check_usable
from hystbench.model import Model
from hystbench.quantities import NONE_KNOWN, Quantities
from hystbench.record import Channel, Record, Use
from hystbench.units import check_same_unit


@dataclass(frozen=True)
class Evidence:
    """Records of one device."""

    name: str
    fit: tuple[Record, ...]
    """What models are fitted to; folds of these decide what pays."""
    hold_out: tuple[Record, ...]
    """Checked with the others; compared with a model only after all is decided."""
    input_hold: Hold = "band-limited"
    """How the input moves between samples."""
    noise_rms: float | None = None
    """RMS noise as declared, in the output's unit."""
    identification: str | None = None
    """Name of the fit record that a hysteretic base is identified from; by default the
    slowest."""
    simulated_column: str | None = None
    """Column of the output that a simulator gave elsewhere, if the records have one."""
    warnings: tuple[str, ...] = ()
    """What of the records is hardly meant, one line each."""
    quantities: Quantities = NONE_KNOWN
    """What the device takes and gives."""
    device_kind: DeviceKind | None = None
    """Kind of the device, where dataset.yaml tells it."""
    free_starts: bool = False
    """Whether records may begin in any state of a linear base."""

    @property
    def deciding(self) -> Evidence:
        """The same without the hold-out records: all that a decision is given."""
        return replace(self, hold_out=())

    @property
    def input(self) -> Channel:
        """Name and unit of the input."""
        return (*self.fit, *self.hold_out)[0].input

    @property
    def output(self) -> Channel:
        """Name and unit of the output."""
        return (*self.fit, *self.hold_out)[0].output

    @property
    def own_offsets(self) -> bool:
        """Whether the zero of the output may be another one in each fit record.

        Not where it is physical: a store is empty at zero, and a window of a free mass
        begins there.
        """
        physical = self.quantities.causality == "storage" or self.in_windows
        return len(self.fit) > 1 and not physical

    @property
    def in_windows(self) -> bool:
        """Whether fit records are windows of a free mass."""
        return any(record.decay_s is not None for record in self.fit)

    @property
    def to_identify_from(self) -> Record:
        """The fit record for identification: the one named, or the slowest.

        As :attr:`Dataset.identification` chooses, but among records as they are
        searched: put together, cut, or with a law taken off. The output moves in it.
        """
        if self.identification is None:
            moving = [record for record in self.fit if np.ptp(record.y) > 0]
            return min(moving or self.fit, key=lambda record: record.rate)
        return next(item for item in self.fit if item.name == self.identification)


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
        If a record cannot be used, there is none to fit or none held out, or one held
        out is a copy of one to fit.
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
    for record in records:
        file = dataset.record_files[record.name]
        _check_length(file, record)
        check_usable(file, record, dataset.stands_still(record.name))
    named = dataset.about.get("identification")
    if named is not None and dataset.use(named) != "fit":
        raise InputError(
            f"{dataset.path}: identification: {named!r} is held out; expected a record "
            "with 'use: fit'"
        )
    unlike = (item.words for item in unlike_the_others(records))
    return evidence_of(dataset, records, (*doubts(dataset, records), *unlike))


def evidence_of(
    dataset: Dataset, records: Sequence[Record], notes: tuple[str, ...] = ()
) -> Evidence:
    """Take records of a dataset for the gap workflow; nothing is checked.

    Parameters
    ----------
    dataset : Dataset
    records : sequence of Record
        As they were read, at least one to fit.
    notes : tuple of str
        What of them is hardly meant.
    """
    named = dataset.about.get("identification")
    decay = decay_of_free_mass(records, dataset.quantities)
    if decay is not None:
        notes, named = (*notes, CUT), None
        records = [window for record in records for window in windows(record, decay)]
    else:
        records = continued(records, dataset)
    return Evidence(
        dataset.name,
        tuple(record for record in records if record.use == "fit"),
        tuple(record for record in records if record.use == "hold-out"),
        dataset.input_hold,
        dataset.about.get("noise_rms"),
        named,
        dataset.simulated_column,
        notes,
        dataset.quantities,
        dataset.device_kind,
    )


CUT = (
    "a force moves a mass that no spring holds: every record is cut where the motion "
    "turns; each window starts at zero, and what its velocity there does is left out"
)


def _check_length(file: Path, record: Record) -> None:
    """Refuse a record that is too short for its role, whatever will be named."""
    least, why = {
        "fit": (folds.SHORTEST, "blocks of it judge what was fitted to the others"),
        "hold-out": (nuisance.SHORTEST, "its first 30 % give what is new in it"),
    }[record.use]
    if len(record) < least:
        raise InputError(
            f"{file}: {len(record)} samples; expected at least {least}, as {why}"
        )


def check_units(evidence: Evidence, model: Model, place: str) -> None:
    """Refuse a model whose units are not those of the records, in some spelling.

    Raises
    ------
    InputError
        Which unit, and what was expected.
    """
    for key, model_has, data_have in (
        ("input", model.input, evidence.input),
        ("output", model.output, evidence.output),
    ):
        whose = f"the {data_have.name} of {evidence.name}"
        where = f"{place}: {key}: unit"
        check_same_unit(where, model_has.unit, whose, data_have.unit, of_model=True)

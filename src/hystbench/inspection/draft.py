"""A dataset.yaml proposed from files: columns, units, records, periods and roles."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from hystbench.copies import Written, common_piece
from hystbench.dataset import Dataset, dataset_of
from hystbench.doubts import doubts
from hystbench.errors import InputError
from hystbench.formats import Table, read_table
from hystbench.inspection.columns import (
    SHORTEST,
    RecordColumns,
    fits,
    parts_of,
    signals_of,
)
from hystbench.inspection.entries import (
    checked_frequency,
    content_of,
    cut_in_two,
    with_roles,
)
from hystbench.inspection.pieces import missing_in
from hystbench.inspection.user import Ask, Flags, User, words
from hystbench.periods import find_period
from hystbench.record import Record
from hystbench.written import sha256


@dataclass(frozen=True)
class Draft:
    """A proposed dataset."""

    dataset: Dataset
    """Checked: each record can be read."""
    records: tuple[Record, ...]
    notes: tuple[str, ...]
    """What was found and what was taken for what, one line each."""
    warnings: tuple[str, ...] = ()
    """What is hardly meant."""


def draft(files: Sequence[Path], place: Path, given: Flags, ask: Ask) -> Draft:
    """Propose a dataset.yaml for files of measurements.

    Parameters
    ----------
    files : sequence of Path
        One or more, of any format that is known.
    place : Path
        Where dataset.yaml is to stand; paths of the files are relative to it.
    given : Flags
    ask : Ask
        Called for what neither files nor flags tell.

    Raises
    ------
    InputError
        If a file cannot be read, no column can be time, input or output, or a record
        cannot be used.
    """
    if given.sampling_frequency is not None:
        checked_frequency(given.sampling_frequency)
    user = User(given, ask)
    parts: list[RecordColumns] = []
    for file in files:
        table = read_table(file)
        for note in table.notes:
            user.note("of file", file=file.name, note=note)
        found = parts_of(table)
        if not found:
            raise InputError(
                f"{file}: no two columns of {SHORTEST} samples or more; expected an "
                f"input and an output{_has(table)}"
            )
        parts += found
    signals = signals_of(parts, user)
    used = [part for part in parts if fits(part, signals)]
    for part in parts:
        if part not in used:
            user.note("left out", where=part.where, **vars(signals))
    about, entries, owners = content_of(used, signals, place, user)
    records = _read(place, about, entries)
    warnings: list[str] = []
    if len(entries) == 1 and not given.hold_out:
        (part,) = owners
        cut = cut_in_two(entries[0], records[0], missing_in(part, signals))
        pieces = _read(place, about, cut)
        if common_piece(*map(Written.of, pieces)) is None:
            entries, records = cut, pieces
            user.note("cut in two")
        else:
            entries = [{**entries[0], "use": "fit"}]
            warnings.append(words("repeats", where=part.where))
    else:
        entries = with_roles(entries, records, user)
    for entry, record in zip(entries, records, strict=True):
        period = find_period(record.u)
        if period is not None:
            entry["period_samples"] = period
    dataset = dataset_of(place, {**about, "records": entries})
    for entry, file in zip(entries, dataset.record_files.values(), strict=True):
        entry["sha256"] = sha256(file)
    records = [
        replace(record, use=entry["use"], period_samples=entry.get("period_samples"))
        for entry, record in zip(entries, records, strict=True)
    ]
    warnings += doubts(dataset, records)
    return Draft(dataset, tuple(records), tuple(user.notes), tuple(warnings))


def _read(
    place: Path, about: Mapping[str, Any], entries: Sequence[Mapping[str, Any]]
) -> list[Record]:
    """Read and check all records."""
    dataset = dataset_of(place, {**about, "records": list(entries)})
    return [dataset.read(name) for name in dataset.record_files]


def _has(table: Table) -> str:
    lengths = [f"{c.name} ({len(c.values)})" for c in table.columns[:6]]
    return f"; it has {', '.join(lengths)}" if lengths else ""

"""Measured records: a dataset.yaml and the files of measurements that it names."""

import re
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from functools import cache, cached_property
from pathlib import Path
from typing import Any, Literal

import numpy as np

from hystbench.dataset_files import check_digest, check_files, file_of
from hystbench.device_kinds import DEVICE_KINDS, DeviceKind
from hystbench.errors import InputError, nearest
from hystbench.even_times import on_even_times, usual_step
from hystbench.formats import Column, Table, read_table
from hystbench.quantities import QUANTITIES, Quantities, Quantity, quantity_of
from hystbench.record import Channel, Hold, Record, Use
from hystbench.samples import (
    UNIFORM_TOLERANCE,
    WhereMoved,
    check_increases,
    check_moves,
    check_period,
    check_unit,
    just_before,
    record_name,
    rows_of,
    sampling_interval,
    whole,
)
from hystbench.schema import check_against_schema
from hystbench.units import check_known, check_same_unit, plain, seconds
from hystbench.yaml_files import load_yaml

CHANNELS = ("time", "input", "output", "simulated")
"""What a column of a dataset may be."""


@dataclass(frozen=True)
class Dataset:
    """What dataset.yaml says; the samples stay in their files until they are read."""

    path: Path
    """The dataset.yaml itself."""
    name: str
    """Name of the dataset, and of its folder under results/datasets."""
    about: Mapping[str, Any]
    """The checked content of dataset.yaml."""

    @property
    def record_files(self) -> dict[str, Path]:
        """File of each record, by the record's name: the one given, or the stem."""
        return {
            record_name(entry): file_of(self.path, entry)
            for entry in self.about["records"]
        }

    def use(self, name: str) -> Use:
        """Tell what a record may be used for."""
        use: Use = self.entry(name).get("use", "fit")
        return use

    def stands_still(self, name: str) -> tuple[str, ...]:
        """Tell which channels of a record, input or output, really stand still."""
        return tuple(self.entry(name).get("stands_still", ()))

    @property
    def input_hold(self) -> Hold:
        """How the input moves between samples."""
        hold: Hold = self.about["input"].get("hold", "band-limited")
        return hold

    def meant(self, name: str) -> tuple[str, ...]:
        """Tell what of a record is meant as it is, and no longer warned of."""
        return tuple(self.entry(name).get("meant", ()))

    def entry(self, name: str) -> Mapping[str, Any]:
        """Give what dataset.yaml says of a record."""
        entries = {record_name(entry): entry for entry in self.about["records"]}
        entry: Mapping[str, Any] = entries[name]
        return entry

    def read(self, name: str) -> Record:
        """Read and check one record.

        Raises
        ------
        InputError
            If a column is missing, a cell is no finite number, time does not
            increase uniformly, or a channel does not move.
        """
        file, entry = self.record_files[name], self.entry(name)
        table, columns, rows = self.columns(name)
        signals = {
            key: whole(table, column, rows, entry.get("missing"))
            for key, column in columns.items()
        }
        # Time alone may be interpolated without a loss: it is uniform anyway.
        there = [
            np.isfinite(column.values[rows])
            for key, column in columns.items()
            if key != "time"
        ]
        lost = ~np.all(there, 0)
        if "time" in signals:
            about = self.about["time"]
            unit = seconds(f"{self.path}: time: unit", about["unit"])
            time = signals.pop("time") * unit
            if "uneven" in about:
                check_increases(table, time, rows.start)
                # One step for all parts of a file, so that one goes on with another.
                dt = usual_step(columns["time"].values * unit)
                signals, lost = on_even_times(
                    f"{file}: {name}", time, dt, signals, lost, self.input_hold
                )
            else:
                tolerance = about.get("tolerance", UNIFORM_TOLERANCE)
                dt = sampling_interval(table, time, tolerance, rows.start, about)
        else:
            dt = 1.0 / self._sampling_frequency(table, columns.values(), entry)
        u, y = signals["input"], signals["output"]
        channels = [self.about["input"], self.about["output"]]
        of = f"{file}: record {name} (rows {rows.start + 1} to {rows.stop})"
        for key, values in (("input", u), ("output", y)):
            check_moves(of, self.about[key], values, self._where_moved(name, key))
        given, measured = (Channel(_name(item), item["unit"]) for item in channels)
        period = entry.get("period_samples")
        if period is not None:
            check_period(f"{self.path}: records: {file.name}", period, u)
        return Record(
            name,
            dt,
            u,
            y,
            given,
            measured,
            "measured",
            self.use(name),
            period,
            signals.get("simulated"),
            lost if lost.any() else None,
        )

    def _where_moved(self, name: str, key: str) -> WhereMoved:
        """Tell where a channel that is constant in a record has to move instead."""
        if key == "input":
            before = self.use(name) == "hold-out" and self.just_before(name)
            return "before" if before else "nowhere"
        if "output" not in self.stands_still(name):
            return "unsaid"
        others = [x for x in self.record_files if x != name and self.use(x) == "fit"]
        moves = any(self._output_moves(other) for other in others)
        return "elsewhere" if moves else "in none"

    def _output_moves(self, name: str) -> bool:
        """Tell whether the output of a record is more than one value."""
        _, columns, rows = self.columns(name)
        values = columns["output"].values[rows]
        return len(np.unique(values[np.isfinite(values)])) > 1

    def just_before(self, name: str) -> list[str]:
        """Name the parts of the same measurement that end where a record begins.

        By their rows; times are not looked at.
        """
        return just_before(self.about["records"], self.entry(name))

    def columns(self, name: str) -> tuple[Table, dict[str, Column], slice]:
        """Read the columns of a record, as they stand in its file.

        Returns
        -------
        table : Table
            All that was read of the file.
        columns : dict of str to Column
            By what they are: those of :data:`CHANNELS` that dataset.yaml names.
        rows : slice
            The record's samples in them.

        Raises
        ------
        InputError
            If a column is missing or has another unit, or there are no such rows.
        """
        file, entry = self.record_files[name], self.entry(name)
        abouts = {key: self.about[key] for key in CHANNELS if key in self.about}
        check_digest(self.path, file, entry)
        table = read_table(file, [about["column"] for about in abouts.values()])
        columns = {
            key: table.column(about["column"], entry.get("group", ""))
            for key, about in abouts.items()
        }
        for key, about in abouts.items():
            check_unit(file, about, columns[key])
        return table, columns, rows_of(self.path, table, entry, [*columns.values()])

    def _sampling_frequency(
        self, table: Table, columns: Iterable[Column], entry: Mapping[str, Any]
    ) -> float:
        """Give the sampling frequency in Hz of a record without a column of time."""
        for about in (entry, self.about):
            if "sampling_frequency_hz" in about:
                return float(about["sampling_frequency_hz"])
        told = table.sampling_frequency(columns)
        if told is None:
            raise InputError(
                f"{self.path}: no 'time' and no 'sampling_frequency_hz', and "
                f"{table.path.name} tells none; expected one of them"
            )
        return told

    @property
    def simulated_column(self) -> str | None:
        """Column of the output that a simulator gave elsewhere, if records have one."""
        about = self.about.get("simulated")
        return None if about is None else str(about["column"])

    @property
    def quantities(self) -> Quantities:
        """What the device takes and gives, as its units and dataset.yaml tell.

        A length is a level where the name of its column has the word ``level`` in it.
        """
        return Quantities(self._quantity("input"), self._quantity("output"))

    def _quantity(self, key: Literal["input", "output"]) -> Quantity:
        channel = self.about[key]
        place = f"{self.path}: {key}"
        found = quantity_of(place, channel["unit"], channel.get("quantity"))
        words = re.split("[^a-z]+", channel["column"].lower())
        named = "quantity" not in channel and found == "position" and "level" in words
        return "level" if named else found

    @property
    def device_kind(self) -> DeviceKind | None:
        """Kind of the device, if dataset.yaml tells it."""
        kind: DeviceKind | None = self.about.get("device", {}).get("kind")
        return kind

    @cached_property
    def identification(self) -> str:
        """Name of the record for identification: the one named, or the slowest.

        The slowest has the least rms(du/dt) / rms(u); only records with
        ``use: fit`` whose output moves are looked at. To find it their files are read,
        once.
        """
        named = self.about.get("identification")
        if named is not None:
            return str(named)
        fit = [name for name in self.record_files if self.use(name) == "fit"]
        moving = [record for record in map(self.read, fit) if np.ptp(record.y) > 0]
        return min(moving, key=lambda record: record.rate).name


def load_dataset(path: str | Path) -> Dataset:
    """Read and check a dataset.yaml (its header and files, not the samples).

    Parameters
    ----------
    path : str or Path
        The dataset.yaml, or the folder that holds it.

    Raises
    ------
    InputError
        If the file, a key or a record's file is missing or wrong.
    """
    file = Path(path)
    if file.is_dir():
        file = file / "dataset.yaml"
    about = load_yaml(file, "a dataset.yaml or its folder")
    if not isinstance(about, dict):
        beside = file.parent / "dataset.yaml"
        hint = f"; did you mean {str(beside)!r}?" if beside.is_file() else ""
        raise InputError(f"{file}: expected a dataset.yaml or its folder{hint}")
    return dataset_of(file, about)


@cache
def schema() -> dict[str, Any]:
    """Give what a dataset.yaml may say, as a JSON Schema."""
    found: dict[str, Any] = load_yaml(Path(__file__).with_suffix(".yaml"))
    own = found["properties"]
    for channel in ("input", "output"):
        own[channel]["properties"]["quantity"]["enum"] = list(QUANTITIES)
    own["device"]["properties"]["kind"]["enum"] = list(DEVICE_KINDS)
    return found


def dataset_of(file: Path, about: dict[str, Any]) -> Dataset:
    """Check what a dataset.yaml says, read or about to be written.

    Parameters
    ----------
    file : Path
        The dataset.yaml; it need not be there yet.
    about : dict
        Its content.

    Raises
    ------
    InputError
        If a key or a record's file is missing or wrong.
    """
    check_against_schema(about, schema(), str(file))
    dataset = Dataset(file, about["name"], about)
    files = dataset.record_files
    check_files(file, about["records"])
    named = about.get("identification")
    if named is not None and named not in files:
        raise InputError(
            f"{file}: identification: no record {named!r}; {nearest(named, files)}"
        )
    if not any(dataset.use(name) == "fit" for name in files):
        raise InputError(f"{file}: records: expected at least one with 'use: fit'")
    channels = [key for key in CHANNELS if key in about]
    columns = [about[channel]["column"] for channel in channels]
    for column in columns:
        if columns.count(column) > 1:
            raise InputError(
                f"{file}: column {column!r} is named twice; "
                f"expected one each for {', '.join(channels[:-1])} and {channels[-1]}"
            )
    if "simulated" in about:
        ours, measured = about["simulated"]["unit"], about["output"]["unit"]
        check_same_unit(f"{file}: simulated: unit", ours, "the output", measured)
    for channel in ("input", "output"):
        check_known(f"{file}: {channel}: unit", about[channel]["unit"])
    if any("quantity" in about[channel] for channel in ("input", "output")):
        _ = dataset.quantities  # refuses one that the unit is none of
    if "time" in about:
        seconds(f"{file}: time: unit", about["time"]["unit"])
    return dataset


def _name(channel: Mapping[str, str]) -> str:
    """Name of a channel: as given, or its column without the unit behind it."""
    if "name" in channel:
        return channel["name"]
    unit, column = plain(channel["unit"]), channel["column"]
    spelt = [unit.replace("/", over) for over in ("_per_", "_", "p", "")]
    spelt += [each.replace("*", "").replace("^", "") for each in spelt]
    for end in (*(f"_{each}" for each in spelt), f"[{unit}]", f"({unit})"):
        if plain(column).endswith(end):
            return column[: -len(end)].strip(" _").replace("_", " ")
    return column.replace("_", " ")

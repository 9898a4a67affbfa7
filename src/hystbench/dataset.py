"""Measured records: a folder with dataset.yaml and one CSV file a record."""

from __future__ import annotations

import csv
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from hystbench.errors import InputError, nearest, short
from hystbench.record import Channel, FloatArray, Record, Use
from hystbench.schema import check_against_schema
from hystbench.text_files import read_text
from hystbench.units import check_known, check_same_unit, plain, seconds
from hystbench.written import reads
from hystbench.yaml_files import load_yaml

#: Steps may differ from their mean by this share where dataset.yaml does not say:
#: printed times are rounded, and a clock that is off by more is no uniform clock.
UNIFORM_TOLERANCE = 0.01

#: The smallest range of a channel; the largest value is one over it.
SMALLEST = 1e-30

#: An input repeats itself if two of its periods differ by no more than this share of
#: its standard deviation, rms.
UNLIKE = 0.2

#: Names of records: they name results, and braces are Snakemake's own.
_NAME = re.compile(r"[^.\-\s{}*?\\\x00-\x1f][^{}*?\\\x00-\x1f]*")

_CHANNEL = {
    "type": "object",
    "required": ["column", "unit"],
    "additionalProperties": False,
    "properties": {
        "column": {"type": "string"},
        "unit": {"type": "string"},
        "name": {"type": "string"},
        "meant": {"type": "boolean"},
    },
}

SCHEMA: dict[str, Any] = {
    "type": "object",
    "required": ["name", "time", "input", "output", "records"],
    "additionalProperties": False,
    "properties": {
        "name": {"type": "string", "pattern": r"^[A-Za-z0-9][A-Za-z0-9._-]*$"},
        "description": {"type": "string"},
        "time": {
            "type": "object",
            "required": ["column", "unit"],
            "additionalProperties": False,
            "properties": {
                "column": {"type": "string"},
                "unit": {"type": "string"},
                "tolerance": {"type": "number", "exclusiveMinimum": 0, "maximum": 0.5},
                "meant": {"type": "boolean"},
            },
        },
        "input": _CHANNEL
        | {
            "properties": {
                **_CHANNEL["properties"],  # type: ignore[dict-item]
                "hold": {"enum": ["zero-order", "linear", "band-limited"]},
            }
        },
        "output": _CHANNEL,
        "simulated": {
            "type": "object",
            "required": ["column", "unit"],
            "additionalProperties": False,
            "properties": {
                "column": {"type": "string"},
                "unit": {"type": "string"},
                "meant": {"type": "boolean"},
            },
        },
        "noise_rms": {"type": "number", "exclusiveMinimum": 0},
        "identification": {"type": "string"},
        "records": {
            "type": "array",
            "minItems": 1,
            "items": {
                "type": "object",
                "required": ["file"],
                "additionalProperties": False,
                "properties": {
                    "file": {"type": "string"},
                    "use": {"enum": ["fit", "hold-out"]},
                    "period_samples": {"type": "integer", "minimum": 2},
                    "stands_still": {
                        "type": "array",
                        "items": {"enum": ["input", "output"]},
                        "uniqueItems": True,
                    },
                    "meant": {
                        "type": "array",
                        "items": {"enum": ["copy", "amplitude"]},
                        "uniqueItems": True,
                    },
                },
            },
        },
    },
}


@dataclass(frozen=True)
class Dataset:
    """What dataset.yaml says; the samples stay in their files until they are read.

    Parameters
    ----------
    path : Path
        The dataset.yaml itself.
    name : str
        Name of the dataset, and of its folder under results/datasets.
    about : mapping
        The checked content of dataset.yaml.
    """

    path: Path
    name: str
    about: Mapping[str, Any]

    @property
    def record_files(self) -> dict[str, Path]:
        """File of each record, by the record's name (the file's stem)."""
        files = [self.path.parent / entry["file"] for entry in self.about["records"]]
        return {file.stem: file for file in files}

    def use(self, name: str) -> Use:
        """Tell what a record may be used for."""
        use: Use = self._entry(name).get("use", "fit")
        return use

    def stands_still(self, name: str) -> tuple[str, ...]:
        """Tell which channels of a record, input or output, really stand still."""
        return tuple(self._entry(name).get("stands_still", ()))

    def meant(self, name: str) -> tuple[str, ...]:
        """Tell what of a record is meant as it is, and no longer warned of."""
        return tuple(self._entry(name).get("meant", ()))

    def _entry(self, name: str) -> Mapping[str, Any]:
        """Give what dataset.yaml says of a record."""
        entries = {Path(entry["file"]).stem: entry for entry in self.about["records"]}
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
        file = self.record_files[name]
        time_about = self.about["time"]
        channels = [self.about["input"], self.about["output"]]
        columns = [time_about["column"], *(item["column"] for item in channels)]
        if self.simulated_column is not None:
            columns.append(self.simulated_column)
        time, u, y, *others = _read_columns(file, columns)
        dt = _sampling_interval(
            file,
            time * seconds(f"{self.path}: time: unit", time_about["unit"]),
            time_about.get("tolerance", UNIFORM_TOLERANCE),
        )
        for item, values in zip(channels, (u, y), strict=True):
            _check_moves(file, item, values)
        given, measured = (Channel(_name(item), item["unit"]) for item in channels)
        period = self._entry(name).get("period_samples")
        if period is not None:
            _check_period(f"{self.path}: records: {file.name}", period, u)
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
            others[0] if others else None,
        )

    @property
    def simulated_column(self) -> str | None:
        """Column of the output that a simulator gave elsewhere, if records have one."""
        about = self.about.get("simulated")
        return None if about is None else str(about["column"])

    @property
    def identification(self) -> str:
        """Name of the record for identification: the one named, or the slowest.

        The slowest has the least rms(du/dt) / rms(u); only records with
        ``use: fit`` are looked at.
        """
        named = self.about.get("identification")
        if named is not None:
            return str(named)
        fit = [name for name in self.record_files if self.use(name) == "fit"]
        return min(fit, key=lambda name: self.read(name).rate)


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
    check_against_schema(about, SCHEMA, str(file))
    dataset = Dataset(file, about["name"], about)
    files = dataset.record_files
    _check_files(file, [entry["file"] for entry in about["records"]])
    named = about.get("identification")
    if named is not None and named not in files:
        raise InputError(
            f"{file}: identification: no record {named!r}; {nearest(named, files)}"
        )
    if not any(dataset.use(name) == "fit" for name in files):
        raise InputError(f"{file}: records: expected at least one with 'use: fit'")
    channels = [key for key in ("time", "input", "output", "simulated") if key in about]
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
    seconds(f"{file}: time: unit", about["time"]["unit"])
    return dataset


def read_input(file: Path, column: str) -> tuple[float, FloatArray]:
    """Read an input of one's own: a CSV file with the columns time_s and another.

    Parameters
    ----------
    file : Path
    column : str
        Name of the input's column.

    Returns
    -------
    dt : float
        Sampling interval in seconds.
    u : ndarray, shape (n,)

    Raises
    ------
    InputError
        If a column is missing, a cell is no finite number, or sampling is not uniform.
    """
    time, u = _read_columns(file, ["time_s", column])
    return _sampling_interval(file, time, UNIFORM_TOLERANCE), u


def _check_files(about: Path, names: Sequence[str]) -> None:
    """Refuse a record whose file is none, and two records of one name."""
    seen: dict[str, str] = {}
    for name in names:
        place, file = f"{about}: records", about.parent / name
        if not _NAME.fullmatch(file.stem):
            raise InputError(
                f"{place}: {short(name)} names results as well; expected a name that "
                "begins with a letter or digit and has none of {}*?\\"
            )
        if file.stem in seen:
            also = seen[file.stem]
            raise InputError(
                f"{place}: {name!r} stands there twice; expected each once"
                if also == name
                else f"{place}: {also!r} and {name!r} are both named {file.stem!r}; "
                "expected a name each, as it names its results"
            )
        seen[file.stem] = name
        if file.is_dir():
            raise InputError(f"{place}: {name!r} is a folder; expected a CSV file")
        if not _is_file(file):
            raise InputError(f"{place}: no file {name!r}; {_other_file(about, name)}")
        reads(file)


def _is_file(file: Path) -> bool:
    try:
        return file.is_file()
    except (OSError, ValueError):  # links in a circle, or no name of a file at all
        return False


def _other_file(about: Path, name: str) -> str:
    """Name the file that may be meant, from the folder of dataset.yaml."""
    folder = (about.parent / name).parent
    if not folder.is_dir():
        return f"there is no folder {str(folder)!r}"
    there = sorted(item.name for item in folder.glob("*.csv") if item.is_file())
    if not there:
        return f"expected a CSV file; the folder {str(folder)!r} has none"
    before = Path(name).parent
    return nearest(name, [str(before / item) for item in there])


def _read_columns(file: Path, columns: list[str]) -> tuple[FloatArray, ...]:
    """Read named columns of a CSV file as numbers."""
    lines = read_text(file, "a CSV file").splitlines()
    if not lines:
        raise InputError(
            f"{file}: empty: no column {columns[0]!r}; expected a header and rows"
        )
    header = [name.strip() for name in next(csv.reader(lines[:1]), [])]
    _check_separator(file, lines, header, columns)
    for column in columns:
        if column not in header:
            raise InputError(
                f"{file}: no column {column!r}; {nearest(column, header or ['time_s'])}"
            )
        if header.count(column) > 1:
            raise InputError(
                f"{file}: {header.count(column)} columns {column!r}; expected one"
            )
    _check_decimals(file, lines, len(header))
    places = [header.index(column) for column in columns]
    rows = [line for line in lines[1:] if line.strip()]
    if len(rows) < 2:
        raise InputError(f"{file}: {len(rows)} rows; expected at least 2 samples")
    try:
        table = np.loadtxt(rows, delimiter=",", usecols=places, comments=None)
    except ValueError:
        # NumPy's own message counts rows in two ways.
        raise InputError(f"{file}: {_first_bad_cell(lines, header, places)}") from None
    bad = np.argwhere(~np.isfinite(table))
    if len(bad):
        raise InputError(f"{file}: {_first_bad_cell(lines, header, places)}")
    return tuple(np.ascontiguousarray(column) for column in table.T)


def _check_separator(
    file: Path, lines: list[str], header: list[str], columns: list[str]
) -> None:
    """Tell which other separator a file has."""
    if any(column in header for column in columns):
        return
    for separator, name in ((";", "semicolons"), ("\t", "tabs"), ("|", "bars")):
        cells = [cell.strip().strip('"') for cell in lines[0].split(separator)]
        if not any(column in cells for column in columns):
            continue
        commas = any("," in line for line in lines[1:3])
        also = " and points in numbers, not decimal commas" * commas
        raise InputError(
            f"{file}: row 1: columns separated by {name} ({separator!r}); expected "
            f"commas between columns{also}"
        )


def _check_decimals(file: Path, lines: list[str], columns: int) -> None:
    """Refuse rows of more cells than the header: decimal commas, or a lost line end."""
    for number, line in enumerate(lines[1:], start=2):
        if line.count(",") < columns or '"' in line:
            continue
        cells = line.rstrip(", \t").count(",") + 1
        if cells > columns:
            raise InputError(
                f"{file}: row {number}: {cells} cells where the header has {columns}; "
                "expected as many, and points in numbers, not decimal commas"
            )


def _first_bad_cell(lines: list[str], header: list[str], places: list[int]) -> str:
    """Find the first cell that is no finite number; rows count from 1 as in editors."""
    for number, cells in enumerate(csv.reader(lines[1:]), start=2):
        for place in places if cells else []:
            cell = cells[place].strip() if place < len(cells) else ""
            try:
                finite = "_" not in cell and bool(np.isfinite(float(cell)))
            except ValueError:
                finite = False
            if not finite:
                return (
                    f"row {number}: column {header[place]!r} is {cell or 'empty'!r}; "
                    "expected a finite number"
                )
    return "expected rows of numbers, separated by commas"


def _check_moves(file: Path, item: Mapping[str, str], values: FloatArray) -> None:
    """Refuse a channel that does not move, or whose squares leave floating point."""
    where = f"{file}: column {item['column']!r}"
    span = float(np.ptp(values))
    if span == 0:
        raise InputError(
            f"{where}: constant ({values[0]:g} {item['unit']}); "
            "expected a signal that moves"
        )
    largest = float(np.abs(values).max())
    if not (span > SMALLEST and largest < 1 / SMALLEST):
        raise InputError(
            f"{where}: a range of {span:g} and values up to {largest:g} "
            f"{item['unit']}; expected {SMALLEST:g} to {1 / SMALLEST:g} in some unit"
        )


def _check_period(place: str, period: int, u: FloatArray) -> None:
    """Refuse a period that does not fit twice, or with which no input repeats."""
    if 2 * period > len(u):
        raise InputError(
            f"{place}: period_samples: {period}; expected at most {len(u) // 2}, "
            f"half of its {len(u)} samples"
        )
    rounds = u[: len(u) // period * period].reshape(-1, period)
    # The nearest two of them: the input may be faded in and out.
    away = float(np.sqrt(np.mean(np.diff(rounds, axis=0) ** 2, axis=1)).min())
    if away > UNLIKE * float(np.std(u)):
        raise InputError(
            f"{place}: period_samples: {period}; the input differs from one period to "
            f"the next by {away / float(np.std(u)):.2g} of its standard deviation; "
            f"expected at most {UNLIKE:g}"
        )


def _sampling_interval(file: Path, time: FloatArray, tolerance: float) -> float:
    """Mean step of a time column that increases uniformly within a tolerance."""
    steps = np.diff(time)
    backward = np.flatnonzero(steps <= 0)
    if len(backward):
        row = int(backward[0])
        raise InputError(
            f"{file}: row {row + 3}: time goes from {time[row]:g} s to "
            f"{time[row + 1]:g} s; expected it to increase"
        )
    dt = float(time[-1] - time[0]) / len(steps)
    # Printed times are rounded: what counts is the distance from the uniform grid.
    away = np.abs(time - time[0] - dt * np.arange(len(time)))
    step_error = np.abs(steps - dt)
    row = int(np.argmax(step_error))
    if step_error[row] > tolerance * dt or away.max() > max(tolerance, 0.5) * dt:
        raise InputError(
            f"{file}: row {row + 3}: a step of {steps[row]:g} s where the mean is "
            f"{dt:g} s; expected uniform sampling within {tolerance:.3g} of a step "
            "(time: tolerance)"
        )
    return dt


def _name(channel: Mapping[str, str]) -> str:
    """Name of a channel: as given, or its column without the unit behind it."""
    if "name" in channel:
        return channel["name"]
    suffix = "_" + plain(channel["unit"]).replace("/", "_per_")
    column = channel["column"]
    if plain(column).endswith(suffix):
        column = column[: -len(suffix)]
    return column.replace("_", " ")

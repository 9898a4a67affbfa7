"""What a file of measurements holds: named columns of numbers."""

from collections.abc import Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hystbench.errors import InputError, in_line, nearest

FloatArray = NDArray[np.float64]

#: Names of numbers that tell a sampling frequency in Hz, in small letters.
FREQUENCIES = frozenset(
    {
        *("fs", "f_s", "fsamp", "fsample", "fsampling", "abtastrate"),
        *("samplerate", "sample_rate", "samplingrate", "sampling_rate"),
        *("samplingfrequency", "sampling_frequency", "sampling_frequency_hz"),
    }
)
#: Names of numbers that tell a sampling interval in seconds.
INTERVALS = frozenset(
    {"dt", "ts", "tsample", "sampling_interval", "sampling_time", "wf_increment"}
)
#: Of a matrix: wider ones are pictures or tables of something else.
MOST_COLUMNS = 256


@dataclass(frozen=True, repr=False)
class Column:
    """One column of a file."""

    name: str
    """Name by which dataset.yaml calls it. What lies in a group of the file has the
    group before a slash."""
    values: FloatArray
    """Shape (n,); NaN where the file has no number."""
    unit: str | None = None
    """Unit, as the file tells it."""
    sampling_frequency_hz: float | None = None
    """Sampling frequency of this column alone, as the file tells it."""
    group: str = ""
    """The group of the file that it lies in; empty at the top."""

    @property
    def short(self) -> str:
        """Its name inside its group."""
        return self.name.removeprefix(f"{self.group}/" if self.group else "")


@dataclass(frozen=True, repr=False)
class Table:
    """Columns of one file; they may differ in length."""

    path: Path
    columns: tuple[Column, ...]
    numbers: Mapping[str, float] = field(default_factory=dict)
    """Lone numbers of the file, such as a sampling frequency, by name."""
    notes: tuple[str, ...] = ()
    """What a reader should know: what was left out, what was taken for what."""
    rows: Sequence[int] | None = None
    """The row of each sample, where the file is a text: as editors count."""
    others: tuple[str, ...] = ()
    """Names of columns that were not read."""

    @property
    def names(self) -> list[str]:
        """Names of the columns, in the file's order."""
        return [column.name for column in self.columns]

    def column(self, name: str, group: str = "") -> Column:
        """Give a column by its name, in a group of the file or beside all groups.

        A group may also be a column of each matrix: ``(:,2)``.

        Raises
        ------
        InputError
            If there is none, with the nearest name, or several.
        """
        wanted = [f"{group}/{name}", f"{name}{group}", name] if group else [name]
        for each in dict.fromkeys(wanted):
            found = [column for column in self.columns if column.name == each]
            if len(found) > 1:
                raise InputError(
                    f"{self.path}: {len(found)} columns {each!r}; expected one"
                )
            if found:
                return found[0]
        where = f" in the group {group!r}" if group else ""
        raise InputError(
            f"{self.path}: no column {name!r}{where}; "
            f"{nearest(wanted[0], [*self.names, *self.others] or ['time_s'])}"
        )

    def place(self, sample: int) -> str:
        """Name the place of a sample, counted from 0, as a reader finds it."""
        if self.rows is not None and 0 <= sample < len(self.rows):
            return f"row {self.rows[sample]}"
        return f"sample {sample + 1}"

    def sampling_frequency(self, columns: Iterable[Column] = ()) -> float | None:
        """Give the sampling frequency in Hz that the file tells, if it tells one.

        Parameters
        ----------
        columns : iterable of Column
            Whose own frequency counts first; a lone number of the file counts next.

        Raises
        ------
        InputError
            If columns differ in it.
        """
        own = {c.sampling_frequency_hz for c in columns} - {None}
        if len(own) > 1:
            told = ", ".join(f"{value:g}" for value in sorted(filter(None, own)))
            raise InputError(
                f"{self.path}: columns sampled at {told} Hz; expected one sampling "
                "frequency for time, input and output"
            )
        if own:
            return own.pop()
        # A number of a group stands for what lies in it.
        for name, value in self.numbers.items():
            known = name.rpartition("/")[2].lower()
            if known in FREQUENCIES and value > 0:
                return value
            if known in INTERVALS and value > 0:
                return 1.0 / value
        return None


def as_numbers(values: object) -> FloatArray | None:
    """Give an array as float64, times as seconds; None where it has no real numbers."""
    if isinstance(values, np.ma.MaskedArray) and values.dtype.kind == "f":
        values = values.filled(np.nan)
    array = np.asarray(values)
    if array.dtype.kind == "M":
        lost = np.isnat(array)
        first = array[~lost][0] if (~lost).any() else np.datetime64("NaT")
        seconds = (array - first) / np.timedelta64(1, "ns") * 1e-9
        return np.where(lost, np.nan, seconds).astype(np.float64)
    if array.dtype.kind == "m":
        return np.asarray(array / np.timedelta64(1, "ns") * 1e-9, dtype=np.float64)
    if array.dtype.kind == "c":
        if np.any(array.imag):
            return None
        array = array.real
    if array.dtype.kind not in "fiub":
        return None
    return np.ascontiguousarray(array, dtype=np.float64)


class Filling:
    """A table of a file while its arrays are read, one after the other.

    Parameters
    ----------
    path : Path
    in_groups : bool
        Whether names have groups, before a slash.
    """

    def __init__(self, path: Path, in_groups: bool = True) -> None:
        self.path, self.in_groups = path, in_groups
        self.columns: list[Column] = []
        self.numbers: dict[str, float] = {}
        self.notes: list[str] = []

    def add(
        self,
        name: str,
        values: object,
        unit: str | None = None,
        frequency: float | None = None,
    ) -> None:
        """Take an array apart into columns: a matrix gives several, a lone number none.

        Parameters
        ----------
        name : str
            Columns of a matrix are named ``name(:,1)`` and so on; its longer side is
            time. Fields of a record array are named ``name/field``.
        values : array_like
            Of any shape. What is left out is noted.
        unit : str, optional
        frequency : float, optional
            Sampling frequency in Hz.
        """
        array = as_numbers(values)
        if array is None:
            is_complex = np.asarray(values).dtype.kind == "c"
            self.leave_out(name, "complex numbers" if is_complex else "no numbers")
            return
        shape, array = array.shape, np.squeeze(array)
        if array.ndim == 0:
            self.numbers[name] = float(array)
        elif array.ndim == 1:
            self._take(name, array, unit, frequency)
        elif array.ndim > 2:
            self.leave_out(name, f"an array of {array.ndim} dimensions")
        elif min(array.shape) > MOST_COLUMNS:
            self.leave_out(name, f"a matrix of {shape}", ", as no few columns")
        else:
            rows = array if array.shape[0] >= array.shape[1] else array.T
            for k, part in enumerate(rows.T, start=1):
                own = np.ascontiguousarray(part)
                self._take(f"{name}(:,{k})", own, unit, frequency)

    def _take(
        self, name: str, values: FloatArray, unit: str | None, frequency: float | None
    ) -> None:
        # In a table without groups a name may be ``speed [m/s]``.
        group = name.rpartition("/")[0] if self.in_groups else ""
        self.columns.append(Column(name, values, unit, frequency, group))

    def leave_out(self, name: str, what: str, why: str = "") -> None:
        """Note that something of the file is no column."""
        self.notes.append(f"{name}: {what}; left out{why}")

    def table(self) -> Table:
        """Give what was read."""
        return Table(self.path, tuple(self.columns), self.numbers, tuple(self.notes))


def fields_of(name: str, array: Any) -> dict[str, Any]:
    """Give the fields of a record array as arrays of their own, by name."""
    names = array.dtype.names
    return {f"{name}/{key}": array[key] for key in names} if names else {name: array}


@contextmanager
def told(path: Path, kind: str) -> Iterator[None]:
    """Turn what a library raises of a damaged file into one line."""
    try:
        yield
    except InputError:
        raise
    except MemoryError as error:
        raise InputError(f"{path}: more than fits into memory") from error
    except Exception as error:
        # Libraries raise anything of what is damaged.
        raise InputError(f"{path}: no readable {kind} ({in_line(error)})") from error

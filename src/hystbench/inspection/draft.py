"""A dataset.yaml proposed from files: columns, units, records, periods and roles."""

from __future__ import annotations

import hashlib
import math
import os
import re
from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from itertools import count
from pathlib import Path
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

from hystbench.copies import common_piece
from hystbench.dataset import RECORD_NAME, Dataset, dataset_of
from hystbench.device_kinds import Kind
from hystbench.doubts import doubts
from hystbench.errors import InputError, nearest
from hystbench.formats import Column, Table, read_table
from hystbench.inspection.clocks import clock_of, ticks_of
from hystbench.inspection.excitation import Excitation, excitation_of
from hystbench.inspection.missing import cannot_be_bridged, runs
from hystbench.inspection.names import choose, is_simulated, is_time, split_unit
from hystbench.inspection.roles import propose
from hystbench.periods import find_period
from hystbench.reading import UNIFORM_TOLERANCE
from hystbench.record import FloatArray, Record
from hystbench.units import NONE, check_known, plain, seconds

LEAST = 20
"""Samples of a signal; fewer are a table of something else."""
ONE_HELD_OUT = 3
"""Of a lone record: a third is held out."""

_OF_MATRIX = re.compile(r"(?P<stem>.+)(?P<place>\(:,\d+\))")


class Ask(Protocol):
    """Asks the user, or refuses where nobody is there."""

    def __call__(self, question: str, choices: Sequence[str], flag: str) -> str:
        """Give one of the choices; without choices, any text."""


@dataclass(frozen=True)
class Given:
    """What flags say already.

    Parameters
    ----------
    name : str, optional
        Of the dataset.
    time, input, output : str, optional
        Names of columns.
    time_unit, input_unit, output_unit : str, optional
    sampling_frequency_hz : float, optional
    hold_out : tuple of str
        Names of records to hold out.
    missing : {"interpolate", "split"}, optional
        What to do where samples are missing.
    device : str, optional
        Kind of the device.
    """

    name: str | None = None
    time: str | None = None
    input: str | None = None
    output: str | None = None
    time_unit: str | None = None
    input_unit: str | None = None
    output_unit: str | None = None
    sampling_frequency_hz: float | None = None
    hold_out: tuple[str, ...] = ()
    missing: str | None = None
    device: Kind | None = None


@dataclass(frozen=True)
class Part:
    """One record to be: a group of columns of one length in a file.

    Parameters
    ----------
    table : Table
    group : str
        Where the columns lie in the file; empty at the top.
    columns : mapping of str to Column
        By the name that they have in every record.
    """

    table: Table
    group: str
    columns: Mapping[str, Column]

    @property
    def where(self) -> str:
        """The file, and the group where there is one."""
        return f"{self.table.path}{f': {self.group}' if self.group else ''}"


@dataclass(frozen=True)
class Draft:
    """A proposed dataset.

    Parameters
    ----------
    dataset : Dataset
        Checked: each record can be read.
    records : tuple of Record
    inputs : mapping of str to Excitation
        By the record's name.
    notes : tuple of str
        What was found and what was taken for what, one line each.
    warnings : tuple of str
        What is hardly meant.
    """

    dataset: Dataset
    records: tuple[Record, ...]
    inputs: Mapping[str, Excitation]
    notes: tuple[str, ...]
    warnings: tuple[str, ...] = ()


@dataclass
class _Signals:
    """Which columns are what, and their units."""

    time: str | None
    time_unit: str
    input: str
    output: str
    units: dict[str, str]
    simulated: str | None = None
    notes: list[str] = field(default_factory=list)


def draft(files: Sequence[Path], place: Path, given: Given, ask: Ask) -> Draft:
    """Propose a dataset.yaml for files of measurements.

    Parameters
    ----------
    files : sequence of Path
        One or more, of any format that is known.
    place : Path
        Where dataset.yaml is to stand; paths of the files are relative to it.
    given : Given
    ask : Ask
        Called for what neither files nor flags tell.

    Raises
    ------
    InputError
        If a file cannot be read, no column can be time, input or output, or a record
        cannot be used.
    """
    if given.sampling_frequency_hz is not None:
        _checked_frequency(given.sampling_frequency_hz)
    notes: list[str] = []
    parts: list[Part] = []
    for file in files:
        table = read_table(file)
        notes += [f"{file.name}: {note}" for note in table.notes]
        found = parts_of(table)
        if not found:
            raise InputError(
                f"{file}: no two columns of {LEAST} samples or more; expected an input "
                f"and an output{_has(table)}"
            )
        parts += found
    signals = _signals(parts, given, ask)
    used = [part for part in parts if _fits(part, signals)]
    for part in parts:
        if part not in used:
            notes.append(
                f"{part.where}: left out, as it has no {signals.input!r} and "
                f"{signals.output!r}"
            )
    notes += signals.notes
    about, entries = _content(used, signals, given, place, ask, notes)
    records = _read(place, about, entries)
    warnings: list[str] = []
    if len(entries) == 1 and not given.hold_out:
        part = next(part for part in used if _is_of(entries[0], part, place))
        cut = _cut(entries[0], records[0], _missing(part, signals))
        pieces = _read(place, about, cut)
        if common_piece(*pieces) is None:
            entries, records = cut, pieces
            notes.append(
                "one record alone: its last part is held out, by whole periods where "
                "it repeats; a record of another kind would prove more"
            )
        else:
            entries = [{**entries[0], "use": "fit"}]
            warnings.append(
                f"{part.where}: the last part repeats what is before it to the last "
                "digit, so nothing is held out; add a record of another input to the "
                "files and run 'hystbench init' again"
            )
    else:
        entries = _roles(entries, records, given, notes)
    for entry, record in zip(entries, records, strict=True):
        period = find_period(record.u)
        if period is not None:
            entry["period_samples"] = period
    dataset = dataset_of(place, {**about, "records": entries})
    for entry, file in zip(entries, dataset.record_files.values(), strict=True):
        entry["sha256"] = _digest(file)
    records = [
        replace(
            record,
            use=entry["use"],
            period_samples=entry.get("period_samples"),
        )
        for entry, record in zip(entries, records, strict=True)
    ]
    inputs = {item.name: excitation_of(item.u, item.dt) for item in records}
    return Draft(
        dataset,
        tuple(records),
        inputs,
        tuple(notes),
        (*warnings, *doubts(dataset, records)),
    )


def _read(
    place: Path, about: Mapping[str, Any], entries: Sequence[Mapping[str, Any]]
) -> list[Record]:
    """Read and check all records."""
    dataset = dataset_of(place, {**about, "records": list(entries)})
    return [dataset.read(name) for name in dataset.record_files]


def parts_of(table: Table) -> list[Part]:
    """Give the parts of a file that may be records.

    Columns of one group and one length belong together, with those of that length at
    the top of the file beside them. Of matrices alike the columns of one number do.
    """
    long = [column for column in table.columns if len(column.values) >= LEAST]
    top = [column for column in long if not column.group]
    groups: dict[str, list[Column]] = {}
    for column in long:
        groups.setdefault(column.group, []).append(column)
    parts = []
    for group, columns in groups.items():
        if not group and (runs := _runs(columns)):
            places = {place for stem in runs.values() for place in stem}
            for place in sorted(places, key=lambda text: int(text[3:-1])):
                own = {stem: by[place] for stem, by in runs.items() if place in by}
                shared = [c for c in columns if not _OF_MATRIX.fullmatch(c.name)]
                parts.append(_part(table, place, [*shared, *own.values()], own))
            continue
        shared = top if group else []
        parts.append(_part(table, group, [*columns, *shared], {}))
    return [part for part in parts if len(part.columns) > 1]


def _runs(columns: Sequence[Column]) -> dict[str, dict[str, Column]]:
    """Give matrices of one width by stem and place; none where one stands alone."""
    stems: dict[str, dict[str, Column]] = {}
    for column in columns:
        found = _OF_MATRIX.fullmatch(column.name)
        if found:
            stems.setdefault(found["stem"], {})[found["place"]] = column
    widths = Counter(len(by) for by in stems.values())
    alike = [stem for stem, by in stems.items() if widths[len(by)] > 1]
    return {stem: stems[stem] for stem in alike}


def _part(
    table: Table, group: str, columns: Sequence[Column], named: Mapping[str, Column]
) -> Part:
    """Make a part of the columns of the most common length."""
    length = Counter(len(column.values) for column in columns).most_common(1)[0][0]
    names = {id(column): name for name, column in named.items()}
    return Part(
        table,
        group,
        {
            names.get(id(column), column.short): column
            for column in columns
            if len(column.values) == length
        },
    )


def _has(table: Table) -> str:
    lengths = [f"{c.name} ({len(c.values)})" for c in table.columns[:6]]
    return f"; it has {', '.join(lengths)}" if lengths else ""


def _signals(parts: Sequence[Part], given: Given, ask: Ask) -> _Signals:
    """Find which columns are time, input and output, of most parts."""
    common = _common(parts)
    first = next(part for part in parts if set(common) <= set(part.columns))
    told = {name: _told(name, first.columns[name]) for name in common}
    time = _time(first, told, given)
    rest = [
        name
        for name in common
        if name != time and not (is_time(*told[name]) and name not in _asked(given))
    ]
    simulated = [n for n in rest if is_simulated(told[n][0]) and n not in _asked(given)]
    rest = [name for name in rest if name not in simulated]
    for name in _asked(given):
        if name not in common:
            raise InputError(
                f"{first.where}: no column {name!r} in all records; "
                f"{nearest(name, common)}"
            )
    chosen = _channels(first, rest, told, given, ask)
    units, notes = {}, []
    for key, name in (("input", chosen[0]), ("output", chosen[1])):
        asked = getattr(given, f"{key}_unit")
        unit = asked if asked is not None else told[name][1]
        if unit is None:
            unit = ask(
                f"Unit of the {key} {name!r} ('-' for none)", (), f"--{key}-unit"
            )
        check_known(f"--{key}-unit", unit)
        if unit in NONE and asked is None:
            notes.append(
                f"{key} {name!r}: no unit is told; '-' is written (--{key}-unit)"
            )
        units[key] = plain(unit) or "-"
    unit_of_time = given.time_unit or (told[time][1] if time else None)
    if time is not None and unit_of_time is None:
        clock = clock_of(first.columns[time].values)
        unit_of_time = clock.unit if clock else "s"
        taken = clock.words if clock else "seconds"
        notes.append(f"time {time!r}: no unit is told; taken for {taken} (--time-unit)")
    return _Signals(
        time,
        plain(unit_of_time or "s"),
        *chosen,
        units,
        simulated[0] if len(simulated) == 1 else None,
        notes,
    )


def _common(parts: Sequence[Part]) -> list[str]:
    """Give the names of columns that most parts share, in the order of the first."""
    sets = Counter(tuple(part.columns) for part in parts)
    names = max(sets, key=lambda names: (sets[names], -len(names)))
    alike = [set(part.columns) for part in parts]
    wide = [n for n in names if sum(n in each for each in alike) > len(parts) / 2]
    return wide if len(wide) > 1 else list(names)


def _told(name: str, column: Column) -> tuple[str, str | None]:
    """Give a column's name without its unit, and its unit, if one is told and known."""
    words, unit = split_unit(name)
    own = column.unit
    if own is not None:
        try:
            check_known("", own)
        except InputError:
            return words, unit
        return words, plain(own)
    return words, unit


def _asked(given: Given) -> list[str]:
    return [name for name in (given.time, given.input, given.output) if name]


def _time(
    part: Part, told: Mapping[str, tuple[str, str | None]], given: Given
) -> str | None:
    """Name the column of time: the one asked for, or one that is called so."""
    if given.time is not None:
        return given.time
    if given.sampling_frequency_hz is not None:
        return None
    called = [name for name in told if is_time(*told[name])]
    rising = [name for name in told if _rises(part.columns[name].values)]
    likely = [name for name in called if name in rising]
    if not likely and not called and part.table.sampling_frequency() is None:
        # A column that rises evenly can be nothing else, if it is the only one.
        own = {c.sampling_frequency_hz for c in part.columns.values()}
        likely = [n for n in rising if n not in _asked(given)] if own == {None} else []
        likely = likely if len(likely) == 1 else []
    return likely[0] if likely else None


def _rises(values: FloatArray) -> bool:
    """Tell whether a column rises evenly, as a clock does."""
    steps = np.diff(values)
    if not np.isfinite(steps).all() or not (steps >= 0).all() or not steps.any():
        return False
    n = len(values)
    line = values[0] + (values[-1] - values[0]) * np.arange(n) / (n - 1)
    return bool(np.abs(values - line).max() < 0.1 * (values[-1] - values[0]))


def _channels(
    part: Part,
    names: Sequence[str],
    told: Mapping[str, tuple[str, str | None]],
    given: Given,
    ask: Ask,
) -> tuple[str, str]:
    """Name input and output: asked for, told by names and units, or asked."""
    moving = [
        n for n in names if n in _asked(given) or np.ptp(_finite(part.columns[n])) > 0
    ]
    if len(moving) < 2:
        raise InputError(
            f"{part.where}: {len(moving)} columns that move beside time "
            f"({', '.join(names) or 'none'}); expected an input and an output"
        )
    left = [name for name in moving if name not in (given.input, given.output)]
    likely = choose([told[name] for name in left])
    found = [given.input, given.output]
    for k, place in enumerate(likely):
        if found[k] is None and place is not None:
            found[k] = left[place]
    for k, key in enumerate(("input", "output")):
        if found[k] is None:
            open_ = [name for name in left if name not in found]
            alone = len(open_) == 1 and found[1 - k] is not None
            asked = f"Which column is the {key}"
            found[k] = open_[0] if alone else ask(asked, open_, f"--{key}")
    one, two = found
    if one is None or two is None or one == two:
        raise InputError(
            f"{part.where}: {one!r} is both input and output; expected one column each"
        )
    return one, two


def _finite(column: Column) -> FloatArray:
    values = column.values[np.isfinite(column.values)]
    return values if len(values) else np.zeros(1)


def _fits(part: Part, signals: _Signals) -> bool:
    wanted = {signals.input, signals.output}
    if signals.time is not None:
        wanted.add(signals.time)
    return wanted <= set(part.columns)


def _content(
    parts: Sequence[Part],
    signals: _Signals,
    given: Given,
    place: Path,
    ask: Ask,
    notes: list[str],
) -> tuple[dict[str, Any], list[dict[str, Any]]]:
    """Give dataset.yaml but for roles and periods; notes are added to."""
    about: dict[str, Any] = {"name": given.name or _name_of(place)}
    if given.device is not None:
        about["device"] = {"kind": given.device}
    entries = []
    tolerance, rates = UNIFORM_TOLERANCE, []
    for part in parts:
        file = _from(place, part)
        entry: dict[str, Any] = {"file": file}
        if part.group:
            entry["group"] = part.group
        clock = None
        if signals.time is not None:
            unit = seconds("--time-unit", signals.time_unit)
            time = part.columns[signals.time].values * unit
            clock = ticks_of(time, part.where, part.table)
            tolerance = max(tolerance, clock.tolerance)
            rates.append(clock)
        entries += _without_missing(part, signals, entry, given, ask, notes)
    rounded = [clock for clock in rates if clock.rounded]
    if signals.time is not None and not rounded:
        about["time"] = {"column": signals.time, "unit": signals.time_unit}
        if tolerance > UNIFORM_TOLERANCE:
            about["time"]["tolerance"] = round(tolerance, 3)
            notes.append(
                f"time: steps differ by up to {100 * tolerance:.2g} % of their mean; "
                "'tolerance' is written, and the mean step is taken"
            )
    elif rounded:
        by_part = dict(zip(map(id, parts), rates, strict=True))
        for part in parts:
            for entry in entries:
                if _is_of(entry, part, place):
                    rate = float(f"{1 / by_part[id(part)].step:.9g}")
                    entry["sampling_frequency_hz"] = rate
        notes.append(
            f"time {signals.time!r} is rounded to more than the sampling interval; "
            "the sampling frequency is written in its place"
        )
    else:
        _frequency(about, parts, signals, given, ask, notes)
    for key, name in (("input", signals.input), ("output", signals.output)):
        about[key] = {"column": name, "unit": signals.units[key]}
        words = split_unit(name)[0]
        if words and words != name and not name.endswith("_" + signals.units[key]):
            about[key]["name"] = words
    if signals.simulated is not None:
        about["simulated"] = {
            "column": signals.simulated,
            "unit": signals.units["output"],
        }
        notes.append(
            f"{signals.simulated!r} is taken for a simulator's output, in the unit of "
            "the output; it is a base for 'hystbench gap --model column'"
        )
    _give_names(entries)
    return about, entries


def _is_of(entry: Mapping[str, Any], part: Part, place: Path) -> bool:
    return (entry["file"], entry.get("group", "")) == (_from(place, part), part.group)


def _from(place: Path, part: Part) -> str:
    """Give the path of a part's file from where dataset.yaml is to stand."""
    file = part.table.path
    # Of folders that are links the real ones count: '..' leads out of those.
    real = file.parent.resolve() / file.name
    return Path(os.path.relpath(real, place.parent.resolve())).as_posix()


def _frequency(
    about: dict[str, Any],
    parts: Sequence[Part],
    signals: _Signals,
    given: Given,
    ask: Ask,
    notes: list[str],
) -> None:
    """Write a sampling frequency, unless each file tells its own when it is read."""
    if given.sampling_frequency_hz is not None:
        about["sampling_frequency_hz"] = given.sampling_frequency_hz
        return
    told = [
        part.table.sampling_frequency(
            [part.columns[signals.input], part.columns[signals.output]]
        )
        for part in parts
    ]
    if None in told:
        text = ask(
            "No column of time; sampling frequency in Hz", (), "--sampling-frequency"
        )
        about["sampling_frequency_hz"] = _checked_frequency(text)
        return
    frequencies = sorted({value for value in told if value})
    said = " and ".join(f"{value:g} Hz" for value in frequencies)
    notes.append(f"no column of time; the files tell a sampling frequency of {said}")


def _checked_frequency(told: str | float) -> float:
    """Give a sampling frequency in Hz that the user tells."""
    try:
        value = float(told)
    except ValueError:
        value = math.nan
    # The interval is one over it, and has to be a finite number too.
    if not (value > 0 and math.isfinite(value) and math.isfinite(1 / value)):
        raise InputError(
            f"--sampling-frequency: {told}; expected a finite number of Hz above 0"
        )
    return value


def _missing(part: Part, signals: _Signals) -> NDArray[np.bool_]:
    """Tell of each sample whether time, input or output has no number."""
    columns = [part.columns[signals.input], part.columns[signals.output]]
    if signals.time is not None:
        columns.append(part.columns[signals.time])
    return np.asarray(
        ~np.all([np.isfinite(column.values) for column in columns], axis=0)
    )


def _without_missing(
    part: Part,
    signals: _Signals,
    entry: dict[str, Any],
    given: Given,
    ask: Ask,
    notes: list[str],
) -> list[dict[str, Any]]:
    """Give the entries of a part: one, or a piece each between missing samples."""
    bad = _missing(part, signals)
    if not bad.any():
        return [entry]
    first = int(np.argmax(bad))
    said = (
        f"{part.where}: {np.count_nonzero(bad)} of {len(bad)} samples are missing, the "
        f"first at {part.table.place(first)}"
    )
    what = given.missing or ask(
        f"{said}; 'interpolate' them or 'split' the record there",
        ("interpolate", "split"),
        "--missing",
    )
    u = part.columns[signals.input].values
    cut = cannot_be_bridged(u) if what == "interpolate" else bad
    entries, left = [], np.count_nonzero(~bad)
    for first, behind in runs(~cut):
        there = first + np.flatnonzero(~bad[first:behind])
        if len(there) < LEAST:
            continue
        rows = [int(there[0]) + 1, int(there[-1]) + 1]
        piece = entry if rows == [1, len(bad)] else {**entry, "rows": rows}
        whole = not bad[there[0] : there[-1]].any()
        entries.append(piece if whole else {**piece, "missing": "interpolate"})
        left -= len(there)
    if what == "interpolate":
        said += "; they are interpolated, and no score counts them"
    if cut.any():
        long = "the input's gaps are longer than a quarter of its fastest period; "
        said += (
            f"; {long if what == 'interpolate' else ''}the record is split into "
            f"{len(entries)} pieces"
        )
    if left:
        said += f"; {left} samples in pieces shorter than {LEAST} are left out"
    notes.append(said)
    return entries


def _give_names(entries: list[dict[str, Any]]) -> None:
    """Name records that share a file or a stem, or whose stem is no name.

    They are called after file and group; where that is taken a number follows.
    """
    stems = Counter(Path(entry["file"]).stem for entry in entries)
    taken, unnamed = set(), []
    for entry in entries:
        stem = Path(entry["file"]).stem
        if stems[stem] == 1 and RECORD_NAME.fullmatch(stem):
            taken.add(stem)
            continue
        shared = stems[stem] > 1 and "group" in entry
        name = f"{stem}-{entry['group']}" if shared else stem
        entry["name"] = re.sub(r"[^\w.-]+", "-", name).strip("-.") or "record"
        unnamed.append(entry)
    wanted = Counter(entry["name"] for entry in unnamed)
    again = [e for e in unnamed if wanted[e["name"]] > 1 or e["name"] in taken]
    taken |= set(wanted)
    for entry in again:
        numbered = (f"{entry['name']}-{k}" for k in count(1))
        entry["name"] = next(name for name in numbered if name not in taken)
        taken.add(entry["name"])


def _name_of(place: Path) -> str:
    """Name a dataset by its folder."""
    name = re.sub(r"[^A-Za-z0-9._-]+", "-", place.resolve().parent.name).strip("-._")
    return name or "dataset"


def _roles(
    entries: list[dict[str, Any]],
    records: Sequence[Record],
    given: Given,
    notes: list[str],
) -> list[dict[str, Any]]:
    """Give the entries of several records with their roles."""
    names = [record.name for record in records]
    if given.hold_out:
        for name in given.hold_out:
            if name not in names:
                raise InputError(
                    f"--hold-out: no record {name!r}; {nearest(name, names)}"
                )
        held, why = given.hold_out, "the records held out are those asked for"
        if set(names) <= set(held):
            raise InputError("--hold-out: all records; expected at least one to fit")
    else:
        held, why = propose(
            {record.name: excitation_of(record.u, record.dt) for record in records}
        )
    notes.append(f"roles: {why}")
    return [
        {**entry, "use": "hold-out" if name in held else "fit"}
        for name, entry in zip(names, entries, strict=True)
    ]


def _cut(
    entry: dict[str, Any], record: Record, missing: NDArray[np.bool_]
) -> list[dict[str, Any]]:
    """Cut a lone record: two thirds to fit, a third held out.

    Samples that are missing at the cut belong to neither.
    """
    first, last = entry.get("rows", (1, len(record)))
    samples = last - first + 1
    part = samples - samples // ONE_HELD_OUT
    period = find_period(record.u)
    if period is not None and samples >= 3 * period:
        part = max(round(part / period), 2) * period
        if samples - part < period:
            part -= period
    name = entry.get("name", Path(entry["file"]).stem)
    there = np.flatnonzero(~missing) + 1
    at = first + part - 1
    before, after = int(there[there <= at][-1]), int(there[there > at][0])
    return [
        {**entry, "name": f"{name}-1", "rows": [first, before], "use": "fit"},
        {**entry, "name": f"{name}-2", "rows": [after, last], "use": "hold-out"},
    ]


def _digest(file: Path) -> str:
    with file.open("rb") as stream:
        return hashlib.file_digest(stream, "sha256").hexdigest()

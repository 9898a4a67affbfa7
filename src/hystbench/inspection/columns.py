"""Columns of files: which belong together, and which are time, input and output."""

import re
from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from hystbench.errors import InputError, refuse_unknown
from hystbench.formats import Column, Table
from hystbench.inspection.clocks import clock_of
from hystbench.inspection.names import (
    both_answer,
    choose,
    force_and_motion,
    is_simulated,
    is_time,
    split_unit,
)
from hystbench.inspection.user import Flags, User
from hystbench.record import FloatArray
from hystbench.sentences import listed
from hystbench.units import NONE, check_known, is_known, plain

NAMED = 5
"""Columns that are left and named; more of them are counted."""
SHORTEST = 20
"""Samples of a signal; fewer are a table of something else."""

_OF_MATRIX = re.compile(r"(?P<stem>.+)(?P<place>\(:,\d+\))")


@dataclass(frozen=True)
class RecordColumns:
    """One record to be: a group of columns of one length in a file."""

    table: Table
    group: str
    """Group of the file in which the columns lie; empty at the top."""
    columns: Mapping[str, Column]
    """Columns by the name that they have in every record."""

    @property
    def where(self) -> str:
        """The file, and the group where there is one."""
        return f"{self.table.path}{f': {self.group}' if self.group else ''}"


@dataclass
class ChosenColumns:
    """Which columns are what, and their units."""

    time: str | None
    time_unit: str
    input: str
    output: str
    units: dict[str, str]
    simulated: str | None = None


def parts_of(table: Table) -> list[RecordColumns]:
    """Give the parts of a file that may be records.

    Columns of one group and one length belong together, with those of that length at
    the top of the file beside them. Of matrices alike the columns of one number do.
    """
    long = [column for column in table.columns if len(column.values) >= SHORTEST]
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
) -> RecordColumns:
    """Make a part of the columns of the most common length."""
    length = Counter(len(column.values) for column in columns).most_common(1)[0][0]
    names = {id(column): name for name, column in named.items()}
    return RecordColumns(
        table,
        group,
        {
            names.get(id(column), column.short): column
            for column in columns
            if len(column.values) == length
        },
    )


def signals_of(parts: Sequence[RecordColumns], user: User) -> ChosenColumns:
    """Find which columns are time, input and output, of most parts."""
    given, asked, common = user.given, _asked(user.given), _common(parts)
    first = next(part for part in parts if set(common) <= set(part.columns))
    for name in asked:
        refuse_unknown(
            name, common, f"{first.where}: no column {name!r} in all records"
        )
    told = {name: _told(name, first.columns[name]) for name in common}
    time = _time(first, told, given)
    rest = [n for n in common if n != time and (n in asked or not is_time(*told[n]))]
    simulated = [n for n in rest if is_simulated(told[n][0]) and n not in asked]
    rest = [name for name in rest if name not in simulated]
    chosen = _channels(first, rest, told, user)
    names = dict(zip(("input", "output"), chosen, strict=True))
    pair = [told[name] for name in rest if name in chosen]
    if given.input is None and given.output is None and both_answer(pair):
        forced = force_and_motion(pair) is not None
        user.note("force and motion" if forced else "either way", **names)
    left = [repr(name) for name in rest if name not in chosen]
    if left and (given.input is None or given.output is None):
        more = [f"{len(left) - NAMED} more"] if len(left) > NAMED else []
        user.note("columns left", columns=listed([*left[:NAMED], *more]))
    units = {key: _unit(key, name, told[name][1], user) for key, name in names.items()}
    unit_of_time = given.time_unit or (told[time][1] if time else None)
    if time is not None and unit_of_time is None:
        counted = clock_of(first.columns[time].values)
        unit_of_time, taken = counted or ("s", "seconds")
        user.note("time", time=time, taken=taken)
    of_base = simulated[0] if len(simulated) == 1 else None
    return ChosenColumns(time, plain(unit_of_time or "s"), *chosen, units, of_base)


def _unit(key: str, name: str, told: str | None, user: User) -> str:
    """Give a channel's unit: that of a flag, the one that is told, or one asked for."""
    flag = f"--{key}-unit"
    asked = getattr(user.given, f"{key}_unit")
    unit = told if asked is None else asked
    if unit is None:
        unit = user.ask(f"Unit of the {key} {name!r} ('-' for none)", (), flag, "-")
    check_known(flag, unit)
    if unit in NONE and asked is None:
        user.note("no unit", key=key, name=name)
    return plain(unit) or "-"


def _common(parts: Sequence[RecordColumns]) -> list[str]:
    """Give the names of columns that most parts share, in the order of the first."""
    sets = Counter(tuple(part.columns) for part in parts)
    names = max(sets, key=lambda names: (sets[names], -len(names)))
    alike = [set(part.columns) for part in parts]
    wide = [n for n in names if sum(n in each for each in alike) > len(parts) / 2]
    return wide if len(wide) > 1 else list(names)


def _told(name: str, column: Column) -> tuple[str, str | None]:
    """Give a column's name without its unit, and its unit, if one is told and known."""
    words, unit = split_unit(name)
    if column.unit is not None and is_known(column.unit):
        return words, plain(column.unit)
    return words, unit


def _asked(given: Flags) -> list[str]:
    return [name for name in (given.time, given.input, given.output) if name]


def _time(
    part: RecordColumns, told: Mapping[str, tuple[str, str | None]], given: Flags
) -> str | None:
    """Name the column of time: the one asked for, or one that is called so."""
    if given.time is not None:
        return given.time
    if given.sampling_frequency is not None:
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
    part: RecordColumns,
    names: Sequence[str],
    told: Mapping[str, tuple[str, str | None]],
    user: User,
) -> tuple[str, str]:
    """Name input and output: asked for, told by names and units, or asked."""
    given = user.given
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
            asked = f"Which column is the {key}", open_, f"--{key}"
            likely_one = _likely([told[name] for name in open_], open_)
            found[k] = open_[0] if alone else user.ask(*asked, likely_one)
    one, two = found
    if one is None or two is None or one == two:
        raise InputError(
            f"{part.where}: {one!r} is both input and output; expected one column each"
        )
    return one, two


def _likely(pair: Sequence[tuple[str, str | None]], names: Sequence[str]) -> str | None:
    """Name the likely input of two columns that may both answer: a force, or the first.

    None of other columns.
    """
    if not both_answer(pair):
        return None
    force, _ = force_and_motion(pair) or (0, 1)
    return names[force]


def _finite(column: Column) -> FloatArray:
    values = column.values[np.isfinite(column.values)]
    return values if len(values) else np.zeros(1)


def fits(part: RecordColumns, signals: ChosenColumns) -> bool:
    """Tell whether a part has the columns."""
    wanted = {signals.input, signals.output}
    if signals.time is not None:
        wanted.add(signals.time)
    return wanted <= set(part.columns)

"""Records of a proposed dataset.yaml: entries, names, roles, missing samples."""

import math
import os
import re
from collections import Counter
from collections.abc import Mapping, Sequence
from itertools import count
from pathlib import Path
from typing import Any

import numpy as np

from hystbench.dataset_files import RECORD_NAME
from hystbench.errors import InputError, refuse_unknown
from hystbench.inspection.clocks import Ticks
from hystbench.inspection.columns import ChosenColumns, RecordColumns
from hystbench.inspection.input_summary import InputSummary, summary_of
from hystbench.inspection.names import split_unit
from hystbench.inspection.pieces import clock_of_part, pieces_of
from hystbench.inspection.user import User, words
from hystbench.periods import find_period
from hystbench.record import Mask, Record
from hystbench.samples import UNIFORM_TOLERANCE
from hystbench.yaml_files import yaml_text

HELD_OUT_PART = 3
"""Part of a lone record that is held out: a third."""
FIRST_COMMENT = (
    "# Proposed by hystbench init. Change what is wrong; the tutorial has all keys.\n"
)
KEY_ORDER = (
    *("file", "group", "rows", "name", "use", "period_samples", "missing"),
    *("sampling_frequency_hz", "stands_still", "meant", "sha256"),
)
"""Order in which a record's line has its keys."""

Entry = dict[str, Any]


def content_of(
    parts: Sequence[RecordColumns], signals: ChosenColumns, place: Path, user: User
) -> tuple[dict[str, Any], list[Entry], list[RecordColumns]]:
    """Give dataset.yaml but for roles and periods.

    Returns
    -------
    about : dict
        All but the records.
    entries : list of dict
        Of the records.
    owners : list of RecordColumns
        The part that each entry is of.
    """
    about: dict[str, Any] = {"name": user.given.name or _name_of(place)}
    if user.given.device is not None:
        about["device"] = {"kind": user.given.device}
    clocks: list[tuple[Ticks | None, list[int]]] = [(None, [])] * len(parts)
    if signals.time is not None:
        clocks = [clock_of_part(part, signals, user) for part in parts]
    all_ticks = [ticks for ticks, _ in clocks if ticks is not None]
    rounded = any(ticks.rounded for ticks in all_ticks)
    entries: list[Entry] = []
    owners: list[RecordColumns] = []
    for part, (ticks, jumps) in zip(parts, clocks, strict=True):
        whole: Entry = {"file": _from(place, part)}
        if part.group:
            whole["group"] = part.group
        if rounded and ticks is not None:
            whole["sampling_frequency_hz"] = float(f"{1 / ticks.step:.9g}")
        pieces = pieces_of(part, signals, whole, jumps, user)
        entries += pieces
        owners += [part] * len(pieces)
    if rounded:
        user.note("rounded", time=signals.time)
    elif all_ticks:
        about["time"] = {"column": signals.time, "unit": signals.time_unit}
        tolerance = max(ticks.tolerance for ticks in all_ticks)
        if any(ticks.uneven for ticks in all_ticks):
            about["time"]["uneven"] = "interpolate"
            user.note("uneven", time=signals.time)
        elif tolerance > UNIFORM_TOLERANCE:
            about["time"]["tolerance"] = round(tolerance, 3)
            user.note("tolerance", percent=100 * tolerance)
    elif (frequency := _frequency(parts, signals, user)) is not None:
        about["sampling_frequency_hz"] = frequency
    for key, name in (("input", signals.input), ("output", signals.output)):
        about[key] = {"column": name, "unit": signals.units[key]}
        words = split_unit(name)[0]
        if words and words != name and not name.endswith("_" + signals.units[key]):
            about[key]["name"] = words
    if signals.simulated is not None:
        unit = signals.units["output"]
        about["simulated"] = {"column": signals.simulated, "unit": unit}
        user.note("simulated", column=signals.simulated)
    _give_names(entries)
    return about, entries, owners


def _from(place: Path, part: RecordColumns) -> str:
    """Give the path of a part's file from where dataset.yaml is to stand."""
    file = part.table.path
    # Of folders that are links the real ones count: '..' leads out of those.
    real = file.parent.resolve() / file.name
    return Path(os.path.relpath(real, place.parent.resolve())).as_posix()


def _frequency(
    parts: Sequence[RecordColumns], signals: ChosenColumns, user: User
) -> float | None:
    """Give a sampling frequency; none where each file tells its own when it is read."""
    if user.given.sampling_frequency is not None:
        return user.given.sampling_frequency
    names = signals.input, signals.output
    told = [
        part.table.sampling_frequency([part.columns[name] for name in names])
        for part in parts
    ]
    if None in told:
        question = "No column of time; sampling frequency in Hz"
        return checked_frequency(user.ask(question, (), "--sampling-frequency", None))
    frequencies = sorted({value for value in told if value})
    user.note("frequency", told=" and ".join(f"{value:g} Hz" for value in frequencies))
    return None


def checked_frequency(told: str | float) -> float:
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


def _give_names(entries: list[Entry]) -> None:
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


def with_roles(
    entries: list[Entry], records: Sequence[Record], user: User
) -> list[Entry]:
    """Give the entries of several records with their roles."""
    names = [record.name for record in records]
    if user.given.hold_out:
        for name in user.given.hold_out:
            refuse_unknown(name, names, f"--hold-out: no record {name!r}")
        held, why = user.given.hold_out, words("asked for")
        if set(names) <= set(held):
            raise InputError("--hold-out: all records; expected at least one to fit")
    else:
        held, why = propose({x.name: summary_of(x.u, x.dt) for x in records})
    user.notes.append(why)
    return [
        {**entry, "use": "hold-out" if name in held else "fit"}
        for name, entry in zip(names, entries, strict=True)
    ]


def cut_in_two(entry: Entry, record: Record, missing: Mask) -> list[Entry]:
    """Cut a lone record: two thirds to fit, a third held out.

    Samples that are missing at the cut belong to neither.
    """
    first, last = entry.get("rows", (1, len(missing)))
    samples = last - first + 1
    part = samples - samples // HELD_OUT_PART
    # Of an uneven clock the rows are not the samples.
    period = find_period(record.u) if samples == len(record) else None
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


def propose(inputs: Mapping[str, InputSummary]) -> tuple[tuple[str, ...], str]:
    """Propose the records to hold out.

    Where there are several kinds of input, one kind is held out: that with the fewest
    records, so long as it does not reach beyond the others in range; of equals the one
    that reaches least beyond them in frequency. Of one kind alone the record in the
    middle of the rates is held out, of eight or more every fourth: a model is judged
    between what it was fitted to, and not beyond.

    Parameters
    ----------
    inputs : mapping of str to InputSummary
        Two records or more.

    Returns
    -------
    tuple of str
        Names of those to hold out; at least one record is left to fit.
    str
        Why these.
    """
    kinds: dict[str, list[str]] = {}
    for name, item in inputs.items():
        kinds.setdefault(item.kind, []).append(name)
    tried = [
        (len(names) > len(inputs) // 2, *_beyond(inputs, names), len(names), kind)
        for kind, names in kinds.items()
    ]
    if len(kinds) > 1:
        *_, kind = min(tried)
        others = " and ".join(sorted(set(kinds) - {kind}))
        return tuple(kinds[kind]), words("another kind", kind=kind, others=others)
    by_rate = sorted(inputs, key=lambda name: inputs[name].rate)
    count = max(1, len(by_rate) // 4)
    step = len(by_rate) / count
    chosen = {by_rate[int((k + 0.5) * step - 0.5)] for k in range(count)}
    held = tuple(name for name in inputs if name in chosen)
    return held, words("one kind", kind=next(iter(kinds)))


def _beyond(inputs: Mapping[str, InputSummary], names: list[str]) -> tuple[bool, float]:
    """Tell whether records reach beyond the range of the others, and their band."""
    own = [inputs[name] for name in names]
    rest = [item for name, item in inputs.items() if name not in names]
    if not rest:
        return True, 0.0
    span = max(item.high for item in rest) - min(item.low for item in rest)
    over = max(
        max(item.high for item in own) - max(item.high for item in rest),
        min(item.low for item in rest) - min(item.low for item in own),
    )
    faster = max(i.high_hz for i in own) / max(i.high_hz for i in rest)
    return over > 0.1 * span, max(faster, 1.0)


def dataset_text(about: Mapping[str, Any]) -> str:
    """Write a dataset.yaml, one line a key and one a record."""
    lines = [FIRST_COMMENT]
    for key, value in about.items():
        if key != "records":
            lines.append(f"{key}: {flow(value)}\n")
    lines.append("records:\n")
    lines += [f"  - {entry_text(entry)}\n" for entry in about["records"]]
    return "".join(lines)


def entry_text(entry: Mapping[str, Any]) -> str:
    """Write a record's entry in one line: known keys first, none is left out."""
    ordered = {key: entry[key] for key in KEY_ORDER if key in entry}
    return flow({**ordered, **entry})


def flow(value: Any) -> str:
    """Write a value in one line."""
    return yaml_text(value, 10**6, flow=True).removesuffix("...\n").strip()

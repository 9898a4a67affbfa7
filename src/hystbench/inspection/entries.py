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

from hystbench.dataset import RECORD_NAME
from hystbench.errors import InputError, refuse_unknown
from hystbench.inspection.clocks import Ticks, ticks_of
from hystbench.inspection.columns import (
    SHORTEST,
    Ask,
    ChosenColumns,
    Flags,
    RecordColumns,
)
from hystbench.inspection.input_summary import (
    InputSummary,
    cannot_be_bridged,
    runs,
    summary_of,
)
from hystbench.inspection.names import split_unit
from hystbench.periods import find_period
from hystbench.record import Mask, Record
from hystbench.samples import UNIFORM_TOLERANCE
from hystbench.units import seconds
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

Entry = dict[str, Any]


def content_of(
    parts: Sequence[RecordColumns],
    signals: ChosenColumns,
    given: Flags,
    place: Path,
    ask: Ask,
    notes: list[str],
) -> tuple[dict[str, Any], list[Entry], list[RecordColumns]]:
    """Give dataset.yaml but for roles and periods; notes are added to.

    Returns
    -------
    about : dict
        All but the records.
    entries : list of dict
        Of the records.
    owners : list of RecordColumns
        The part that each entry is of.
    """
    about: dict[str, Any] = {"name": given.name or _name_of(place)}
    if given.device is not None:
        about["device"] = {"kind": given.device}
    entries: list[Entry] = []
    owners: list[RecordColumns] = []
    clocks: list[Ticks] = []
    for part in parts:
        if signals.time is not None:
            unit = seconds("--time-unit", signals.time_unit)
            time = part.columns[signals.time].values * unit
            clocks.append(ticks_of(time, part.where, part.table))
        whole = {"file": _from(place, part)}
        if part.group:
            whole["group"] = part.group
        pieces = _without_missing(part, signals, whole, given, ask, notes)
        entries += pieces
        owners += [part] * len(pieces)
    if any(clock.rounded for clock in clocks):
        steps = {
            id(part): clock.step for part, clock in zip(parts, clocks, strict=True)
        }
        for entry, part in zip(entries, owners, strict=True):
            entry["sampling_frequency_hz"] = float(f"{1 / steps[id(part)]:.9g}")
        notes.append(
            f"time {signals.time!r} is rounded to more than the sampling interval; "
            "the sampling frequency is written in its place"
        )
    elif clocks:
        about["time"] = {"column": signals.time, "unit": signals.time_unit}
        tolerance = max(clock.tolerance for clock in clocks)
        if tolerance > UNIFORM_TOLERANCE:
            about["time"]["tolerance"] = round(tolerance, 3)
            notes.append(
                f"time: steps differ by up to {100 * tolerance:.2g} % of their mean; "
                "'tolerance' is written, and the mean step is taken"
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
    return about, entries, owners


def _from(place: Path, part: RecordColumns) -> str:
    """Give the path of a part's file from where dataset.yaml is to stand."""
    file = part.table.path
    # Of folders that are links the real ones count: '..' leads out of those.
    real = file.parent.resolve() / file.name
    return Path(os.path.relpath(real, place.parent.resolve())).as_posix()


def _frequency(
    about: dict[str, Any],
    parts: Sequence[RecordColumns],
    signals: ChosenColumns,
    given: Flags,
    ask: Ask,
    notes: list[str],
) -> None:
    """Write a sampling frequency, unless each file tells its own when it is read."""
    if given.sampling_frequency is not None:
        about["sampling_frequency_hz"] = given.sampling_frequency
        return
    told = [
        part.table.sampling_frequency(
            [part.columns[signals.input], part.columns[signals.output]]
        )
        for part in parts
    ]
    if None in told:
        text = ask(
            "No column of time; sampling frequency in Hz",
            (),
            "--sampling-frequency",
            None,
        )
        about["sampling_frequency_hz"] = checked_frequency(text)
        return
    frequencies = sorted({value for value in told if value})
    said = " and ".join(f"{value:g} Hz" for value in frequencies)
    notes.append(f"no column of time; the files tell a sampling frequency of {said}")


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


def missing_in(part: RecordColumns, signals: ChosenColumns) -> Mask:
    """Tell of each sample whether time, input or output has no number."""
    columns = [part.columns[signals.input], part.columns[signals.output]]
    if signals.time is not None:
        columns.append(part.columns[signals.time])
    return np.asarray(
        ~np.all([np.isfinite(column.values) for column in columns], axis=0)
    )


def _without_missing(
    part: RecordColumns,
    signals: ChosenColumns,
    entry: Entry,
    given: Flags,
    ask: Ask,
    notes: list[str],
) -> list[Entry]:
    """Give the entries of a part: one, or a piece each between missing samples."""
    bad = missing_in(part, signals)
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
        None,
    )
    u = part.columns[signals.input].values
    cut = cannot_be_bridged(u) if what == "interpolate" else bad
    entries, left = [], np.count_nonzero(~bad)
    for first, behind in runs(~cut):
        there = first + np.flatnonzero(~bad[first:behind])
        if len(there) < SHORTEST:
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
        said += f"; {left} samples in pieces shorter than {SHORTEST} are left out"
    notes.append(said)
    return entries


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
    entries: list[Entry], records: Sequence[Record], given: Flags, notes: list[str]
) -> list[Entry]:
    """Give the entries of several records with their roles."""
    names = [record.name for record in records]
    if given.hold_out:
        for name in given.hold_out:
            refuse_unknown(name, names, f"--hold-out: no record {name!r}")
        held, why = given.hold_out, "the hold-out records are those asked for"
        if set(names) <= set(held):
            raise InputError("--hold-out: all records; expected at least one to fit")
    else:
        held, why = propose(
            {record.name: summary_of(record.u, record.dt) for record in records}
        )
    notes.append(f"roles: {why}")
    return [
        {**entry, "use": "hold-out" if name in held else "fit"}
        for name, entry in zip(names, entries, strict=True)
    ]


def cut_in_two(entry: Entry, record: Record, missing: Mask) -> list[Entry]:
    """Cut a lone record: two thirds to fit, a third held out.

    Samples that are missing at the cut belong to neither.
    """
    first, last = entry.get("rows", (1, len(record)))
    samples = last - first + 1
    part = samples - samples // HELD_OUT_PART
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
        return (
            tuple(kinds[kind]),
            f"the inputs held out are of another kind ({kind}) than those to fit "
            f"({others})",
        )
    by_rate = sorted(inputs, key=lambda name: inputs[name].rate)
    count = max(1, len(by_rate) // 4)
    step = len(by_rate) / count
    chosen = {by_rate[int((k + 0.5) * step - 0.5)] for k in range(count)}
    kind = next(iter(kinds))
    return (
        tuple(name for name in inputs if name in chosen),
        f"all inputs are of one kind ({kind}); of these one in the middle of the rates "
        "is held out, and a record of another kind would prove more",
    )


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
            lines.append(f"{key}: {_flow(value)}\n")
    lines.append("records:\n")
    lines += [f"  - {entry_text(entry)}\n" for entry in about["records"]]
    return "".join(lines)


def entry_text(entry: Mapping[str, Any]) -> str:
    """Write a record's entry in one line."""
    ordered = {key: entry[key] for key in KEY_ORDER if key in entry}
    return _flow(ordered)


def _flow(value: Any) -> str:
    return yaml_text(value, 10**6, flow=True).removesuffix("...\n").strip()

"""Pieces of a record to be: cut where its clock jumps or samples are missing."""

from collections.abc import Sequence
from itertools import pairwise
from typing import Any

import numpy as np

from hystbench.errors import InputError
from hystbench.even_times import usual_step
from hystbench.inspection.clocks import Ticks, jumps_of, ticks_of
from hystbench.inspection.columns import SHORTEST, ChosenColumns, RecordColumns
from hystbench.inspection.input_summary import cannot_be_bridged, runs
from hystbench.inspection.user import User, words
from hystbench.record import Mask
from hystbench.samples import UNIFORM_TOLERANCE
from hystbench.units import seconds

MOST_LOST = 0.5
"""Share of a record that may lie in pieces too short to be records: of more the clock
is no clock."""


def clock_of_part(
    part: RecordColumns, signals: ChosenColumns, user: User
) -> tuple[Ticks, list[int]]:
    """Look at the clock of a part.

    Returns
    -------
    ticks : Ticks
        Of the piece that is least even, where it jumps.
    jumps : list of int
        Samples, from 0, before which it jumps.

    Raises
    ------
    InputError
        If it is uneven all over, or samples enough for a record come in other steps
        one after the other, as another sampling rate is no lost row; but not where
        ``--uneven`` says that samples are to be interpolated.
    """
    unit = seconds("--time-unit", signals.time_unit)
    time = part.columns[signals.time or ""].values * unit
    even = Ticks(usual_step(time), UNIFORM_TOLERANCE, False, uneven=True)
    try:
        ticks = ticks_of(time, part.where, part.table)
        as_it_is = user.given.uneven is None or ticks.tolerance <= UNIFORM_TOLERANCE
        return ticks if as_it_is else even, []
    except InputError:
        if user.given.uneven is not None:
            return even, []
        jumps = jumps_of(time)
        parts = list(pairwise([0, *jumps, len(time)]))
        there = np.isfinite(time)
        times = np.array([np.count_nonzero(there[a:b]) for a, b in parts])
        kept = int(times[times >= SHORTEST].sum())
        in_a_row = max((b - a for a, b in runs(times == 1)), default=0)
        too_many = kept < MOST_LOST * np.count_nonzero(there)
        if not jumps or too_many or in_a_row >= SHORTEST:
            raise
    long = [parts[k] for k in np.flatnonzero(times >= SHORTEST)]
    found = [ticks_of(time[a:b], part.where, part.table, a) for a, b in long]
    return max(found, key=lambda ticks: (ticks.rounded, ticks.tolerance)), jumps


def missing_in(part: RecordColumns, signals: ChosenColumns) -> Mask:
    """Tell of each sample whether time, input or output has no number."""
    columns = [part.columns[signals.input], part.columns[signals.output]]
    if signals.time is not None:
        columns.append(part.columns[signals.time])
    return np.asarray(
        ~np.all([np.isfinite(column.values) for column in columns], axis=0)
    )


def pieces_of(
    part: RecordColumns,
    signals: ChosenColumns,
    entry: dict[str, Any],
    jumps: Sequence[int],
    user: User,
) -> list[dict[str, Any]]:
    """Give the entries of a part: one, or a piece each between what cuts it.

    Parameters
    ----------
    part : RecordColumns
    signals : ChosenColumns
    entry : dict
        Of the part as a whole.
    jumps : sequence of int
        Samples, from 0, before which the clock jumps.
    user : User
        Is asked what to do where samples are missing.
    """
    bad = missing_in(part, signals)
    if not bad.any() and not jumps:
        return [entry]
    said = []
    what, cut = "", bad
    if bad.any():
        told = words(
            "missing",
            where=part.where,
            count=np.count_nonzero(bad),
            samples=len(bad),
            place=part.table.place(int(np.argmax(bad))),
        )
        said.append(told)
        ways = ("interpolate", "split")
        question = f"{told}; 'interpolate' them or 'split' the record there"
        what = user.given.missing or user.ask(question, ways, "--missing", None)
        u = part.columns[signals.input].values
        cut = cannot_be_bridged(u) if what == "interpolate" else bad
    entries, left = [], int(np.count_nonzero(~bad))
    for first, behind in _between(~cut, jumps):
        there = first + np.flatnonzero(~bad[first:behind])
        if len(there) < SHORTEST:
            continue
        rows = [int(there[0]) + 1, int(there[-1]) + 1]
        piece = entry if rows == [1, len(bad)] else {**entry, "rows": rows}
        whole = not bad[there[0] : there[-1]].any()
        entries.append(piece if whole else {**piece, "missing": "interpolate"})
        left -= len(there)
    holds = {
        "jumps": bool(jumps),
        "interpolated": what == "interpolate",
        "split": what == "split",
        "split at long gaps": what == "interpolate" and cut.any(),
        "short pieces": left > 0,
    }
    numbers: dict[str, Any] = {
        "pieces": _counted(len(entries), "piece"),
        "left": _counted(left, "sample"),
        "are": "is" if left == 1 else "are",
        "shortest": SHORTEST,
    }
    if jumps:
        more = f" and {len(jumps) - 1} more" * (len(jumps) > 1)
        place = part.table.place(jumps[0])
        numbers |= {"where": part.where, "place": f"{place}{more}"}
    said += [words(topic, **numbers) for topic, true in holds.items() if true]
    user.notes.append("; ".join(said))
    return entries


def _counted(count: int, what: str) -> str:
    return f"{count} {what}{'s' * (count != 1)}"


def _between(kept: Mask, jumps: Sequence[int]) -> list[tuple[int, int]]:
    """Give the stretches that are kept, cut at jumps."""
    found: list[tuple[int, int]] = []
    for first, behind in runs(kept):
        ends = [first, *(at for at in jumps if first < at < behind), behind]
        found += pairwise(ends)
    return found

"""Whether a record looks like that of two live channels: neither stuck nor clipped."""

from __future__ import annotations

from collections.abc import Collection
from pathlib import Path

import numpy as np

from hystbench.errors import InputError
from hystbench.flat import COARSE, is_cut_off, repeats, smallest_step, stretches
from hystbench.record import FloatArray, Record

STUCK_SHARE = 0.05
"""Share of a record, and of the input's range, over which no output stands still."""
CLIPPED_SHARE = 0.01
"""Share of the input's range that it goes on while a clipped output stands."""
APPROACH = 5
"""Samples of motion before the input stops, or after it jumps."""
JUMP_RATIO = 10.0
"""Ratio to the median step: a larger step is a jump."""
STRETCH_PARTS = 12
"""Parts that a stretch is cut into; their means are free of noise and of fast
ringing."""
MOVED_SHARE = 0.1
"""Share of the output's range that it goes meanwhile."""
IF_REAL = (
    "; if it is real, say 'stands_still: [{}]' of this record in dataset.yaml; if the "
    "recorder did it, leave this record out"
)
"""What a refusal ends with: only who measured can know."""


def check_usable(
    file: Path, record: Record, stands_still: Collection[str] = ()
) -> None:
    """Refuse a record one of whose channels stands still while the other moves.

    Parameters
    ----------
    file : Path
        Where it was read from, for the message.
    record : Record
    stands_still : collection of {"input", "output"}
        Channels that really do so, as at an end stop; they are not looked at.

    Raises
    ------
    InputError
        With the first row of the stretch, whether it looks stuck or clipped, and what
        to say where it is real.
    """
    if "input" not in stands_still:
        _check_input(file, record)
    if "output" not in stands_still:
        _check_output(file, record)


def _check_output(file: Path, record: Record) -> None:
    """Refuse an output that stands still while the input moves, by no physics.

    A recorder that held its value lets go with a jump. Or, as one that is clipped, it
    stops at a rate, and moves off at one, while the input goes on beyond where the
    output stopped. A play rests where the input turns, and a mass that friction holds
    comes to rest first: both move off without a jump.
    """
    y, u = record.y, record.u
    reach, ends = float(np.ptp(u)), (y.min(), y.max())
    if ends[0] == ends[1]:
        return  # looked at as such where records are read
    told = max(CLIPPED_SHARE, COARSE * smallest_step(y) / float(np.ptp(y))) * reach
    for first, last in repeats(y, STUCK_SHARE * len(y)):
        if np.ptp(u[first:last]) <= STUCK_SHARE * reach:
            continue
        past = is_cut_off(y, first, last) and _goes_beyond(u, first, last) > told
        if past or (last < len(y) and _jumps(y, last)):
            how = "clipped" if past and y[first] in ends else "stuck"
            raise _refusal(file, record, "output", first, last, how)
    clipped = [
        (part.first, part.behind)
        for part in stretches(y)
        if part.kind == "clipped" and _goes_beyond(u, part.first, part.behind) > told
    ]
    if sum(last - first for first, last in clipped) > STUCK_SHARE * len(y):
        raise _refusal(file, record, "output", *clipped[0], "clipped")


def _goes_beyond(u: FloatArray, first: int, behind: int) -> float:
    """How far an input goes on past where it was when the output stopped.

    In the way in which it went over half the stretch: what lags stops somewhat after
    the input has turned.
    """
    near = max((behind - first) // 2, APPROACH)
    came = np.sign(u[first] - u[max(first - near, 0)])
    return float(np.max(came * (u[first:behind] - u[first])))


def _refusal(
    file: Path, record: Record, side: str, first: int, last: int, how: str
) -> InputError:
    """Say which stretch of a channel stands still, and what to say if it is real."""
    channel, values, other = (
        (record.input, record.u, "output goes on")
        if side == "input"
        else (record.output, record.y, "input moves")
    )
    return InputError(
        f"{file}: row {first + 2}: {channel.name} is {values[first]:g} {channel.unit} "
        f"for {last - first} samples while the {other}; expected a channel that is not "
        f"{how}{IF_REAL.format(side)}"
    )


def _check_input(file: Path, record: Record) -> None:
    """Refuse an input that stands still while the output goes on.

    An input may rest, and the output then settles or rings. But an input that stops in
    the middle of a motion, or stands from the first sample on, and jumps to where the
    motion has come to meanwhile was stuck; and one that stops at its end every time,
    while the output turns half way, was clipped.
    """
    u, y = record.u, record.y
    if np.ptp(u) == 0:
        return  # a part of a longer record, in which it moves
    flat, reach = _flat(u), float(np.ptp(y))
    for first, last in flat:
        on = last < len(u) and _jumps(u, last) and _unmoved(y, last, last - first)
        if on and _moves(y[first:last], reach):
            raise _refusal(file, record, "input", first, last, "stuck")
    for end in (u.min(), u.max()):
        own = [(a, b) for a, b in flat if u[a] == end and b < len(u)]
        if len(own) > 1 and all(_turns_half_way(y[a:b], reach) for a, b in own):
            first, last = next((a, b) for a, b in flat if u[a] == end)
            raise _refusal(file, record, "input", first, last, "clipped")


def _flat(u: FloatArray) -> list[tuple[int, int]]:
    """Give the stretches, long enough to matter, where an input that moved is still."""
    moves = np.abs(np.diff(u))
    usual = JUMP_RATIO * float(np.median(moves[moves != 0]))
    found = []
    for first, last in repeats(u, max(STUCK_SHARE * len(u), 2 * STRETCH_PARTS)):
        # The motion that stops; of a stretch from the start, the one that goes on.
        beside = (
            moves[last : last + APPROACH]
            if not first
            else (moves[max(first - APPROACH, 0) : first])
        )
        if len(beside) == APPROACH and beside.min() > 0 and beside.max() < usual:
            found.append((first, last))
    return found


def _jumps(u: FloatArray, at: int) -> bool:
    moves = np.abs(np.diff(u))
    return bool(moves[at - 1] > JUMP_RATIO * np.median(moves[moves != 0]))


def _unmoved(y: FloatArray, at: int, span: int) -> bool:
    """Tell whether an output goes on at its rate past a jump of the input."""
    part = max(span // STRETCH_PARTS, 2)
    before = y[at - 1] - y[max(at - 1 - part, 0)]
    after = y[min(at + part, len(y) - 1)] - y[at]
    return bool(abs(after - before) < 0.5 * abs(before))


def _means(y: FloatArray) -> FloatArray:
    return np.array([float(part.mean()) for part in np.array_split(y, STRETCH_PARTS)])


def _moves(y: FloatArray, reach: float) -> bool:
    """Tell whether an output goes far and is no slower in the end."""
    means = _means(y)
    steps, third = np.abs(np.diff(means)), STRETCH_PARTS // 3
    settles = steps[-third:].mean() < steps[:third].mean() / 2
    return bool(np.ptp(means) > MOVED_SHARE * reach) and not settles


def _turns_half_way(y: FloatArray, reach: float) -> bool:
    """Tell whether an output turns once, in the middle, as far there as back."""
    means = _means(y)
    turn = int(np.argmax(np.abs(means - means[0])))
    there, back = abs(means[turn] - means[0]), abs(means[-1] - means[turn])
    steps = np.diff(means)
    turns = np.count_nonzero(np.diff(np.sign(steps[np.abs(steps) > 0.02 * reach])))
    middle = STRETCH_PARTS / 3 <= turn + 0.5 <= 2 * STRETCH_PARTS / 3
    return (
        middle
        and min(there, back) > max(MOVED_SHARE * reach, 0.5 * max(there, back))
        and (turns == 1)
    )

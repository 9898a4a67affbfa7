"""Records of a free mass: how it is known, and where its records are cut."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import replace
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from hystbench.gap.thresholds import MOST
from hystbench.quantities import Quantities
from hystbench.record import FloatArray, Record

SPRING_SHARE = 0.1
"""Share of the input's rms below which a spring's force is none."""
UNBRAKED_S = 1e6
"""Time constant, in seconds, of a mass that nothing brakes."""
LEAST_WINDOW = 100
"""Samples of a window, at least."""
NEIGHBOURS = 5
"""Samples on either side through which a parabola gives velocity and acceleration."""


def decay_of_free_mass(
    records: Iterable[Record], quantities: Quantities
) -> float | None:
    """Give the time constant of a mass that a force moves and no spring holds.

    The input of the fit records is put down to acceleration, velocity, position, dry
    friction and a constant, by least squares. The time constant is that with which the
    velocity dies out: mass over damping, in seconds.

    Parameters
    ----------
    records : iterable of Record
        Only those with ``use: fit`` are looked at.
    quantities : Quantities

    Returns
    -------
    float or None
        None where it is another device.
    """
    if quantities.causality != "force to motion" or quantities.output != "position":
        return None
    columns, wanted = [], []
    for record in records:
        if record.use != "fit" or len(record) < 2 * LEAST_WINDOW:
            continue
        velocity, acceleration = _derivatives(record)
        position = record.y - np.mean(record.y)
        friction, constant = np.sign(velocity), np.ones(len(record))
        own = (acceleration, velocity, position, friction, constant)
        columns.append(np.column_stack(own))
        wanted.append(record.u)
    if not columns:
        return None
    stacked, u = np.vstack(columns), np.concatenate(wanted)
    sizes = np.maximum(np.sqrt(np.mean(stacked**2, axis=0)), 1e-300)
    found = np.linalg.lstsq(stacked / sizes, u, rcond=1e-10)[0]
    left = float(np.mean((u - (stacked / sizes) @ found) ** 2))
    total = float(np.var(u))
    if left >= MOST * total or abs(found[2]) > SPRING_SHARE * np.sqrt(total):
        return None
    mass, damping = found[:2] / sizes[:2]
    return float(mass / damping) if mass > 0 and damping > 0 else UNBRAKED_S


def windows(record: Record, decay_s: float | None = None) -> tuple[Record, ...]:
    """Cut a record where its motion turns; each window starts at zero.

    Parameters
    ----------
    record : Record
    decay_s : float, optional
        Time constant with which an unknown velocity at its first sample dies out.

    Returns
    -------
    tuple of Record
        One, of the whole record, where it does not turn.
    """
    starts = _starts(record)
    return tuple(
        replace(
            window,
            name=f"{record.name}-{k + 1}",
            y=window.y - window.y[0],
            simulated=None,
            decay_s=decay_s,
        )
        for k, ends in enumerate(pairwise([*starts, len(record)]))
        for window in [record.cut(slice(*ends))]
        if len(window) >= LEAST_WINDOW or len(starts) == 1
    )


def runs(records: Sequence[Record]) -> tuple[tuple[int, ...], ...]:
    """Give which records were measured in one run: windows of one record, or it alone.

    Parameters
    ----------
    records : sequence of Record
        As they were measured, or cut by :func:`windows`.

    Returns
    -------
    tuple of tuple of int
        Numbers of the records, by run.
    """
    found: dict[str, list[int]] = {}
    for number, record in enumerate(records):
        window = record.decay_s is not None
        run = record.name.rpartition("-")[0] if window else f"{number} {record.name}"
        found.setdefault(run, []).append(number)
    return tuple(tuple(own) for own in found.values())


def _starts(record: Record) -> list[int]:
    """Give the samples where a window begins: the first, and those of no velocity."""
    if len(record) < 2 * LEAST_WINDOW:
        return [0]
    velocity, _ = _derivatives(record)
    turns: NDArray[np.intp] = np.flatnonzero(np.diff(np.sign(velocity)) != 0)
    starts = [0]
    for turn in turns.tolist():
        nearer = turn + int(abs(velocity[turn + 1]) < abs(velocity[turn]))
        if nearer - starts[-1] >= LEAST_WINDOW and len(record) - nearer >= LEAST_WINDOW:
            starts.append(nearer)
    return starts


def _derivatives(record: Record) -> tuple[FloatArray, FloatArray]:
    """Velocity and acceleration of the output, by parabolas through its neighbours.

    Towards the ends the first and the last parabola go on.
    """
    place = np.arange(-NEIGHBOURS, NEIGHBOURS + 1)
    parabolas = np.linalg.pinv(np.vander(place, 3, increasing=True))
    slope = np.correlate(record.y, parabolas[1], "valid")
    bend = 2 * np.correlate(record.y, parabolas[2], "valid")
    before, after = place[:NEIGHBOURS], place[NEIGHBOURS + 1 :]
    velocity = [slope[0] + bend[0] * before, slope, slope[-1] + bend[-1] * after]
    acceleration = np.pad(bend, NEIGHBOURS, mode="edge")
    return np.concatenate(velocity) / record.dt, acceleration / record.dt**2

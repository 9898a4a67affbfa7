"""A coordinate with forces inside, a function for each step as in steps.py.

The functions of inside.c in Python.
"""

from __future__ import annotations

import math

from hystbench.export.forces import all_forces, balance, moved
from hystbench.export.steps import remember


def mechanism(
    gain,
    bias,
    segments,
    points,
    ahead,
    corners,
    ramp,
    parts,
    h,
    step,
    shown,
    start,
    count,
    forces,
    motion,
    memory,
    history,
    z,
):
    """Move a coordinate with forces inside over straight lines of what drives it."""
    moves = history[0] > ahead
    remember(points, history, gain * z + bias)
    if history[0] <= ahead:
        return 0.0
    p = history[1 + ahead]
    if not moves:
        motion[:] = start[0], start[1]
        if start[2] > 0:
            motion[0] += balance(start[2], p, count, forces, memory)
    x, w = motion
    places = corners.reshape(segments + 1, points) @ history[1:]
    for i in range(segments if moves else 0):
        now, p = places[i], places[i + 1]
        slope = ramp * (p - now) / parts
        for s in range(parts):
            ends = now + s * slope, now + s * slope + slope
            x, w = moved(count, forces, memory, step, h, ends, x, w)
            if not abs(x) < 1e100:
                x = w = math.nan  # it has run away, and stays there
                break
    motion[:] = x, w
    force = math.nan if math.isnan(x) else all_forces(count, forces, x, w, 0.0, memory)
    return shown @ (x, w, force, p)


def force_between(
    velocity,
    fine,
    dt,
    width,
    taps,
    count,
    forces,
    known,
    samples,
    between,
    memory,
    filtered,
):
    """Filter forces on a motion that are taken fine times in an interval.

    It ends one sample before the newest of those that are known. A velocity is straight
    between samples; that of a position is between the middles of intervals.
    """
    first = known == 2  # of the record: the place where it begins
    if velocity:
        start, end = samples[1 if first else 2], samples[1]
        middle = (start + end) / 2
    else:
        following = (samples[0] - samples[1]) / dt
        middle = following if first else (samples[1] - samples[2]) / dt
        last = (samples[2] - samples[3]) / dt if known > 3 else middle
        start, end = (last + middle) / 2, (middle + following) / 2
    for i in range(fine if first else 1, fine + 1):
        t = 2.0 * i / fine
        v = start + (middle - start) * t if t < 1 else middle + (end - middle) * (t - 1)
        moved = 0.0 if first else (between[1] + v) / 2 * (dt / fine)
        if first:
            between[0] = 0.0 if velocity else samples[1]
        else:
            between[0] += moved
        between[1] = v
        force = all_forces(count, forces, between[0], v, moved, memory)
        remember(width, filtered, force)
    return taps @ filtered[1:]


def impedance(
    mass,
    damping,
    stiffness,
    bias,
    velocity,
    points,
    ahead,
    last,
    rate,
    curvature,
    way,
    fine,
    dt,
    width,
    taps,
    count,
    forces,
    place,
    between,
    memory,
    filtered,
    history,
    z,
):
    """Give the force that a motion takes; rates take samples on both sides.

    Rates have rows of weights for the first sample, the second and so on, the last one
    for all that follow.
    """
    moves, before = history[0] > ahead, place[0]
    remember(points, history, z)
    force, known = 0.0, int(history[0])
    if fine and known > 1:
        force = force_between(
            velocity,
            fine,
            dt,
            width,
            taps,
            count,
            forces,
            known,
            history[1:],
            between,
            memory,
            filtered,
        )
    if known <= ahead:
        return 0.0
    z = history[1 + ahead]
    row = min(int(place[1]), last) * points
    place[1] += 1
    v = rate[row : row + points] @ history[1:]
    if velocity:
        q = before + way @ history[1:] if moves else 0.0
        v, a = z, v
    else:
        q, a = z, curvature[row : row + points] @ history[1:]
    place[0] = q
    if not fine:
        moved = q - before if moves else 0.0
        force = all_forces(count, forces, q, v, moved, memory)
    return mass * a + damping * v + stiffness * q + force + bias

"""A coordinate with forces inside, a function for each step as in steps.py.

The functions of inside.c in Python.
"""

from __future__ import annotations

import math

from hystbench.export.forces import all_forces, balance, moved
from hystbench.export.steps import remember


def mechanism(k, motion, memory, history, z):
    """Move a coordinate with forces inside over straight lines of what drives it."""
    moves = history[0] > k.ahead
    remember(k.points, history, k.gain * z + k.bias)
    if history[0] <= k.ahead:
        return 0.0
    p = history[1 + k.ahead]
    if not moves:
        motion[:] = k.start[0], k.start[1]
        if k.start[2] > 0:
            motion[0] += balance(k.start[2], p, k.count, k.forces, memory)
    x, w = motion
    places = k.corners.reshape(k.segments + 1, k.points) @ history[1:]
    for i in range(k.segments if moves else 0):
        now, p = places[i], places[i + 1]
        slope = k.ramp * (p - now) / k.parts
        for s in range(k.parts):
            ends = now + s * slope, now + s * slope + slope
            x, w = moved(k.count, k.forces, memory, k.step, k.h, ends, x, w)
            if not abs(x) < 1e100:
                x = w = math.nan  # it has run away, and stays there
                break
    motion[:] = x, w
    force = (
        math.nan if math.isnan(x) else all_forces(k.count, k.forces, x, w, 0.0, memory)
    )
    return k.shown @ (x, w, force, p)


def force_between(k, known, samples, between, memory, filtered):
    """Filter forces on a motion that are taken fine times in an interval.

    It ends one sample before the newest of those that are known. A velocity is straight
    between samples; that of a position is between the middles of intervals.
    """
    first = known == 2  # of the record: the place where it begins
    if k.velocity:
        start, end = samples[1 if first else 2], samples[1]
        middle = (start + end) / 2
    else:
        following = (samples[0] - samples[1]) / k.dt
        middle = following if first else (samples[1] - samples[2]) / k.dt
        last = (samples[2] - samples[3]) / k.dt if known > 3 else middle
        start, end = (last + middle) / 2, (middle + following) / 2
    for i in range(k.fine if first else 1, k.fine + 1):
        t = 2.0 * i / k.fine
        v = start + (middle - start) * t if t < 1 else middle + (end - middle) * (t - 1)
        moved = 0.0 if first else (between[1] + v) / 2 * (k.dt / k.fine)
        if first:
            between[0] = 0.0 if k.velocity else samples[1]
        else:
            between[0] += moved
        between[1] = v
        force = all_forces(k.count, k.forces, between[0], v, moved, memory)
        remember(k.width, filtered, force)
    return k.taps @ filtered[1:]


def impedance(k, place, between, memory, filtered, history, z):
    """Give the force that a motion takes; rates take samples on both sides.

    Rates have rows of weights for the first sample, the second and so on, the last one
    for all that follow.
    """
    moves, before = history[0] > k.ahead, place[0]
    remember(k.points, history, z)
    force, known = 0.0, int(history[0])
    if k.fine and known > 1:
        samples = history[1:]
        force = force_between(k, known, samples, between, memory, filtered)
    if known <= k.ahead:
        return 0.0
    z = history[1 + k.ahead]
    row = min(int(place[1]), k.last) * k.points
    place[1] += 1
    v = k.rate[row : row + k.points] @ history[1:]
    if k.velocity:
        q = before + k.way @ history[1:] if moves else 0.0
        v, a = z, v
    else:
        q, a = z, k.curvature[row : row + k.points] @ history[1:]
    place[0] = q
    if not k.fine:
        moved = q - before if moves else 0.0
        force = all_forces(k.count, k.forces, q, v, moved, memory)
    return k.mass * a + k.damping * v + k.stiffness * q + force + k.bias

"""What undoes a block, a function for each step as in steps.py.

The functions of inverse_steps.c in Python.
"""

from __future__ import annotations

import math

import numpy as np

from hystbench.export.steps import dead_zone, play, remember


def limited(low, high, z):
    """Stand at a limit where the signal is beyond it."""
    return min(max(z, low), high)


def of_plays(path, own, envelope, count, thresholds, terms, w, v, growth):
    """Give what plays make of an input, their states being w, and the states then."""
    a, left, right = envelope, v, v
    if own:
        left = a[0] * math.tanh(a[1] * v + a[2]) + a[3]
        right = a[4] * math.tanh(a[5] * v + a[6]) + a[7]
    p = play(left, right, growth * thresholds, w.copy())
    first, second, third = terms.reshape(3, count)
    return path * v + np.sum(p * (first + p * (second + p * third))), p


def undo_plays(
    near, path, own, envelope, count, thresholds, terms, low, high, w, at, z, growth
):
    """Find the input of plays: regula falsi, the end that stays halved (Illinois)."""
    plays = path, own, envelope, count, thresholds, terms, w

    def off(v):
        return dead_zone(near, of_plays(*plays, v, growth)[0] - z)

    one = min(max(at[0], low), high)
    other, began = one, one
    off_one = off_other = off(one)
    step = at[1] if at[1] > 0 else 1e-6 * (abs(one) + 1e-6)
    while off_one != 0 and off_other != 0 and (off_other > 0) == (off_one > 0):
        limit = low if off_other > 0 else high
        if other == limit:
            break
        one, off_one = other, off_other
        other = max(one - step, low) if off_one > 0 else min(one + step, high)
        off_other = off(other)
        step *= 2
    if (off_other > 0) != (off_one > 0):
        for turn in range(200):
            if off_one == 0 or off_other == 0:
                break
            least, most = min(one, other), max(one, other)
            middle = other - off_other * (other - one) / (off_other - off_one)
            if turn % 3 == 2 or not least < middle < most:
                middle = 0.5 * (one + other)
            if not least < middle < most:
                break
            if most - least <= 1e-15 * (abs(least) + abs(most)):
                break
            off_middle = off(middle)
            if (off_middle > 0) == (off_other > 0):
                off_one *= 0.5
            else:
                one, off_one = other, off_other
            other, off_other = middle, off_middle
    at[0], at[1] = other, abs(other - began)
    w[:] = of_plays(*plays, other, growth)[1]
    return other


def undo_growing_plays(
    coefficient,
    exponent,
    dt,
    near,
    path,
    own,
    envelope,
    count,
    thresholds,
    terms,
    low,
    high,
    w,
    at,
    before,
    z,
):
    """Let thresholds grow with the rate of the last interval."""
    rate = 0.0 if before[0] < 2 else (before[1] - before[2]) / dt
    plays = near, path, own, envelope, count, thresholds, terms
    growth = 1 + coefficient * abs(rate) ** exponent
    v = undo_plays(*plays, low, high, w, at, z, growth)
    before[:] = min(before[0] + 1, 2), v, before[1]
    return v


def applied_field(coefficient, exponent, points, ahead, rate, history, z):
    """Give the field that is applied where another acts."""
    remember(points, history, z)
    fast = rate @ history[1:] if history[0] > 1 else 0.0
    lost = math.copysign(coefficient * abs(fast) ** exponent, fast)
    return history[1 + ahead] + lost


def looked_up(last, low, each, values, z):
    """Go in straight lines through values that lie as far apart as each other."""
    place = max(0.0, min(float(last), (z - low) / each))
    before = int(place) if place < last else last - 1
    return values[before] + (place - before) * (values[before + 1] - values[before])

"""What undoes a block, a function for each step as in steps.py.

The functions of inverse_steps.c in Python.
"""

from __future__ import annotations

import math

from hystbench.export.steps import dead_zone, remember


def undo(near, low, high, way, coefficient, exponent, dt, at, pace, output, z):
    """Find the input of hysteresis, by regula falsi with an end that is halved."""

    def off(v):
        return way * dead_zone(near, output(v) - z)

    rate = 0.0 if pace[0] < 2 else (pace[1] - pace[2]) / dt
    pace[3] = 1 + coefficient * abs(rate) ** exponent
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
    at[:] = other, abs(other - began)
    pace[:3] = min(pace[0] + 1, 2), other, pace[1]
    return other


def limited(low, high, z):
    """Stand at a limit where the signal is beyond it."""
    return min(max(z, low), high)


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

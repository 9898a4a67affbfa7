"""One function for each kind of step: constants, states, then what enters.

The functions of steps.c in Python: states are arrays that are changed in place and all
zero at the start. A step of many constants takes them together, as ``k``. hystbench
copies what a model needs of this file into its own.
"""

from __future__ import annotations

import math

import numpy as np


def carry_on(count, known, values):
    """Turn what came after the first sample about it; behind that go straight on."""
    first = known - 1
    for i in range(known, count):
        if i <= 2 * first:
            values[i] = 2 * values[first] - values[2 * first - i]
        else:
            values[i] = 2 * values[i - 1] - values[max(i - 2, 0)]


def remember(points, history, v):
    """Keep a sample; history counts them, then has them, the newest first."""
    values = history[1:]
    values[1:] = values[:-1].copy()
    values[0] = v
    if history[0] < points:
        history[0] += 1
        carry_on(points, int(history[0]), values)


def play(left, right, r, w):
    """Move generalized play operators, Eq. 4."""
    np.maximum(right - r, np.minimum(left + r, w), out=w)
    return w


def polynomial(count, coefficients, z):
    """Horner's scheme."""
    y = 0.0
    for i in reversed(range(count)):
        y = y * z + coefficients[i]
    return y


def clip(limit, z):
    """Clip both ways."""
    return max(-limit, min(limit, z))


def dead_zone(half_width, z):
    """Take off what lies within."""
    return z - clip(half_width, z)


def saturation(level, sharpness, z):
    """Level off as a tangent or by the algebraic law."""
    ratio = z / level
    if sharpness == 0:
        return level * math.tanh(ratio)
    return z / (1 + abs(ratio) ** sharpness) ** (1 / sharpness)


def backlash(half_width, started, w, z):
    """Follow the input at the edges of the gap."""
    if started[0] == 0:
        w[0] = z
    started[0] = 1
    return play(z, z, half_width, w)[0]


def late(samples, kept, z):
    """Give what entered so many samples before."""
    before = kept[-1]
    kept[1:] = kept[:-1].copy()
    kept[0] = z
    return before


def at_samples(points, taps, history, z):
    """Weigh the newest samples."""
    remember(points, history, z)
    return taps @ history[1:]


def friction(coulomb, velocity_scale, points, rate, history, z):
    """Add a force against the motion."""
    velocity = rate @ history[1:] if history[0] > 1 else 0.0
    return z + coulomb * math.tanh(velocity / velocity_scale)


def drift(slope, spacing, values, path, count, z):
    """Go in straight lines through values that lie spacing samples apart."""
    now, last = count[0], values - 1
    place = now / spacing
    before = int(place) if place < last else last
    y = z + slope * now + path[before]
    if before < last:
        y += (place - before) * (path[before + 1] - path[before])
    count[0] = now + 1
    return y


def mains_pickup(cycles, harmonics, amplitudes, phases, count, z):
    """Add the hum."""
    y, turns = z, cycles * count[0]
    turns -= math.floor(turns)
    for i in range(harmonics):
        y += amplitudes[i] * math.sin(2 * math.pi * (i + 1) * turns + phases[i])
    count[0] += 1
    return y


def slew_limit(rate, started, before, now, z):
    """Follow an input that goes straight, at a limited rate."""
    if started[0] == 0:
        before[0] = now[0] = z
    started[0] = 1
    slope, lag = z - before[0], before[0] - now[0]
    way = math.copysign(rate, lag if lag != 0 else slope)
    apart = way - slope
    at = 0.0 if lag == 0 else lag / apart if apart != 0 else math.inf
    if not 0 <= at < 1:
        now[0] += way
    elif abs(slope) <= rate:
        now[0] = z
    else:
        now[0] = z - (1 - at) * (slope - math.copysign(rate, slope))
    before[0] = z
    return now[0]


def linear(k, x, x_next, history, offset, z):
    """Do ``x(k) = phi x(k-1) + sum_j drive_j v(k-j)``, ``y = output x + direct v``.

    Of the newest sample's time less those that are known ahead.
    """
    moves = history[0] > k.ahead
    if k.settled and history[0] == 0:
        offset[0] = z
    remember(k.points, history, z - offset[0])
    if moves:
        x_next[:] = k.phi.reshape(k.size, k.size) @ x + history[1:] @ k.drive.reshape(
            k.points, k.size
        )
        x[:] = x_next
    return k.direct * history[1 + k.ahead] + k.static * offset[0] + k.output @ x


def modes(k, x, history, offset, z):
    """Do the same where phi is diagonal."""
    moves = history[0] > k.ahead
    if k.settled and history[0] == 0:
        offset[0] = z
    remember(k.points, history, z - offset[0])
    if moves:
        x[:] = k.phi * x + history[1:] @ k.drive.reshape(k.points, k.size)
    return k.direct * history[1 + k.ahead] + k.static * offset[0] + k.output @ x


def thermal_drift(coefficient, count, lags, points, history, started, before, x, z):
    """Let the heat go through low-passes."""
    heat = history[points] * history[points]
    for i in range(count):
        lag = lags[3 * i : 3 * i + 3]
        if started[0] != 0:
            x[i] = lag[0] * x[i] + lag[1] * before[i] + lag[2] * heat
        before[i] = heat
        heat = x[i]
    started[0] = 1
    return z + coefficient * heat


def input_delay(shift, first, points, taps, count, kept, z):
    """Keep samples in a ring; take the delayed one from a curve through a few."""
    room, now = first + points, int(count[0])
    kept[now % room] = z
    count[0] = now + 1
    if now < shift:
        return kept[0]
    window = np.zeros(points)
    known = min(points, now - first + 1)
    for i in range(known):
        window[i] = kept[(now - first - i) % room]
    carry_on(points, known, window)
    return taps @ window


def stiffness_hardening(k, mode, history, z):
    """Integrate a stiffening mode by the classical Runge-Kutta method."""

    def bend(x, v, force):
        return force - x * (1 + k.coefficient * x * x) - 2 * k.damping * v

    x, v = mode
    moves = history[0] > k.ahead
    remember(k.points, history, z)
    places = k.corners.reshape(k.segments + 1, k.points) @ history[1:]
    for i in range(k.segments if moves else 0):
        now, then = places[i], places[i + 1]
        slope, reach = k.ramp * (then - now), np.fmax(abs(x), abs(then))
        stiffness = math.sqrt(1 + 3 * abs(k.coefficient) * reach * reach)
        whole = k.phase * max(stiffness, k.damping) / 0.1
        if not whole < 1e5 - 1:
            x = math.nan  # it has run away, and stays there
        if math.isnan(x):
            break
        steps = math.ceil(whole)
        h, part = k.phase / steps, 1 / steps
        for s in range(steps):
            f1 = now + s * part * slope
            f2 = now + (s + 0.5) * part * slope
            f4 = now + (s + 1) * part * slope
            a1 = bend(x, v, f1)
            v2, x2 = v + h / 2 * a1, x + h / 2 * v
            a2 = bend(x2, v2, f2)
            v3, x3 = v + h / 2 * a2, x + h / 2 * v2
            a3 = bend(x3, v3, f2)
            v4, x4 = v + h * a3, x + h * v3
            a4 = bend(x4, v4, f4)
            x += h / 6 * (v + 2 * (v2 + v3) + v4)
            v += h / 6 * (a1 + 2 * (a2 + a3) + a4)
    mode[:] = x, v
    return (1 - k.participation) * history[1 + k.ahead] + k.participation * x


def flow_out(rate, exponent, h):
    """Give what leaves a store."""
    return rate * h**exponent if h > 0 else 0.0


def store(k, level, history, z):
    """Fill and empty a store by a Runge-Kutta method of second order."""
    moves, over = history[0] > k.ahead, 0.0
    remember(k.points, history, k.gain * z + k.bias)
    if history[0] <= k.ahead:
        return 0.0
    h = level[0] if moves else min(k.start, k.height)
    places = k.corners.reshape(k.segments + 1, k.points) @ history[1:]
    for i in range(k.segments if moves else 0):
        now, slope = places[i], k.ramp * (places[i + 1] - places[i]) / k.parts
        for s in range(k.parts):
            inflow = now + s * slope
            rise = k.t / 2 * (inflow - flow_out(k.rate, k.exponent, h))
            half = min(k.height, max(0.0, h + rise))
            left = flow_out(k.rate, k.exponent, half)
            h = max(0.0, h + k.t * (inflow + slope / 2 - left))
            over += max(0.0, h - k.height)
            h = min(h, k.height)
    level[0] = h
    if not k.outflow:
        return h
    return flow_out(k.rate, k.exponent, h) + k.caught * (
        over / (k.segments * k.parts * k.t)
    )

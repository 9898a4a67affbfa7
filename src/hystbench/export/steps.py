"""One function for each kind of step: constants, states, then what enters.

The functions of steps.c in Python: states are arrays that are changed in place and all
zero at the start. hystbench copies what a model needs of this file into its own.
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


def linear(
    size,
    points,
    ahead,
    phi,
    drive,
    output,
    direct,
    settled,
    static,
    x,
    x_next,
    history,
    offset,
    z,
):
    """Do ``x(k) = phi x(k-1) + sum_j drive_j v(k-j)``, ``y = output x + direct v``.

    Of the newest sample's time less those that are known ahead.
    """
    moves = history[0] > ahead
    if settled and history[0] == 0:
        offset[0] = z
    remember(points, history, z - offset[0])
    if moves:
        x_next[:] = phi.reshape(size, size) @ x + history[1:] @ drive.reshape(
            points, size
        )
        x[:] = x_next
    return direct * history[1 + ahead] + static * offset[0] + output @ x


def modes(
    size,
    points,
    ahead,
    phi,
    drive,
    output,
    direct,
    settled,
    static,
    x,
    history,
    offset,
    z,
):
    """Do the same where phi is diagonal."""
    moves = history[0] > ahead
    if settled and history[0] == 0:
        offset[0] = z
    remember(points, history, z - offset[0])
    if moves:
        x[:] = phi * x + history[1:] @ drive.reshape(points, size)
    return direct * history[1 + ahead] + static * offset[0] + output @ x


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


def stiffness_hardening(
    participation,
    phase,
    damping,
    coefficient,
    ramp,
    segments,
    points,
    ahead,
    corners,
    mode,
    history,
    z,
):
    """Integrate a stiffening mode by the classical Runge-Kutta method."""

    def bend(x, v, force):
        return force - x * (1 + coefficient * x * x) - 2 * damping * v

    x, v = mode
    moves = history[0] > ahead
    remember(points, history, z)
    places = corners.reshape(segments + 1, points) @ history[1:]
    for i in range(segments if moves else 0):
        now, then = places[i], places[i + 1]
        slope, reach = ramp * (then - now), np.fmax(abs(x), abs(then))
        stiffness = math.sqrt(1 + 3 * abs(coefficient) * reach * reach)
        whole = phase * max(stiffness, damping) / 0.1
        if not whole < 1e5 - 1:
            x = math.nan  # it has run away, and stays there
        if math.isnan(x):
            break
        steps = math.ceil(whole)
        h, part = phase / steps, 1 / steps
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
    return (1 - participation) * history[1 + ahead] + participation * x


def gpi(envelope, count, thresholds, weights, w, v, growth):
    """Eq. 9, thresholds times growth; envelope: a0 to a7 of Eqs. 5 and 6."""
    a = envelope
    left = a[0] * math.tanh(a[1] * v + a[2]) + a[3]
    right = a[4] * math.tanh(a[5] * v + a[6]) + a[7]
    return weights @ play(left, right, growth * thresholds, w)


def prandtl_ishlinskii(
    count, thresholds, weights, square_weights, cube_weights, w, v, growth
):
    """Add weighted plays, their squares and cubes."""
    p = play(v, v, growth * thresholds, w)
    return v + np.sum(p * (weights + p * (square_weights + p * cube_weights)))


def hysteresis_shape(
    count, thresholds, weights, square_weights, degrees, powers, w, v, growth
):
    """Give what is added to the hysteresis inside."""
    p = play(v, v, growth * thresholds, w)
    return polynomial(degrees, powers, v) + np.sum(p * (weights + p * square_weights))


def butterfly(coefficient, threshold, w, v, growth):
    """Give what is added to the hysteresis inside."""
    return coefficient * play(v, v, growth * threshold, w)[0] ** 2


def split(all_of_it, scale, unit, power, s):
    """Solve ``s + scale (s / unit)^power = all_of_it`` for s above 0 by Newton."""
    for _ in range(60):
        if not s > 0:
            break
        rest = scale * (s / unit) ** power
        change = (s + rest - all_of_it) / (1 + power * rest / s)
        s -= change
        if abs(change) <= 1e-13 * all_of_it:
            break
    return s


def acting_field(c, a, dt, field, v):
    """Solve ``v - field = c |rate|^a sign(rate)`` by implicit Euler."""
    apart = v - field[0]
    whole, lags = abs(apart), a <= 1
    if c == 0 or not whole > 0:
        field[0] = v
        return v
    scale, unit, power = (dt, c, 1 / a) if lags else (c, dt, a)
    guess = field[1]
    if not 0 < guess < whole:
        guess = min(whole, unit * (whole / scale) ** (1 / power))
    guess = min(split(whole, scale, unit, power, guess), whole)
    moved = math.copysign(guess, apart)
    field[0] = v - moved if lags else field[0] + moved
    field[1] = guess
    return field[0]


def rate_dependent_hysteresis(
    form,
    coefficient,
    exponent,
    dt,
    fine,
    points,
    ahead,
    values,
    rates,
    history,
    growth_before,
    field,
    v,
    growth,
):
    """Give the fields and growths that what is inside gets, one after the other."""
    first = history[0] == ahead
    remember(points, history, v)
    if history[0] <= ahead:
        return []
    v = history[1 + ahead]
    if first:
        growth_before[0], field[0] = growth, v
    inside = []
    for row in [fine - 1] if first else range(fine):
        taps = slice(row * points, (row + 1) * points)
        rate = rates[taps] @ history[1:] if history[0] > 1 else 0.0
        effect = coefficient * abs(rate) ** exponent
        now = v if row == fine - 1 else values[taps] @ history[1:]
        factor = growth_before[0] + (growth - growth_before[0]) * (row + 1) / fine
        if form == 0:
            factor *= 1 + effect
        elif form == 1:
            now -= math.copysign(effect, rate)
        else:
            now = acting_field(coefficient, exponent, dt, field, now)
        inside.append((now, factor))
    growth_before[0] = growth
    return inside


def rdgpi(
    spacing,
    loss,
    weight,
    tau,
    envelope_gain,
    envelope_offset,
    points,
    ahead,
    rate,
    count,
    history,
    w,
    z,
):
    """Let thresholds and weights follow the rate: docs/rdgpi.md of hystbench."""
    remember(points, history, z)
    if history[0] <= ahead:
        return 0.0
    z = history[1 + ahead]
    speed = abs(rate @ history[1:]) if history[0] > 1 else 0.0
    apart = spacing[0] * math.log(spacing[1] + spacing[2] * speed)
    ratio, envelope = math.exp(-tau * apart), envelope_gain * z + envelope_offset
    number = np.arange(count)
    y = ratio**number @ play(envelope, envelope, number * apart, w)
    return weight * (1 - loss[0] * math.log(loss[1] + loss[2] * speed)) * y


def mass_below(cells, mass, x, y):
    """Mass of the density below x and below y, in cells: bilinear within a cell."""
    i, j = min(int(x), cells - 1), min(int(y), cells - 1)
    low = i * (cells + 1) + j
    high = low + cells + 1
    below = mass[low] + (y - j) * (mass[low + 1] - mass[low])
    above = mass[high] + (y - j) * (mass[high + 1] - mass[high])
    return below + (x - i) * (above - below)


def relays(cells, room, limit, mass, memory, turns, outputs, z):
    """Move all relays, by Everett's function at the turns that are not wiped out."""
    depth = int(memory[1])
    x = max(0.0, min(float(cells), (z + limit) / (2 * limit) * cells))
    if x < memory[2] if depth % 2 == 0 else x > memory[2]:
        if depth + 2 >= room:
            depth -= 2
        depth += 1
        turns[depth], outputs[depth] = memory[2], memory[3]
    if depth % 2 == 0:
        while depth >= 2 and x >= turns[depth - 1]:
            depth -= 2
    else:
        while depth >= 3 and x <= turns[depth - 1]:
            depth -= 2
        if depth == 1 and x <= turns[0]:
            depth = 0
    turn = turns[depth]
    own = mass_below(cells, mass, turn, turn)
    everett = 0.5 * (mass_below(cells, mass, x, x) + own)
    everett -= mass_below(cells, mass, x, turn)
    memory[1:4] = depth, x, outputs[depth] + (-everett if depth % 2 else everett)
    return memory[3]


def preisach(cells, room, limit, reversible, mass, memory, turns, outputs, z):
    """Add the relays to the reversible part."""
    kept = (cells, room, limit, mass, memory, turns, outputs)
    if memory[0] == 0:  # demagnetized by alternating, falling inputs
        for i in range(cells, 0, -1):
            relays(*kept, limit * i / cells)
            relays(*kept, -limit * i / cells)
        relays(*kept, 0.0)
        memory[0], memory[4] = 1, memory[3]
    return reversible * z + relays(*kept, z) - memory[4]


def langevin_ratio(x):
    """Langevin's function over its argument; near zero by its series."""
    q, size = x * x, abs(x)
    if q < 0.01:
        inner = -1 / 4725 + q * 2 / 93555
        return 1 / 3 + q * (-1 / 45 + q * (2 / 945 + q * inner))
    e = math.exp(-2 * size)
    return ((1 + e) / (1 - e) - 1 / size) / size


def jiles_atherton(
    saturation,
    shape,
    coupling,
    pinning,
    reversibility,
    longest,
    bias,
    start,
    field,
    magnetization,
    z,
):
    """Integrate over the field by the classical Runge-Kutta method."""

    def slope(h, m):
        x = (h + coupling * m) / shape
        ratio = langevin_ratio(x)
        anhysteretic = x * ratio
        rise = (1 - anhysteretic * anhysteretic - 2 * ratio) / shape
        gap = direction * (anhysteretic - m)
        effective = max(gap, 0.0) / pinning + reversibility * rise
        return effective / (1 - coupling * effective)

    way = (bias + z) - (bias + field[0])
    direction = -1 if way < 0 else 1
    m = start + magnetization[0] if math.isfinite(way) else math.nan
    steps = math.ceil(abs(way) / longest) if math.isfinite(way) else 0
    each = way / max(steps, 1)
    for s in range(steps):
        at = bias + field[0] + s * each
        first = slope(at, m)
        second = slope(at + each / 2, m + each / 2 * first)
        third = slope(at + each / 2, m + each / 2 * second)
        fourth = slope(at + each, m + each * third)
        m += each / 6 * (first + 2 * (second + third) + fourth)
    field[0], magnetization[0] = z, m - start
    return saturation * magnetization[0]


def flow_out(rate, exponent, h):
    """Give what leaves a store."""
    return rate * h**exponent if h > 0 else 0.0


def store(
    gain,
    bias,
    segments,
    points,
    ahead,
    corners,
    ramp,
    parts,
    t,
    rate,
    exponent,
    height,
    start,
    outflow,
    caught,
    level,
    history,
    z,
):
    """Fill and empty a store by a Runge-Kutta method of second order."""
    moves, over = history[0] > ahead, 0.0
    remember(points, history, gain * z + bias)
    if history[0] <= ahead:
        return 0.0
    h = level[0] if moves else min(start, height)
    places = corners.reshape(segments + 1, points) @ history[1:]
    for i in range(segments if moves else 0):
        now, slope = places[i], ramp * (places[i + 1] - places[i]) / parts
        for s in range(parts):
            inflow = now + s * slope
            rise = t / 2 * (inflow - flow_out(rate, exponent, h))
            half = min(height, max(0.0, h + rise))
            left = flow_out(rate, exponent, half)
            h = max(0.0, h + t * (inflow + slope / 2 - left))
            over += max(0.0, h - height)
            h = min(h, height)
    level[0] = h
    if not outflow:
        return h
    return flow_out(rate, exponent, h) + caught * (over / (segments * parts * t))

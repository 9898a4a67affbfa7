"""Steps of hysteresis, one function for each kind as in steps.py.

The functions of hysteresis_steps.c in Python.
"""

from __future__ import annotations

import math

import numpy as np

from hystbench.export.steps import play, polynomial, remember


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


def rate_dependent_hysteresis(k, history, growth_before, field, v, growth):
    """Give the fields and growths that what is inside gets, one after the other."""
    first = history[0] == k.ahead
    remember(k.points, history, v)
    if history[0] <= k.ahead:
        return []
    v = history[1 + k.ahead]
    if first:
        growth_before[0], field[0] = growth, v
    inside = []
    for row in [k.fine - 1] if first else range(k.fine):
        taps = slice(row * k.points, (row + 1) * k.points)
        rate = k.rates[taps] @ history[1:] if history[0] > 1 else 0.0
        effect = k.coefficient * abs(rate) ** k.exponent
        now = v if row == k.fine - 1 else k.values[taps] @ history[1:]
        factor = growth_before[0] + (growth - growth_before[0]) * (row + 1) / k.fine
        if k.form == 0:
            factor *= 1 + effect
        elif k.form == 1:
            now -= math.copysign(effect, rate)
        else:
            now = acting_field(k.coefficient, k.exponent, k.dt, field, now)
        inside.append((now, factor))
    growth_before[0] = growth
    return inside


def rdgpi(k, history, w, z):
    """Let thresholds and weights follow the rate: docs/rdgpi.md of hystbench."""
    remember(k.points, history, z)
    if history[0] <= k.ahead:
        return 0.0
    z = history[1 + k.ahead]
    speed = abs(k.rate @ history[1:]) if history[0] > 1 else 0.0
    apart = k.spacing[0] * math.log(k.spacing[1] + k.spacing[2] * speed)
    ratio, envelope = math.exp(-k.tau * apart), k.envelope_gain * z + k.envelope_offset
    number = np.arange(k.count)
    y = ratio**number @ play(envelope, envelope, number * apart, w)
    return k.weight * (1 - k.loss[0] * math.log(k.loss[1] + k.loss[2] * speed)) * y


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


def jiles_atherton(k, field, magnetization, z):
    """Integrate over the field by the classical Runge-Kutta method."""

    def slope(h, m):
        x = (h + k.coupling * m) / k.shape
        ratio = langevin_ratio(x)
        anhysteretic = x * ratio
        rise = (1 - anhysteretic * anhysteretic - 2 * ratio) / k.shape
        gap = direction * (anhysteretic - m)
        effective = max(gap, 0.0) / k.pinning + k.reversibility * rise
        return effective / (1 - k.coupling * effective)

    way = (k.bias + z) - (k.bias + field[0])
    direction = -1 if way < 0 else 1
    m = k.start + magnetization[0] if math.isfinite(way) else math.nan
    steps = math.ceil(abs(way) / k.longest) if math.isfinite(way) else 0
    each = way / max(steps, 1)
    for s in range(steps):
        at = k.bias + field[0] + s * each
        first = slope(at, m)
        second = slope(at + each / 2, m + each / 2 * first)
        third = slope(at + each / 2, m + each / 2 * second)
        fourth = slope(at + each, m + each * third)
        m += each / 6 * (first + 2 * (second + third) + fourth)
    field[0], magnetization[0] = z, m - k.start
    return k.saturation * magnetization[0]

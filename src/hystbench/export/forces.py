"""Forces against one coordinate: their laws, and the way of a step against them.

The functions of the kernel's forces.c in Python. A force is a row of six numbers: its
law's number, and those of the law.
"""

from __future__ import annotations

import math

import numpy as np

from hystbench.export.steps import clip, dead_zone


def mean_dead_zone(start, end, gap):
    """Average a dead zone between two places."""
    a, b = dead_zone(gap, start), dead_zone(gap, end)
    if a * b > 0 or start == end:
        return (a + b) / 2
    return (b - a) / (end - start) * (b + a) / 2


def mean_held(z, way, reach, gap):
    """Average a dead zone over a way; z moves along until it is held at its reach."""
    start, end = clip(reach, z), clip(reach, z + way)
    if way == 0:
        return dead_zone(gap, start)
    moved = end - start
    climbed = mean_dead_zone(start, end, gap) * moved
    return (climbed + dead_zone(gap, end) * (way - moved)) / way


def phi2(y):
    """Give ``(exp(y) - 1 - y) / y^2``, near zero by its series."""
    if abs(y) > 0.3:
        return (math.expm1(y) - y) / (y * y)
    total = 0.0
    for k in range(13, 1, -1):
        total = total * y + 1 / math.factorial(k)
    return total


def sinh(x):
    """Give a hyperbolic sine that is infinite where it is too large."""
    return math.sinh(x) if abs(x) < 700 else math.copysign(math.inf, x)


def integral_of(x, a, way):
    """Move x, which follows ``x' = 1 + a x``; also give its integral over the way."""
    slope = 1 + a * x
    if not slope > 0:
        return x, x * way
    y = a * way
    twice = phi2(y)
    return x + slope * way * (1 + y * twice), way * (x + slope * way * twice)


def bouc_wen(z, way, share):
    """Move Bouc and Wen's operator; also give its integral over the way."""
    sign = -1 if way < 0 else 1
    x, length, b = sign * z, abs(way), 2 * share - 1
    until = first = 0.0
    if x < 0:
        until = length
        if abs(b) < 1e-9:
            until = -x
        elif b * x > -1:
            until = -math.log1p(b * x) / b
        until = min(until, length)
        x, first = integral_of(x, b, until)
    x, second = integral_of(x, -1.0, length - until)
    return sign * x, first + second


def sliding(f, v):
    """Give the largest force of friction at a velocity."""
    return f[1] + (f[2] * math.exp(-(v / f[3]) * (v / f[3])) if f[3] > 0 else 0.0)


def friction_reach(f, v):
    """Give how far friction gives way, which is as stiff at every velocity."""
    most = sliding(f, 0.0)
    return f[4] * (sliding(f, v) / most) if most > 0 else 0.0


def remembered(f, way, v, memory):
    """Give what a force remembers after a way, v being the velocity at its end."""
    kind = int(f[0])
    if kind == 3:
        return clip(friction_reach(f, v), memory + way)
    if kind == 5:
        return bouc_wen(memory, way / f[2], f[3])[0]
    if kind == 7:
        return clip(f[2], memory + way)
    return memory


def inner_force(f, q, v, memory):
    """Give a force: its law's number, then the numbers of the law."""
    kind = int(f[0])
    if kind == 0:
        return q * q * (f[1] + f[2] * q)
    if kind == 1:
        return f[1] * (f[2] * sinh(q / f[2]) - q)
    if kind == 2:
        way = q - f[3]
        return 0.0 if f[4] * way < 0 else f[1] * dead_zone(f[2], way)
    if kind == 3:
        return sliding(f, 0.0) * memory / f[4]
    if kind == 4:
        return f[1] * v * abs(v)
    if kind == 8:
        return f[1] * math.tanh(v / f[2])
    if kind == 5:
        return f[1] * memory
    if kind == 6:
        return f[1] * (np.sin(q + f[2]) - math.sin(f[2]))
    return f[1] * dead_zone(f[3], memory)


def mean_force(f, q, way, v, memory):
    """Average a force over a way from q, which is its work; v is the mean velocity."""
    kind, end, middle, half = int(f[0]), q + way, q + way / 2, way / 2
    if kind == 0:
        squares = q * q + end * end
        return f[1] * (squares + q * end) / 3 + f[2] * middle * squares / 2
    if kind == 1:
        y = half / f[2]
        spread = sinh(y) / y if y != 0 else 1.0
        return f[1] * (f[2] * sinh(middle / f[2]) * spread - middle)
    if kind == 2:
        start, end = q - f[3], end - f[3]
        if f[4] != 0:
            start = f[4] * max(0.0, f[4] * start)
            end = f[4] * max(0.0, f[4] * end)
        mean = mean_dead_zone(start, end, f[2])
        return f[1] * (mean if way == 0 else mean * ((end - start) / way))
    if kind == 3:
        held = mean_held(memory, way, friction_reach(f, v), 0.0)
        return sliding(f, 0.0) / f[4] * held
    if kind == 4:
        return f[1] * v * abs(v)
    if kind == 8:
        return f[1] * math.tanh(v / f[2])
    if kind == 5:
        turned = way / f[2]
        mean = bouc_wen(memory, turned, f[3])[1] / turned if turned != 0 else memory
        return f[1] * mean
    if kind == 6:
        spread = np.sin(half) / half if half != 0 else 1.0
        return f[1] * (np.sin(middle + f[2]) * spread - math.sin(f[2]))
    return f[1] * mean_held(memory, way, f[2], f[3])


def all_forces(count, forces, q, v, way, memory):
    """Move all memories by a way; give the sum of the forces at its end."""
    total = 0.0
    for i in range(count):
        f = forces[6 * i : 6 * i + 6]
        memory[i] = remembered(f, way, v, memory[i])
        total += inner_force(f, q, v, memory[i])
    return total


def way_near(miss, alone):
    """Find the way by the secant method; NaN where it does not get there."""
    x, at_x = alone, miss(alone)
    step = -at_x
    for _ in range(6):
        if abs(step) <= 1e-9 * abs(x):
            return x + step
        if not abs(x + step - alone) < abs(alone):
            break
        before = at_x
        x += step
        at_x = miss(x)
        if at_x == before:
            break
        step *= at_x / (before - at_x)
    return math.nan


def way_of(count, forces, memory, q, alone, gives, h):
    """Find the way from q whose mean force leaves it.

    By Chandrupatla's method where a force falls with the velocity, or where the secant
    method does not find it.
    """

    def miss(way):
        total = 0.0
        for i in range(count):
            f = forces[6 * i : 6 * i + 6]
            if h > 0:
                total += mean_force(f, q, way, way / h, memory[i])
            else:  # on the way to a place of rest the force at its end counts
                total += inner_force(f, q + way, 0.0, memory[i])
        return way - alone + gives * total

    laws = [forces[6 * i : 6 * i + 3] for i in range(count)]
    falls = any(int(kind) == 3 and excess > 0 for kind, _, excess in laws)
    near_by = math.nan if falls else way_near(miss, alone)
    if near_by == near_by:
        return near_by
    a, b = 0.0, alone
    at_a, at_b = miss(a), miss(b)
    if at_a == 0 or at_b == 0:
        return a if at_a == 0 else b
    if (at_a > 0) == (at_b > 0):
        b = -at_a
        at_b = miss(b)
    for _ in range(100):
        if (at_a > 0) != (at_b > 0):
            break
        a, at_a, b = b, at_b, 2 * b
        at_b = miss(b)
    else:
        return math.nan
    t = at_a / (at_a - at_b)
    for _ in range(100):
        x = a + (t if 0 < t < 1 else 0.5) * (b - a)
        at_x = miss(x)
        if (at_x > 0) == (at_a > 0):
            c, at_c = a, at_a
        else:
            c, at_c, b, at_b = b, at_b, a, at_a
        a, at_a = x, at_x
        best, apart = (a if abs(at_a) < abs(at_b) else b), abs(b - a)
        near = 4e-16 * abs(best) + 1e-16 * abs(alone)
        if at_a == 0 or apart <= near:
            return a if at_a == 0 else best
        xi = (a - b) / (c - b)
        phi = 1.0 if at_c == at_b else (at_a - at_b) / (at_c - at_b)
        t = 0.5
        if phi != 1 and phi * phi < xi and (1 - phi) ** 2 < 1 - xi:
            t = at_a / (at_b - at_a) * at_c / (at_b - at_c)
            t += (c - a) / (b - a) * at_a / (at_c - at_a) * at_b / (at_c - at_b)
        t = max(near / apart / 2, min(1 - near / apart / 2, t))
    return a if abs(at_a) < abs(at_b) else b


def turns(count, forces):
    """Tell whether a force turns with the direction of the motion."""
    return any(int(forces[6 * i]) in (3, 5, 7) for i in range(count))


def over(count, forces, memory, step, h, ends, q, v):
    """Give the way of a part of an interval, and the velocity after it."""
    now = np.array([q, v, *ends])
    alone = float(step[:4] @ now) - q
    way, gives = alone, step[2] + step[3]
    if count:
        way = way_of(count, forces, memory, q, alone, gives, h)
    after = float(step[4:] @ now)
    return way, after - (step[6] + step[7]) * ((alone - way) / gives)


def moved(count, forces, memory, step, h, ends, q, v):
    """Give q and v after a part, which is taken in eighths where the motion turns."""
    way, after = over(count, forces, memory, step[:8], h, ends, q, v)
    fine = 8 if after * v < 0 and turns(count, forces) else 1
    slope = (ends[1] - ends[0]) / fine
    for i in range(fine):
        own = ends[0] + i * slope, ends[0] + (i + 1) * slope
        if fine > 1:
            way, after = over(count, forces, memory, step[8:], h / fine, own, q, v)
        q, v = q + way, after
        all_forces(count, forces, q, v, way, memory)
    return q, v


def balance(stiffness, p, count, forces, memory):
    """Find where springs hold a force, next to where the linear one alone does."""
    q = p / stiffness
    return q + way_of(count, forces, memory, q, 0.0, 1 / stiffness, 0.0)

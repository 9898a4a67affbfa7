"""Gaps of a known kind, by plain NumPy: what locate must find again.

Nothing of hystbench's own blocks is used. The plants are a plain gain and a plain
Prandtl-Ishlinskii operator; each effect is written by its definition.
"""

from __future__ import annotations

import numpy as np
from scipy import signal

from hystbench.gap.records.scored_samples import Compared
from hystbench.record import Channel, Record

DT = 1 / 2000
THRESHOLDS = np.array([0.0, 0.1, 0.25, 0.45, 0.7])
WEIGHTS = np.array([4.0, 1.5, 1.2, 0.9, 0.6])


def plain_play(u, half_width):
    """The play operator, from rest."""
    return widened_play(u, half_width, np.ones_like(u))


def widened_play(u, half_width, widen):
    """The same where the half-width changes, all samples at once.

    A sample clips the state to [u - r, u + r]. Two clips in turn are one clip again, so
    those of 2, 4, 8... samples come from pairs of the ones before.
    """
    low, high = u - half_width * widen, u + half_width * widen
    step = 1
    while step < len(u):
        ends = (low[step:], high[step:])
        before = (low[:-step], high[:-step])
        ends = [np.clip(item, *ends) for item in before]
        low = np.concatenate([low[:step], ends[0]])
        high = np.concatenate([high[:step], ends[1]])
        step *= 2
    return np.clip(0.0, low, high)


def hysteretic(u, widen=None):
    widen = np.ones_like(u) if widen is None else widen
    pairs = zip(THRESHOLDS, WEIGHTS, strict=True)
    return sum(weight * widened_play(u, half, widen) for half, weight in pairs)


def straight(u):
    return 6.0 * u


def inputs(samples=4000, seed=0):
    """What a laboratory would take, as (name, u, period)."""
    rng = np.random.default_rng(seed)
    t = np.arange(samples) * DT
    found = []
    for frequency, size in ((1, 1.0), (10, 1.0), (10, 0.4), (50, 0.8), (125, 0.5)):
        u = size * np.sin(2 * np.pi * frequency * t)
        found.append((f"sine-{frequency}-{size}", u, round(1 / frequency / DT)))
    period = samples // 4
    lines = np.arange(1, 1 + int(200 * period * DT))
    phases = rng.uniform(0, 2 * np.pi, len(lines))
    wave = sum(
        np.cos(2 * np.pi * k * np.arange(period) / period + p)
        for k, p in zip(lines, phases, strict=True)
    )
    wave = np.tile(wave / np.max(np.abs(wave)), 4)
    found.append(("multisine", wave, period))
    chirp = 0.7 * signal.chirp(t, 1, t[-1], 200)
    found.append(("chirp", chirp * np.minimum(1, (t[-1] - t) / 0.05), None))
    decay = np.exp(-t / (t[-1] / 2)) * np.sin(2 * np.pi * 5 * t)
    found.append(("decaying", decay, None))
    return found


def low_passed(x, tau):
    keep = np.exp(-DT / tau)
    return signal.lfilter([0.5 * (1 - keep), 0.5 * (1 - keep)], [1, -keep], x)


def linear(x, transfer):
    """Filter by a frequency response, with room for what went before."""
    room = np.concatenate([np.zeros(len(x)), x, np.zeros(len(x))])
    frequency = np.fft.rfftfreq(len(room), DT)
    out = np.fft.irfft(np.fft.rfft(room) * transfer(2j * np.pi * frequency), len(room))
    return out[len(x) : 2 * len(x)]


def slew(u, rate):
    out = []
    state = float(u[0])
    for value in u.tolist():
        state += min(max(value - state, -rate * DT), rate * DT)
        out.append(state)
    return np.array(out)


def mode(hertz, damping, part):
    wn = 2 * np.pi * hertz
    return lambda s: 1 - part + part * wn**2 / (s**2 + 2 * damping * wn * s + wn**2)


def diffusion(tau):
    def transfer(s):
        q = np.sqrt(np.where(s == 0, 1e-9, s * tau))
        return np.tanh(q) / q

    return transfer


def effects(rng):
    """Each effect: (plant, u) to output, by the name in the vocabulary."""

    def rate_of(u):
        return np.gradient(u, DT)

    def drift(u):
        steps = rng.standard_normal(6)
        knots = np.linspace(0, 1, 6)
        return 0.5 * np.interp(np.linspace(0, 1, len(u)), knots, np.cumsum(steps))

    def mains(u):
        t = np.arange(len(u)) * DT
        return 0.3 * np.sin(2 * np.pi * 50.03 * t + rng.uniform(0, 6.28))

    def widened(u):
        return hysteretic(u, 1 + 0.02 * np.abs(rate_of(u)) ** 0.7)

    return {
        "input-delay": lambda p, u: linear(p(u), lambda s: np.exp(-s * 0.0007)),
        "drive-lag": lambda p, u: p(linear(u, lambda s: 1 / (1 + 0.0015 * s))),
        "eddy-diffusion": lambda p, u: p(linear(u, diffusion(0.002))),
        "drive-saturation": lambda p, u: p(np.clip(u, -0.6, 0.6)),
        "slew-limit": lambda p, u: p(slew(u, 90.0)),
        "dead-zone": lambda p, u: p(np.sign(u) * np.maximum(np.abs(u) - 0.08, 0)),
        "hysteresis": lambda p, u: hysteretic(u),
        "asymmetry": lambda p, u: p(u) + 0.03 * p(u) ** 2,
        "saturation": lambda p, u: 7 * np.tanh(p(u) / 7),
        "rate-dependent-hysteresis": lambda p, u: widened(u),
        "resonance": lambda p, u: linear(p(u), mode(70, 0.04, 0.1)),
        "friction": lambda p, u: p(u) + 0.4 * np.tanh(rate_of(u) / 0.5),
        "backlash": lambda p, u: plain_play(p(u), 0.3),
        "creep": lambda p, u: p(u) + 0.3 * low_passed(p(u), 0.6),
        "thermal-drift": lambda p, u: p(u) + 3 * low_passed(u**2, 2.0),
        "sensor-lag": lambda p, u: linear(p(u), lambda s: 1 / (1 + 0.001 * s)),
        "sensor-nonlinearity": lambda p, u: p(u) + 0.02 * p(u) ** 2 - 0.005 * p(u) ** 3,
        "mains-pickup": lambda p, u: p(u) + mains(u),
        "drift": lambda p, u: p(u) + drift(u),
        "calibration-error": lambda p, u: 1.08 * p(u) + 0.1,
    }


def gap_of(name, plant, ratio_db=20.0, seed=0, samples=4000):
    """Make the records of one effect at a gap-to-noise ratio; tell the noise."""
    rng = np.random.default_rng(seed)
    effect = effects(rng)[name]
    pairs = [(n, u, effect(plant, u), plant(u), p) for n, u, p in inputs(samples, seed)]
    gap = np.sqrt(np.mean(np.concatenate([(y - s) ** 2 for _, _, y, s, _ in pairs])))
    noise = gap / 10 ** (ratio_db / 20)
    return [
        compare(n, u, y + noise * rng.standard_normal(len(u)), s, p)
        for n, u, y, s, p in pairs
    ], noise


def compare(name, u, y, simulated, period=None, dt=DT):
    record = Record(
        name,
        dt,
        np.array(u),
        np.array(y),
        Channel("current", "A"),
        Channel("displacement", "um"),
        "twin",
        period_samples=period,
    )
    return Compared(record, np.array(simulated))

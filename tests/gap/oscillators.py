"""Oscillators of known kinds, driven by a multisine, by Runge and Kutta's rule.

All are simulated at once, a column each, with a mass of one. Written apart from the
blocks of hystbench.
"""

from __future__ import annotations

import numpy as np

DT = 1 / 128
PERIOD = 2048
STEPS = 3
HERTZ = 8.0
DAMPING = 0.02
SPEED = 2 * np.pi * HERTZ

KINDS = {
    "linear": {},
    "hardening": {"cubic": 0.4},
    "softening": {"soft": 0.6},
    "hysteresis": {"slip": 0.3},
    "coulomb": {"coulomb": 25.0},
    "clearance": {"gap": 0.1},
    "before": {"limit": 300.0},
}
LEVELS = (50.0, 100.0, 200.0, 400.0)


def multisine(seed=0, low=2.0, high=20.0):
    """Lines of one size and random phases, RMS one, PERIOD samples."""
    rng = np.random.default_rng(seed)
    frequency = np.fft.rfftfreq(PERIOD, DT)
    lines = np.zeros(len(frequency), dtype=complex)
    there = (frequency >= low) & (frequency <= high)
    lines[there] = np.exp(2j * np.pi * rng.random(there.sum()))
    u = np.fft.irfft(lines, PERIOD)
    return u / u.std()


def number_of(kinds, name, default):
    """Give a number of every kind, at every level."""
    values = [KINDS[kind].get(name, default) for kind in kinds]
    return np.repeat(values, len(LEVELS)).astype(float)


def simulate(kinds=tuple(KINDS), periods=3, seed=0):
    """Give input, position, velocity and acceleration by kind.

    Returns
    -------
    dict of str to ndarray, shape (4, levels, samples)
    """
    u = multisine(seed)
    spectrum = np.zeros(PERIOD * STEPS + 1, dtype=complex)
    spectrum[: PERIOD // 2 + 1] = np.fft.rfft(u)
    fine = np.fft.irfft(spectrum, 2 * STEPS * PERIOD) * 2 * STEPS
    size = np.tile(LEVELS, len(kinds))
    cubic, soft = (number_of(kinds, name, 0.0) for name in ("cubic", "soft"))
    slip, gap = (number_of(kinds, name, np.inf) for name in ("slip", "gap"))
    coulomb = number_of(kinds, "coulomb", 0.0)
    limit = number_of(kinds, "limit", np.inf)
    bounded = np.isfinite(limit)
    square = SPEED**2
    loose, held = (
        share * square * np.isfinite(most) for share, most in ((0.5, gap), (0.3, slip))
    )
    # What drives the masses at every instant: saturated before, where that is.
    forces = np.outer(fine, size)
    forces[:, bounded] = limit[bounded] * np.tanh(forces[:, bounded] / limit[bounded])

    def rate(state, driven):
        x, v, h = state
        spring = square * (cubic * x**3 + x / np.sqrt(1 + soft * x**2))
        # Bouc and Wen's spring in the place of a third of the stiffness.
        spring += held * (h - x) - loose * np.clip(x, -gap, gap)
        damped = 2 * DAMPING * SPEED * v + coulomb * np.tanh(v / 0.2)
        inside = (np.abs(h) / slip) ** 2 * 0.5 * (1 + np.sign(v * h))
        return np.array([v, driven - spring - damped, v * (1 - inside)])

    state = np.zeros((3, len(size)))
    out = np.zeros((4, len(size), periods * PERIOD))
    step = DT / STEPS
    for k in range(periods * PERIOD):
        place = 2 * STEPS * k
        out[:, :, k] = [
            size * fine[place % len(fine)],
            state[0],
            state[1],
            rate(state, forces[place % len(forces)])[1],
        ]
        for j in range(STEPS):
            first, middle, last = (
                forces[(place + 2 * j + i) % len(forces)] for i in range(3)
            )
            a = rate(state, first)
            b = rate(state + step / 2 * a, middle)
            c = rate(state + step / 2 * b, middle)
            d = rate(state + step * c, last)
            state = state + step / 6 * (a + 2 * b + 2 * c + d)
    whole = out.reshape(4, len(kinds), len(LEVELS), -1)
    return {kind: whole[:, k] for k, kind in enumerate(kinds)}

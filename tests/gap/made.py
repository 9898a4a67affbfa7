"""Records for the tests of the gap, from plain numpy."""

import numpy as np

from hystbench.gap.compared import Compared
from hystbench.record import Channel, Record

CURRENT = Channel("current", "A")
DISPLACEMENT = Channel("displacement", "um")


def record(u, y=None, *, name="made", dt=0.001, use="fit", period_samples=None):
    u = np.array(u, dtype=float)
    y = np.zeros_like(u) if y is None else np.array(y, dtype=float)
    return Record(name, dt, u, y, CURRENT, DISPLACEMENT, "twin", use, period_samples)


def sine(frequency_hz, *, amplitude=1.0, count=2000, dt=0.001, phase=0.0):
    time = np.arange(count) * dt
    return amplitude * np.sin(2 * np.pi * frequency_hz * time + phase)


def compared(u, residual, *, simulated=None, **about):
    """A record whose residual is the given one."""
    simulated = 5 * np.asarray(u) if simulated is None else simulated
    made = record(u, simulated + residual, **about)
    return Compared(made, simulated)

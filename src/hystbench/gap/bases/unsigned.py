"""Records of a sensor that does not show the sign, with the sign put back.

The speed of a shaft counted in pulses is a magnitude. No linear model has it as its
output, but one has the speed itself: its sign is that of a linear model's output, which
is fitted to the output with that sign. The two are found in turn, from the signs of the
input behind lags of several lengths.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from hystbench.blocks.drive_lag import DriveLag
from hystbench.gap.bases.orders import ROUGH, Orders
from hystbench.gap.records.evidence import Evidence
from hystbench.record import FloatArray

TURNS = 8
"""Times that signs are found anew, at most."""
LAGS = 4
"""Lengths of the lag, from a sample to a tenth of the shortest record."""
BOTH = 0.02
"""Share of the samples that must have either sign: else nothing is hidden."""
BELOW = 0.05
"""Share of the output's size by which noise may bring a magnitude below zero."""
NEAR = 0.1
"""Least magnitude that is shown, as a share of it: a speed that turns around passes
zero."""


def with_signs(evidence: Evidence) -> Evidence | None:
    """Give the output of the fit records a sign, where the sensor may not show it.

    Returns
    -------
    Evidence or None
        None where outputs are below zero, or a linear model turns around in none.
    """
    fit = evidence.fit
    if any(float(x.y.min()) < -BELOW * float(x.y.max()) for x in fit):
        return None
    if not any(float(x.y.min()) < NEAR * float(x.y.max()) for x in fit):
        return None
    if not any(float(x.u.min()) < 0.0 < float(x.u.max()) for x in fit):
        return None
    best: tuple[float, Evidence] | None = None
    for signs in _beginnings(evidence):
        for _ in range(TURNS):
            pairs = zip(fit, signs, strict=True)
            signed = replace(
                evidence, fit=tuple(replace(x, y=s * x.y) for x, s in pairs)
            )
            orders = Orders(signed)
            shown = _simulated(orders)
            off = _off(shown, orders)
            if best is None or off < best[0]:
                best = off, signed
            anew = tuple(np.where(y < 0.0, -1.0, 1.0) for y in shown)
            if all(np.array_equal(a, b) for a, b in zip(anew, signs, strict=True)):
                break
            signs = anew
    if best is None:
        return None
    below = np.mean(np.concatenate([x.y for x in best[1].fit]) < 0.0)
    return best[1] if BOTH < below < 1.0 - BOTH else None


def _beginnings(evidence: Evidence) -> Iterator[tuple[FloatArray, ...]]:
    """Give the signs of the inputs behind lags."""
    step = min(x.dt for x in evidence.fit)
    long = min(x.dt * len(x) for x in evidence.fit) / 10
    able = DriveLag.parameters()["time_constant_s"]
    lags = np.geomspace(step, max(long, 2 * step), LAGS)
    for lag in np.clip(lags, able.low, able.high).tolist():
        block = DriveLag(time_constant_s=lag, hold="linear")
        late = (block.simulate(x.u, x.u, x.dt) for x in evidence.fit)
        yield tuple(np.where(z < 0.0, -1.0, 1.0) for z in late)


def _simulated(orders: Orders) -> list[FloatArray]:
    """Fit a ratio of one order and simulate it, one output a record."""
    task, ratio = orders.roughly(ROUGH - 1)
    return task.simulate(ratio)


def _off(shown: list[FloatArray], orders: Orders) -> float:
    """Sum the squares of what the magnitude of a model's output is off."""
    return sum(
        float(np.sum((np.abs(y) - np.abs(x.y))[mask] ** 2))
        for y, x, mask in zip(shown, orders.evidence.fit, orders.whole, strict=True)
    )

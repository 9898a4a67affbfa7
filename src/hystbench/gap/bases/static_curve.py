"""Records of a device that begins with a static curve, with its output as the input.

A motor that a dead zone holds follows no gain. Where a record sweeps through the dead
zone, poles and zeros of the best linear model imitate it, and beside them it no longer
shows. So a linear model is also looked for behind a curve of no given form.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from hystbench.blocks.base import Block
from hystbench.blocks.starts import started
from hystbench.gap.bases.orders import ROUGH, Orders
from hystbench.gap.bases.sums import summed
from hystbench.gap.records.evidence import Evidence
from hystbench.gap.thresholds import LOOSE, MOST, NUMBER_PAYS
from hystbench.record import FloatArray, Record

KNOTS = 8
"""Where the curve bends, at equal distances over the range of the inputs."""
TURNS = 4
"""Times that both are found anew, at most."""


def behind_a_curve(
    evidence: Evidence, chain: Sequence[Block], off: float
) -> Evidence | None:
    """Give the fit records with what a static curve makes of their inputs.

    The curve is solved for with nothing behind it, and with a linear model; then that
    model and the curve are found in turn. The curve gives nothing for no input, and its
    mean slope over the records is one.

    Parameters
    ----------
    evidence : Evidence
    chain : sequence of Block
        The linear model that was found without a curve.
    off : float
        Its rms error on the fit records.

    Returns
    -------
    Evidence or None
        None where no curve leaves less than a quarter of the power of that, where a
        line has no part in it, as in a square, or in windows of a mass that nothing
        holds: what those forget of their start depends on the input.
    """
    if evidence.in_windows:
        return None
    every = np.concatenate([record.u for record in evidence.fit])
    knots = np.linspace(every.min(), every.max(), KNOTS + 2)[1:-1]
    orders = Orders(evidence)
    beginnings = (_solved(orders, knots, own) for own in ((), tuple(chain)))
    found = min((_in_turn(orders, knots, x, off) for x in beginnings), key=_left)
    bent = np.concatenate([record.u for record in found.evidence.fit])
    if found.left**2 > LOOSE * off**2 or np.var(every) < NUMBER_PAYS * np.var(bent):
        return None
    return found.evidence


@dataclass(frozen=True)
class _Curve:
    """A curve in front of a linear model."""

    evidence: Evidence
    """Records with its output as the input."""
    left: float
    """RMS error of both."""


def _left(curve: _Curve) -> float:
    return curve.left


def _in_turn(orders: Orders, knots: FloatArray, begun: _Curve, off: float) -> _Curve:
    """Find the linear model and the curve in turn, where the curve takes most."""
    best = begun
    for _ in range(TURNS):
        if best.left**2 > MOST * off**2:
            break
        again = _solved(orders, knots, (_linear_behind(best),))
        if again.left >= best.left:
            break
        best = again
    return best


def _solved(orders: Orders, knots: FloatArray, behind: Sequence[Block]) -> _Curve:
    """Solve for the curve in front of linear blocks."""
    evidence = orders.evidence
    bent = [_bends(record.u, knots) for record in evidence.fit]
    signals = [_sent(behind, *own) for own in zip(evidence.fit, bent, strict=True)]
    left, _, numbers = summed(signals, orders)
    curved = [columns @ numbers[:-1] for columns in bent]
    fit = _of_mean_slope(evidence.fit, curved)
    return _Curve(replace(evidence, fit=fit), left)


def _linear_behind(curve: _Curve) -> Block:
    """Fit a ratio of one order to what comes out of a curve."""
    task, ratio = Orders(curve.evidence).roughly(ROUGH)
    return task.block(ratio)


def _bends(u: FloatArray, knots: FloatArray) -> FloatArray:
    """Give the signals that a curve through zero is a sum of, shape (n, 1 + knots)."""
    beyond = u[:, None] - knots
    bent = np.where(knots > 0.0, np.maximum(beyond, 0.0), np.minimum(beyond, 0.0))
    return np.column_stack([u, bent])


def _sent(behind: Sequence[Block], record: Record, bent: FloatArray) -> FloatArray:
    """Send signals through linear blocks, and put ones beside them."""
    columns = []
    for z in bent.T:
        for block in behind:
            z = started(block, record).simulate(z, record.u, record.dt)
        columns.append(z)
    return np.column_stack([*columns, np.ones(len(bent))])


def _of_mean_slope(
    records: Sequence[Record], curved: Sequence[FloatArray]
) -> tuple[Record, ...]:
    """Give the records with a curve's outputs, of a mean slope of one."""
    u, z = (np.concatenate(x) for x in ([record.u for record in records], curved))
    slope = float(np.polyfit(u, z, 1)[0])
    return tuple(
        replace(record, u=own / slope)
        for record, own in zip(records, curved, strict=True)
    )

"""Linear bases that are sums of signals, each times a number: a gain, an impedance."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from hystbench.blocks.base import Block
from hystbench.blocks.gain import Gain
from hystbench.blocks.impedance import INPUTS, NUMBERS, Impedance
from hystbench.gap.bases.orders import Judged, Orders
from hystbench.gap.bases.output_error import own_columns
from hystbench.gap.records.scored_samples import without
from hystbench.record import FloatArray, Mask


@dataclass(frozen=True)
class Sum(Judged):
    """A base that is the sum of some signals, each times a number."""

    chain: tuple[Block, ...]
    words: str


def static(orders: Orders) -> Sum:
    """Fit a gain and a constant."""
    signals = [np.column_stack([x.u, np.ones(len(x))]) for x in orders.evidence.fit]
    fit, folds, (value, offset) = summed(signals, orders)
    chain = (Gain(value=value, offset=offset),)
    return Sum(fit, folds, orders.constant, chain, "order 0 (a gain and an offset)")


def summed(
    signals: Sequence[FloatArray], orders: Orders
) -> tuple[float, float, list[float]]:
    """Fit a sum of signals: error on all records, on the folds, and the numbers.

    Parameters
    ----------
    signals : sequence of ndarray, shape (n, k)
        Of each record, in columns; the last is of ones.
    orders : Orders
        The records with their folds.
    """
    evidence, whole = orders.evidence, orders.whole
    sizes = np.maximum(np.sqrt(np.mean(np.vstack(signals) ** 2, axis=0)), 1e-300)
    scaled = [columns / sizes for columns in signals]
    outputs = [record.y for record in evidence.fit]
    own = own_columns(evidence.fit, evidence.own_offsets)

    def masked(parts: Sequence[FloatArray], masks: tuple[Mask, ...]) -> FloatArray:
        each = zip(parts, own, masks, strict=True)
        return np.concatenate([without(x[m], of[m]) for x, of, m in each])

    def solved(masks: tuple[Mask, ...]) -> FloatArray:
        left, right = masked(scaled, masks), masked(outputs, masks)
        return np.asarray(np.linalg.lstsq(left, right, rcond=None)[0], np.float64)

    def squares(numbers: FloatArray, masks: tuple[Mask, ...]) -> float:
        error = masked(outputs, masks) - masked(scaled, masks) @ numbers
        return float(error @ error)

    best = solved(whole)
    if evidence.own_offsets:  # the mean of what each record has of its own
        each = zip(scaled, outputs, whole, strict=True)
        best[-1] = np.mean(
            np.concatenate([(y - x @ best)[mask] for x, y, mask in each])
        )
    judged = sum(squares(solved(fold.train), fold.validation) for fold in orders.folds)
    count = sum(int(mask.sum()) for mask in whole)
    fit, folds = (float(np.sqrt(x / count)) for x in (squares(best, whole), judged))
    return fit, folds, (best / sizes).tolist()


def impedance(orders: Orders) -> Sum | None:
    """Fit the force of a mass on a spring to a motion; none to any other input.

    It grows with the frequency: a ratio of polynomials that can be run has no such.
    """
    evidence, about = orders.evidence, orders.evidence.quantities
    if about.causality != "motion to force" or about.input not in INPUTS:
        return None
    signals = [
        Impedance.columns(about.input, evidence.input_hold, record.u, record.dt)
        for record in evidence.fit
    ]
    fit, folds, found = summed(signals, orders)
    numbers: dict[str, Any] = dict(zip(NUMBERS, found, strict=True))
    block = Impedance(**numbers, input=about.input, hold=evidence.input_hold)
    return Sum(
        fit, folds, orders.constant, (block,), "the impedance of a mass on a spring"
    )

"""A given base whose numbers and timing are known only about, as in a laboratory."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import fields, replace

import numpy as np

from hystbench.blocks.base import Block
from hystbench.blocks.input_delay import InputDelay
from hystbench.blocks.simulator import Simulator
from hystbench.gap.bases.orders import HIGHEST
from hystbench.gap.thresholds import ABOUT
from hystbench.model import Model
from hystbench.record import Record

LATE = 2
"""Sampling intervals by which a recorded input may be late or early: each channel is
read within one."""


def known_about(base: Model, records: Sequence[Record]) -> Model | None:
    """Free what a given base states, each number by what it may be off.

    A number may be off by a share of itself, and the recorded input by two sampling
    intervals: one for each channel.

    Parameters
    ----------
    base : Model
    records : sequence of Record
        Their sampling intervals tell what timing is.

    Returns
    -------
    Model or None
        None where the base says itself what is free, or calls its numbers exact; where
        it cannot be run again, or its calls are dear.
    """
    dear = any(isinstance(x, Simulator) or not x.reruns for x in base.chain)
    if base.free or base.exact or dear:
        return None
    chain = _in_time(base.chain, LATE * min(record.dt for record in records))
    shift = len(chain) - len(base.chain)
    model = replace(base, chain=chain, provenance={})
    labels = [label for label, _ in model.labelled()]
    shares = {
        f"{label}.{name}": ABOUT
        for label, block in zip(labels, chain, strict=True)
        for name in _stated(block)
    }
    shares |= {f"{labels[0]}.delay_s": 1.0} if shift else {}
    old = [label for label, _ in base.labelled()]
    now = dict(zip(old, labels[shift:], strict=True))
    told = {
        f"{now[name.rpartition('.')[0]]}.{name.rpartition('.')[2]}": item
        for name, item in base.provenance.items()
    }
    return replace(model, free=tuple(shares), tolerances=shares, provenance=told)


def _in_time(chain: tuple[Block, ...], most: float) -> tuple[Block, ...]:
    """Put a delay of nothing before a chain, which may grow, or become a lead.

    Nothing where the chain begins with a delay.
    """
    if isinstance(chain[0], InputDelay):
        return chain
    return (InputDelay(delay_s=most, lead_s=most), *chain)


def _stated(block: Block) -> list[str]:
    """Give the numbers of a block that are not what they are where nobody states them.

    None of a hysteresis, a wrong shape of which is looked for anyway, nor of a delay,
    as timing is free. Of many poles a small step of one coefficient alone may make a
    model unstable.
    """
    if block.hysteretic or isinstance(block, InputDelay):
        return []
    usual = {item.name: item.default for item in fields(block)}
    found = []
    for name in block.parameters():
        value = getattr(block, name)
        if isinstance(value, str) or value == usual.get(name):
            continue
        numbers = np.atleast_1d(np.asarray(value, dtype=float))
        poles = name == "denominator" and len(numbers) > HIGHEST + 1
        if np.isfinite(numbers).all() and numbers.any() and not poles:
            found.append(name)
    return found

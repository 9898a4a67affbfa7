"""A given base whose numbers and timing are known only about, as in a laboratory."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import fields, replace
from typing import Any

import numpy as np

from hystbench.blocks.base import Block
from hystbench.blocks.input_delay import InputDelay
from hystbench.blocks.simulator import Simulator
from hystbench.gap.bases.linear import IdentifiedModel
from hystbench.gap.bases.orders import HIGHEST
from hystbench.gap.thresholds import ABOUT
from hystbench.model import Model
from hystbench.model_content import Provenance
from hystbench.record import Record

LATE = 2
"""Sampling intervals by which a recorded input may be late or early: each channel is
read within one."""


def roughly_known(base: Model, records: Sequence[Record]) -> Model | None:
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
        it cannot be run again, its calls are dear, or it was identified as a linear
        one.
    """
    dear = any(isinstance(x, Simulator) or not x.reruns for x in base.chain)
    if base.free or base.exact or dear or isinstance(base, IdentifiedModel):
        return None
    chain = behind_a_delay(base.chain, LATE * min(record.dt for record in records))
    model = replace(base, chain=chain, provenance={})
    first, *labels = (label for label, _ in model.labelled())
    shares = {
        f"{label}.{name}": ABOUT
        for label, block in zip(labels, base.chain, strict=True)
        for name in stated(block)
    }
    shares[f"{first}.delay_s"] = 1.0
    now = dict(zip((label for label, _ in base.labelled()), labels, strict=True))
    return replace(
        model, free=tuple(shares), tolerances=shares, provenance=_told(base, now)
    )


def behind_a_delay(chain: tuple[Block, ...], most: float) -> tuple[Block, ...]:
    """Put a delay of nothing before a chain, which may grow, or become a lead."""
    return (InputDelay(delay_s=most, lead_s=most), *chain)


def as_it_was(model: Model) -> Model:
    """Give back the base that :func:`roughly_known` was given; any other as it is."""
    first, *rest = model.chain
    timing = isinstance(first, InputDelay) and first.delay_s == first.lead_s > 0.0
    if not (timing and model.tolerances):
        return model
    given = replace(model, chain=tuple(rest), free=(), tolerances={}, provenance={})
    old, new = ([label for label, _ in each.labelled()] for each in (model, given))
    now = dict(zip(old[1:], new, strict=True))
    return replace(given, provenance=_told(model, now))


def _told(model: Model, labels: Mapping[str, str]) -> dict[str, Provenance]:
    """Give where numbers come from, by the labels that their blocks have now."""
    found = {}
    for name, item in model.provenance.items():
        label, _, parameter = name.rpartition(".")
        found[f"{labels[label]}.{parameter}"] = item
    return found


def defaults(block: Block) -> dict[str, Any]:
    """Give what each parameter of a block is where nobody states it, by name."""
    usual = {item.name: item.default for item in fields(block)}
    return {name: usual[name] for name in block.parameters()}


def stated(block: Block) -> list[str]:
    """Give the numbers of a block that are not what they are where nobody states them.

    None of a delay, as timing is free, and no count. Of many poles a small step of one
    coefficient alone may make a model unstable.
    """
    if isinstance(block, InputDelay):
        return []
    found = []
    for name, usual in defaults(block).items():
        value, about = getattr(block, name), block.parameters()[name]
        if isinstance(value, str) or value == usual or about.whole:
            continue
        numbers = np.atleast_1d(np.asarray(value, dtype=float))
        poles = name == "denominator" and len(numbers) > HIGHEST + 1
        if np.isfinite(numbers).all() and numbers.any() and not poles:
            found.append(name)
    return found

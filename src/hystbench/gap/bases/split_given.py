"""A transfer function that was given, as two in series where a curve may lie inside."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from hystbench.blocks.base import Block
from hystbench.blocks.gain import Gain
from hystbench.blocks.transfer_function import TransferFunction
from hystbench.gap.bases.spectral import Ratio
from hystbench.gap.bases.split_linear import ENOUGH, parts_of, ways_at_ends, ways_inside
from hystbench.gap.bases.wiener_hammerstein import HalvesError
from hystbench.gap.records.evidence import Evidence
from hystbench.model import Model

SAME = 1e-3
"""Share of the output's range by which a split may change it, at its beginning."""


def split_given(model: Model, evidence: Evidence) -> tuple[Model, str]:
    """Write a transfer function in series where a static curve inside explains much.

    The model does what it did. Its poles and zeros are dealt to two halves in every
    way; a polynomial between them must leave clearly less on the fit records than one
    before or behind the whole.

    Parameters
    ----------
    model : Model
        Split if it is one transfer function of order two or more, and gains behind it.
    evidence : Evidence
        Only its fit records are looked at.

    Returns
    -------
    Model
        The same where there is nothing to split.
    str
        A few words where it was split.
    """
    block, *behind = model.chain
    if not isinstance(block, TransferFunction) or len(block.denominator) < 3:
        return model, ""
    if block.integrates:  # its response goes on for ever, which spectra do not hold
        return model, ""
    if not all(isinstance(item, Gain) for item in behind):
        return model, ""
    scale, ratio = _ratio(block)
    whole = tuple(record.counted for record in evidence.fit)
    task = HalvesError(evidence.fit, whole, evidence.input_hold, scale, block.start)
    ends = [task.bent(way) for way in ways_at_ends(ratio)]
    ways = [task.bent(way) for way in ways_inside(ratio)]
    best = min(ways, key=lambda way: way.cost, default=None)
    if best is None or best.cost > ENOUGH * min(end.cost for end in ends):
        return model, ""
    front, back, middle = parts_of(task, best)
    static = block.numerator[-1] / block.denominator[-1]
    # The halves hold poles and zeros; the back takes the whole's gain.
    own = np.polymul(front.numerator, back.numerator)[0]
    own /= front.denominator[0] * back.denominator[0]
    gain = np.trim_zeros(np.array(block.numerator), "f")[0] / block.denominator[0] / own
    back = replace(back, numerator=tuple(gain * x for x in back.numerator))
    between = Gain(value=1.0, offset=-middle)
    after = Gain(value=1.0, offset=middle * static)
    split = _with(model, (front, between, back, after))
    if not _same(model, split, evidence):
        # A start from rest knows no offset: the signal is counted from its zero.
        split = _with(model, (front, replace(back, start=block.start)))
    words = (
        f"; its transfer function is written as two in series, of order "
        f"{len(best.front.a)} and {len(best.back.a)}, since a static curve between "
        "them explains much"
    )
    return split, words


def _ratio(block: TransferFunction) -> tuple[float, Ratio]:
    """Give the scale of a transfer function and its ratio in that scale."""
    down = np.array(block.denominator[::-1])
    up = np.array(block.numerator[::-1])
    order = len(down) - 1
    scale = float(abs(down[0] / down[-1]) ** (1 / order))
    top = down[-1] * scale**order
    a = down * scale ** np.arange(order + 1) / top
    b = up * scale ** np.arange(len(up)) / top
    return scale, Ratio(a[:-1], np.trim_zeros(b, "b"), 0.0, np.inf)


def _with(model: Model, blocks: tuple[Block, ...]) -> Model:
    """Put blocks in the place of the first, its free numbers being those of both."""
    chain = (*blocks, *model.chain[1:])
    split = replace(model, chain=chain, free=(), tolerances={}, provenance={})
    old, new = ([label for label, _ in each.labelled()] for each in (model, split))
    halves = [label for label in new if label.startswith("transfer-function")]
    labels = {old[0]: halves}
    labels |= {a: [b] for a, b in zip(old[1:], new[len(blocks) :], strict=True)}

    def named(name: str) -> list[str]:
        label, _, parameter = name.rpartition(".")
        return [f"{each}.{parameter}" for each in labels[label]]

    shares: Mapping[str, float] = model.tolerances
    return replace(
        split,
        free=tuple(new for name in model.free for new in named(name)),
        tolerances={n: share for k, share in shares.items() for n in named(k)},
    )


def _same(model: Model, split: Model, evidence: Evidence) -> bool:
    model, split = (each.with_hold(evidence.input_hold) for each in (model, split))
    for record in evidence.fit:
        y, other = (each.simulate(record.u, record.dt) for each in (model, split))
        if float(np.abs(y - other).max()) > SAME * float(np.ptp(y)):
            return False
    return True

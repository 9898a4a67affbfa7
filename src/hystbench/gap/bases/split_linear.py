"""A linear base as two in series, where a static curve between them explains much.

Behind a static nonlinearity between two filters the best linear model is, for a
Gaussian input, the product of both filters [1]_: nothing of the curve shows in it, and
no effect before or behind it makes up for the curve. Its poles and zeros are dealt to
two halves in every way, and each way is judged by how well it does with a polynomial
between the halves [2]_. The polynomial is then dropped: the base stays linear, and has
a place where an effect can be tried.

References
----------
.. [1] J. J. Bussgang, "Crosscorrelation functions of amplitude-distorted Gaussian
   signals", MIT Research Laboratory of Electronics, Technical Report 216, 1952.
.. [2] J. Sjoberg, J. Schoukens, "Initializing Wiener-Hammerstein models based on
   partitioning of the best linear approximation", Automatica 48 (2012) 353-359.
"""

from __future__ import annotations

import itertools
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from operator import attrgetter

import numpy as np

from hystbench.blocks.base import Block
from hystbench.blocks.gain import Gain
from hystbench.blocks.held import Hold
from hystbench.blocks.starts import started
from hystbench.blocks.transfer_function import TransferFunction
from hystbench.cores import each
from hystbench.gap.bases.spectral import Ratio, Rational
from hystbench.gap.bases.wiener_hammerstein import Halves, HalvesError
from hystbench.gap.records.evidence import Evidence
from hystbench.gap.records.folds import Fold
from hystbench.gap.thresholds import LOOSE, NUMBER_PAYS
from hystbench.model import Model
from hystbench.record import FloatArray

COST = attrgetter("cost")
#: Of the error's power a curve inside leaves no more, beside one at either end.
ENOUGH = 1 - LOOSE
#: With more ways to deal poles and zeros, all zeros stay together.
MOST_WAYS = 512
#: Ways that are refined a little, and steps of it; steps to the end, and on a fold.
LIKELY = 3
ROUNDS = 5
TO_THE_END = 40
FOLD_ROUNDS = 4
ROUGHLY_S = 0.1
"""Seconds that halves take to be refined."""
#: Poles of both halves together, at most.
HIGHEST = 8
#: A new pole or zero starts beyond the others, at so many times the scale.
BEYOND = 5.0


def is_bent(task: HalvesError, ratios: Sequence[Ratio]) -> bool:
    """Tell whether a static curve somewhere pays at all; a quick look."""
    ways = (
        way for ratio in ratios for way in (*ways_at_ends(ratio), *ways_inside(ratio))
    )
    linear = min(ratio.cost for ratio in ratios)
    return any(task.bent(way).cost < ENOUGH * linear for way in ways)


def best_split(
    task: HalvesError, ratios: Sequence[Ratio], folds: Sequence[Fold]
) -> Halves | None:
    """Find the two halves between which a static curve explains most.

    Parameters
    ----------
    task : HalvesError
    ratios : sequence of Ratio
        Linear models of the records, of several orders.
    folds : sequence of Fold
        Of the same records.

    Returns
    -------
    Halves or None
        None where a curve at one end does nearly as well on samples that did not fit
        it.
    """
    ends = [task.bent(way) for ratio in ratios for way in ways_at_ends(ratio)]
    ways = [[task.bent(way) for way in ways_inside(ratio)] for ratio in ratios]
    end = task.refined(min(ends, key=COST), TO_THE_END)
    likely = [way for own in ways for way in sorted(own, key=COST)[:LIKELY]]
    tried = _refined(task, likely)
    best = min(tried, key=COST, default=None)
    if best is None or best.cost > ENOUGH * end.cost:
        return None
    enough = [way for way in tried if way.cost <= best.cost / (1 - NUMBER_PAYS) ** 2]
    fewest = min(enough, key=lambda way: (way.count, way.cost))
    fewest = task.refined(fewest, TO_THE_END)
    grown = _grown(task, fewest)
    # What has grown too long follows the records, and is worse on folds.
    tried = [fewest] if grown is fewest else [grown, fewest]
    on_folds = [_on_folds(task, way, folds) for way in tried]
    least = int(np.argmin(on_folds))
    outside = _on_folds(task, end, folds)
    return tried[least] if on_folds[least] < ENOUGH * outside else None


def chain_of(task: HalvesError, halves: Halves) -> tuple[tuple[Block, ...], float]:
    """Write halves as blocks, the curve left out.

    The gain between them has an offset: the signal is counted from the point about
    which the curve is odd. To a linear base that is nothing, as the constant at the
    end takes it off again.

    Returns
    -------
    tuple of Block
    float
        Sum of squares of what the chain leaves, over the samples that count.
    """
    front, back, middle = parts_of(task, halves)
    chain: tuple[Block, ...] = (front, Gain(value=1.0, offset=-middle), back)
    value, offset, error = _line(task, chain)
    scaled = replace(back, numerator=tuple(value * x for x in back.numerator))
    return (*chain[:-1], scaled, Gain(value=1.0, offset=offset)), error


def parts_of(
    task: HalvesError, halves: Halves
) -> tuple[TransferFunction, TransferFunction, float]:
    """Give the blocks of both halves, and the point about which the curve is odd.

    The front has a gain of one where it has any.
    """
    a, b = halves.front.a, halves.front.b
    unit = b[0] / a[0] if b[0] else 1.0
    front = Rational(a, b / unit).block(task.scale, task.hold, task.start)
    after = task.start if task.start != "rest" else "settled"
    # A staircase is smooth behind the front.
    smooth: Hold = "linear" if task.hold == "zero-order" else task.hold
    back = halves.back.block(task.scale, smooth, after)
    return front, back, task.middle(halves) / unit


def _line(task: HalvesError, chain: tuple[Block, ...]) -> tuple[float, float, float]:
    """Fit a gain and a constant behind a chain, and give the sum of squares left."""
    tables, wanted = [], []
    for record, mask in zip(task.records, task.masks, strict=True):
        z = record.u
        for block in chain:
            z = started(block, record).simulate(z, record.u, record.dt)
        tables.append(np.column_stack([z, np.ones(len(z))])[mask])
        wanted.append(record.y[mask])
    table, y = np.vstack(tables), np.concatenate(wanted)
    value, offset = np.linalg.lstsq(table, y, rcond=None)[0]
    error = y - value * table[:, 0] - offset
    return float(value), float(offset), float(error @ error)


def _grown(task: HalvesError, halves: Halves) -> Halves:
    """Give either half a further pole, or zero, as long as one matters.

    The order of a linear model is hidden in what the curve distorts.
    """
    while True:
        longer = [
            way
            for way in _more(halves)
            if len(way.front.a) + len(way.back.a) <= HIGHEST
        ]
        tried = _refined(task, longer)
        if not tried:
            return halves
        best = task.refined(min(tried, key=COST), TO_THE_END)
        if best.cost > (1 - NUMBER_PAYS) ** 2 * halves.cost:
            return halves
        halves = best


def _refined(task: HalvesError, every: Sequence[Halves]) -> list[Halves]:
    """Refine several halves a little."""
    return each(
        lambda way: task.refined(way, ROUNDS), every, "halves", seconds=ROUGHLY_S
    )


def _more(halves: Halves) -> Iterator[Halves]:
    """Give halves with one more pole, one more zero, or both, far out."""
    for front in _longer(halves.front):
        yield replace(halves, front=front)
    for back in _longer(halves.back):
        yield replace(halves, back=back)


def _longer(half: Rational) -> Iterator[Rational]:
    a, b, far = half.a, half.b, np.array([BEYOND, 1.0])
    pole, zero = np.convolve(np.append(a, 1.0), far)[:-1], np.convolve(b, far / BEYOND)
    yield Rational(pole, BEYOND * b)
    yield Rational(pole, BEYOND * zero)
    if len(b) <= len(a):
        yield Rational(a, zero)


def _on_folds(task: HalvesError, halves: Halves, folds: Sequence[Fold]) -> float:
    """Sum of squares over samples that did not fit."""

    def squares(fold: Fold) -> float:
        train = replace(task, masks=fold.train)
        # A polynomial says nothing beyond what it was fitted to.
        fitted = train.within(train.refined(halves, FOLD_ROUNDS))
        return replace(task, masks=fold.validation).squares(fitted)

    return sum(each(squares, folds, "halves on folds", seconds=ROUGHLY_S))


def ways_at_ends(ratio: Ratio) -> Iterator[Halves]:
    """Give the curve before a linear model and behind it."""
    nothing, whole = Rational(np.zeros(0), np.ones(1)), Rational(ratio.a, ratio.b)
    yield Halves(nothing, whole)
    yield Halves(whole, nothing)


def ways_inside(ratio: Ratio) -> Iterator[Halves]:
    """Deal poles and zeros to two halves, both proper and both with a pole."""
    poles, zeros = _pairs(np.append(ratio.a, 1.0)), _pairs(ratio.b)
    choices = list(itertools.product((False, True), repeat=len(zeros)))
    if 2 ** (len(poles) + len(zeros)) > MOST_WAYS:
        choices = [choices[0], choices[-1]]
    for of_poles in itertools.product((False, True), repeat=len(poles)):
        front_a, back_a = _dealt(poles, of_poles)
        for of_zeros in choices:
            front_b, back_b = _dealt(zeros, of_zeros)
            proper = len(front_b) <= len(front_a) and len(back_b) <= len(back_a)
            if proper and len(front_a) > 1 and len(back_a) > 1:
                # a gain of one for constants, unless it lets none through
                static = front_b[0] / front_a[0] or 1.0
                front = Rational(front_a[:-1], front_b / static)
                yield Halves(front, Rational(back_a[:-1], back_b))


def _pairs(ascending: FloatArray) -> list[list[complex]]:
    """Give real roots, and pairs of conjugate ones."""
    roots = np.roots(ascending[::-1])
    real = [[complex(x.real)] for x in roots if x.imag == 0]
    return real + [[complex(x), complex(x.conjugate())] for x in roots if x.imag > 0]


def _dealt(
    pairs: Sequence[Sequence[complex]], front: Sequence[bool]
) -> tuple[FloatArray, FloatArray]:
    """Give the polynomials of the roots of either side, ascending, the last one."""
    found = []
    for side in (True, False):
        own = [
            x for pair, to in zip(pairs, front, strict=True) if to is side for x in pair
        ]
        found.append(np.atleast_1d(np.real(np.poly(np.array(own))))[::-1].copy())
    return found[0], found[1]


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
    scale, ratio = _scaled(block)
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
    split = _in_series(model, (front, between, back, after))
    if not _same(model, split, evidence):
        # A start from rest knows no offset: the signal is counted from its zero.
        split = _in_series(model, (front, replace(back, start=block.start)))
    words = (
        f"; its transfer function is written as two in series, of order "
        f"{len(best.front.a)} and {len(best.back.a)}, since a static curve between "
        "them explains much"
    )
    return split, words


def _scaled(block: TransferFunction) -> tuple[float, Ratio]:
    """Give the scale of a transfer function and its ratio in that scale."""
    down = np.array(block.denominator[::-1])
    up = np.array(block.numerator[::-1])
    order = len(down) - 1
    scale = float(abs(down[0] / down[-1]) ** (1 / order))
    top = down[-1] * scale**order
    a = down * scale ** np.arange(order + 1) / top
    b = up * scale ** np.arange(len(up)) / top
    return scale, Ratio(a[:-1], np.trim_zeros(b, "b"), 0.0, np.inf)


def _in_series(model: Model, blocks: tuple[Block, ...]) -> Model:
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

"""What a hysteresis of the wrong shape could do, spanned without any truth.

Powers of what enters the hysteresis, powers of play operators of it (sums of play
operators approximate any Prandtl-Ishlinskii operator, sums of their powers much of a
Preisach operator), loops that forget along the way (as of Duhem's equation), each
operator of the chain's own hysteresis and the tangents of its envelopes, all sent
through the blocks behind the hysteresis.

Of a simulator whose inside is not seen the same is made of what it gives as well: what
else may lie in it, behind its hysteresis, is in there.
"""

from __future__ import annotations

import itertools
from collections.abc import Callable, Sequence
from dataclasses import replace
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from hystbench.blocks.base import Block
from hystbench.blocks.force import against
from hystbench.blocks.gpi import GeneralizedPrandtlIshlinskii
from hystbench.blocks.hysteretic_force import HystereticForce
from hystbench.blocks.linear import LinearBlock
from hystbench.gap.records.scored_samples import ScoredSamples
from hystbench.gap.simulation.shared import Same
from hystbench.gap.simulation.simulation import Signals, Simulation
from hystbench.operators import play
from hystbench.record import FloatArray

POWERS, OPERATORS, OPERATOR_POWERS = 5, 10, 3
"""Powers of a signal; play operators of it; powers of each of these."""
MIXED = 6
"""Play operators, the input among them, of which products are taken."""
FORGETTING_WAYS = (0.05, 0.15, 0.4, 1.0, 3.0)
"""Ways in which loops forget, as shares of the largest input."""
SLOPES, HEIGHTS, LEVELS = (1, 5), (0, 4), (0, 3, 4, 7)
"""Which of the envelope functions' numbers a0 to a7 (Eqs. 5 and 6) are per unit of
input, which are heights, and which are in the unit of their output."""
LEAST_NUMBER = 0.1
"""Least size that a number counts as, in its unit."""
CHANGE_SHARE = 1e-3
"""Size of a change beside the signal that it changes."""
WEAKEST = 1e-3
"""Directions weaker than this share of the strongest are left out."""

Maker = Callable[[Block, Signals, Signals, ScoredSamples | None], list[Signals]]
"""Makes ways of a hysteresis, of what enters it and, unseen, what it gives."""


def reshapings(simulation: Simulation, sample: ScoredSamples) -> FloatArray:
    """Give what reshaping the hysteresis could add to the output.

    Returns
    -------
    ndarray, shape (scored samples, k)
        Without anything in the chain that holds a hysteresis, no column.
    """
    closing = closing_reshapings(simulation, sample)
    return np.hstack([closing, _behind(simulation, sample, _that_forget)])


def closing_reshapings(simulation: Simulation, sample: ScoredSamples) -> FloatArray:
    """Give the same but for loops that forget, so of loops whose small ones close.

    A loop that forgets is much like one that lags: beside it the numbers of a lag are
    hardly known.
    """
    return _behind(simulation, sample, _that_close)


def products(simulation: Simulation, sample: ScoredSamples) -> FloatArray:
    """Give what a hysteresis could add that is no sum of curves of play operators.

    Products of the input and of play operators of it, two of them or the square of one
    with another: they tell a hysteresis whose loops depend on where they lie, as of
    most materials, from one of play operators. Sent on as the reshapings are.

    What is returned is as of :func:`reshapings`.
    """
    return _behind(simulation, sample, _mixed)


def _behind(
    simulation: Simulation,
    sample: ScoredSamples,
    make: Maker,
) -> FloatArray:
    """Make signals of the hysteresis and send them through what follows it."""
    if simulation.loop is None:
        return np.zeros((len(sample), 0))
    behind = simulation.chain[simulation.behind_hysteresis :]
    # What nothing follows is wanted at the scored samples alone.
    wanted = None if behind else sample
    place = simulation.loop
    block, v = simulation.chain[place], simulation.at(place)
    given = () if block.seen else simulation.at(place + 1)
    ways = _made(make, block, Same(*v), Same(*given), Same(wanted))
    if not behind:
        return np.column_stack([np.concatenate(way) for way in ways])
    sent = _all_sent(simulation, Same(ways))
    if _are_linear(behind):
        return np.column_stack([sample.take(after) for after, _ in sent])
    now = sample.take(simulation.output)
    return np.column_stack(
        [(sample.take(after) - now) / change for after, change in sent]
    )


@lru_cache(maxsize=8)
def _made(
    make: Maker, block: Block, v: Same, given: Same, sample: Same
) -> list[Signals]:
    """Make the ways; kept, as chains often differ only in what follows."""
    return make(block, v.objects, given.objects, *sample.objects)


@lru_cache(maxsize=4)
def _all_sent(simulation: Simulation, given: Same) -> list[tuple[Signals, float]]:
    """Send each way on; kept, as more than one choice of samples is asked for."""
    behind = simulation.chain[simulation.behind_hysteresis :]
    (ways,) = given.objects
    return [_sent(simulation, behind, way) for way in ways]


def _are_linear(blocks: Sequence[Block]) -> bool:
    return all(isinstance(block, LinearBlock) for block in blocks)


def orthonormal(columns: FloatArray) -> FloatArray:
    """Give an orthonormal basis of columns, each scaled to one first."""
    if not columns.shape[1]:
        return columns
    # By the small Gram matrix: a full decomposition of the columns is ten times dearer,
    # and the weakest direction that is left is at right angles to 1e-10 of its size.
    gram = columns.T @ columns
    size = np.sqrt(gram.diagonal())
    usable = np.flatnonzero(np.isfinite(size) & (size > 0))
    size = size[usable]
    values, vectors = np.linalg.eigh(
        gram[np.ix_(usable, usable)] / np.outer(size, size)
    )
    keep = values > (WEAKEST**2) * values[-1]
    turned = vectors[:, keep] / (size[:, None] * np.sqrt(values[keep]))
    return np.asarray(columns[:, usable] @ turned)


def _that_close(
    block: Block, v: Signals, given: Signals, sample: ScoredSamples | None
) -> list[Signals]:
    """Give ways in which the output of a hysteresis could differ, of loops that close.

    They are made of what enters it and, where its inside is not seen, of what it gives.
    """
    ways: list[Signals] = [tuple(np.ones(len(z)) for z in _at(v, sample))]
    for signals in filter(None, (v, given)):
        ways += _powers(signals, sample)
    own: list[Signals] = []
    if isinstance(block, GeneralizedPrandtlIshlinskii):
        own = [_at(x, sample) for x in _own(block, v)]
    return ways + own


def _mixed(
    block: Block, v: Signals, given: Signals, sample: ScoredSamples | None
) -> list[Signals]:
    """Give products of what enters a hysteresis and of play operators of it."""
    amplitude = max(float(np.abs(z).max()) for z in v) or 1.0
    thresholds = np.arange(MIXED) / (MIXED + 1)  # the first is the input itself
    plays = [
        np.ascontiguousarray(play(z / amplitude, thresholds).T[:, _rows(k, sample)])
        for k, z in enumerate(v)
    ]
    each = range(MIXED)
    ways: list[Signals] = []
    for i, j in itertools.combinations(each, 2):
        ways.append(tuple(p[i] * p[j] for p in plays))
        ways.append(tuple(p[i] ** 2 * p[j] for p in plays))
        ways.append(tuple(p[i] * p[j] ** 2 for p in plays))
    return ways


def _rows(record: int, sample: ScoredSamples | None) -> slice | NDArray[np.intp]:
    return slice(None) if sample is None else sample.positions[record]


def _at(signals: Signals, sample: ScoredSamples | None) -> Signals:
    """Give whole signals, or their scored samples."""
    return tuple(z[_rows(k, sample)] for k, z in enumerate(signals))


def _powers(signals: Signals, sample: ScoredSamples | None) -> list[Signals]:
    """Give powers of signals and of play operators of them."""
    amplitude = max(float(np.abs(z).max()) for z in signals) or 1.0
    thresholds = amplitude * np.arange(1, OPERATORS + 1) / (OPERATORS + 1)
    scaled = _at(tuple(z / amplitude for z in signals), sample)
    plays = [
        np.ascontiguousarray(play(z, thresholds).T[:, _rows(k, sample)]) / amplitude
        for k, z in enumerate(signals)
    ]
    ways = []
    for base in (scaled, *zip(*plays, strict=True)):
        power = base
        for _ in range(POWERS if base is scaled else OPERATOR_POWERS):
            ways.append(power)
            power = tuple(a * b for a, b in zip(power, base, strict=True))
    return ways


def _that_forget(
    block: Block, v: Signals, given: Signals, sample: ScoredSamples | None
) -> list[Signals]:
    """Give loops that forget along the way, and products of them with the signal.

    Dahl's operator, ``dh = dz - |dz| h / way``, for a few ways. Their small loops do
    not close: no sum of play operators does so, while Duhem's equation does.
    """
    amplitude = max(float(np.abs(z).max()) for z in v) or 1.0
    scaled = tuple(np.concatenate([[0.0], z / amplitude]) for z in v)
    at = _at(tuple(z[1:] for z in scaled), sample)
    found: list[Signals] = []
    for way in FORGETTING_WAYS:
        law = HystereticForce(largest=way, yield_distance=way, sharing=0.0)
        loops = tuple(against((law,), z, np.zeros(len(z)), 1.0)[1:] for z in scaled)
        loops = _at(loops, sample)
        found += [loops, tuple(a * b for a, b in zip(loops, at, strict=True))]
    return found


def _own(block: GeneralizedPrandtlIshlinskii, v: Signals) -> list[Signals]:
    """Give a few groups of the block's operators, and tangents of its envelopes."""
    count = len(block.thresholds)
    groups = np.array_split(np.arange(count), min(count, OPERATORS))
    starts = [group[0] for group in groups]
    sums = [
        np.ascontiguousarray(np.add.reduceat(block.operators(z), starts, axis=1).T)
        for z in v
    ]
    ways: list[Signals] = [tuple(z[k] for z in sums) for k in range(len(groups))]
    now = [block.grow(z, z, 1.0, None) for z in v]
    slope = 1.0 / (max(float(np.abs(z).max()) for z in v) or 1.0)
    height = max(abs(block.envelope[k]) for k in HEIGHTS) or 1.0
    units = [slope if k in SLOPES else height if k in LEVELS else 1.0 for k in range(8)]
    for k, value in enumerate(block.envelope):
        moved = list(block.envelope)
        moved[k] = value + CHANGE_SHARE * max(abs(value), LEAST_NUMBER * units[k])
        other = replace(block, envelope=tuple(moved))
        ways.append(
            tuple(other.grow(z, z, 1.0, None) - y for z, y in zip(v, now, strict=True))
        )
    return ways


def _sent(
    simulation: Simulation, behind: tuple[Block, ...], signals: Signals
) -> tuple[Signals, float]:
    """Send a small change of the hysteresis's output through the blocks behind it.

    Give the output with the change, and how small the change is.
    """
    if _are_linear(behind):  # they answer to the change alone, of any size
        return simulation.run(behind, signals), 1.0
    now = simulation.at(simulation.behind_hysteresis)
    size = CHANGE_SHARE * simulation.largest(simulation.behind_hysteresis)
    largest = float(max(max(s.max(), -s.min()) for s in signals))
    change = size / max(largest, 1e-300)
    moved = tuple(z + change * s for z, s in zip(now, signals, strict=True))
    return simulation.run(behind, moved), change

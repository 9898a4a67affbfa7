"""What a hysteresis of the wrong shape could do, spanned without any truth.

Powers of what enters the hysteresis, powers of play operators of it (sums of play
operators approximate any Prandtl-Ishlinskii operator, sums of their powers much of a
Preisach operator), each operator of the chain's own hysteresis and the tangents of its
envelopes, all sent through the blocks behind the hysteresis.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from hystbench.blocks.base import Block
from hystbench.blocks.gpi import GeneralizedPrandtlIshlinskii
from hystbench.gap.sample import Sample
from hystbench.gap.scene import Scene, Signals
from hystbench.operators import play
from hystbench.record import FloatArray

POWERS = 5
OPERATORS = 10
OPERATOR_POWERS = 3
SMALL = 1e-3
"""Size of a change beside the signal that it changes."""
SMALLEST = 1e-3
"""Directions weaker than this share of the strongest are left out."""


def directions(scene: Scene, sample: Sample, more: FloatArray) -> FloatArray:
    """Give an orthonormal basis of what reshaping the hysteresis could do.

    Parameters
    ----------
    scene : Scene
    sample : Sample
    more : ndarray, shape (scored samples, k)
        What else could be wrong in shape.

    Returns
    -------
    ndarray, shape (scored samples, d)
        Without a hysteresis in the chain, only what ``more`` holds.
    """
    place = scene.hysteresis
    if place is None:
        columns = []
    else:
        behind = scene.chain[scene.behind_hysteresis :]
        columns = [
            sample.take(_sent(scene, behind, signals)) for signals in _ways(scene)
        ]
    return orthonormal(np.column_stack([*columns, more]))


def orthonormal(columns: FloatArray) -> FloatArray:
    """Give an orthonormal basis of columns, each scaled to one first."""
    if not columns.shape[1]:
        return columns
    size = np.linalg.norm(columns, axis=0)
    usable = np.isfinite(size) & (size > 0)
    columns = columns[:, usable] / size[usable]
    # By the small Gram matrix: a full decomposition of the columns is ten times dearer.
    values, vectors = np.linalg.eigh(columns.T @ columns)
    keep = values > (SMALLEST**2) * values[-1]
    basis = columns @ (vectors[:, keep] / np.sqrt(values[keep]))
    # A second pass makes what rounding has left orthonormal too.
    q, _ = np.linalg.qr(basis)
    return np.ascontiguousarray(q)


def _ways(scene: Scene) -> list[Signals]:
    """Give ways in which the output of the hysteresis could differ."""
    place = scene.hysteresis
    assert place is not None  # noqa: S101  (the caller has looked)
    block, v = scene.chain[place], scene.before[place]
    amplitude = scene.largest(place)
    thresholds = amplitude * np.arange(1, OPERATORS + 1) / (OPERATORS + 1)
    plays = [play(z, thresholds)[0] / amplitude for z in v]
    ways: list[Signals] = [
        tuple((z / amplitude) ** k for z in v) for k in range(POWERS + 1)
    ]
    ways += [
        tuple(np.ascontiguousarray(p[:, i] ** k) for p in plays)
        for k in range(1, OPERATOR_POWERS + 1)
        for i in range(OPERATORS)
    ]
    if isinstance(block, GeneralizedPrandtlIshlinskii):
        ways += _own(scene, block, v)
    return ways


def _own(
    scene: Scene, block: GeneralizedPrandtlIshlinskii, v: Signals
) -> list[Signals]:
    """Give a few groups of the block's operators, and tangents of its envelopes."""
    ways = []
    count = len(block.thresholds)
    for group in np.array_split(np.arange(count), min(count, OPERATORS)):
        weights = np.zeros(count)
        weights[group] = 1.0
        ways.append(scene.run((replace(block, weights=tuple(weights.tolist())),), v))
    now = scene.run((block,), v)
    for k, value in enumerate(block.envelope):
        moved = list(block.envelope)
        moved[k] = value + 1e-3 * max(abs(value), 0.1)
        other = scene.run((replace(block, envelope=tuple(moved)),), v)
        ways.append(tuple(a - b for a, b in zip(other, now, strict=True)))
    return ways


def _sent(scene: Scene, behind: tuple[Block, ...], signals: Signals) -> Signals:
    """Send a small change of the hysteresis's output through the blocks behind it."""
    if not behind:
        return signals
    now = scene.before[scene.behind_hysteresis]
    size = SMALL * scene.largest(scene.behind_hysteresis)
    change = size / max(float(max(np.abs(s).max() for s in signals)), 1e-300)
    moved = tuple(z + change * s for z, s in zip(now, signals, strict=True))
    return tuple(
        (after - before) / change
        for after, before in zip(scene.run(behind, moved), scene.output, strict=True)
    )

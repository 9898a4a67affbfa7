"""A model's inverse as steps: code that turns a wanted output into the input.

Each block is undone by itself, the last one first. That can be done sample by sample
where a block is a straight line, a first-order lag, linear dynamics that answer at
once, or made of play operators, whose output rises with the input.
"""

from __future__ import annotations

from functools import partial

import numpy as np

from hystbench.blocks.base import Block
from hystbench.blocks.gain import Gain
from hystbench.blocks.gpi import GeneralizedPrandtlIshlinskii
from hystbench.blocks.linear import LinearBlock, StateSpace, linear_step
from hystbench.blocks.prandtl_ishlinskii import PrandtlIshlinskii
from hystbench.blocks.step import (
    PASSED,
    Sampling,
    Step,
    polynomial,
    smooth_curve,
    through_samples,
)
from hystbench.errors import InputError
from hystbench.export.described import Described, Maker, Piece, arranged, labels_of
from hystbench.model import Model
from hystbench.record import FloatArray

CAN_BE_UNDONE = (
    "expected gain, gpi, hysteresis, prandtl-ishlinskii, a first-order lag, or linear "
    "dynamics that answer at once; 'hystbench invert --reference' iterates for the rest"
)

Ends = tuple[float, float]
"""Lowest and highest value of a signal."""


def describe_inverse(model: Model, sampling: Sampling, limits: Ends) -> Described:
    """Ask for the step that undoes each block.

    Parameters
    ----------
    model : Model
    sampling : Sampling
    limits : pair of float
        Lowest and highest input of the model: where the wanted output is out of reach
        the code stands there.

    Raises
    ------
    InputError
        If a block cannot be undone sample by sample, or the limits or the sampling make
        no sense.
    """
    low, high = limits
    if not -np.inf < low < high < np.inf:
        raise InputError(
            f"--limit-low and --limit-high: {low:g} and {high:g}; expected two "
            "numbers, the first one lower: there the code stands where an output is "
            "out of reach"
        )
    labels, makers, ends = labels_of(model), list[Maker](), limits
    for place, block in enumerate(model.chain, start=1):
        label = f"{labels[id(block)]}_undone"
        makers.append(partial(_undone, place, block, label, ends))
        ends = _through(block, ends)
    held = Step("limited", {"low": low, "high": high})
    makers = [*reversed(makers), lambda _: Piece("limits", held)]
    name, sides = f"{model.name} inverse", (model.output, model.input)
    return arranged(name, *sides, makers, sampling)


def _refused(place: int, block: Block, why: str) -> InputError:
    return InputError(
        f"chain: block {place}: {block.name}: no inverse that runs sample by sample, "
        f"as {why}; {CAN_BE_UNDONE}"
    )


def _undone(
    place: int, block: Block, label: str, ends: Ends, sampling: Sampling
) -> Piece:
    if isinstance(block, Gain):
        if block.value == 0:
            raise _refused(place, block, "its value is 0")
        return Piece(label, polynomial(-block.offset / block.value, 1 / block.value))
    if isinstance(block, GeneralizedPrandtlIshlinskii | PrandtlIshlinskii):
        return Piece(label, _plays(block, ends))
    if isinstance(block, LinearBlock):
        return Piece(label, _linear(place, block, sampling))
    raise _refused(place, block, "none is known")


def _through(block: Block, ends: Ends) -> Ends:
    """Give what a slow signal between two ends becomes."""
    if isinstance(block, LinearBlock):
        gain = float(block.frequency_response(np.zeros(1))[0].real)
        low, high = sorted(gain * end for end in ends)
        return low, high
    path = np.array([*ends, *ends])
    passed = block.simulate(path, path, 1.0)
    return float(passed.min()), float(passed.max())


def _plays(block: GeneralizedPrandtlIshlinskii | PrandtlIshlinskii, ends: Ends) -> Step:
    """Give the step that finds the input of play operators, to rounding."""
    count = len(block.thresholds)
    terms, path, envelope = np.zeros((3, count)), 0.0, np.zeros(8)
    terms[0] = block.weights
    past = ""
    if isinstance(block, PrandtlIshlinskii):
        path = 1.0
        for row, values in enumerate((block.square_weights, block.cube_weights), 1):
            terms[row] = values or 0.0
    else:
        envelope = np.array(block.envelope)
        past = PASSED if block.start == "settled" else ""
    constants = {
        "path": path,
        "own": int(path == 0.0),
        "envelope": envelope,
        "count": count,
        "thresholds": np.array(block.thresholds),
        "terms": terms.ravel(),
        "low": ends[0],
        "high": ends[1],
    }
    return Step("undo_plays", constants, {"w": count, "at": 2}, past=past)


def _linear(place: int, block: LinearBlock, sampling: Sampling) -> Step:
    """Give the step that undoes linear dynamics."""
    system = block.continuous()
    if system.d != 0:
        inverse = _reciprocal(system)
        if (np.linalg.eigvals(inverse.a).real >= 0).any():
            raise _refused(place, block, "its inverse is unstable")
        return linear_step(inverse, sampling, "band-limited")
    rise = float(system.c @ system.b)
    if len(system.b) > 1 or rise == 0:
        raise _refused(place, block, "it takes more than one derivative")
    # y' = a y + c b v, with the rate of the curve through the samples.
    points, ahead = sampling.points, sampling.ahead
    rate = through_samples(points, lambda m: m * (-float(ahead)) ** max(m - 1, 0))
    taps: FloatArray = rate / sampling.dt / rise
    taps[ahead] -= system.a[0, 0] / rise
    return Step(
        "at_samples",
        {"points": points, "taps": taps},
        {"history": 1 + points},
        forward=True,
        differs=smooth_curve(points, ahead),
    )


def _reciprocal(system: StateSpace) -> StateSpace:
    """Exchange input and output of a system that answers at once."""
    d = system.d
    a = system.a - np.outer(system.b, system.c) / d
    return StateSpace(a, system.b / d, -system.c / d, 1 / d)

"""A model's inverse as code that turns a wanted output into the input.

Each block is undone by itself, the last one first, with what is known at a sample: the
reference so far. What that leaves, each step says of itself.
"""

from collections.abc import Iterator
from dataclasses import replace
from functools import partial
from typing import Any, cast

import numpy as np

from hystbench.blocks.attached import Simulated
from hystbench.blocks.base import Block
from hystbench.blocks.drift import Drift
from hystbench.blocks.force import Driven, Force
from hystbench.blocks.input_delay import InputDelay
from hystbench.blocks.linear import LinearBlock
from hystbench.blocks.mains_pickup import MainsPickup
from hystbench.blocks.mechanism import Mechanism
from hystbench.blocks.rate_dependent_hysteresis import RateDependentHysteresis
from hystbench.blocks.rdgpi import RateDependentPrandtlIshlinskii
from hystbench.blocks.slew_limit import SlewLimit
from hystbench.blocks.step import Sampling, Step
from hystbench.blocks.superposed import Superposed
from hystbench.blocks.transfer_function import TransferFunction
from hystbench.blocks.wrapping import HystereticBlock, Wrapped
from hystbench.errors import InputError
from hystbench.export import undone
from hystbench.export.described import (
    Described,
    Maker,
    Piece,
    arranged,
    labels_of,
    pieces_of,
)
from hystbench.export.undone import Ends, Making
from hystbench.model import Model

CAN_BE_UNDONE = (
    "expected curves and hysteresis that rise or fall throughout, linear dynamics "
    "without zeros in the right half plane, or a mechanism's motion; 'hystbench invert "
    "--reference' iterates for the rest"
)


def describe_inverse(model: Model, sampling: Sampling, limits: Ends) -> Described:
    """Ask for the steps that undo each block.

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
    piece_of = pieces_of(model)
    places = {id(block): place for place, block in enumerate(model.chain, start=1)}
    for step in model.steps:
        block = _first(step)
        label = f"{labels[id(block)]}_undone"
        where = f"chain: block {places[id(block)]}: {block.name}: "
        inner = partial(piece_of, _inside(step))
        try:
            back = [
                partial(_piece, label, number, where, making, inner)
                for number, making in enumerate(_undone(step, ends), start=1)
            ]
        except undone.CannotBe as why:
            raise _refused(where, str(why)) from None
        makers = [*back, *makers]
        ends = _through(step, ends)
    held = Step("limited", {"low": low, "high": high})
    makers.append(lambda _: Piece("limits", held))
    name, sides = f"{model.name} inverse", (model.output, model.input)
    return arranged(name, *sides, makers, sampling)


def _first(step: Simulated) -> Block:
    """Give the block that a step of the model begins with."""
    first: Any = step
    while isinstance(first, Wrapped | Driven | Superposed):
        first = first.host if isinstance(first, Driven) else first.inner
    block: Block = first
    return block


def _refused(where: str, why: str) -> InputError:
    return InputError(
        f"{where}no inverse that runs sample by sample, as {why}; {CAN_BE_UNDONE}"
    )


def _inside(step: Simulated) -> Any:
    """Give the hysteresis that a step is, or that a rate is around."""
    if isinstance(step, Wrapped) and isinstance(step.by, RateDependentHysteresis):
        return step.inner
    return step


def _piece(
    label: str,
    number: int,
    where: str,
    making: Making,
    inner: Maker,
    sampling: Sampling,
) -> Piece:
    """Name a step after the block that it undoes, and put that in where it is tried."""
    try:
        step = making(sampling)
    except undone.CannotBe as why:
        raise _refused(where, str(why)) from None
    tried = inner(replace(sampling, ahead=0)) if step.undoes else None
    return Piece(label if number == 1 else f"{label}_{number}", step, tried)


def _undone(step: Simulated, ends: Ends) -> Iterator[Making]:
    """Give what undoes a step of the model, in the order of the inverse's signal."""
    inner = _inside(step)
    if isinstance(inner, RateDependentPrandtlIshlinskii) or _depends_on_rate(inner):
        raise undone.CannotBe("its output depends on the rate that is sought")
    if isinstance(step, Wrapped) and inner is not step:
        by = cast(RateDependentHysteresis, step.by)
        if by.form == "growing-thresholds":
            yield undone.hysteresis(inner, ends, by)
        else:
            yield undone.hysteresis(inner, ends)
            yield partial(undone.field, by)
    elif isinstance(step, HystereticBlock | Wrapped):
        yield undone.hysteresis(step, ends)
    elif isinstance(step, LinearBlock):
        if isinstance(step, TransferFunction) and step.integrates:
            raise undone.CannotBe("a pole at s = 0 has no inverse that settles")
        yield from undone.linear(step)
    elif isinstance(step, Mechanism):
        yield from _motion(step, ())
    elif isinstance(step, Driven) and isinstance(step.host, Mechanism):
        yield from _motion(step.host, step.forces)
    elif isinstance(step, InputDelay):
        late = f"{step.shift_s:.6g} s"
        yield partial(
            undone.left, f"is left: what follows the reference is {late} late"
        )
    elif isinstance(step, SlewLimit):
        slow = f"is left: it does nothing up to {step.rate:.6g} a second"
        if step.time_constant_s:
            late = f"{step.time_constant_s:.6g} s or more late"
            slow = f"is left: what follows the reference is {late}"
        yield partial(undone.left, slow)
    elif isinstance(step, Drift | MainsPickup):
        yield partial(undone.left, "is left, as its start in time is not known")
    elif isinstance(step, Block):
        yield partial(undone.curve, step, ends)
    else:
        raise undone.CannotBe("none is known with what is attached to it")


def _depends_on_rate(step: Any) -> bool:
    """Tell whether a rate is around hysteresis that something else is around."""
    return isinstance(step, Wrapped) and (
        isinstance(step.by, RateDependentHysteresis) or _depends_on_rate(step.inner)
    )


def _motion(block: Mechanism, forces: tuple[Force, ...]) -> Iterator[Making]:
    """Undo a coordinate: the force that its motion takes is what drives it."""
    if block.output not in ("position", "velocity") or block.blend or not block.gain:
        raise undone.CannotBe("its output is not a motion alone, or its gain is 0")
    yield partial(undone.motion, block, forces)
    yield partial(undone.straight, block.bias, block.gain)


def _through(step: Simulated, ends: Ends) -> Ends:
    """Give what a slow signal between two ends becomes."""
    if isinstance(step, LinearBlock):
        gain = step.continuous().static_gain
        low, high = sorted(gain * end for end in ends)
        return low, high
    path = np.array([*ends, *ends])
    passed = step.simulate(path, path, 1.0)
    return float(passed.min()), float(passed.max())

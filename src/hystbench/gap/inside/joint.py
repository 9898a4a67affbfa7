"""Forces at one place of a structure, which several of its modes move: the joint.

No linear record tells how far each mode moves it. So the shapes of the modes there are
fitted together with the first force, begun with one mode alone or with two, and are
charged as numbers are.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace
from itertools import combinations

import numpy as np

from hystbench.blocks.base import Block
from hystbench.blocks.gain import Gain
from hystbench.blocks.mechanism import Mechanism
from hystbench.blocks.other_modes import OtherModes
from hystbench.blocks.structure import SHAPES, Structure
from hystbench.blocks.transfer_function import TransferFunction
from hystbench.errors import InputError
from hystbench.gap.bases.poles import poles_of, residues_of
from hystbench.gap.fitting.state import Free, ModelState
from hystbench.gap.inside.host_places import MODES
from hystbench.gap.inside.modes_of_base import (
    APART,
    coefficients_of,
    coincide,
    direct_of,
    mode_of,
    one_by_one,
    sum_of,
)

LITTLE = 1e-3
"""Share of its shape at the drive with which a mode begins that hardly moves the joint:
from zero no fit could tell which way it does."""


def structure(
    start: ModelState, output: str, others_too: bool = False
) -> ModelState | None:
    """Give a linear model as a structure; None if one coordinate is all it has.

    A structure has two modes, or one beside real poles: those of a drive that turns
    freely, whose shaft swings. The model does what it did. Drive and sensor are
    taken to be at one place, so that they share one shape of each mode. The shape at
    the joint stays open.

    Parameters
    ----------
    start : ModelState
        Its chain is a transfer function, of which no two poles coincide, and gains; of
        any other there is none.
    output : {"position", "velocity", "acceleration"}
    others_too : bool
        Whether the numbers of what is left, real poles, and the offset are free too.
    """
    block, *behind = start.chain
    if not isinstance(block, TransferFunction):
        return None
    if not all(isinstance(item, Gain) for item in behind):
        return None
    poles = poles_of(block)
    residues = residues_of(block, poles)
    if coincide(poles):
        return None
    peaks = np.abs(residues / np.where(poles.real, poles.real, 1.0))
    swings = poles.imag > 0
    least = APART * np.max(peaks[swings], initial=0.0)
    modes: list[Mechanism] = []
    through, taken = 0.0, np.zeros(len(poles), dtype=bool)
    for k in np.argsort(np.abs(poles)):
        if not swings[k] or peaks[k] <= least:
            continue
        one = mode_of(block, poles[k], residues[k], output)
        if one is None:
            continue
        modes.append(one[0])
        through += one[1]
        taken |= np.isin(poles, (poles[k], poles[k].conj()))
    if not modes or (len(modes) == 1 and np.all(taken)):
        return None
    whole = direct_of(block)
    direct = whole - through
    if abs(direct) <= APART * (abs(whole) + abs(through)):
        direct = 0.0  # that is rounding
    rest: list[OtherModes] = []
    if not np.all(taken):
        try:
            others = sum_of(block, poles[~taken], residues[~taken], direct)
            rest, direct = [*one_by_one(others)] if others_too else [others], 0.0
        except InputError:
            return None  # so little damped that rounding makes it unstable
    own = _written(modes, block, direct)
    free = [Free(0, name, k) for name in MODES for k in range(len(modes))]
    free += [Free(0, "direct")] if direct else []
    chain = (own, *rest, *behind)
    if others_too:
        free += [x for k, item in enumerate(rest, 1) for x in coefficients_of(item, k)]
        # A curve or a weight has a mean, which the offset of the base took.
        free += [Free(k, "offset") for k, x in enumerate(chain) if isinstance(x, Gain)]
    return replace(start, chain=chain, free=tuple(free)).settled()


def _written(
    modes: Sequence[Mechanism], block: TransferFunction, direct: float
) -> Structure:
    """Write modes as one block; a mode of mass m has a shape of 1 / sqrt(m)."""
    about = np.array(
        [[x.stiffness / x.mass, x.damping / x.mass, x.gain / x.mass] for x in modes]
    )
    stiffness, damping, constant = (tuple(column.tolist()) for column in about.T)
    shape = tuple(float(x.mass**-0.5) for x in modes)
    return Structure(
        stiffness=stiffness,
        damping=damping,
        modal_constant=constant,
        drive=shape,
        blend=tuple(x.blend for x in modes),
        direct=direct,
        output=modes[0].output,
        start=block.start,
        hold=block.hold,
    )


def joints(state: ModelState) -> Iterator[ModelState]:
    """Give a structure with its joint at all the places that a fit begins with.

    The shapes of all modes but one are free then: that one sets how a force is
    measured. Nothing is given of any other host, and of a structure that has a joint.
    """
    place = next((k for k, x in enumerate(state.chain) if has_no_joint(x)), None)
    if place is None:
        return
    host = state.chain[place]
    assert isinstance(host, Structure)  # noqa: S101  (for the type checker)
    count, drive = len(host.stiffness), np.array(host.drive)
    alone = [{k: 1.0} for k in range(count)]
    pairs = [
        {a: 1.0, b: sign}
        for a, b in combinations(range(count), 2)
        for sign in (1.0, -1.0)
    ]
    for moved in (*alone, *pairs):
        shares = np.full(count, LITTLE)
        shares[list(moved)] = list(moved.values())
        first = next(iter(moved))
        joint = {"joint": tuple((shares * drive).tolist())}
        others = (k for k in range(count) if k != first)
        shapes = (Free(place, name, k) for k in others for name in SHAPES)
        free = (*state.free, *shapes)
        yield replace(state.with_values({place: joint}), free=free)


def has_no_joint(block: Block) -> bool:
    """Tell whether a block is a structure whose joint is not known."""
    return isinstance(block, Structure) and not block.joint

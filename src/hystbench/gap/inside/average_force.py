"""What a force does on average, taken out of the spring and damper of its host."""

from __future__ import annotations

from dataclasses import replace
from functools import lru_cache
from typing import Any

import numpy as np

from hystbench.blocks.base import Block
from hystbench.blocks.force import Dynamics, Force, against
from hystbench.blocks.held import Hold
from hystbench.blocks.mechanism import Mechanism, free_starts
from hystbench.blocks.other_modes import OtherModes
from hystbench.blocks.parameter import HUGE
from hystbench.blocks.structure import Structure
from hystbench.gap.fitting.state import Free, ModelState
from hystbench.gap.inside.host_places import host_of
from hystbench.gap.simulation.shared import Same
from hystbench.gap.simulation.simulation import Simulation
from hystbench.record import FloatArray

REMAINS = 0.05
"""Least share of a spring or a damper that remains where a force begins that does its
work."""


def evened(state: ModelState) -> ModelState:
    """Take out of a mass's spring and damper what a force put in last does on average.

    Along the way that the host goes without the force: the spring and the damper that
    are nearest to the force there, in least squares (statistical linearization [1]_).
    So the mode that the force is put into stays where it was. A host that is known
    stays as it is.

    References
    ----------
    .. [1] J. B. Roberts, P. D. Spanos, Random Vibration and Statistical Linearization,
       Wiley, 1990.
    """
    (place,) = state.added[-1].blocks
    law, chain = state.chain[place], list(state.chain)
    number = host_of(state)
    host = chain[number]
    if not isinstance(host, Mechanism | Structure):
        return state
    if place < number:
        known = any(np.isfinite(x.low) for x in state.free if x.block == number)
        # A gain does what a mass, a damper and a spring do together.
        known = known or not any_is_free(
            state, number, "gain", "mass", "modal_constant"
        )
        return state if known else _as_strong(state, place)
    loose = any_is_free(state, number, "stiffness", "damping")
    if not (isinstance(law, Force) and loose):
        return state
    own = chain[number + 1 :]
    others = tuple(x for x in own if isinstance(x, Force) and x is not law)
    square, product = np.zeros((3, 3)), np.zeros(3)
    dts = [record.dt for record in state.records]
    ways = _ways(state.chain[: number + 1], others, Same(state.records), state.hold)
    for dt, (q, v) in zip(dts, ways, strict=True):
        place_counts = q if spring_of(host) else np.zeros(len(q))
        columns = np.column_stack([place_counts, v, np.ones(len(q))])
        alike = 1.0 / max(float(np.sum(v**2)), 1.0 / HUGE)  # as records are weighed
        square += alike * columns.T @ columns
        product += alike * columns.T @ against((law,), q, v, dt)
    sizes = np.sqrt(np.maximum(np.diag(square), 1.0 / HUGE))
    if not (np.all(np.isfinite(square)) and np.all(np.isfinite(product))):
        return state
    scaled = square / np.outer(sizes, sizes)
    spring, damper, _ = np.linalg.lstsq(scaled, product / sizes, rcond=1e-9)[0] / sizes
    if max(abs(spring), abs(damper)) > HUGE:
        return state  # the host all but runs away
    return relieved(state, number, float(spring), float(damper))


@lru_cache(maxsize=1)
def _ways(
    chain: tuple[Block, ...], others: tuple[Force, ...], given: Same, hold: Hold
) -> list[tuple[FloatArray, FloatArray]]:
    """Give q and v in each record of a host, the last of a chain: laws share them."""
    (records,) = given.objects
    *_, host = chain
    number = len(chain) - 1
    assert isinstance(host, Dynamics)  # noqa: S101  (for the type checker)
    signals = Simulation(chain, records, hold, "quick").driving(number)
    moves = (
        host.motion(z, record.dt, others)
        for record, z in zip(records, signals, strict=True)
    )
    return [
        (np.ascontiguousarray(own.position), np.ascontiguousarray(own.velocity))
        for own in moves
    ]


def spring_of(host: Block) -> float:
    """Give the stiffness that a force inside a host meets; zero without a spring."""
    if isinstance(host, Structure):
        return 1.0 / host.receptance
    return float(getattr(host, "stiffness", 0.0))


def relieved(
    state: ModelState, place: int, spring: float, damper: float = 0.0
) -> ModelState:
    """Take so much out of a host's spring and damper, where they may change.

    Of a structure that much at the joint: each mode loses it as far as it moves that.
    A share of them stays in any case.
    """
    host: Any = state.chain[place]
    shape = np.array(host.joint) if isinstance(host, Structure) else np.ones(1)
    values: dict[str, Any] = {}
    for name, less in (("stiffness", spring), ("damping", damper)):
        free = _unknown(state, place).get(name)
        if free is None:
            continue
        own = np.array(getattr(host, name))
        remains = np.maximum(own - less * shape**2, REMAINS * own)
        left = np.clip(remains, *state.range_of(free))
        values[name] = (
            tuple(left.tolist()) if isinstance(host, Structure) else float(left[0])
        )
    return state.with_values({place: values})


def without_spring(state: ModelState, place: int) -> ModelState:
    """Give a mass no spring, if nobody knows that it has one and it may start so."""
    host: Any = state.chain[place]
    if not isinstance(host, Mechanism) or "stiffness" not in _unknown(state, place):
        return state
    if host.start not in free_starts(host.output) or host.stiffness == 0.0:
        return state
    free = (x for x in state.free if (x.block, x.parameter) != (place, "stiffness"))
    return replace(state.with_values({place: {"stiffness": 0.0}}), free=tuple(free))


def _as_strong(state: ModelState, place: int) -> ModelState:
    """Let a mass, and what is beside it, be driven as strongly as without the curve."""
    pairs = zip(state.simulation.at(place), state.simulation.at(place + 1), strict=True)
    powers = np.array([[np.var(one), np.var(other)] for one, other in pairs])
    before, behind = np.sum(powers / np.maximum(powers[:, :1], 1.0 / HUGE), axis=0)
    times = float(np.sqrt(behind / before)) if before > 0 else 1.0
    if not (np.isfinite(times) and times > 0):
        return state
    values: dict[int, dict[str, Any]] = {}
    for k, block in enumerate(state.chain):
        if isinstance(block, Mechanism):
            values[k] = {"gain": block.gain / times}
        elif isinstance(block, Structure):
            constants = tuple(x / times for x in block.modal_constant)
            values[k] = {"modal_constant": constants, "direct": block.direct / times}
        elif isinstance(block, OtherModes):
            values[k] = {"numerator": tuple(x / times for x in block.numerator)}
    return state.with_values(values)


def _unknown(state: ModelState, place: int) -> dict[str, Free]:
    """Give the numbers of a block that may be anything, as nobody knows them."""
    own = (free for free in state.free if free.block == place)
    return {free.parameter: free for free in own if free.given is None}


def any_is_free(state: ModelState, place: int, *names: str) -> bool:
    """Tell whether some number of a block may be anything."""
    return not _unknown(state, place).keys().isdisjoint(names)

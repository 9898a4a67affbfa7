"""Hosts of a motion of first order, where nobody tells what moves.

A mass whose velocity is seen, as a current in a coil, and a spring that pulls a damper
have one equation. A law of the velocity is a friction in the first, and a law of the
place a stiffness in the second.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

from hystbench.blocks.mechanism import Mechanism
from hystbench.blocks.transfer_function import TransferFunction
from hystbench.gap.fitting.least_squares import fitted
from hystbench.gap.fitting.score import Score
from hystbench.gap.fitting.state import Free, ModelState
from hystbench.gap.inside.host import Host
from hystbench.gap.inside.one_coordinate import (
    free_masses,
    likeliest,
    span_and_step,
)

NO_MASS = 1e-3
"""Time constant of the spring's mass, in sampling intervals: too short to show."""


def of_first_order(start: ModelState) -> bool:
    """Tell whether a base is a transfer function of one pole."""
    parts = [block for block in start.chain if isinstance(block, TransferFunction)]
    return [len(block.denominator) for block in parts] == [2]


def both_readings(state: ModelState, score: Score) -> Iterator[Host]:
    """Give a mass whose velocity is seen, and a spring that pulls a damper.

    Parameters
    ----------
    state : ModelState
        A model of one coordinate on the records.
    score : Score
    """
    moving = likeliest(free_masses(state.records, "velocity", state.hold), score)
    if moving is None:
        return
    mass = moving.state.chain[0]
    assert isinstance(mass, Mechanism)  # noqa: S101  (they are masses)
    _, step = span_and_step(state.records)
    spring = replace(
        mass,
        mass=NO_MASS * step * mass.mass,
        damping=mass.mass,
        stiffness=mass.damping,
        output="position",
    )
    own = ("mass", "damping")
    free = (
        *(Free(0, name) for name in ("damping", "stiffness")),
        *(x for x in moving.state.free if x.block or x.parameter not in own),
    )
    chain = (spring, *moving.state.chain[1:])
    pulled = fitted(replace(moving.state, chain=chain, free=free), score)
    words = "stands in place of the linear base"
    yield Host(moving.state, moving, f"a mass whose velocity is the output {words}")
    yield Host(pulled.state, pulled, f"a spring that pulls a damper {words}")

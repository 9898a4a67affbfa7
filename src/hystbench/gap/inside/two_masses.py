"""A mass with another one attached, as a host in place of an identified base."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import replace
from itertools import product
from typing import Any

import numpy as np

from hystbench.blocks.attached_mass import AttachedMass
from hystbench.blocks.base import Block
from hystbench.blocks.mechanism import Mechanism
from hystbench.blocks.transfer_function import TransferFunction
from hystbench.gap.fitting.edit_chain import rearranged
from hystbench.gap.fitting.least_squares import Fitted
from hystbench.gap.fitting.score import Score
from hystbench.gap.fitting.state import Free, ModelState
from hystbench.gap.inside.host import Host
from hystbench.gap.inside.one_coordinate import BEGUN, best_host, free_masses
from hystbench.gap.thresholds import PAYS

SHARES = (0.2, 0.5, 0.8)
"""Shares of the mass that is attached."""
RATIO = 0.05
"""Damping ratio with which they are begun."""


def of_two_masses(
    one: Fitted, frequencies: Sequence[float], score: Score
) -> Iterator[Host]:
    """Give a mass with another one attached, where that pays as an effect does."""
    state = one.state
    block = state.chain[0]
    if not (frequencies and isinstance(block, Mechanism)):
        return
    loose = free_masses(state.records, block.output, state.hold)
    best = best_host(two_masses([state, *loose], frequencies), score)
    if best is not None and best.score < one.score - PAYS:
        words = "a mass with another one attached stands in place of the linear base"
        yield Host(best.state, best, words, kind="two masses")


def two_masses(
    hosts: Iterable[ModelState], frequencies: Sequence[float]
) -> Iterator[ModelState]:
    """Write masses as two of as much together, which swing against each other.

    What friction or a clearance holds at the driven side of a flexible shaft acts on
    the motion of both modes: of the mass as a whole, and of the two against each other.

    Parameters
    ----------
    hosts : iterable of ModelState
        Each begins with a mechanism; further blocks do not depend on what enters them.
    frequencies : sequence of float
        At which the two are begun, in rad/s.

    Yields
    ------
    ModelState
        With all numbers of both masses free.
    """
    found: list[tuple[float, int, ModelState]] = []
    for host in hosts:
        for w, share in product(frequencies, SHARES):
            begun = _sized(_split(host, w, share))
            if begun is not None:
                rest = float(np.mean(begun.residual**2))
                found.append((rest, len(found), begun))
    for _, _, state in sorted(found)[:BEGUN]:
        yield state


def further_modes_of(base: ModelState) -> list[float]:
    """Give the frequencies, in rad/s, at which a base swings beside one coordinate.

    It has two poles of one coordinate; those of a further mode were asked for by
    folds, as those that only imitate friction are not.
    """
    poles = [
        pole
        for block in base.chain
        if isinstance(block, TransferFunction)
        for pole in np.roots(block.denominator)
    ]
    if len(poles) < 3:
        return []
    return [float(abs(pole)) for pole in poles if pole.imag > 0]


def _split(state: ModelState, frequency: float, share: float) -> ModelState:
    """Attach a share of the mass of a mechanism to the rest of it."""
    whole, *behind = state.chain
    assert isinstance(whole, Mechanism)  # noqa: S101  (for the type checker)
    own, attached = (1 - share) * whole.mass, share * whole.mass
    reduced = own * share
    other = AttachedMass(
        mass=attached,
        damping=2 * RATIO * frequency * reduced,
        stiffness=frequency**2 * reduced,
    )
    split = rearranged(
        state,
        (replace(whole, mass=own), other, *behind),
        {k: k + (k > 0) for k in range(len(state.chain))},
    )
    free = (*split.free, *(Free(1, name) for name in AttachedMass.parameters()))
    return replace(split, free=free).settled()


def _sized(state: ModelState) -> ModelState | None:
    """Give two masses the size that fits best; None if they would move backwards."""
    output = state.sample.take(state.simulation.output)
    columns = np.column_stack([output, np.ones(len(output))])
    if not np.all(np.isfinite(columns)):
        return None
    gain = float(np.linalg.lstsq(columns, state.measured, rcond=1e-10)[0][0])
    if gain <= 0.0:
        return None
    return state.with_blocks({k: _over(state.chain[k], gain) for k in (0, 1)})


def _over(block: Block, gain: float) -> Block:
    """Divide a mass, its damper and its spring by a number."""
    numbers: dict[str, Any] = {
        name: getattr(block, name) / gain for name in ("mass", "damping", "stiffness")
    }
    return replace(block, **numbers)

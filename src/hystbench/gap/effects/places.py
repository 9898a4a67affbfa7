"""Places in a chain where an effect may stand."""

from __future__ import annotations

from functools import lru_cache

import numpy as np

from hystbench.blocks.forced import ForcedDynamics
from hystbench.blocks.gain import Gain
from hystbench.blocks.held import HeldBlock
from hystbench.blocks.linear import LinearBlock
from hystbench.blocks.state_space import StateSpace
from hystbench.blocks.store import Store
from hystbench.gap.simulation.simulation import Simulation
from hystbench.quantities import Quantities, quantity_of

TRANSFER_FUNCTION = "transfer-function"
BETWEEN_HALVES = "inside the base"
"""Place of an effect between two transfer functions."""
ROUNDED, TIMES = 1e-6, 40
"""Share of an impulse response that is rounded off; times at which it is looked at."""


def places_between_halves(simulation: Simulation) -> list[int]:
    """Give the places between the transfer functions of a chain: before all but one.

    A linear base that is written as two in series may hide a static nonlinearity
    between its halves.
    """
    linear = [
        k for k, item in enumerate(simulation.chain) if item.name == TRANSFER_FUNCTION
    ]
    return linear[1:]


def drives_a_machine(simulation: Simulation) -> bool:
    """Tell whether the input drives a mass or fills a store, with no material before.

    What limits the input there is the drive's. A linear base of a force and a motion,
    by their units, is such a mass.
    """
    first = next((x for x in simulation.chain if not isinstance(x, Gain)), None)
    if isinstance(first, ForcedDynamics | Store):
        return True
    record = simulation.records[0]
    units = record.input.unit, record.output.unit
    return isinstance(first, LinearBlock) and _is_force_to_motion(*units)


@lru_cache
def _is_force_to_motion(given: str, shown: str) -> bool:
    """Tell whether units are those of a force and of the motion that it makes."""
    takes, gives = quantity_of("input", given), quantity_of("output", shown)
    return takes == "force" and Quantities(takes, gives).causality == "force to motion"


def has_dynamics(simulation: Simulation) -> bool:
    """Tell whether a chain holds linear dynamics, so that its order counts."""
    return any(isinstance(block, LinearBlock) for block in simulation.chain)


def only_lags(simulation: Simulation) -> bool:
    """Tell whether all linear dynamics of a chain come to rest without overshoot.

    So heat and current do. What has a loop may stand behind them; behind the motion of
    a mass, or the force of a damper, it is another effect.
    """
    if any(record.decay_s is not None for record in simulation.records):
        return False  # windows of a free mass
    linear = (x for x in simulation.chain if isinstance(x, LinearBlock))
    return all(_comes_to_rest(block.continuous()) for block in linear)


def _comes_to_rest(system: StateSpace) -> bool:
    """Tell whether a step response only grows, or only falls, to where it ends."""
    from scipy.linalg import expm  # late: few chains are looked at

    rates = -np.linalg.eigvals(system.a).real
    if not len(rates):
        return True
    if rates.min() <= 0.0 or system.static_gain == 0.0:
        return False
    way = np.sign(system.static_gain)
    times = np.geomspace(0.01 / rates.max(), 10 / rates.min(), TIMES)
    impulse = way * (expm(times[:, None, None] * system.a) @ system.b @ system.c)
    rises = impulse.min() >= -ROUNDED * impulse.max()
    return bool(way * system.d >= 0.0 and rises)


def places_in_drive(simulation: Simulation, linear: bool = False) -> list[int]:
    """Give the places among the drive's effects where another one does another thing.

    Before the first block, and behind each of them that does not commute with what is
    put there: a limit with anything, a lag with a limit. A pure delay may stand where
    it is.

    Parameters
    ----------
    simulation : Simulation
    linear : bool
        Whether what is put there is linear.
    """
    places = [0]
    for k, block in enumerate(simulation.chain):
        if block.place != "drive":
            break
        is_limit = not isinstance(block, HeldBlock)
        if is_limit or (not linear and isinstance(block, LinearBlock)):
            places.append(k + 1)
    return places


def places_in_sensor(simulation: Simulation, linear: bool = False) -> list[int]:
    """Give the places among the sensor's effects where another one does another thing.

    Behind the last block, and before each of the sensor's that does not commute with
    what is put there: a lag before a curve, or a curve before a lag.

    Parameters
    ----------
    simulation : Simulation
    linear : bool
        Whether what is put there is linear.
    """
    end = len(simulation.chain)
    own = range(simulation.behind_mechanics, end)
    before = (
        k for k in own if isinstance(simulation.chain[k], LinearBlock) is not linear
    )
    return [end, *before]

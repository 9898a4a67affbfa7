"""Places in a chain where an effect may stand."""

from __future__ import annotations

from hystbench.blocks.held import HeldBlock
from hystbench.blocks.linear import LinearBlock
from hystbench.gap.simulation.simulation import Simulation

TRANSFER_FUNCTION = "transfer-function"
INSIDE = "inside the base"
"""Place of an effect between two transfer functions."""


def places_between_halves(simulation: Simulation) -> list[int]:
    """Give the places between the transfer functions of a chain: before all but one.

    A linear base that is written as two in series may hide a static nonlinearity
    between its halves.
    """
    linear = [
        k for k, item in enumerate(simulation.chain) if item.name == TRANSFER_FUNCTION
    ]
    return linear[1:]


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

"""The base model that a solver gets: the plant's own loop, or the best GPI there is."""

from dataclasses import asdict

import numpy as np

from hystbench.blocks.base import Block
from hystbench.blocks.gain import Gain
from hystbench.blocks.gpi import GeneralizedPrandtlIshlinskii
from hystbench.blocks.resonance import Resonance
from hystbench.challenge.campaigns import RecordCommand
from hystbench.challenge.plant.actuator import KnownMode
from hystbench.challenge.plant.hysteresis import GeneralizedPlays, PlantLoop
from hystbench.identification import identify
from hystbench.model import Model
from hystbench.record import Channel, FloatArray

INPUT, OUTPUT = Channel("current", "A"), Channel("displacement", "um")
#: Order of an identified base, and what its search may cost.
GPI_ORDER, GPI_ITERATIONS, GPI_STARTS = 20, 60, 2
#: Records that a quasi-static GPI is identified from, in either campaign.
QUASI_STATIC = ("slow-loop", "minor-loops", "triangle", "ringing", "biased-tones")


def base_model(
    loop: PlantLoop,
    mode: KnownMode | None,
    records: tuple[RecordCommand, ...],
    linear: bool,
) -> Model:
    """Make the model that is handed over.

    Parameters
    ----------
    loop : PlantLoop
        The plant's hysteresis. Plays are handed over as they are; of another family
        the best quasi-static GPI is identified from its slow loop and minor loops.
    mode : KnownMode, optional
    records : tuple of RecordCommand
    linear : bool
        Whether the base has a gain in the place of hysteresis.
    """
    u = quasi_static(records)
    chain: list[Block] = []
    if linear:
        chain.append(Gain(value=slope(loop, u), offset=0.0))
    else:
        plays = loop if isinstance(loop, GeneralizedPlays) else _nearest(loop, u)
        chain.append(
            GeneralizedPrandtlIshlinskii(
                envelope=plays.envelope,
                thresholds=tuple(map(float, plays.thresholds)),
                weights=tuple(map(float, plays.weights)),
            )
        )
    if mode is not None:
        chain.append(Resonance(hold="band-limited", **asdict(mode)))
    return Model("base", INPUT, OUTPUT, tuple(chain))


def quasi_static(records: tuple[RecordCommand, ...]) -> FloatArray:
    """Commands of the slow records, one after the other.

    A loop does not depend on the rate, so the way from the last sample of one to the
    first of the next needs no samples between.
    """
    chosen = [item.sampled() for item in records if item.name in QUASI_STATIC]
    return np.concatenate(chosen)


def slope(loop: PlantLoop, u: FloatArray) -> float:
    """Gain of the straight line nearest to a loop, in um/A."""
    y = loop.respond(u)
    return float(u @ y / (u @ u))


def _nearest(loop: PlantLoop, u: FloatArray) -> GeneralizedPlays:
    """Identify the plays that are nearest to a loop of another family."""
    found = identify(
        u,
        loop.respond(u),
        GPI_ORDER,
        offset=False,
        nonnegative=True,
        start="rest",
        starts=GPI_STARTS,
        max_iterations=GPI_ITERATIONS,
    )
    envelope = tuple(found.envelope.to_dict().values())
    return GeneralizedPlays(envelope, found.thresholds, found.weights)

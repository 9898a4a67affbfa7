"""``mains-pickup``: a tone and its harmonics that the input does not explain."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np

from hystbench.gap.effects.effect import Declined, Effect
from hystbench.gap.effects.variant import EVERY, Beside, SomeSamples, Values, Variant
from hystbench.gap.simulation.simulation import Simulation
from hystbench.record import FloatArray, Record

MAINS_HZ = (50.0, 60.0)
HARMONICS = 3
"""Of the mains that are looked at: the fundamental, the second and the third."""


class MainsPickup(Effect):
    """A tone near a mains frequency, with a new phase in every record."""

    name = "mains-pickup"
    shows = "unexplained"
    place = "sensor"

    def variants(self, simulation: Simulation) -> Iterator[Variant]:
        """Offer the fundamental alone and with harmonics, near the mains."""
        usable = [
            f
            for f in MAINS_HZ
            if f < SHOWN / simulation.step and f * simulation.span > 3
        ]
        if not usable:
            raise Declined("records too short, or sampled too slowly, for the mains")
        for harmonics in (1, HARMONICS):
            yield self.added(
                simulation,
                Beside(self.name, harmonics, tone),
                form="fundamental" if harmonics == 1 else f"{harmonics} harmonics",
                grids={
                    "frequency_hz": np.concatenate(
                        [f * np.array([0.995, 1.0, 1.005]) for f in usable]
                    )
                },
                charge=1 + harmonics * (1 + 0.25 * len(simulation.records)),
            )

    def describe(self, given: Values, amplitudes: FloatArray) -> dict[str, Any]:
        """Give the block's parameters; phases are those of the first record."""
        pairs = amplitudes.reshape(len(amplitudes), -1, 2)
        size = np.sqrt(np.mean(np.sum(pairs**2, axis=2), axis=0))
        return {
            "frequency_hz": given["frequency_hz"],
            "amplitudes": [float(x) for x in size],
            "phases": [float(x) for x in np.arctan2(pairs[0, :, 1], pairs[0, :, 0])],
        }


def tone(
    record: Record, given: Values, harmonics: int, at: SomeSamples = EVERY
) -> FloatArray:
    """Give sine and cosine of each harmonic over a record, shape (n, 2 harmonics)."""
    angle = 2 * np.pi * given["frequency_hz"] * record.time[at]
    order = np.arange(1, harmonics + 1)
    waves = np.stack([np.sin(np.outer(angle, order)), np.cos(np.outer(angle, order))])
    # Beyond half the sampling rate a tone would stand for something slow.
    waves[:, :, order * given["frequency_hz"] * record.dt > SHOWN] = 0.0
    return np.ascontiguousarray(waves.transpose(1, 2, 0).reshape(len(angle), -1))


SHOWN = 0.45
"""Of the sampling rate, up to which a record shows a tone."""

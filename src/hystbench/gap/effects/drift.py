"""``drift``: something slow that the input does not explain."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from hystbench.gap.effects.effect import Effect
from hystbench.gap.effects.variant import EVERY, Beside, SomeSamples, Values, Variant
from hystbench.gap.records.nuisance import periods_of_input, shows_a_path
from hystbench.gap.simulation.simulation import Simulation
from hystbench.record import FloatArray, Record

PATH, WINDING = "path", "winding path"
FORMS = {"ramp": 1, PATH: 4, WINDING: 10}
"""Degree of the polynomial that is tried in each record."""


class Drift(Effect):
    """A ramp or a slow path, of its own in every record."""

    name = "drift"
    shows = "unexplained"
    place = "sensor"
    free_forms = (PATH, WINDING)
    like_noise = True

    def variants(self, simulation: Simulation) -> Iterator[Variant]:
        """Offer one slope for all records, a ramp in each, and a path in each."""
        end = len(simulation.chain)
        small = 1e-3 * simulation.largest(end) / simulation.span
        yield self.inserted(simulation, end, form="one slope", unit={"slope": small})
        if not any(shows_a_path(record) for record in simulation.records):
            return
        charges = {
            form: 0.5 * sum(degree(record, order) for record in simulation.records)
            for form, order in FORMS.items()
        }
        if charges[WINDING] == charges[PATH]:
            del charges[WINDING]  # no record has periods enough to wind
        for form, charge in charges.items():
            beside = Beside(self.name, FORMS[form], path)
            yield self.added(simulation, beside, form=form, charge=charge)

    @classmethod
    def levels(cls) -> Beside:
        """Give a constant in each record: an offset of its own, and no drift."""
        return Beside(cls.name, 0, path)

    def describe(self, given: Values, amplitudes: FloatArray) -> dict[str, float]:
        """Give the block's slope: the mean one, of a path that of its ramp."""
        return {"slope": float(np.mean(amplitudes[:, 0]))}


def degree(record: Record, order: int) -> int:
    """Give the degree of a record's path, at most one for each period of the input.

    What goes to and fro as fast as the input could be anything that follows it; a path
    of that degree has half its frequency.
    """
    return min(order, max(1, int(periods_of_input(record))))


def path(
    record: Record, given: Values, order: int, at: SomeSamples = EVERY
) -> FloatArray:
    """Give a ramp, and for a path Legendre polynomials beside it, shape (n, k).

    Of order zero it is a constant: an offset of the record's own, and no drift.
    """
    ramp = record.time[at, None]
    if order == 0:
        return np.ones_like(ramp)
    if order == 1:
        return ramp
    x = np.linspace(-1.0, 1.0, len(record))[at]
    curved = np.polynomial.legendre.legvander(x, order)
    curved[:, degree(record, order) + 1 :] = 0.0
    return np.ascontiguousarray(np.hstack([ramp, curved[:, :1], curved[:, 2:]]))

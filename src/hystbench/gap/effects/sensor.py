"""What a sensor adds: a gain, a curve, and signals that the input does not explain."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np

from hystbench.blocks.calibration_error import CalibrationError as Sensor
from hystbench.gap.effects.effect import Declined, Effect
from hystbench.gap.effects.law import Law, Passed
from hystbench.gap.effects.material import soft_limits
from hystbench.gap.effects.places import places_in_sensor
from hystbench.gap.effects.variant import EVERY, Beside, SomeSamples, Values, Variant
from hystbench.gap.records.nuisance import periods_of_input, shows_a_path
from hystbench.gap.simulation.simulation import Simulation
from hystbench.gap.thresholds import SHAPE
from hystbench.record import FloatArray, Record


class CalibrationError(Effect):
    """A gain and an offset behind the last block."""

    name = "calibration-error"
    shows = "amplitude"
    place = "sensor"

    def variants(self, simulation: Simulation) -> Iterator[Variant]:
        """Offer the gain, the offset and both.

        Beside another shape of the hysteresis there is nothing to offer: what the shape
        misses would pass for a gain, which is the shape's own already.

        Raises
        ------
        Declined
            If the chain has such a shape.
        """
        if any(block.name == SHAPE for block in simulation.chain):
            raise Declined("the other shape of the hysteresis has a gain of its own")
        end = len(simulation.chain)
        step = {"gain": 1e-3, "offset": 1e-3 * simulation.largest(end)}
        for used in CALIBRATIONS:
            yield self.inserted(
                simulation,
                end,
                # The gain is solved for as what it adds to one.
                lambda given: {
                    "gain": 1.0 + given.get("gain", 0.0),
                    "offset": given.get("offset", 0.0),
                },
                form=" and ".join(used),
                unit={name: step[name] for name in used},
            )

    def around(self, passed: Passed) -> Iterator[Law]:
        """Offer them behind a host whose numbers were given.

        One that was identified from the records has a gain and an offset of its own.
        """
        if passed.shortest < passed.step:
            for used in CALIBRATIONS:
                yield Law(" and ".join(used), Sensor(gain=1.0), used, "behind")


CALIBRATIONS = (("gain",), ("offset",), ("gain", "offset"))


UNSIGNED = "unsigned-sensor"


class SensorNonlinearity(Effect):
    """A square and a cube behind the last block, or a sensor that shows no sign.

    Behind what has effects inside it may also near a limit. A material that saturates
    there looks the same, so that the two cannot be told apart.
    """

    name = "sensor-nonlinearity"
    shows = "amplitude"
    place = "sensor"
    laws = (UNSIGNED, "saturation")

    def variants(self, simulation: Simulation) -> Iterator[Variant]:
        """Offer the square, the cube and both, before the sensor's lag as well.

        And the magnitude behind all, where no measured output is below zero and
        simulated ones are.
        """
        for place in places_in_sensor(simulation):
            largest = simulation.largest(place)
            unit = {"quadratic": 1e-3 / largest, "cubic": 1e-3 / largest**2}
            for form, used in CURVES.items():
                yield self.inserted(
                    simulation,
                    place,
                    lambda given: {"quadratic": 0.0, "cubic": 0.0, **given},
                    form=form,
                    unit={name: unit[name] for name in used},
                    free=used,
                    charge=CURVE_CHARGE,
                )

        if hides_the_sign(simulation):
            end = len(simulation.chain)
            yield self.inserted(
                simulation,
                end,
                lambda given: {"scale": 1.0},
                law=UNSIGNED,
                form="magnitude",
            )

    def around(self, passed: Passed) -> Iterator[Law]:
        """Offer it behind the host: both terms, and soft limits."""
        for sign in (1.0, -1.0):
            quadratic, cubic = 0.03 / passed.shown, sign * 0.03 / passed.shown**2
            yield self.curve("behind", "both", quadratic=quadratic, cubic=cubic)
        if passed.both_ways:  # the limit is as far on both sides
            yield from soft_limits(self, passed, "soft")


BELOW = 0.05
"""Share of the largest output: what is further below zero is not noise."""


def hides_the_sign(simulation: Simulation) -> bool:
    """Tell whether outputs are simulated below zero where none is measured there."""
    size = max(float(np.max(np.abs(record.y))) for record in simulation.records)
    simulated = min(float(np.min(y)) for y in simulation.output)
    measured = min(float(np.min(record.y)) for record in simulation.records)
    return simulated < -BELOW * size <= measured


CURVE_CHARGE = 2.0
"""Charge for each form: a sensor's curve has both terms, as a rule. One that is a
square alone is more likely the material's asymmetry, and one that is a cube alone its
saturation: the same curve to the data, and one number less."""
CURVES = {
    "square": ("quadratic",),
    "cube": ("cubic",),
    "both": ("quadratic", "cubic"),
}


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


MAINS_HZ = (50.0, 60.0)
HARMONICS = 3
"""Harmonics of the mains that are looked at: the fundamental, the second and the
third."""


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
"""Share of the sampling rate up to which a record shows a tone."""

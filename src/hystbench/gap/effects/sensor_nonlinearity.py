"""``sensor-nonlinearity``: a static polynomial of the true output."""

from __future__ import annotations

from collections.abc import Iterator

from hystbench.gap.effects.base import Effect, Variant, places_in_sensor
from hystbench.gap.scene import Scene


class SensorNonlinearity(Effect):
    """A square and a cube behind the last block."""

    name = "sensor-nonlinearity"
    place = "sensor"

    def variants(self, scene: Scene) -> Iterator[Variant]:
        """Offer the square, the cube and both, before the sensor's lag as well."""
        for place in places_in_sensor(scene):
            largest = scene.largest(place)
            unit = {"quadratic": 1e-3 / largest, "cubic": 1e-3 / largest**2}
            for form, used in FORMS.items():
                yield self.inserted(
                    scene,
                    place,
                    lambda given: {"quadratic": 0.0, "cubic": 0.0, **given},
                    form=form,
                    unit={name: unit[name] for name in used},
                    free=used,
                )


FORMS = {
    "square": ("quadratic",),
    "cube": ("cubic",),
    "both": ("quadratic", "cubic"),
}

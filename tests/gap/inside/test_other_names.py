"""A curve behind a mass that two names stand for."""

import numpy as np
import pytest

from hystbench.blocks.mechanism import Mechanism
from hystbench.blocks.stiffness import Stiffness
from hystbench.model import Model
from hystbench.quantities import Quantities
from hystbench.record import Channel, Record
from tests.gap.made import shaken
from tests.gap.searched import among, search

CHANNELS = Channel("force", "N"), Channel("way", "mm")
MASS = Mechanism(mass=0.4e-3, damping=8.8e-3, stiffness=0.193)
LIMIT = 60.0
PLANT = Model("plant", *CHANNELS, (MASS, Stiffness(quadratic=0.0, cubic=2e-4)))


def test_a_sensor_and_a_material_that_near_a_limit_are_told_as_a_set():
    random, records = np.random.default_rng(1), []
    t = 1e-3 * np.arange(2500)
    for k in range(3):
        u = shaken(random, t, 0.5, 9)
        x = PLANT.simulate(u, 1e-3)
        y = LIMIT * np.tanh(x / LIMIT)
        y = y + 0.003 * y.std() * random.standard_normal(len(y))
        records.append(Record(f"r{k}", 1e-3, u, y, *CHANNELS, "measured", "fit"))
    curves = among("saturation", "sensor-nonlinearity", "stiffness-hardening")
    about = Quantities("force", "position")
    base = Model("rig", *CHANNELS, (MASS,))
    found = search("rig", records, base, quantities=about, vocabulary=curves).content
    (effect,) = (x for x in found["effects"] if x["place"] == "behind")
    names = {effect["name"], *effect["cannot_be_told_from"]}
    assert names == {"saturation", "sensor-nonlinearity"}
    assert effect["confidence"] <= 0.5
    assert effect["parameters"]["level"]["value"] == pytest.approx(LIMIT, rel=0.02)

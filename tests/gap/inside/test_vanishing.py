"""An effect whose numbers went to where it is another one."""

import numpy as np
import pytest

from hystbench.gap.fitting.least_squares import Fitted
from hystbench.gap.fitting.score import Score
from hystbench.gap.fitting.state import Added, Free, ModelState
from hystbench.gap.inside.likeliest import to_the_end
from hystbench.gap.records.scored_samples import ScoredSamples
from hystbench.model import Model
from hystbench.record import Channel, Record
from tests.gap.small import block

NOISE, DT = 1e-3, 0.01
CHANNELS = Channel("force", "N"), Channel("way", "mm")


@pytest.mark.parametrize(
    ("damping", "friction", "names"),
    [(2.2, 0.0, []), (2.0, 4.0, ["friction"])],
    ids=["a damper", "a friction"],
)
def test_a_friction_that_only_grows_with_the_velocity_is_a_damper(
    damping, friction, names
):
    """What is missing is a tenth of the damper, or a friction that has an end."""
    about = {"mass": 1.0, "stiffness": 100.0}
    law = block("smooth-friction", coulomb=friction, velocity_scale=1.0)
    plant = Model(
        "plant", *CHANNELS, (block("mechanism", damping=damping, **about), law)
    )
    t = DT * np.arange(1500)
    u = 20 * sum(np.sin(w * t + w) for w in (3.0, 7.0, 11.0))
    noise = NOISE * np.random.default_rng(0).standard_normal(len(t))
    records = (Record("r", DT, u, plant.simulate(u, DT) + noise, *CHANNELS, "plant"),)
    begun = block("smooth-friction", coulomb=2.0, velocity_scale=2.0)
    chain = (block("mechanism", damping=2.0, **about), begun)
    numbers = ("coulomb", "velocity_scale")
    values = {name: getattr(begun, name) for name in numbers}
    state = ModelState(
        chain,
        records,
        ScoredSamples.of(records),
        free=tuple(Free(1, name) for name in numbers),
        added=(Added("friction", "inside", "smooth", (1,), values, 2.0),),
        hold="linear",
    ).settled()
    score = Score.plain(state.sample, NOISE**2)
    found = to_the_end([Fitted(state, np.inf)], score)
    assert [name for item in found for name in item.effects] == names

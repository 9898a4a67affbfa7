"""A delay beside a force: to first order a lag does the same."""

from functools import partial

import numpy as np

from hystbench.blocks.friction_force import FrictionForce
from hystbench.blocks.mechanism import Mechanism
from hystbench.gap.effects.law import Law
from hystbench.gap.fitting.edit_chain import without_effect
from hystbench.gap.fitting.least_squares import fitted_to_the_end
from hystbench.gap.fitting.score import Score
from hystbench.gap.fitting.state import Free, ModelState
from hystbench.gap.inside.as_late import lateness, with_others_as_late
from hystbench.gap.inside.insert_law import laws_for, with_law
from hystbench.gap.records.scored_samples import ScoredSamples
from hystbench.record import Channel, Record

DT, FINE, COUNT, NOISE, LATE = 2e-3, 5, 2500, 0.05, 9
AXIS = Mechanism(mass=0.0045, damping=0.025, stiffness=1.7, hold="zero-order")
DRY = FrictionForce(coulomb=2.2, presliding_distance=0.06)
OFFERED = ("friction", "sensor-lag", "drive-lag", "input-delay")


def late_record():
    """An axis with dry friction, to which its command comes nine samples late."""
    rng, time = np.random.default_rng(25), np.arange(COUNT) * DT
    lines = zip(rng.uniform(0.2, 4, 12), rng.uniform(0, 6, 12), strict=True)
    u = sum(4 * np.sin(2 * np.pi * f * time + p) for f, p in lines)
    u *= np.clip(time / 0.4, 0, 1)
    acts = np.repeat(np.concatenate([np.zeros(LATE), u[:-LATE]]), FINE)
    y = AXIS.motion(acts, DT / FINE, (DRY,)).position[::FINE]
    y += NOISE * rng.standard_normal(COUNT)
    about = Channel("force", "N"), Channel("position", "mm"), "twin"
    return Record("random", DT, u, y, *about)


def test_beside_friction_a_delay_takes_the_place_of_a_lag_that_is_as_late():
    records = (late_record(),)
    free = tuple(Free(0, name) for name in ("mass", "damping", "stiffness"))
    sample = ScoredSamples.of(records)
    axis = ModelState((AXIS,), records, sample, free=free, hold="zero-order").settled()
    score = Score.plain(sample, NOISE**2)
    host = fitted_to_the_end(axis, score)
    offer = partial(laws_for, offered=OFFERED)
    friction = with_law(axis, "friction", Law("dry", DRY, ("coulomb",)))
    laws = {law.form: law for law in offer(host)["sensor-lag"]}
    begun = with_law(friction, "sensor-lag", laws["second order"])
    lagging = fitted_to_the_end(begun, score)
    every = with_others_as_late(lagging, [host, lagging], offer, score)
    best = min(every, key=lambda item: item.score)
    assert set(best.effects) == {"friction", "input-delay"}
    assert best.score < lagging.score - 20
    assert abs(lateness(best.state.chain[0]) / (LATE * DT) - 1) < 0.03
    # What is left of both without the one that is late was tried as well.
    left = without_effect(lagging.state, 1).added
    assert any(item.effects == tuple(x.effect for x in left) for item in every)

"""A simpler law stands where the one of many numbers had stood for two effects."""

from dataclasses import replace

import numpy as np
import pytest

from hystbench.gap.effects import effects
from hystbench.gap.fitting.least_squares import Fitted
from hystbench.gap.fitting.model_score import score_of
from hystbench.gap.fitting.score import Score
from hystbench.gap.fitting.state import Added, Free, ModelState
from hystbench.gap.inside.simpler_laws import with_simpler_laws
from hystbench.gap.records.scored_samples import ScoredSamples
from hystbench.record import Channel, Record
from tests.gap.small import block

DT, NOISE = 0.01, 0.05
TORQUE, SPEED = Channel("torque", "N*m"), Channel("speed", "rad/s")
ROTOR = {"mass": 0.02, "damping": 0.002, "output": "velocity"}
COULOMB, DRAG = 0.12, 1.2e-3


def chain_of(friction, **rotor):
    mass = block("mechanism", stiffness=0.0, **{**ROTOR, **rotor})
    return mass, block("drag", coefficient=DRAG), friction


def sliding(name, **numbers):
    return block(name, **{"coulomb": COULOMB, "presliding_distance": 1e-3, **numbers})


@pytest.fixture(scope="module")
def rotor():
    """A fan behind dry friction."""
    rng, found = np.random.default_rng(4), []
    true = chain_of(sliding("friction-force"))
    for k in range(2):
        u = np.repeat(rng.uniform(-0.5, 0.5, 30), 40)
        record = Record(f"{k}", DT, u, u, TORQUE, SPEED, "twin")
        (y,) = ModelState(true, (record,), ScoredSamples.of((record,))).exact
        found.append(replace(record, y=y + NOISE * rng.standard_normal(len(u))))
    return tuple(found)


def state(records, friction, names):
    chain = chain_of(friction)
    free = (
        *(Free(0, name) for name in ("mass", "damping")),
        Free(1, "coefficient"),
        *(Free(2, name) for name in names),
    )
    added = (
        Added("drag", "inside", "square", (1,), {}, 1.0),
        Added("friction", "inside", "LuGre", (2,), {}, float(len(names))),
    )
    sample = ScoredSamples.of(records)
    return ModelState(chain, records, sample, free=free, added=added).settled()


NUMBERS = ("coulomb", "presliding_distance", "static_excess", "stribeck_velocity")


def test_an_excess_that_stood_for_a_drag_goes(rotor):
    """It fades over the whole range of speeds, as no Stribeck's excess does."""
    stuck = sliding(
        "lugre-force", coulomb=1e-3, static_excess=0.11, stribeck_velocity=40.0
    )
    found = state(rotor, stuck, NUMBERS)
    score = Score.plain(found.sample, NOISE**2)
    before = Fitted(found, score_of(found, score))
    (best,) = with_simpler_laws(before, [before], score)
    assert best.effects == before.effects
    assert best.score < before.score
    friction = best.state.chain[2]
    assert friction.name == "friction-force"
    assert friction.coulomb == pytest.approx(COULOMB, rel=0.05)
    assert best.state.chain[1].coefficient == pytest.approx(DRAG, rel=0.1)
    assert best.state.freedom == before.state.freedom - 2
    own = [free.parameter for free in best.state.free if free.block == 2]
    assert own == ["coulomb", "presliding_distance"]


def test_an_effect_alone_and_a_law_of_few_numbers_stay(rotor):
    plain = state(rotor, sliding("friction-force"), NUMBERS[:2])
    score = Score.plain(plain.sample, NOISE**2)
    found = Fitted(plain, score_of(plain, score))
    assert with_simpler_laws(found, [found], score) == [found]
    assert not [*effects()["drag"].simpler(plain.chain[1])]

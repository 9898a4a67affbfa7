"""Another law stands where the one that was found first had stood for two effects."""

from dataclasses import replace

import numpy as np
import pytest

from hystbench.gap.effects import effects
from hystbench.gap.fitting.least_squares import Fitted, fitted_to_the_end
from hystbench.gap.fitting.model_score import score_of
from hystbench.gap.fitting.score import Score
from hystbench.gap.fitting.state import Added, Free, ModelState
from hystbench.gap.inside.other_laws import by_other_laws
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
    (best,) = by_other_laws(before, score)
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
    assert by_other_laws(found, score) == []
    assert not [*effects()["drag"].other_laws(plain.chain[1])]


def test_a_loop_of_the_other_exponent_is_tried_beside_a_spring():
    """Beside a spring that hardens the sharper loop leaves noise alone."""
    rng = np.random.default_rng(6)
    mass = block("mechanism", mass=1.0, damping=1.0, stiffness=50.0)
    spring = block("stiffness", quadratic=0.0, cubic=200.0)
    loop = {"largest": 3.0, "yield_distance": 0.05, "sharing": 0.5}
    sharp = block("hysteretic-force", exponent=2.0, **loop)
    u = np.repeat(rng.uniform(-15, 15, 60), 20)
    force, way = Channel("force", "N"), Channel("way", "m")
    record = Record("one", DT, u, u, force, way, "twin")
    sample = ScoredSamples.of((record,))
    (y,) = ModelState((mass, spring, sharp), (record,), sample).exact
    record = replace(record, y=y + 1e-4 * rng.standard_normal(len(u)))
    free = (
        *(Free(0, name) for name in ("mass", "damping", "stiffness")),
        Free(1, "cubic"),
        *(Free(2, name) for name in loop),
    )
    added = (
        Added("stiffness-hardening", "inside", "cube", (1,), {}, 1.0),
        Added("hysteretic-force", "inside", "Bouc-Wen", (2,), {}, 3.0),
    )
    chain = mass, spring, block("hysteretic-force", exponent=1.0, **loop)
    sample = ScoredSamples.of((record,))
    found = ModelState(chain, (record,), sample, free=free, added=added).settled()
    score = Score.plain(sample, 1e-8)
    before = fitted_to_the_end(found, score)
    (best,) = by_other_laws(before, score)
    assert best.score < before.score - 50
    assert best.forms == ("cube", "Bouc-Wen, exponent 2")
    assert best.state.chain[2].largest == pytest.approx(3.0, rel=0.05)
    assert best.state.freedom == before.state.freedom

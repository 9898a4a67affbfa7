"""Whether what was named may be the base's own, with other numbers."""

import numpy as np
import pytest

from hystbench.gap.fitting.model_score import score_of
from hystbench.gap.fitting.re_tuning_gain import re_tuned_score, repeats_the_base
from hystbench.gap.fitting.state import Added
from hystbench.gap.thresholds import PAYS
from tests.gap.made import record
from tests.gap.small import MODE, block, hysteresis, plain_score, state_of

OSCILLATOR = block("mechanism", mass=1e-4, damping=1e-2, stiffness=30.0)
HARDENING = block("stiffness", quadratic=0.0, cubic=1.0)
DRAG = block("drag", coefficient=1e-5)
PLAY = block("backlash", half_width=0.1)
LATER = block("resonance", **{**MODE, "frequency_hz": 150.0})
NEAR = block("resonance", **{**MODE, "frequency_hz": 95.0})
MODES = (hysteresis(), block("resonance", **MODE))


@pytest.mark.parametrize(
    ("base", "added", "told"),
    [
        ((OSCILLATOR, HARDENING), HARDENING, True),
        ((OSCILLATOR, DRAG), HARDENING, False),
        ((OSCILLATOR,), HARDENING, False),
        ((PLAY,), PLAY, True),
        (MODES, NEAR, True),
        (MODES, LATER, False),
        (MODES, PLAY, False),
    ],
)
def test_a_kind_that_the_base_has_is_told(base, added, told):
    effect = Added("any", "inside", "", (len(base),), {}, 1.0)
    state = state_of((*base, added), added=(effect,))
    assert repeats_the_base(state) is told


def tank(u, rate, rim, dt=0.1, fine=50):
    """Level of a tank with a free outlet, in fine steps; what is above its rim goes."""
    level, found = 0.0, []
    for flow in u.tolist():
        found.append(level)
        for _ in range(fine):
            level += dt / fine * (flow - rate * np.sqrt(max(level, 0.0)))
            level = min(level, rim)
    return np.array(found)


def test_the_rate_of_a_tank_that_overflows_may_be_off():
    """The rim is put into the base's own store: its other numbers are the base's."""
    random = np.random.default_rng(4)
    u = np.repeat(random.uniform(0.0, 2.0, 30), 40)
    noise = 1e-3 * random.standard_normal(len(u))
    given = (record(u, tank(u, 0.5, 4.0) + noise, dt=0.1),)
    store = block("store", gain=1.0, rate=0.49, exponent=0.5, height=4.0, caught=0.0)
    rim = Added("overflow", "inside", "last", (0,), {"0.height": 1e30}, 1.0)
    state = state_of((store,), given, hold="zero-order", added=(rim,))
    score = plain_score(state)
    assert re_tuned_score(state, score, np.inf, far=True) < (
        score_of(state, score) - 3 * PAYS
    )


@pytest.mark.parametrize(("exponent", "told"), [(0.497, True), (0.7, False)])
def test_a_number_about_where_the_base_had_it_is_the_bases_own(exponent, told):
    store = block("store", gain=1.0, rate=0.5, exponent=exponent)
    law = Added("outflow", "inside", "power", (0,), {"0.exponent": 0.5}, 1.0)
    assert repeats_the_base(state_of((store,), added=(law,))) is told

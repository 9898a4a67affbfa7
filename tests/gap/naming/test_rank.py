"""What stands first of the effects that were tried beside a model."""

from dataclasses import dataclass, replace

import numpy as np
import pytest

from hystbench.gap.effects import effects
from hystbench.gap.fitting.edit_chain import with_effect
from hystbench.gap.fitting.model_score import make_score
from hystbench.gap.fitting.refit import finished
from hystbench.gap.fitting.state import Free
from hystbench.gap.naming import rank as module
from hystbench.gap.naming import rivals
from hystbench.gap.naming.rank import does_without_itself, rank
from hystbench.gap.naming.rivals import (
    above_noise_of_its_own,
    beside_their_own_shapes,
    beyond_simpler_laws,
    simplest_of_a_tie,
)
from hystbench.gap.naming.rounds import Candidate, best_forms
from hystbench.gap.records.floor import Floor
from hystbench.gap.simulation.simulation import Simulation
from hystbench.gap.thresholds import CERTAIN, LOOSE, PAYS, SCALE
from tests.gap.made import record
from tests.gap.small import (
    ENVELOPE,
    GPI,
    block,
    chains,
    hysteresis,
    measured,
    plain_score,
    records,
    state_of,
)

NOISE = 0.02
FLOOR = Floor(NOISE, "declared")


def ranked(chain, more=(), names=("calibration-error", "asymmetry")):
    """Rank some effects beside a base on what a chain gives, slightly disturbed."""
    given = measured(chain, NOISE, given=records() * 3)
    state = state_of(more, given)
    known = [effects()[name] for name in names]
    return rank(state, make_score(state, FLOOR), known)


@pytest.mark.parametrize("bias", [0.0, 4e-3, 8e-3])
def test_an_offset_is_no_bias_of_the_field(bias):
    """A bias with the sensor's zero free has an offset and one number more.

    What it takes beyond an offset is a hundredth of the gap at most.
    """
    base = (block("prandtl-ishlinskii", thresholds=[0.0, 0.2, 0.4], weights=[4, 3, 2]),)
    field = (block("gain", value=1.0, offset=bias), *base)
    first, *_ = ranked((*field, block("calibration-error", gain=1.0, offset=0.3)), base)
    assert first.effect == "calibration-error"


def test_creep_stands_behind_a_curve_of_the_base():
    """As of an elastomer under the stress of a squared voltage."""
    lag = block("drive-lag", time_constant_s=2e-3)
    curve = (lag, block("asymmetry", coefficient=3.0))
    slow = block("creep", magnitudes=[0.5], time_constants_s=[0.2])
    first, *_ = ranked((*curve, slow), curve, ("creep", "thermal-drift"))
    assert first.effect == "creep"
    assert first.state.power(0.0) ** 0.5 < 1.5 * NOISE


def test_one_of_two_effects_may_widen_the_gap_of_a_linear_base():
    """A dead zone is most of three gentle records; the hard one is clipped as well.

    With the dead zone the gain is larger, and the hard record is farther off. Nothing
    of that is hidden: a linear base has no shape that could do it.
    """
    t = np.arange(1500) / 1000
    beat = np.sin(2 * np.pi * 4 * t) * np.cos(2 * np.pi * 1.3 * t)
    driven = [(0.25, "a"), (0.3, "b"), (0.35, "c"), (4.0, "hard")]
    given = tuple(record(size * beat, name=name, dt=1e-3) for size, name in driven)
    gain, zone = block("gain", value=12.0), block("dead-zone", half_width=0.15)
    chain = (zone, block("drive-saturation", limit=1.0), gain)
    found = measured(chain, NOISE, given=given)
    state = state_of((block("gain", value=3.0),), found, free=(Free(0, "value"),))
    score = make_score(state, FLOOR)
    state, _ = finished(state, score)
    first, _ = rank(state, score, [effects()[x] for x in ("dead-zone", "asymmetry")])
    assert first.effect == "dead-zone"
    assert first.state.power(0.0) > 4 * state.power(0.0)
    (place,) = first.state.added[0].blocks
    assert first.state.chain[place].half_width == pytest.approx(0.15, rel=0.05)


LOOP = (block("prandtl-ishlinskii", thresholds=[0.0, 0.2, 0.4], weights=[4, 3, 2]),)
FREE = "hysteresis-shape"


@dataclass
class Leaves:
    """A model that leaves a share of the gap, with as many numbers."""

    left: float
    freedom: float

    def share(self, other, _floor, _gap):
        return other.left - self.left

    def power(self, _floor):
        return self.left


@pytest.mark.parametrize(
    ("left", "behind", "gain", "first"),
    [
        (0.02, 10.0, 300.0, "creep"),
        (0.02, CERTAIN + 10, 300.0, FREE),  # beyond doubt
        (LOOSE + 0.02, 10.0, 300.0, FREE),  # the law leaves too much to be a name
        (0.02, 10.0, PAYS - 1, FREE),  # it does not pay
    ],
)
def test_a_free_correction_is_no_rival_of_a_law_that_leaves_little(
    left, behind, gain, first
):
    score = plain_score(state_of(LOOP))
    free = Candidate(FREE, "material", "", 0.0, 400.0, Leaves(0.01, 23.0))
    law = Candidate("creep", "material", "", behind, gain, Leaves(left, 2.0))
    ranking = beyond_simpler_laws([free, law], Leaves(1.0, 0.0), score)
    assert ranking[0].effect == first


@pytest.mark.parametrize(
    ("behind", "numbers", "needs", "exact", "first"),
    [
        (SCALE - 0.1, 1.0, PAYS, True, "saturation"),
        # No simpler: the score decides.
        (SCALE - 0.1, 2.0, PAYS, True, "sensor-nonlinearity"),
        # They can be told apart.
        (SCALE + 0.1, 1.0, PAYS, True, "sensor-nonlinearity"),
        # It does not pay, or was not simulated exactly.
        (SCALE - 0.1, 1.0, 299.0, True, "sensor-nonlinearity"),
        (SCALE - 0.1, 1.0, PAYS, False, "sensor-nonlinearity"),
    ],
)
def test_of_effects_that_cannot_be_told_apart_the_fewest_numbers_go_first(
    behind, numbers, needs, exact, first
):
    curve = Candidate(
        "sensor-nonlinearity", "sensor", "both", 0.0, 300.0, Leaves(0.01, 2.0)
    )
    other = Candidate(
        "saturation", "material", "", behind, 300.0 - behind, Leaves(0.01, numbers)
    )
    last = Candidate("drift", "sensor", declined="added already")
    of_them = {"sensor-nonlinearity", *(["saturation"] if exact else [])}
    ranking = simplest_of_a_tie([curve, other, last], of_them, needs)
    assert ranking[0].effect == first
    assert sorted(x.score for x in ranking[:2]) == [0.0, behind]  # as they were
    assert ranking[-1] is last


@pytest.mark.parametrize(
    ("numbers", "left", "first"),
    [
        (2.0, 0.015, "calibration-error"),
        (2.0, 0.05, "asymmetry"),  # the bias takes what matters
        (3.0, 0.015, "asymmetry"),  # the other is no simpler
    ],
)
def test_a_bias_that_takes_hardly_more_than_a_gain_and_an_offset_is_none(
    numbers, left, first
):
    """Both have an offset: of the bias it is that of the sensor's zero."""
    score = plain_score(state_of(LOOP))
    bias = Candidate("asymmetry", "material", "bias", 0.0, 437.0, Leaves(0.01, 2.0))
    other = Candidate(
        "calibration-error", "sensor", "both", 10.0, 427.0, Leaves(left, numbers)
    )
    ranking = beyond_simpler_laws([bias, other], Leaves(1.0, 0.0), score)
    assert ranking[0].effect == first


def test_a_corner_of_the_field_is_the_limit_of_the_drive():
    """What bends from the smallest signals on is no corner."""
    clipped = (block("drive-saturation", limit=0.5), *LOOP)
    first, soft = ranked(clipped, LOOP, ("saturation", "drive-saturation"))
    assert first.effect == "drive-saturation"
    assert first.form != "rounded"  # the sharpest of these is a clip
    assert soft.score > first.score + PAYS


@pytest.mark.parametrize("share", [0.8, 0.2])
def test_a_linear_base_may_saturate_behind_what_moves(share):
    """Whether the records meet the level seldom or nearly always."""
    moved = chains()["mode inside"]
    level = share * Simulation(moved, records()).largest(len(moved))
    bent = (*moved, block("saturation", level=level))
    first, *_ = ranked(bent, moved, ("saturation", "sensor-nonlinearity"))
    assert first.effect == "saturation"
    (place,) = first.state.added[0].blocks
    assert place == len(moved)
    assert first.state.chain[place].level == pytest.approx(level, rel=0.02)


def test_one_that_was_not_judged_on_records_held_back_is_never_first(monkeypatch):
    """Behind those that get worse there may be one that was out of reach before."""
    judges = {name: getattr(module, name) for name in ("exactly", "on_folds")}
    # The lag loses on folds; simulated exactly the next two do.
    loses = [("on_folds", "sensor-lag")]
    loses += [("exactly", x) for x in ("rate-dependent-hysteresis", "eddy-diffusion")]

    def judge(name):
        def judged(item, *rest):
            found = judges[name](item, *rest)
            less = 1e4 * ((name, item.effect) in loses)
            return replace(found, score=found.score + less, gain=found.gain - less)

        return judged

    monkeypatch.setattr(module, "EXACT", 1)
    for name in judges:
        monkeypatch.setattr(module, name, judge(name))
    inside = "hystbench.gap.naming.rivals.on_folds"
    monkeypatch.setattr(inside, judge("on_folds"))
    names = ("sensor-lag", "rate-dependent-hysteresis", "eddy-diffusion", "drive-lag")
    lag = block("sensor-lag", time_constant_s=0.004)
    first, *_ = ranked((*LOOP, lag), LOOP, names)
    assert first.effect == "drive-lag"
    assert first.gain_on_folds is not None


OTHER = replace(LOOP[0], weights=(4.0, 2.0, 4.0))
"""A loop of another shape."""


def test_a_wrong_shape_behind_a_lag_is_what_the_lagged_model_may_leave():
    """The plant's loop is of another shape and lags; the base knows neither.

    What the shape does wrong lags as well, which no reshaping of the base does.
    """
    lag = block("sensor-lag", time_constant_s=0.02)
    state = state_of(LOOP, measured((OTHER, lag), NOISE, given=records() * 3))
    score = make_score(state, FLOOR)
    (variant, *_) = effects()["sensor-lag"].variants(state.simulation)
    right = with_effect(state, variant, {"time_constant_s": 0.02}).settled()
    beside_the_base_s = score.of(right.residual) - score.least()
    assert above_noise_of_its_own(right, state, NOISE**2) < beside_the_base_s - PAYS


def test_those_that_score_alike_are_compared_beside_their_own_shapes(monkeypatch):
    """The best of them keeps its score and gain; one that is far behind has no part."""
    state = state_of(LOOP, measured((OTHER,), NOISE, given=records() * 3))
    own = iter((70.0, 50.0))
    monkeypatch.setattr(rivals, "above_noise_of_its_own", lambda *_: next(own))
    given = [
        Candidate(name, "drive", score=value, gain=300.0 - value, state=state)
        for name, value in (("delay", 100.0), ("lag", 110.0), ("far", 290.0))
    ]
    found = beside_their_own_shapes(given, ("delay", "lag"), state, NOISE**2)
    assert [(x.effect, x.score, x.gain) for x in found] == [
        ("lag", 110.0, 190.0),
        ("delay", 130.0, 170.0),
        ("far", 290.0, 10.0),
    ]
    assert beside_their_own_shapes(given, ("lag",), state, NOISE**2) == given


def test_of_two_forms_the_one_that_does_better_on_folds_stays():
    plain = Candidate("hysteresis", "material", "plays", 10.0)
    bent = Candidate("hysteresis", "material", "generalized plays", -500.0)
    other = Candidate("creep", "mechanics", "", 5.0)
    on_folds = {"plays": 10.0, "generalized plays": 900.0, "": 5.0}
    found = best_forms([bent, other, plain], lambda item: on_folds[item.form])
    assert found == [plain, other]
    # What declined is no form to stay, unless there is no other.
    declined = Candidate("hysteresis", "material", declined="fits best at an end")
    assert best_forms([declined, plain], lambda item: item.score) == [plain]
    assert best_forms([declined], lambda item: item.score) == [declined]


def test_a_loop_that_bends_is_a_hysteresis_alone():
    """Its form of generalized plays is bent before it is held against plain ones.

    Those leave a sixth of the gap, which a curve beside them would take: a second name.
    """
    loop = block("gpi", **GPI, envelope={**ENVELOPE, "a1": 1.8, "a5": 1.6})
    given = measured((loop,), NOISE, given=records() * 3)
    base = state_of((block("gain", value=20.7),), given)
    known = [effects()[name] for name in ("hysteresis", "saturation")]
    first, *_ = rank(base, make_score(base, FLOOR), known)
    assert (first.effect, first.form) == ("hysteresis", "generalized plays")
    assert first.state.power(NOISE**2) < 0.01 * base.power(NOISE**2)


def test_what_gains_too_little_of_what_is_needed_is_not_refitted():
    lag = block("sensor-lag", time_constant_s=0.004)
    state = state_of(LOOP, measured((*LOOP, lag), NOISE, given=records() * 3))
    score = make_score(state, FLOOR)
    known = [effects()["sensor-lag"]]
    (alone,) = rank(state, score, known, folds=False)
    assert alone.state is not None
    (enough,) = rank(state, score, known, folds=False, needs=alone.gain)
    assert enough.gain == alone.gain
    (less,) = rank(state, score, known, folds=False, needs=10 * alone.gain)
    assert less.state is None
    assert less.gain <= alone.gain
    # An effect that the base was found together with is, as slopes may tell nothing.
    known_of = replace(state, expected="sensor-lag")
    (refitted, *_) = rank(known_of, score, known, folds=False, needs=10 * alone.gain)
    assert refitted.gain == pytest.approx(alone.gain)


@pytest.mark.parametrize("folds", [False, True])
def test_what_is_far_behind_is_refitted_to_the_end_for_folds_alone(monkeypatch, folds):
    """Without them what was judged best so far tells how far a refit has to come."""
    wanted, plain = [], module.added

    def noted(state, trial, score, least):
        wanted.append(least)
        return plain(state, trial, score, least)

    monkeypatch.setattr(module, "added", noted)
    base = block("gpi", envelope=ENVELOPE, **GPI)
    made = (block("drive-lag", time_constant_s=1e-2), base)
    state = state_of((base,), measured(made, NOISE, given=records() * 3))
    known = [effects()[name] for name in ("drive-lag", "sensor-lag", "input-delay")]
    found = rank(state, make_score(state, FLOOR), known, folds=folds)
    assert wanted[0] == np.inf
    assert len(wanted) > 1
    if folds:
        assert set(wanted) == {np.inf}
    else:
        assert wanted[1] < np.inf
        assert wanted[1] > min(item.score for item in found)


@pytest.mark.parametrize(("bias", "alike"), [(0.0, True), (0.15, False)])
def test_a_bias_of_the_field_is_more_than_the_zero_of_a_sensor(bias, alike):
    loop = hysteresis()
    given = (block("gain", value=1.0, offset=bias), loop)
    plant = (*given, block("gain", value=1.0, offset=0.5))
    state = state_of((loop,), measured(plant, NOISE))
    offered = effects()["asymmetry"].variants(state.simulation)
    form = next(item for item in offered if item.form == "bias")
    state = with_effect(state, form, {"bias": 0.01, "zero": 0.5}).settled()
    score = make_score(state, FLOOR, forms=False)
    state, value = finished(state, score)
    assert does_without_itself(state, state.added[-1], value, score) == alike

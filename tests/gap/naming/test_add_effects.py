"""A further round: what it gives to effects that do nothing, and what its end is."""

from dataclasses import replace

import numpy as np
import pytest

from hystbench.gap.effects import effects
from hystbench.gap.fitting.edit_chain import with_effect
from hystbench.gap.fitting.model_score import make_score
from hystbench.gap.fitting.refit import added
from hystbench.gap.fitting.tried import trials_of
from hystbench.gap.naming import add_effects
from hystbench.gap.naming.add_effects import SoFar, advance
from hystbench.gap.naming.rounds import Candidate, Round
from hystbench.gap.progress import silent
from hystbench.gap.records.floor import Floor
from hystbench.gap.thresholds import PAYS
from tests.gap.small import MODE, block, measured, record, records, state_of

NOISE = 0.02
FLOOR = Floor(NOISE, "declared")
LAG_S = 0.004
LIKE_A_MODE = ("eddy-diffusion", "input-delay", "sensor-lag", "hysteresis")
"""What depends on frequency too, and plays, which have an envelope of eight numbers."""


def progress_with(lag_s, more=()):
    """Records of a plant whose drive lags, and a model with that effect in it."""
    gain, lag = block("gain", value=12.0), block("drive-lag", time_constant_s=LAG_S)
    given = measured((lag, gain, *more), NOISE, given=records() * 3)
    before = state_of((gain,), given)
    variant = next(iter(effects()["drive-lag"].variants(before.simulation)))
    after = with_effect(before, variant, {"time_constant_s": lag_s})
    return replace(SoFar.begun(before, FLOOR), state=after.settled())


@pytest.mark.parametrize("lag_s", [LAG_S, 1.3 * LAG_S])
def test_effects_that_do_nothing_gain_nothing_from_the_refit(lag_s):
    """There is a mode too: little else is like it.

    However far the model's own number is from its best: that refit comes first.
    """
    after = advance(progress_with(lag_s, (block("resonance", **MODE),)), FLOOR, print)
    (one,) = after.rounds
    gains = {x.effect: x.gain for x in one.ranking if x.state is not None}
    assert gains.pop("resonance") > PAYS
    others = [gains[name] for name in gains if name not in LIKE_A_MODE]
    assert max(others, default=0.0) < PAYS
    refitted = one.before.value(one.before.free[0])
    assert abs(refitted - lag_s) > 0.01 * LAG_S


def test_a_round_beside_a_model_that_has_all_is_none():
    after = advance(progress_with(LAG_S), FLOOR, print)
    assert after.nothing_to_gain
    assert after.done
    assert not after.rounds


@pytest.mark.parametrize(("share", "ended"), [(0.01, False), (0.2, True)])
def test_the_search_ends_where_no_more_is_left_than_may_stay_unnamed(share, ended):
    """A mode is missing still, and takes more of the gap than the lesser share."""
    progress = progress_with(LAG_S, (block("resonance", **MODE),))
    left = progress.state.power(NOISE**2)
    asked = replace(progress, gap=10 * left, share=share)
    assert advance(asked, FLOOR, print).nothing_to_gain is ended


def two_effects():
    """A model with a delay and a mode, and the rounds in which they were taken."""
    before = progress_with(LAG_S, (block("resonance", **MODE),)).state
    first = Candidate("drive-lag", "drive", score=0.0, gain=900.0, state=before)
    variant = next(iter(effects()["resonance"].variants(before.simulation)))
    state = with_effect(before, variant, MODE)
    second = Candidate("resonance", "mechanics", score=0.0, gain=500.0, state=state)
    return state, [Round(before, 0.0, (x,), True) for x in (first, second)]


@pytest.mark.parametrize(("gain", "tried"), [(PAYS + 1.0, True), (PAYS - 1.0, False)])
def test_what_would_still_pay_is_tried_in_the_place_of_what_was_added(
    gain, tried, monkeypatch
):
    """It takes too little to be a further effect, but an effect may have its place."""
    state, rounds = two_effects()
    more = Candidate("eddy-diffusion", "drive", score=0.0, gain=gain, state=state)
    small = Candidate("creep", "mechanics", score=0.0, gain=1.0, state=state)
    rounds.append(Round(state, 0.0, (more, small), False))
    asked = []

    def looked(state, rounds, floor, say, rivals=()):
        asked.append(set(rivals))
        return state, ()

    monkeypatch.setattr(add_effects, "reconsidered", looked)
    found = SoFar(state, 1.0, rounds=tuple(rounds))
    add_effects.looked_over(found, rounds[0].before, FLOOR, silent)
    assert asked == ([{"eddy-diffusion"}] if tried else [])


def test_where_an_effect_gives_way_all_are_tried_once_more(monkeypatch):
    state, rounds = two_effects()
    more = Candidate("eddy-diffusion", "drive", score=0.0, gain=90.0, state=state)
    rounds.append(Round(state, 0.0, (more,), False))
    asked = []

    def looked(state, rounds, floor, say, rivals=()):
        asked.append(set(rivals))
        lag, mode = state.added
        other = lag._replace(effect="eddy-diffusion")
        return replace(state, added=(other, mode)), ()

    monkeypatch.setattr(add_effects, "reconsidered", looked)
    found = SoFar(state, 1.0, rounds=tuple(rounds))
    add_effects.looked_over(found, rounds[0].before, FLOOR, silent)
    assert asked[0] == {"eddy-diffusion"}
    assert asked[1] > {"creep", "drive-lag"}
    assert len(asked) == 2


def test_another_shape_is_fitted_to_what_it_is_to_take():
    """A laboratory's one play operator in place of five: most of the loop comes back.

    While effects are compared, what a shape could do is spared; its own numbers must
    not be.
    """
    t = np.arange(2500) / 500
    tops = (
        np.interp(t % 1, [0, 0.5, 1], [0, 1, 0])
        * np.array([60, 45, 15, 55, 10])[t.astype(int)]
    )
    rng = np.random.default_rng(1)
    lines = zip(rng.uniform(0.5, 8, 20), rng.uniform(0, 6, 20), strict=True)
    random = sum(4 * np.sin(2 * np.pi * f * t + p) for f, p in lines)
    given = tuple(
        record(u, name=name, dt=1 / 500)
        for name, u in (("tops", tops), ("random", random), ("small", random / 4))
    )
    five, one = (
        (
            block("prandtl-ishlinskii", thresholds=thresholds, weights=weights),
            block("gain", value=gain),
        )
        for thresholds, weights, gain in (
            ((2.0, 6.0, 14.0, 26.0, 40.0), (0.14, 0.13, 0.11, 0.09, 0.08), 0.1),
            ((8.0,), (0.45 / 1.1,), 0.11),
        )
    )
    start = state_of(one, measured(five, 0.006, given=given), count=1000)
    floor = Floor(0.006, "declared")
    score = make_score(start, floor)
    (trial,), _ = trials_of(effects()["hysteresis-shape"], start, score)
    state, value = added(start, trial, score)
    first = Candidate(trial.variant.effect, "material", score=value, state=state)
    rounds = (Round(start, value + 50.0, (first,), True),)
    found = replace(SoFar.begun(start, floor), state=state, rounds=rounds)
    named = add_effects.looked_over(found, start, floor, silent).state
    assert [item.effect for item in named.added] == ["hysteresis-shape"]
    gap = start.power(floor.square)
    assert state.power(floor.square) > 0.1 * gap
    assert named.power(floor.square) < 0.05 * gap

"""A further round: what it gives to effects that do nothing, and where it ends."""

from dataclasses import replace

import pytest

from hystbench.gap.effects import effects
from hystbench.gap.fitting.edit_chain import with_effect
from hystbench.gap.naming.add_effects import SoFar, advance
from hystbench.gap.thresholds import PAYS
from tests.gap.small import MODE, block, measured, records, state_of

NOISE = 0.02
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
    return replace(SoFar.begun(before, NOISE), state=after.settled())


@pytest.mark.parametrize("lag_s", [LAG_S, 1.3 * LAG_S])
def test_effects_that_do_nothing_gain_nothing_from_the_refit(lag_s):
    """There is a mode too: little else is like it.

    However far the model's own number is from its best: that refit comes first.
    """
    after = advance(progress_with(lag_s, (block("resonance", **MODE),)), NOISE, print)
    (one,) = after.rounds
    gains = {x.effect: x.gain for x in one.ranking if x.state is not None}
    assert gains.pop("resonance") > PAYS
    others = {name: gains[name] for name in gains if name not in LIKE_A_MODE}
    assert others
    assert max(others.values()) < PAYS


def test_a_round_beside_a_model_that_has_all_is_none():
    after = advance(progress_with(LAG_S), NOISE, print)
    assert after.closed
    assert after.done
    assert not after.rounds


@pytest.mark.parametrize(("share", "closed"), [(0.01, False), (0.2, True)])
def test_the_search_ends_where_no_more_is_left_than_may_stay_unnamed(share, closed):
    """A mode is missing still, and takes more of the gap than the lesser share."""
    progress = progress_with(LAG_S, (block("resonance", **MODE),))
    left = progress.state.power(NOISE**2)
    asked = replace(progress, gap=10 * left, share=share)
    assert advance(asked, NOISE, print).closed is closed

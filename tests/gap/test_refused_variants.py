"""Variants that their own blocks refuse: the effect declines, the search goes on."""

from dataclasses import replace

import pytest

from hystbench.errors import InputError
from hystbench.gap.effects import effects
from hystbench.gap.effects.effect import Declined, Effect
from hystbench.gap.fitting.tried import trials_of
from hystbench.gap.fitting.variant_search import Attempt
from hystbench.gap.naming.rank import rank
from tests.gap.small import block, coarse, measured, plain_score, state_of

NOISE = 0.02


class Lags(Effect):
    """The drive's lag, of which some variants refuse every value."""

    name, place = "drive-lag", "drive"

    def __init__(self, *refused):
        self.refused = refused

    def variants(self, simulation):
        lag, *_ = effects()["drive-lag"].variants(simulation)

        def refuse(values):
            raise InputError(f"time_constant_s: {values['time_constant_s']:g} is not")

        for refused in self.refused:
            yield replace(lag, build=refuse) if refused else lag


@pytest.fixture(scope="module")
def beside():
    lag = block("drive-lag", time_constant_s=0.004)
    gain = block("gain", value=12.0)
    state = state_of((gain,), measured((lag, gain), NOISE))
    return state, plain_score(state, NOISE**2)


def test_a_variant_that_refuses_every_point_declines_with_the_last_message(beside):
    state, score = beside
    (variant,) = Lags(True).variants(state.simulation)
    last = variant.grids["time_constant_s"][-1]
    with pytest.raises(Declined, match=f"^time_constant_s: {last:g} is not$"):
        coarse(Attempt(state, variant, score))


def test_an_effect_declines_if_all_of_its_variants_do(beside):
    state, score = beside
    trials, why = trials_of(Lags(True, True), state, score)
    assert not trials
    assert why.startswith("time_constant_s: ")
    lag, gain = rank(state, score, [Lags(True), effects()["calibration-error"]])[::-1]
    assert (lag.effect, lag.state) == ("drive-lag", None)
    assert lag.declined == why
    assert not gain.declined


def test_one_variant_that_refuses_leaves_the_others(beside):
    state, score = beside
    trials, why = trials_of(Lags(True, False), state, score)
    assert not why
    (trial,) = trials
    (alone,), _ = trials_of(Lags(False), state, score)
    assert trial.values == alone.values

"""Adding ends at noise and step error together."""

from dataclasses import replace

import numpy as np
import pytest

from hystbench.blocks.curve import finer
from hystbench.gap.effects import effects
from hystbench.gap.fitting.edit_chain import with_effect
from hystbench.gap.fitting.model_score import above_floor, floor_with_steps, step_error
from hystbench.gap.fitting.on_records import start_state
from hystbench.gap.naming import add_effects as naming
from hystbench.gap.naming.add_effects import SoFar, advance
from hystbench.gap.progress import silent
from hystbench.gap.records.floor import Floor
from hystbench.gap.simulation.simulation import Simulation
from hystbench.model import Model
from tests.gap.made import CURRENT, DISPLACEMENT, record
from tests.gap.small import block, hysteresis, plain_score, records

NOISE = 0.02
FLOOR = Floor(NOISE, "declared")


def steps_of(chain, one):
    """What a loop misses at the samples, by far more steps of it than ours."""
    fine = finer(one.u, 64)
    exact = chain[0].simulate(fine, fine, one.dt / 64)[::64]
    return float(
        np.sqrt(np.mean((chain[0].simulate(one.u, one.u, one.dt) - exact) ** 2))
    )


def left_with(size, chain, seed=7):
    """A model that leaves white noise of an RMS on every record."""
    rng = np.random.default_rng(seed)
    exact = Simulation(chain, records(), "band-limited", "fine").output
    made = tuple(
        record(one.u, y + size * rng.standard_normal(len(y)), name=one.name, dt=one.dt)
        for one, y in zip(records(), exact, strict=True)
    )
    base = Model("rig", CURRENT, DISPLACEMENT, chain)
    return start_state(made, base, declared=NOISE)[0]


def test_powers_of_noise_and_steps_add():
    assert floor_with_steps(3.0, 4.0) == 5.0
    assert floor_with_steps(0.02, 0.0) == 0.02


def test_what_the_steps_miss_is_nothing_to_gain():
    """A quarter of the step error's power beside the noise; five times as much."""
    chain = (hysteresis(),)
    squares = [steps_of(chain, one) ** 2 for one in records()]
    error = float(np.sqrt(np.mean(squares)))
    assert step_error(left_with(NOISE, chain)) == pytest.approx(error, rel=0.2)
    noise = error / 2
    for share, nothing in ((0.25, True), (5.0, False)):
        state = left_with(np.hypot(noise, np.sqrt(share) * error), chain)
        score = plain_score(state, noise**2)
        alone = score.of(state.residual) - score.least()
        assert alone > 1.0  # to noise alone there is something to gain
        gain = above_floor(state, score)
        assert gain < alone
        assert (gain == pytest.approx(0.0, abs=1e-9)) is nothing


def test_of_a_simulator_whose_inside_is_not_seen_no_step_error_is_claimed():
    """Its steps are its own; the noise alone is the floor then."""
    state = left_with(NOISE, (block("gain", value=12.0),))
    stored = block("simulated-column", column="any")
    assert step_error(state) == pytest.approx(0.0, abs=1e-9)
    assert step_error(replace(state, chain=(stored,))) is None
    assert floor_with_steps(NOISE, None) == NOISE


def test_without_steps_it_is_the_floor_of_the_noise():
    state = left_with(3 * NOISE, (block("gain", value=12.0),))
    score = plain_score(state, NOISE**2)
    alone = score.of(state.residual) - score.least()
    assert above_floor(state, score) == pytest.approx(alone, rel=1e-9)


@pytest.mark.parametrize("error", [0.0, 1.0])
def test_no_effect_is_tried_where_steps_hold_what_is_left(monkeypatch, error):
    """The round ends before the search; without a step error the search begins."""
    state = left_with(3 * NOISE, (block("gain", value=12.0),))
    (lag, *_) = effects()["sensor-lag"].variants(state.simulation)
    state = with_effect(state, lag, {"time_constant_s": 1e-7}).settled()

    class SearchedError(Exception):
        pass

    def rank(*given, **more):
        raise SearchedError

    monkeypatch.setattr(naming, "rank", rank)
    monkeypatch.setattr(
        "hystbench.gap.fitting.model_score.step_error", lambda state: error
    )
    progress = SoFar(state, 8 * NOISE**2)  # all that the base leaves is still there
    if error:
        assert advance(progress, FLOOR, silent).done
    else:
        with pytest.raises(SearchedError):
            advance(progress, FLOOR, silent)

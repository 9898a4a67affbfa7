"""Records of a hardening spring that jump between two motions, and a fit to them."""

import numpy as np
import pytest

from hystbench.gap.fitting import in_stages
from hystbench.gap.fitting.in_stages import fitted_in_stages, gentlest, led_out
from hystbench.gap.fitting.least_squares import Fitted, fitted_to_the_end
from hystbench.gap.fitting.score import Score
from hystbench.gap.fitting.state import Free, ModelState
from hystbench.gap.inside.one_coordinate import best_host, one_coordinate
from hystbench.gap.records.scored_samples import ScoredSamples
from hystbench.gap.thresholds import PAYS
from hystbench.model import Model
from hystbench.quantities import Quantities
from hystbench.record import Channel, Record
from tests.gap.small import block

CUBIC, NOISE, DT = 60.0, 1e-3, 0.02
CHANNELS = Channel("f", "V"), Channel("x", "V")
MASS = "mass", "damping", "stiffness"


def through_its_resonance(levels):
    """Sweeps and sums of sines in turn, through the mode at 10 rad/s."""
    rng, t = np.random.default_rng(0), DT * np.arange(1500)
    host = block("mechanism", mass=1.0, damping=0.5, stiffness=100.0)
    spring = block("stiffness", quadratic=0.0, cubic=CUBIC)
    plant, sweep = Model("plant", *CHANNELS, (host, spring)), np.linspace(6, 18, 1500)
    given = []
    for k, level in enumerate(levels):
        phases = rng.uniform(0, 6, 9)
        sines = np.sin(np.outer(t, np.linspace(5, 16, 9)) + phases).sum(axis=1)
        u = level * (sines / 2 if k % 2 else np.sin(DT * np.cumsum(sweep)))
        y = plant.simulate(u, DT) + NOISE * rng.standard_normal(len(u))
        given.append(Record(f"{k}", DT, u, y, *CHANNELS, "measured"))
    return tuple(given)


def of(records, *chain, cubic=False):
    free = [Free(0, name) for name in MASS] + [Free(1, "cubic")] * cubic
    sample = ScoredSamples.of(records)
    return ModelState(chain, records, sample, free=tuple(free), hold="linear").settled()


def begun(records):
    """The mass is a little off, and the spring hardens by a fortieth."""
    host = block("mechanism", mass=1.02, damping=0.65, stiffness=103.0)
    spring = block("stiffness", quadratic=0.0, cubic=CUBIC / 40)
    return of(records, host, spring, cubic=True)


def test_gentle_records_lead_to_numbers_that_the_others_stop_short_of():
    records = through_its_resonance((1, 1, 20, 8))
    state = begun(records)
    linear = of(records, block("mechanism", mass=1.0, damping=0.55, stiffness=101.0))
    gentle = gentlest(linear)
    assert gentle == (0, 1)
    score = Score.plain(state.sample, NOISE**2)
    staged = led_out(fitted_in_stages(state, score, gentle), score)
    assert staged.state.chain[1].cubic == pytest.approx(CUBIC, rel=0.01)
    assert staged.score < fitted_to_the_end(state, score).score - 100


def test_what_leaves_noise_is_fitted_once():
    records = through_its_resonance((1, 1))
    state = begun(records)
    score = Score.plain(state.sample, NOISE**2)
    once = fitted_to_the_end(state, score)
    assert once.score < score.least(once.state.freedom) + PAYS
    assert fitted_in_stages(state, score, (0,)).score == once.score
    assert led_out(once, score) is once


def test_the_worst_record_leads_out_of_a_valley():
    """The others hold numbers that they fit, of which the loud one has no use."""
    records = through_its_resonance((1, 1, 14))
    score = Score.plain(ScoredSamples.of(records), NOISE**2)
    stopped = fitted_to_the_end(begun(records), score)
    assert stopped.score > score.least(stopped.state.freedom) + PAYS
    led = led_out(stopped, score)
    assert led.score < stopped.score - 100


def test_one_record_has_no_gentle_half():
    assert gentlest(begun(through_its_resonance((1,)))) == ()


def test_a_host_is_known_by_the_records_in_which_the_spring_is_linear():
    """Of the loud ones alone the motion would be a velocity, or the mode elsewhere."""
    records = through_its_resonance((1, 1, 20, 8))
    score = Score.plain(ScoredSamples.of(records), NOISE**2)
    hosts = one_coordinate(records, Quantities("voltage", "voltage"), "linear")
    mass = best_host(hosts, score).state.chain[0]
    assert mass.output == "position"
    assert mass.stiffness / mass.mass == pytest.approx(100.0, rel=0.03)


@pytest.mark.parametrize(
    ("scores", "last"),
    [
        ((100.0, 60.0, 30.0, 10.0), "to the end"),  # overtakes
        ((100.0, 95.0, 60.0), 95.0),  # falls too slowly
        ((100.0, 99.0, 20.5, 20.4, 20.3), 99.0),
        ((22.0, 20.5, 20.4, 20.3), 20.5),  # comes to the same place
        ((np.inf, np.inf, np.inf), np.inf),  # runs away
    ],
)
def test_a_fit_is_left_that_does_not_overtake(scores, last, monkeypatch):
    """The other fit has a score of 20."""
    left = list(scores)

    def fitted_on(state, score, evaluations=0):
        return Fitted(state, left.pop(0))

    monkeypatch.setattr(in_stages, "fitted", fitted_on)
    monkeypatch.setattr(in_stages, "fitted_to_the_end", lambda *_: "to the end")
    begun = Fitted(None, left.pop(0))
    found = in_stages._overtaking(begun, None, Fitted(None, 20.0))
    assert getattr(found, "score", found) == last

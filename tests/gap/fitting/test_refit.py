"""Fits: never worse than what they start from, and where a plain minimiser ends."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy import optimize

from hystbench.blocks.mechanism import Mechanism
from hystbench.blocks.stop import Stop
from hystbench.errors import InputError
from hystbench.gap.effects import effects
from hystbench.gap.fitting import refit as refits
from hystbench.gap.fitting.cross_validation import gain_on_folds
from hystbench.gap.fitting.edit_chain import with_effect
from hystbench.gap.fitting.model_score import (
    make_score,
    score_of,
    score_of_numbers,
)
from hystbench.gap.fitting.refit import (
    FAR,
    added,
    finished,
    finished_to_the_end,
    mended,
    refit,
    sizes,
)
from hystbench.gap.fitting.state import Added, Free, ModelState
from hystbench.gap.fitting.variant_search import Attempt, fine
from hystbench.gap.naming.rank import rank
from hystbench.gap.records.floor import Floor
from hystbench.gap.thresholds import PARAMETER, SCALE
from hystbench.model import Model
from hystbench.record import Channel, Record
from tests.gap.made import record
from tests.gap.small import (
    ENVELOPE,
    block,
    chains,
    coarse,
    hysteresis,
    measured,
    plain_score,
    records,
    state_of,
)

NOISE = 0.02
FLOOR = Floor(NOISE, "declared")
CHANNELS = Channel("force", "N"), Channel("position", "mm")


def lagged(tau):
    return (block("drive-lag", time_constant_s=tau), hysteresis())


def mode(hertz, part):
    return (
        hysteresis(),
        block("resonance", frequency_hz=hertz, damping_ratio=0.05, participation=part),
    )


def free_of(chain, names):
    return tuple(
        Free(k, name)
        for k, item in enumerate(chain)
        for name in names
        if name in item.parameters()
    )


def test_a_refit_ends_where_it_could_not_come_so_far_as_is_wanted(monkeypatch):
    """Not after the first round: of a lag from a tenth the second one gains more."""
    monkeypatch.setattr(refits, "MENDED", 1)  # so that rounds can be asked for
    given_records = measured(lagged(1e-2), NOISE)
    chain = lagged(1e-3)
    state = state_of(chain, given_records, free=free_of(chain, ["time_constant_s"]))
    score = plain_score(state, NOISE**2)
    before = score_of(state, score)
    once, twice, whole = (refit(state, score, rounds)[1] for rounds in (1, 2, 5))
    assert once - twice > before - once
    assert twice > whole
    assert refit(state, score, wanted=whole)[1] == whole
    assert refit(state, score, wanted=twice - 3 * (once - twice) - 1.0)[1] == twice


@given(
    st.floats(2e-4, 3e-2),
    st.floats(1e-4, 5e-2),
    st.sampled_from([1e-9, 4e-4, 1.0]),
)
@settings(max_examples=20)
def test_a_refit_never_scores_worse(there, start, floor):
    given_records = measured(lagged(there), NOISE)
    chain = lagged(start)
    state = state_of(chain, given_records, free=free_of(chain, ["time_constant_s"]))
    score = plain_score(state, floor)
    after, value = refit(state, score)
    assert value <= score_of(state, score)
    assert value == pytest.approx(score_of(after, score))
    assert [x.name for x in after.chain] == [x.name for x in chain]


@given(st.integers(0, 2**32 - 1))
@settings(max_examples=10)
def test_a_refit_of_many_numbers_never_scores_worse(seed):
    """Far off, with every number free: steps that do harm are taken back."""
    rng = np.random.default_rng(seed)
    given_records = measured(mode(110.0, 0.25), NOISE)
    chain = mode(*(np.array([110.0, 0.25]) * rng.uniform(0.3, 2.5, 2)))
    names = ["frequency_hz", "damping_ratio", "participation"]
    free = (*free_of(chain, names), *(Free(0, "weights", k) for k in range(4)))
    state = state_of(chain, given_records, free=free)
    score = make_score(state, FLOOR)
    after, value = refit(state, score)
    assert value <= score_of(state, score)
    for item in after.free:
        about = after.chain[item.block].parameters()[item.parameter]
        assert about.low <= after.value(item) <= about.high


def test_a_refit_ends_where_a_plain_minimiser_does():
    given_records = measured(lagged(4e-3), NOISE)
    chain = lagged(3e-3)
    state = state_of(chain, given_records, free=free_of(chain, ["time_constant_s"]))
    score = plain_score(state)
    after, value = refit(state, score)

    def plain(tau):
        return score_of(replace(state, chain=lagged(tau)), score)

    best = optimize.minimize_scalar(plain, bounds=(2e-3, 6e-3), method="bounded")
    assert value < best.fun + 0.1
    assert after.chain[0].time_constant_s == pytest.approx(best.x, rel=1e-2)
    assert after.chain[0].time_constant_s == pytest.approx(4e-3, rel=2e-2)


def test_mended_tangents_foretell_the_step_and_stay_as_they_are_across_it():
    chain = mode(100.0, 0.2)
    free = free_of(chain, ["frequency_hz", "participation"])
    state = state_of(chain, measured(mode(110.0, 0.25), NOISE), free=free)
    size, step = np.array([100.0, 0.2]), np.array([8.0, 0.04])
    moved = state.moved(dict(enumerate(step.tolist())))
    tangents = mended(state.tangents, state, moved, size)
    change = state.residual - moved.residual
    assert not np.allclose(state.tangents @ step, change, rtol=1e-2)
    np.testing.assert_allclose(tangents @ step, change, rtol=1e-9)
    in_sizes = step / size
    across = np.array([-in_sizes[1], in_sizes[0]]) * size
    np.testing.assert_allclose(tangents @ across, state.tangents @ across, rtol=1e-9)


def test_a_refit_takes_tangents_of_the_bases_numbers_where_it_has_come_far(
    monkeypatch,
):
    """It ends where one does that takes them in every round, to a tenth of a number."""
    chain = mode(100.0, 0.2)
    free = free_of(chain, ["frequency_hz", "participation", "damping_ratio"])
    state = state_of(chain, measured(mode(110.0, 0.25), NOISE), free=free)
    score = plain_score(state)
    best = score_of(state, score)
    every = state
    for _ in range(8):
        every, best = refit(every, score, rounds=1)
    taken, moved = [], []
    tangents, at = ModelState.tangents_of, ModelState.at

    def counted(self, numbers):
        taken.extend(numbers)
        return tangents(self, numbers)

    def stepped(self, *values):
        moved.append(values)
        return at(self, *values)

    monkeypatch.setattr(ModelState, "tangents_of", counted)
    monkeypatch.setattr(ModelState, "at", stepped)
    _, value = refit(replace(state), score)
    assert value == pytest.approx(best, abs=PARAMETER / 10)
    assert len(taken) <= 2 * len(free) < 4 * len(free) <= len(moved) * len(free)


def test_tangents_that_are_lent_are_not_taken_anew(monkeypatch):
    chain = mode(108.0, 0.2)
    free = free_of(chain, ["frequency_hz", "participation"])
    state = state_of(chain, measured(mode(110.0, 0.25), NOISE), free=free)
    score = plain_score(state)
    _, best = refit(state, score)
    lent = state.tangents.copy()
    monkeypatch.setattr(ModelState, "tangents", None)
    _, value = refit(replace(state), score, lent=lent)
    assert score_of(state, score) - value > 0.9 * (score_of(state, score) - best)


def test_a_tolerance_holds_a_number_of_the_base_back():
    given_records = measured((block("gain", value=12.0),), NOISE)
    found = {}
    for tolerance in (None, 1.0, 1e-3):
        state = state_of(
            (block("gain", value=11.0),),
            given_records,
            free=(Free(0, "value", None, tolerance, given=11.0),),
        )
        after, _ = refit(state, plain_score(state))
        found[tolerance] = after.chain[0].value
    assert found[None] == pytest.approx(12.0, rel=1e-3)
    assert found[None] >= found[1.0] - 1e-6
    assert 11.0 <= found[1e-3] < 11.5


def test_beside_a_number_at_the_end_of_its_range_the_others_are_at_their_best():
    # Cut off behind the step, the gain would leave the offset of a gain of 1.5.
    u = 1.0 + np.sin(np.arange(400) / 7)
    given = record(u, 1.5 * u + 0.2)
    chain = (block("gain", value=1.0, offset=0.0),)
    free = (Free(0, "value", low=0.9, high=1.1), Free(0, "offset"))
    state = replace(state_of(chain, [given]), free=free)
    found, _ = refit(state, plain_score(state, 0.01))
    gain, offset = (found.value(item) for item in free)
    assert gain == 1.1
    assert offset == pytest.approx(np.mean(given.y - 1.1 * u), rel=1e-2)


def test_a_held_number_stays_where_it_was_fitted_first():
    # Each refit would else begin where the last one ended, and pay nothing for it.
    loop, lag = hysteresis(), block("drive-lag", time_constant_s=4e-3)
    found = measured((lag, loop, block("gain", value=1.3)), NOISE)
    free = (Free(1, "value", None, 0.02, given=1.0),)
    state = state_of((loop, block("gain", value=1.0)), found, free=free)
    score = plain_score(state)
    once, least = finished(state, score)
    again, value = finished(once, score)
    assert again.chain[1].value == pytest.approx(once.chain[1].value, abs=2e-3)
    moved = (once.chain[1].value - 1.0) / 0.02
    assert least == pytest.approx(score.of(once.residual) + moved**2)
    assert value == pytest.approx(least, abs=0.1)


def test_numbers_are_found_below_a_floor_that_is_too_high():
    """Where the noise is only bounded the score is flat over a range of values."""
    found = measured((block("gain", value=12.0),), NOISE)
    free = (Free(0, "value"),)
    # What is left is above the noise, and below the floor.
    state = state_of((block("gain", value=12.02),), found, free=free)
    floor = 3 * float(np.sqrt(state.power(0.0)))
    flat, _ = finished(state, plain_score(state, floor**2))
    best, _ = finished(state, score_of_numbers(state, Floor(floor, "declared")))
    least = float(np.mean(state.squares))
    assert np.mean(best.squares) <= np.mean(flat.squares) <= least * 1.001
    truth = [r.u @ r.y / (r.u @ r.u) for r in found]
    assert min(truth) <= best.chain[0].value <= max(truth)


def attempt(state, score, name):
    variant = next(iter(effects()[name].variants(state.simulation)))
    return Attempt(state, variant, score)


def test_the_coarse_search_is_the_best_point_of_the_grid():
    state = state_of((hysteresis(),), measured(lagged(4e-3), NOISE))
    score = plain_score(state)
    one = attempt(state, score, "drive-lag")
    axis = one.variant.grids["time_constant_s"]
    found = coarse(one)
    values = [
        score_of(
            with_effect(state, one.variant, {"time_constant_s": float(tau)}), score
        )
        for tau in axis
    ]
    assert found.score == pytest.approx(min(values))
    assert found.values["time_constant_s"] == axis[np.argmin(values)]


def test_the_fine_search_stays_in_its_grid_and_is_no_worse():
    state = state_of((hysteresis(),), measured(lagged(4e-3), NOISE))
    score = plain_score(state)
    one = attempt(state, score, "drive-lag")
    start = coarse(one)
    end = fine(start)
    assert end.score <= start.score
    # Where the grid is halved twice it is as near as a quarter of a step.
    axis = one.variant.grids["time_constant_s"]
    step = np.log(axis[1] / axis[0]) / 4
    assert abs(np.log(end.values["time_constant_s"] / 4e-3)) < 2 * step
    edge = fine(one.at((float(axis[0]),)))
    assert edge.values["time_constant_s"] >= axis[0]


@pytest.mark.parametrize("name", ["drive-lag", "resonance"])
def test_a_step_is_the_same_with_the_signals_at_hand_and_without(name):
    state = state_of((hysteresis(),), measured(mode(110.0, 0.25), NOISE))
    score = plain_score(state)
    one = attempt(state, score, name)
    best = coarse(one)
    other = one.at(tuple(float(axis[0]) for axis in one.variant.grids.values()))
    assert other.score > best.score
    for trial in (best, other):
        without = attempt(state, score, name)  # has looked at no point
        np.testing.assert_array_equal(one.step(trial), without.step(trial))


def test_what_is_solved_for_comes_out_as_it_was_put_in():
    state = state_of((hysteresis(),), measured(mode(110.0, 0.25), NOISE))
    score = plain_score(state)
    one = attempt(state, score, "resonance")
    trial = fine(coarse(one))
    after, value = added(state, trial, score)
    assert value <= trial.score + 1.0
    found = after.chain[1]
    assert found.frequency_hz == pytest.approx(110.0, rel=0.02)
    assert found.participation == pytest.approx(0.25, rel=0.1)


def test_finished_is_exact_and_no_worse_than_its_start_is_exactly():
    chain = mode(100.0, 0.2)
    free = free_of(chain, ["frequency_hz", "participation"])
    state = state_of(chain, measured(mode(110.0, 0.25), NOISE), free=free)
    score = plain_score(state)
    after, value = finished(state, score)
    assert value <= score_of(state.settled(), score)
    exact = after.settled()
    assert value == pytest.approx(score_of(exact, score))


def test_declined_effects_stand_at_the_end_with_a_reason():
    state = state_of(chains()["gain"], measured(chains()["gain"], NOISE))
    known = [effects()[x] for x in ("hysteresis-shape", "calibration-error")]
    ranking = rank(state, plain_score(state, NOISE**2), known)
    assert {item.effect for item in ranking} == {item.name for item in known}
    last = ranking[-1]
    assert last.effect == "hysteresis-shape"
    assert "no hysteresis" in last.declined
    assert last.state is None


def test_an_effect_is_not_added_twice():
    chain = lagged(4e-3)
    state = state_of((hysteresis(),), measured(chain, NOISE))
    score = plain_score(state, NOISE**2)
    known = [effects()[x] for x in ("drive-lag", "calibration-error")]
    first = rank(state, score, known)[0]
    assert first.effect == "drive-lag"
    again = rank(first.state, score, known)
    assert again[-1].effect == "drive-lag"
    assert again[-1].declined == "added already"


def test_gains_are_what_the_score_falls_by():
    state = state_of((hysteresis(),), measured(lagged(4e-3), NOISE))
    score = make_score(state, FLOOR)
    now = score_of(state, score)
    names = ("resonance", "input-delay", "asymmetry")
    ranking = rank(state, score, [effects()[x] for x in names])
    judged = [item for item in ranking if not item.declined]
    for item in judged:
        assert item.gain == pytest.approx(now - item.score)
    finalists = [item.score for item in judged if item.state is not None]
    assert finalists == sorted(finalists)
    # Those of several laws pay for the choice as well.
    plain = [item for item in judged if len(item.variants) == 1]
    assert any(item.gain_on_folds is not None for item in plain)
    for item in plain:
        if item.gain_on_folds is not None:
            gain = now - score_of(item.state, score)
            held = gain_on_folds(state, item.state, score)
            charged = held - PARAMETER * item.state.freedom
            assert item.gain == pytest.approx(min(gain, charged))
        elif item.state is not None:
            assert score_of(item.state, score) == pytest.approx(item.score)


def test_the_frequency_of_a_tone_is_found_to_what_the_noise_lets_see():
    noise, hertz = 0.002, 50.037
    plain = measured(chains()["gain"], noise)
    picked = [
        replace(item, y=item.y + 0.3 * np.sin(2 * np.pi * hertz * item.time + k))
        for k, item in enumerate(plain)
    ]
    state = state_of(chains()["gain"], tuple(picked))
    tone = next(effects()["mains-pickup"].variants(state.simulation))
    near = with_effect(state, tone, {"frequency_hz": hertz + 0.02})
    after, _ = finished(near, plain_score(state, noise**2))
    ((_, values),) = after.beside
    # The bound of Cramer and Rao for the longer record alone, its scored samples.
    length, count = plain[0].time[-1], len(state.sample.positions[0])
    bound = np.sqrt(6 / count) * noise / (np.pi * 0.3 * length)
    assert abs(values["frequency_hz"] - hertz) < 4 * bound


@pytest.mark.parametrize("unit", [1.0, 2.0**-20])
def test_a_number_that_hardly_moves_the_output_stays_among_those_of_its_list(unit):
    """An operator that the input only just reaches; its weight could be anything."""
    one = block("gpi", envelope=ENVELOPE, thresholds=[0.0], weights=[1.0])
    reach = max(one.simulate(x.u, x.u, x.dt).max() for x in records())
    loop = block(
        "gpi",
        envelope=ENVELOPE,
        thresholds=[0.0, reach - 1e-9],
        weights=[0.8 * unit, 0.5 * unit],
    )
    state = state_of((loop,), free=tuple(Free(0, "weights", k) for k in (0, 1)))
    own, hardly = sizes(state, state.tangents) / unit
    assert own == pytest.approx(0.8)
    assert 0.5 <= hardly <= 0.8 * FAR


def test_a_number_that_is_zero_has_the_size_that_moves_the_output_a_tenth():
    chain = (hysteresis(), block("asymmetry", coefficient=0.0))
    state = state_of(chain, free=free_of(chain, ["coefficient"]))
    (size,) = sizes(state, state.tangents)
    plain = np.concatenate(
        [
            x[at]
            for x, at in zip(
                state.simulation.output, state.sample.positions, strict=True
            )
        ]
    )
    wanted = 0.1 * np.sqrt(np.mean(plain**2) / np.mean(plain**4))
    assert size == pytest.approx(wanted, rel=1e-3)


def test_plays_do_not_run_against_free_numbers_of_a_filter():
    """A play without a threshold does what the gain does: the two could grow apart."""
    law = {"thresholds": [0.0, 0.2, 0.4], "weights": [0.0, 0.2, 0.1]}
    (there,) = chains()["mode inside"]
    given_records = measured((block("prandtl-ishlinskii", **law), there), NOISE)
    chain = (replace(there, numerator=(12.5,)), block("gain", value=1.0))
    of_filter = (Free(0, "denominator", k) for k in range(4))
    free = (Free(0, "numerator", 0), *of_filter, Free(1, "value"))
    state = state_of(chain, given_records, free=free)
    score = plain_score(state, NOISE**2)
    effect = effects()["hysteresis"]
    plays = next(x for x in effect.variants(state.simulation) if x.form == "plays")
    found = coarse(Attempt(state, plays, score))
    assert abs(found.values["weight 0"]) < 1e-3
    assert added(state, found, score)[1] < found.score + 10


FILTER = {"numerator": [12.0], "denominator": [1e-4, 1e-4, 1.0]}


def test_a_pole_that_a_refit_moves_over_the_axis_is_put_back_as_far_before_it():
    chain = (block("transfer-function", **FILTER),)
    free = tuple(Free(0, "denominator", k) for k in range(3))
    state = state_of(chain, free=free)
    (moved,) = state.moved({1: -3e-4}, reflected=True).chain
    assert moved.denominator == pytest.approx((1e-4, 2e-4, 1.0))
    with pytest.raises(InputError, match="unstable"):
        state.moved({1: -3e-4})


def test_numbers_of_a_block_are_moved_together():
    """One after the other the filter would be unstable between."""
    chain = (block("transfer-function", **FILTER),)
    free = tuple(Free(0, "denominator", k) for k in range(3))
    (moved,) = state_of(chain, free=free).moved({0: -2e-4, 1: -2e-4, 2: -2.0}).chain
    assert moved.denominator == pytest.approx((-1e-4, -1e-4, -1.0))


def test_numbers_that_stand_in_for_each_other_are_fitted_to_the_end():
    """A law's coefficient and exponent: five rounds end on the way."""
    t = np.arange(3000) / 1000
    tones = ((0.7, 1.1), (3.1, 0.9), (11.0, 1.2), (23.0, 0.6))
    u = sum(size * np.sin(2 * np.pi * hz * t) for hz, size in tones)
    loop = block(
        "prandtl-ishlinskii",
        thresholds=[0.0, 0.3, 0.8, 1.5],
        weights=[1.0, 0.6, 0.4, 0.3],
    )
    law = {"form": "growing-thresholds"}
    name = "rate-dependent-hysteresis"
    truth = block(name, coefficient=0.006, exponent=0.6, **law)
    begun = block(name, coefficient=0.05, exponent=0.3, **law)
    made = measured((loop, truth), 0.01, given=(record(u, name="a", dt=1e-3),))
    state = state_of(
        (loop, begun),
        made,
        count=1500,
        free=(Free(1, "coefficient"), Free(1, "exponent")),
        added=(Added(name, "material", "", (1,), {}, 2.0),),
    )
    score = plain_score(state, 0.01**2)
    _, least = finished(state, score)
    end = finished_to_the_end(state, score)
    assert score.of(end.residual) < least - 5 * SCALE
    assert finished(end, score)[1] > score.of(end.residual) - SCALE


def test_a_number_that_the_records_do_not_tell_stays():
    """Of three records one alone comes to the stop; a fold leaves that one out."""
    dt, given = 1e-3, []
    spring = Mechanism(mass=1e-3, damping=0.01, stiffness=4.0)
    stop = Stop(contact_stiffness=9.0, gap=0.5)
    chain = (spring, stop)
    noise = np.random.default_rng(3)
    for k, size in enumerate((0.1, 1.0, 0.12)):
        t = dt * np.arange(3000)
        u = size * (np.sin(2 * np.pi * 4.3 * t + k) + np.sin(2 * np.pi * 9.1 * t))
        y = Model("rig", *CHANNELS, chain).simulate(u, dt)
        y = y + 1e-3 * noise.standard_normal(len(u))
        given.append(Record(f"r{k}", dt, u, y, *CHANNELS, "measured", "fit"))
    free = (Free(1, "contact_stiffness"), Free(1, "gap"))
    state = replace(state_of(chain, tuple(given)), free=free)
    used = tuple(np.full(len(x), k != 1) for k, x in enumerate(state.sample.positions))
    score = replace(plain_score(state, 0.25e-6), used=used)
    found, value = refit(state, score)
    assert value <= score_of(state, score)
    assert found.chain[1].gap == pytest.approx(0.5, rel=0.1)
    assert found.chain[1].contact_stiffness == pytest.approx(9.0, rel=0.1)


def test_a_base_far_off_is_re_tuned_down_to_the_noise():
    """The quick simulation of its mode lacks something else where the mode goes."""
    random, dt, noise = np.random.default_rng(3), 1 / 600, 0.01
    time, square = np.arange(3000) * dt, (2 * np.pi * 80) ** 2

    def mode(numerator, *denominator):
        numbers = {"numerator": [numerator], "denominator": list(denominator)}
        return block("transfer-function", hold="band-limited", **numbers)

    true = mode(1.1 * square, 0.935, 84.4, 1.03 * square)
    base = mode(square, 1.0, 80.4, square)
    tones = zip(random.uniform(20, 200, 25), random.uniform(0, 6, 25), strict=True)
    u = sum(np.sin(2 * np.pi * f * time + phase) for f, phase in tones)
    y = true.simulate(u, u, dt) + noise * random.standard_normal(len(time))
    free = tuple(
        Free(0, name, k, 0.1 * value, 0.9 * value, 1.1 * value, given=value)
        for name in ("numerator", "denominator")
        for k, value in enumerate(getattr(base, name))
    )
    state = state_of((base,), (record(u, y, dt=dt),), free=free)
    found, _ = finished(state, plain_score(state, noise**2))
    assert np.sqrt(np.mean(found.squares)) < 1.2 * noise


def test_tangents_of_poles_at_the_very_edge_are_taken():
    """Three swings alike part whichever way a coefficient goes, and one grows."""
    poles = [-1e-3 + 1j, -1e-3 - 1j] * 3
    edge = block(
        "transfer-function",
        numerator=[1.0],
        denominator=np.poly(poles).real.tolist(),
        hold="linear",
    )
    one = record(np.sin(0.3 * np.arange(300)), y=np.zeros(300), dt=0.1)
    state = state_of((edge,), (one,), free=(Free(0, "denominator", 2),))
    for way in (1, -1):
        with pytest.raises(InputError, match="unstable"):
            state.moved({0: way * state.steps[0]})
    assert np.isfinite(state.tangents).all()

"""What named effects cannot own, on records whose hidden effect is known."""

from dataclasses import replace
from functools import cache
from pathlib import Path

import numpy as np
import pytest
import yaml

from hystbench.commands.gap import gap
from hystbench.gap.effects import effects
from hystbench.gap.fitting.edit_chain import numbers_of
from hystbench.gap.fitting.state import Added
from hystbench.gap.judging.known_signals import (
    halves,
    in_runs,
    low_pass,
    random_walks,
)
from hystbench.gap.judging.measure_unowned import (
    means_may_differ_by_chance,
    measure_unowned,
    winding,
)
from hystbench.gap.judging.unowned import SORTS, Unowned
from hystbench.gap.records.floor import Floor
from hystbench.gap.records.free_mass import runs
from hystbench.gap.report.words import verdict_sentence
from hystbench.gap.schema import UNNAMED
from hystbench.gap.simulation.simulation import Simulation
from hystbench.gap.thresholds import LOOSE, UNNAMED_SHARE
from hystbench.record import Channel, Record
from tests.gap.made import record
from tests.gap.small import block, measured, state_of

NOISE = 0.02
FLOOR = Floor(NOISE, "declared")
GAIN = block("gain", value=12.0)


@cache
def inputs():
    """Four records of tones that start softly, each of other tones."""
    given = []
    for seed in range(4):
        rng = np.random.default_rng(seed)
        t = np.arange(1600) / 800
        u = sum(
            rng.uniform(0.1, 0.3) * np.sin(2 * np.pi * f * t + rng.uniform(0, 6))
            for f in rng.uniform(1, 60, 5)
        )
        soft = np.minimum(1, t / 0.1)
        given.append(record(u * soft, name=f"tones-{seed}", dt=1 / 800))
    return tuple(given)


def with_output(change, seed=0):
    """The gain's output, changed record by record, with noise."""
    rng = np.random.default_rng(100 + seed)
    return tuple(
        record(
            one.u,
            12.0 * one.u + change(k, one) + NOISE * rng.standard_normal(len(one)),
            name=one.name,
            dt=one.dt,
        )
        for k, one in enumerate(inputs())
    )


def lagging(given, tau):
    """The gain with a sensor lag named behind it."""
    start = state_of((GAIN,), given, count=800)
    lag = block("sensor-lag", time_constant_s=tau)
    simulation = Simulation((GAIN,), given)
    (variant, *_) = effects()["sensor-lag"].variants(simulation)
    added = Added("sensor-lag", "sensor", "", (1,), {"time_constant_s": tau}, 1)
    chain = (GAIN, lag)
    state = state_of(
        chain,
        given,
        count=800,
        free=tuple(numbers_of(lag, 1, variant)),
        added=(added,),
    )
    return start, state


def lag_of(tau):
    return lambda k, one: low_pass(12.0 * one.u, one.dt, tau, 0.0) - 12.0 * one.u


def test_the_right_name_owns_all_that_it_leaves():
    given = measured((GAIN, block("sensor-lag", time_constant_s=4e-3)), NOISE)
    for tau in (4e-3, 4.2e-3):  # a number a little off is its own
        found = measure_unowned(*lagging(given, tau), FLOOR)
        assert not found.too_much
        assert found.structured < 1e-3
        assert found.changing is not None
        assert found.changing < 1e-3
        assert found.unrelated < 0.01
        assert found.factors == pytest.approx([1.0, 1.0], abs=0.1)


def test_other_forms_of_a_name_own_nothing_in_sums_of_tens_of_times_each():
    """A notch is no lag, though lags of other times, added and subtracted, span it."""
    w = 2 * np.pi * 30
    notch = block(
        "transfer-function",
        numerator=(1.0, 0.2 * w, w * w),
        denominator=(1.0, 1.0 * w, w * w),
    )
    given = with_output(
        lambda k, one: 12.0 * (notch.simulate(one.u, one.u, one.dt) - one.u)
    )
    lags = [lagging(given, tau) for tau in np.geomspace(1e-3, 1e-2, 30)]
    start, best = min(lags, key=lambda item: item[1].power(NOISE**2))
    stays = best.power(NOISE**2) / start.power(NOISE**2)
    assert measure_unowned(start, best, FLOOR).structured > stays / 2


@pytest.mark.parametrize("spread", [0.3, -0.3])
def test_a_strength_that_differs_between_records_is_found_with_its_factors(spread):
    # A signal of every record that the model has as 12 u (1 + 0.1 strength).
    strength = 1 + spread * np.array([1.0, -1.0, 0.5, -0.5])
    given = with_output(lambda k, one: 1.2 * strength[k] * one.u)
    start = state_of((GAIN,), given, count=800)
    named = block("calibration-error", gain=1.1, offset=0.0)
    added = Added("calibration-error", "sensor", "", (1,), {}, 1)
    state = state_of((GAIN, named), given, count=800, added=(added,))
    found = measure_unowned(start, state, FLOOR)
    assert found.too_much
    # A gain is named, so its strength and the gain of the whole change alike.
    assert found.sort in ("strength", "gain")
    assert found.factors == pytest.approx(strength, abs=0.02)
    # Of strengths 1 + e_k the mean of e_k^2 over the mean of (1 + e_k)^2 goes, but for
    # a common gain, which the name may own: the records' own powers weigh both.
    powers = np.array([np.var(one.u) for one in given])
    common = powers @ strength / powers.sum()
    share = powers @ (strength - common) ** 2 / (powers @ strength**2)
    assert found.structured == pytest.approx(share, rel=0.1)
    assert found.changing == pytest.approx(share, rel=0.1)


SHAPES = {
    "gain": lambda k, one: 12.0 * (0.3, -0.3, 0.15, -0.15)[k] * one.u,
    "path": lambda k, one: (k + 1) * np.sin(np.linspace(0.0, 3.0, len(one))),
    "memory": lambda k, one: lag_of(3e-3)(k, one),
    "curve": lambda k, one: 2.0 * np.abs(one.u) ** 3,
    "history": lambda k, one: 3.0 * one.u * low_pass(one.u**2, one.dt, 0.6, 0.0),
    "unrelated": lambda k, one: np.random.default_rng(k).standard_normal(len(one)),
}


@pytest.mark.parametrize("sort", SHAPES)
def test_with_no_name_the_sort_of_the_gap_is_told(sort):
    given = with_output(SHAPES[sort])
    start = state_of((GAIN,), given, count=800)
    found = measure_unowned(start, start, FLOOR)
    assert found.sort == sort
    assert found.changing is None
    assert found.factors == ()
    if sort == "unrelated":
        assert found.structured < UNNAMED_SHARE
        assert found.unrelated > 0.9


def test_noise_alone_has_no_structure():
    given = with_output(lambda k, one: 0.0)
    start = state_of((GAIN,), given, count=800)
    found = measure_unowned(start, start, FLOOR)
    # Of less gap than noise the noise's power counts: shares are of that.
    assert found.structured < 0.02
    assert found.unrelated < 0.1


def test_another_effect_than_the_hidden_one_is_withdrawn():
    # A cube beside a lag: a lag alone cannot own it.
    given = with_output(lambda k, one: lag_of(4e-3)(k, one) + 6.0 * one.u**3)
    start, state = lagging(given, 4e-3)
    found = measure_unowned(start, state, FLOOR)
    assert found.too_much
    assert found.sort == "curve"
    assert SORTS["curve"] in found.reason


def test_a_path_that_is_named_owns_slow_paths():
    def wander(k, one):
        slow = np.arange(len(one)) / len(one)
        return 0.5 * np.cos(np.pi * (k + 1) * slow)

    given = with_output(wander)
    start = state_of((GAIN,), given, count=800)
    simulation = Simulation((GAIN,), given)
    beside = next(
        x.beside
        for x in effects()["drift"].variants(simulation)
        if x.beside is not None
    )
    added = Added("drift", "sensor", "", (), {}, 1)
    state = state_of((GAIN,), given, count=800, added=(added,), beside=((beside, {}),))
    assert measure_unowned(start, start, FLOOR).structured > 0.5
    assert not measure_unowned(start, state, FLOOR).too_much
    # In windows of a free mass any small error of a force makes such a path.
    cut = state_of((GAIN,), [replace(one, decay_s=1.0) for one in given], count=800)
    assert measure_unowned(cut, cut, FLOOR).structured < 0.1


def test_a_path_that_is_named_owns_what_its_most_winding_form_could_do():
    # Seven half waves in a record, of which the path that is named has degree four.
    given = with_output(
        lambda k, one: 0.5 * np.cos(7 * np.pi * np.arange(len(one)) / len(one) + k)
    )
    start = state_of((GAIN,), given, count=800)
    variants = list(effects()["drift"].variants(Simulation((GAIN,), given)))
    plain = next(x.beside for x in variants if x.form == "path")
    added = Added("drift", "sensor", "path", (), {}, 1)
    state = state_of((GAIN,), given, count=800, added=(added,), beside=((plain, {}),))
    found = measure_unowned(start, state, FLOOR)
    assert not found.too_much
    assert found.stays < 0.05
    # Without its name such a path stays what follows no known signal.
    assert measure_unowned(start, start, FLOOR).stays > 0.5


def test_one_number_sets_both_limits():
    for share in (0.01, 0.05):
        assert Unowned(1.01 * share, share).too_much
        assert not Unowned(0.99 * share, share, 0.5).too_much


def test_a_sort_is_told_where_more_stays_than_may():
    found = Unowned(0.02, gains={"statics": 50.0, "rate": 20.0})
    assert found.sort == "curve"
    assert "2 %" in found.reason
    assert found.mapping()["sentence"] == SORTS["curve"]
    fine = Unowned(0.002, unrelated=0.1, gains={"statics": 50.0}).mapping()
    assert fine["sort"] is fine["sentence"] is None


def test_halves_are_those_of_every_record():
    given = measured((GAIN,))
    state = state_of((GAIN,), given, count=100)
    signals = np.random.default_rng(0).standard_normal((len(state.sample), 3))
    parts = halves(state, signals)
    assert parts.shape == (len(state.sample), 3 * 2 * len(given))
    assert parts.reshape(len(signals), -1, 3).sum(axis=1) == pytest.approx(signals)
    assert (np.count_nonzero(parts, axis=0) == 50).all()


def test_windows_of_one_record_are_one_run():
    """A strength may change over what was measured in one go, not in each window."""
    whole = measured((GAIN,))
    cut = tuple(
        replace(one, name=f"{one.name}-{k}", decay_s=1.0, u=u, y=y)
        for one in whole
        for k, (u, y) in enumerate(
            zip(np.array_split(one.u, 7), np.array_split(one.y, 7), strict=True), 1
        )
    )
    assert runs(whole) == ((0,), (1,))
    assert runs(cut) == (tuple(range(7)), tuple(range(7, 14)))
    state = state_of((GAIN,), cut, count=20)
    strength = in_runs(state)
    assert strength.shape == (len(state.sample), 2 * 4)
    # Its slowest cosine falls from the first window of a run to the last one.
    slow = strength[: len(state.sample) // 2, 1]
    assert np.all(np.diff(slow) < 0)
    ends = slow[[0, -1]]
    assert ends == pytest.approx([1.0, -1.0], abs=0.01)
    signals = np.random.default_rng(0).standard_normal((len(state.sample), 3))
    assert halves(state, signals).shape == (len(state.sample), 3 * 2 * 2)


PLAIN = {"verdict": "unnamed", "reason": "", "withdrawn": None}


def test_gap_json_may_hold_every_sort():
    assert {*UNNAMED["properties"]["sort"]["enum"]} == {*SORTS, None}


@pytest.mark.parametrize("sort", SORTS)
def test_the_page_says_what_it_is_like_and_of_what_sort(sort):
    shares = {"structured": 0.013, "unrelated": 0.013, "sort": sort}
    told = PLAIN | {"unnamed": shares | {"sentence": SORTS[sort]}}
    names = {"effects": [{"name": "drive-lag"}, {"name": "creep"}]}
    assert verdict_sentence(told | names) == (
        "The simulator lacks something like drive lag and creep, but not only that: "
        f"1.3 % of the gap's power stays, and {SORTS[sort]}."
    )
    assert verdict_sentence(told | {"effects": []}).endswith(f" {SORTS[sort]}.")


def test_names_that_leave_more_than_a_quarter_are_only_the_nearest():
    shares = {"structured": 0.4, "unrelated": 0.01, "sort": "curve"}
    told = PLAIN | {"unnamed": shares | {"sentence": SORTS["curve"]}}
    assert verdict_sentence(told | {"effects": [{"name": "creep"}]}) == (
        "No effect of the vocabulary accounts for what differs. Nearest comes creep: "
        f"40 % of the gap's power stays, and {SORTS['curve']}."
    )


def test_an_older_result_without_the_shares_has_its_sentence_too():
    told = PLAIN | {"unnamed": None}
    assert verdict_sentence(told | {"effects": [{"name": "creep"}]}).endswith(
        "not only that: too much of the gap stays."
    )
    assert verdict_sentence(told | {"effects": []}).endswith("what differs.")


def test_the_command_and_the_workflow_allow_the_same_share():
    command = {option.name: option for option in gap.params}
    assert command["unnamed_share"].default == UNNAMED_SHARE
    config = yaml.safe_load(Path("config.yaml").read_text())
    assert config["gap"]["unnamed_share"] == UNNAMED_SHARE


def test_a_drift_owns_no_more_cosines_than_a_record_has_periods():
    """What goes to and fro as fast as the input may be anything that follows it."""
    t = np.arange(2000) * 1e-3
    given = [np.sin(2 * np.pi * periods * t / 2.0) for periods in (3, 40)]
    records = [
        Record("r", 1e-3, u, u, Channel("u", "V"), Channel("y", "V"), "measured", "fit")
        for u in given
    ]
    assert [winding(one) for one in records] == [3, 10]


def named_drift(change, seed=0, sizes=(0.5, 0.5, 0.5, 0.5)):
    """What is unnamed beside a drift, of slow inputs of several sizes."""
    rng = np.random.default_rng(300 + seed)
    t = np.arange(1600) / 800
    given = [
        record(
            u := sizes[k]
            * np.sin(np.pi * (k + 2) * t / t[-1])
            * np.minimum(1, t / 0.1),
            12.0 * u + change(rng, u) + NOISE * rng.standard_normal(len(u)),
            name=f"slow-{k}",
            dt=1 / 800,
        )
        for k in range(4)
    ]
    start = state_of((GAIN,), given, count=800)
    variants = list(effects()["drift"].variants(Simulation((GAIN,), given)))
    path = next(x.beside for x in variants if x.form == "path")
    added = Added("drift", "sensor", "path", (), {}, 1)
    state = state_of((GAIN,), given, count=800, added=(added,), beside=((path, {}),))
    return measure_unowned(start, state, FLOOR)


def walk(rng, u):
    """A random walk of about one in a record."""
    return np.cumsum(rng.standard_normal(len(u))) / np.sqrt(len(u))


@pytest.mark.parametrize("seed", range(3))
def test_what_a_path_leaves_of_a_random_walk_follows_slow_signals_by_chance_alone(seed):
    assert not named_drift(walk, seed).too_much


@pytest.mark.parametrize("seed", range(2))
def test_a_curve_stays_structure_beside_a_drift_that_is_a_random_walk(seed):
    found = named_drift(lambda rng, u: walk(rng, u) + 3.0 * np.maximum(u, 0) ** 2, seed)
    assert found.too_much


@pytest.mark.parametrize("seed", range(2))
def test_a_slow_path_that_the_inputs_power_causes_is_no_drift(seed):
    """A coil's heat goes with the square of the current, in all records alike."""
    sizes = (0.2, 0.5, 0.8, 0.4)

    def heat(rng, u):
        return 5.0 * low_pass(u**2, 1 / 800, 0.7) + 0.02 * walk(rng, u)

    found = named_drift(heat, seed, sizes)
    assert found.structured > LOOSE
    assert found.sort == "history"
    # A random walk that is as large in records of other sizes is none of it.
    assert not named_drift(walk, seed, sizes).too_much


def test_a_longer_run_has_the_larger_random_walk():
    """Its variance grows with time, whatever share of all samples a run has."""
    given = [
        record(np.sin(np.arange(n) / 20), name=f"{n}", dt=1e-3) for n in (500, 2000)
    ]
    state = state_of((GAIN,), given, count=2000)
    columns, sizes = random_walks(state)
    local = sizes / np.sqrt(np.mean(columns**2, axis=0))
    count = len(sizes) // 2
    np.testing.assert_allclose(local[count:] / local[:count], 2.0)
    np.testing.assert_allclose(local[0] / local[9], 10.0)
    many = state_of((GAIN,), given * 50, count=200)
    assert random_walks(many)[0].shape[1] == 1000


def broad(change, seed):
    """The gain's output over broad inputs, changed, with a little noise."""
    rng, found = np.random.default_rng(seed), []
    for k in range(4):
        u = low_pass(rng.standard_normal(1600), 1.0, 3.0, 0.0)
        one = record(u, name=f"broad-{k}", dt=1 / 800)
        y = 12.0 * u + change(k, one) + NOISE * rng.standard_normal(len(u))
        found.append(record(u, y, name=one.name, dt=one.dt))
    return tuple(found)


def coloured(seed, samples):
    """Noise with a memory of fifty samples."""
    white = np.random.default_rng(seed).standard_normal(samples)
    return low_pass(white, 1.0, 50.0, 0.0) * 10


def test_coloured_noise_follows_known_signals_only_by_chance():
    told = []
    for seed in range(8):
        given = broad(lambda k, one, s=seed: coloured(50 + 10 * s + k, len(one)), seed)
        start = state_of((GAIN,), given, count=800)
        found = measure_unowned(start, start, FLOOR)
        told.append(found.by_chance > 0.0)
        if found.by_chance:
            # Some is the mean of a record, which noise of a long memory has too.
            assert found.structured < found.by_chance
            assert found.unrelated > LOOSE
    # A test at 5 %: two of eight fail in one of twenty times.
    assert sum(told) >= 6


@pytest.mark.parametrize("inputs_of", [broad, lambda change, seed: with_output(change)])
def test_a_strength_that_changes_in_time_is_more_than_chance(inputs_of):
    def fading(k, one):
        return 2.0 * one.u * np.cos(np.pi * one.time / one.time[-1])

    start = state_of((GAIN,), inputs_of(fading, 0), count=800)
    found = measure_unowned(start, start, FLOOR)
    assert found.by_chance == 0.0
    assert found.structured > 0.5


def test_a_zero_of_each_record_is_no_chance():
    zeros = (0.5, -0.4, 0.3, -0.6)
    given = broad(lambda k, one: np.full(len(one), zeros[k]), 3)
    start = state_of((GAIN,), given, count=800)
    found = measure_unowned(start, start, FLOOR)
    assert found.too_much
    assert found.structured > 0.5


@pytest.mark.parametrize(("apart", "by_chance"), [(0.0, True), (1.0, False)])
def test_means_of_slow_noise_are_no_structure(apart, by_chance):
    """Of noise that decays in twenty samples; and with an offset of each record."""
    rng = np.random.default_rng(4)
    given = []
    for k, one in enumerate(inputs()):
        slow = rng.standard_normal(len(one)).cumsum()
        slow -= low_pass(slow, one.dt, 20 * one.dt)
        y = 12.0 * one.u + slow + apart * (k % 2) * slow.std()
        given.append(record(one.u, y, name=one.name, dt=one.dt))
    state = state_of((GAIN,), tuple(given))
    assert means_may_differ_by_chance(state) == by_chance

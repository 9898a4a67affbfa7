"""A case holds what its spec says, measured on its records alone."""

import itertools
import json
from dataclasses import asdict, replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from hystbench.challenge.campaigns import CAMPAIGNS, PERIOD_SAMPLES
from hystbench.challenge.case import make_case
from hystbench.challenge.plant.actuator import Actuator, KnownMode
from hystbench.challenge.plant.effects import APART, IN_ACTUATOR
from hystbench.challenge.plant.hysteresis import draw as draw_loop
from hystbench.challenge.plant.kind import Range, draw
from hystbench.challenge.spec import ACTUATORS, GROUPS, CaseSpec, draw_spec
from hystbench.challenge.where import held, shortest
from hystbench.errors import InputError

CREEP = CaseSpec(3, "single", ("creep",), "gpi", 20.0)


@pytest.fixture(scope="module")
def creep():
    return make_case(CREEP)


def rms(values):
    return float(np.sqrt(np.mean(np.square(values))))


def fit(case):
    return np.concatenate([record.y for record in case.records if record.use == "fit"])


def test_the_vocabulary_is_that_of_the_model_files():
    # the table of effects, but for the base blocks
    assert {name for name, kind in IN_ACTUATOR.items() if kind.listed} == {
        *("input-delay", "drive-lag", "eddy-diffusion", "drive-saturation"),
        *("slew-limit", "dead-zone", "hysteresis", "hysteresis-shape", "asymmetry"),
        *("saturation", "rate-dependent-hysteresis", "resonance", "friction"),
        *("stiffness-hardening", "backlash", "creep", "thermal-drift", "sensor-lag"),
        *("sensor-nonlinearity", "mains-pickup", "drift", "calibration-error"),
    }


def test_there_are_unlisted_effects():
    assert sum(not kind.listed for kind in IN_ACTUATOR.values()) >= 8


def test_the_same_spec_gives_the_same_case(creep):
    again = make_case(CREEP)
    for one, other in zip(creep.records, again.records, strict=True):
        assert (one.y == other.y).all()
        assert (one.u == other.u).all()
    assert creep.model == again.model
    assert creep.truth == again.truth


def test_another_seed_gives_another_plant(creep):
    other = make_case(replace(CREEP, seed=4))
    assert other.model != creep.model
    assert not (other.records[0].y == creep.records[0].y).all()


def test_noise_reaches_the_ratio(creep):
    # The same plant and the same draws: without noise to speak of, without effect.
    clear = fit(make_case(replace(CREEP, ratio_db=60.0)))
    plain = make_case(CaseSpec(3, "none", (), "gpi", 20.0))
    # the effect's own size, from records: the difference's power less the noise's
    both = rms(clear - fit(plain)) ** 2 - plain.truth["noise_rms"] ** 2
    effect = np.sqrt(both)
    noise = rms(fit(creep) - clear)
    assert 20 * np.log10(effect / noise) == pytest.approx(20.0, abs=0.2)
    assert creep.truth["noise_rms"] == pytest.approx(noise, rel=0.03)
    assert creep.truth["effects"][0]["rms"] == pytest.approx(effect, rel=0.03)


def test_the_noise_is_white(creep):
    clear = make_case(replace(CREEP, ratio_db=60.0))
    noise = creep.records[3].y - clear.records[3].y
    power = np.abs(np.fft.rfft(noise)) ** 2
    bands = [part.mean() for part in np.array_split(power[1:-1], 4)]
    assert max(bands) / min(bands) < 1.25
    assert abs(np.mean(noise[1:] * noise[:-1])) < 0.05 * np.var(noise)


def test_every_effect_of_several_reaches_the_ratio():
    spec = CaseSpec(5, "pair", ("backlash", "mains-pickup"), "gpi", 15.0)
    truth = make_case(spec).truth
    ratios = [effect["ratio_db"] for effect in truth["effects"]]
    assert min(ratios) == pytest.approx(15.0)
    assert truth["ratio_all_db"] > 15.0


@pytest.mark.parametrize("seed", range(3))
def test_the_base_of_plays_is_the_plant_but_for_noise(seed):
    case = make_case(CaseSpec(seed, "none", (), "gpi", 20.0))
    slow = case.records[0]
    left = slow.y - case.model.simulate(slow.u, slow.dt)
    assert rms(left) == pytest.approx(case.truth["noise_rms"], rel=0.05)
    assert case.truth["effects"] == []
    # and everywhere the model's own error of sampling is a small part of the output
    assert case.truth["base_error_fit_rms"] < 0.01 * case.truth["output_rms"]


@pytest.mark.parametrize("family", ["preisach", "jiles-atherton"])
def test_the_base_of_another_family_is_near_and_wrong(family):
    truth = make_case(CaseSpec(0, "none", (), family, 20.0)).truth
    share = truth["base_error_fit_rms"] / truth["output_rms"]
    assert 1e-3 < share < 0.04


def test_a_hidden_hysteresis_leaves_a_straight_base():
    case = make_case(CaseSpec(1, "single", ("hysteresis",), "preisach", 20.0))
    assert case.model.chain[0].name == "gain"
    assert {block.name for block in case.model.chain[1:]} <= {"resonance"}


def test_hardening_leaves_the_linear_mode_in_the_base():
    case = make_case(CaseSpec(2, "single", ("stiffness-hardening",), "gpi", 20.0))
    mode = case.model.chain[-1]
    told = case.truth["effects"][0]["parameters"]
    assert mode.name == "resonance"
    for name in ("frequency_hz", "damping_ratio", "participation"):
        assert getattr(mode, name) == told[name]


def place(name, view, seed=6, **more):
    case = make_case(CaseSpec(seed, "single", (name,), "gpi", 20.0, **more))
    told = case.truth["effects"][0]
    (found,) = [item for item in told["where"] if item["view"] == view]
    assert found["right"]
    assert found["share"] >= 0.5 or view == "delay"
    return found, told["parameters"]


def test_where_a_mode_is():
    found, parameters = place("resonance", "frequency")
    assert found["from"] * 0.8 < parameters["frequency_hz"] < found["to"] * 1.25


def test_where_a_delay_is():
    found, parameters = place("input-delay", "delay")
    # First order in the delay: at 400 Hz the terms left out and the plant's mode
    # take a part, never the larger one.
    assert found["from"] < parameters["delay_s"] < found["to"]
    assert found["share"] > 0.5


def test_where_the_mains_are():
    found, parameters = place("mains-pickup", "unexplained")
    assert found["from"] <= 50.0 <= found["to"]
    assert found["to"] < 60.0
    assert len(parameters["amplitudes"]) == 3


def test_what_a_range_holds():
    found, parameters = place("resonance", "frequency")
    assert held(found, 0.0, 1e5) == pytest.approx(1.0, abs=1e-3)
    assert held(found, found["from"], found["to"]) == pytest.approx(
        found["share"], abs=1e-3
    )
    low, high = 0.5 * parameters["frequency_hz"], 2 * parameters["frequency_hz"]
    assert held(found, low, high) > 0.5
    assert held(found, 0.0, 5.0) < 0.1
    plain = {"edges": [0.0, 1.0, 3.0], "shares": [0.4, 0.6]}
    assert held(plain, 0.5, 2.0) == pytest.approx(0.2 + 0.3)


def test_where_drift_is():
    found, _ = place("drift", "unexplained")
    assert found["to"] < 0.5


def test_where_the_amplifier_saturates():
    found, parameters = place("drive-saturation", "amplitude")
    assert max(abs(found["from"]), abs(found["to"])) > parameters["limit"]


def test_where_the_current_slews():
    found, parameters = place("slew-limit", "rate")
    assert found["to"] > parameters["rate"]


@given(st.lists(st.floats(0.0, 1.0), min_size=1, max_size=12).filter(sum))
def test_the_shortest_range_holds_half(shares):
    shares = np.array(shares)
    low, high = shortest(shares)
    half = 0.5 * shares.sum() * (1 - 1e-9)
    assert shares[low:high].sum() >= half
    shorter = high - low - 1
    sums = [shares[k : k + shorter].sum() for k in range(len(shares) - shorter + 1)]
    assert shorter == 0 or max(sums) <= 0.5 * shares.sum() * (1 + 1e-9)


def test_a_difference_without_its_record_has_no_place():
    assert json.dumps(make_case(CaseSpec(1, "none", (), "gpi", 3.0)).truth)


@pytest.fixture(scope="module")
def excitations():
    items = CAMPAIGNS["standard"](np.random.default_rng(0))
    return {item.name: item for item in items}


FAMILIES = itertools.cycle(ACTUATORS)
#: Each effect on one family or another, and on one where its size is drawn from more.
SHOWN = [
    *((next(FAMILIES), name, 1.0) for name in IN_ACTUATOR),
    *(("gpi", name, 3.0) for name in IN_ACTUATOR),
]


@pytest.mark.parametrize(("family", "name", "spread"), SHOWN)
def test_every_effect_shows(family, name, spread, excitations):
    random = np.random.default_rng(8)
    loop = draw_loop(family, random)
    mode = KnownMode(120.0, 0.03, 0.2)
    for form in IN_ACTUATOR[name].forms:
        if (form == "growing-thresholds") != (family == "gpi") and (
            name == "rate-dependent-hysteresis"
        ):
            continue
        effect = draw(IN_ACTUATOR[name], random, spread, (form,))
        if name == "stiffness-hardening":
            more = {**effect.parameters, **asdict(mode)}
            effect = replace(effect, parameters=more)
        largest = 0.0
        for key in ("multisine-strong", "steps"):
            item = excitations[key]
            plants = (Actuator(loop, mode, effects, 1) for effects in ((effect,), ()))
            with_it, without = (
                plant.convert(plant.read(item, item.dt, item.samples, 0), item.dt, 0)
                for plant in plants
            )
            assert np.isfinite(with_it).all()
            largest = max(largest, rms(with_it - without) / rms(without))
        if name in ("hysteresis", "hysteresis-shape"):
            # the loop itself is what these change: see make_case
            assert largest == 0.0
        else:
            assert 1e-5 < largest < 2.0


def test_a_biased_loop_is_read_from_its_own_middle(excitations):
    # Over the largest loop a bias then tilts and bends, and shifts nothing.
    item = excitations["slow-loop"]
    effect = draw(
        IN_ACTUATOR["asymmetry"], np.random.default_rng(2), 1.0, ("field-bias",)
    )
    for family in ACTUATORS:
        loop = draw_loop(family, np.random.default_rng(3))
        y, plain = (
            Actuator(loop, None, effects, 0).read(item, item.dt, item.samples, 0)
            for effects in ((effect,), ())
        )
        difference = (y - plain)[2000:4000]
        assert abs(np.mean(difference)) < 0.02 * rms(plain)
        assert np.std(difference) > 1e-3


def test_a_command_is_delayed_exactly(excitations):
    item = excitations["multisine-wide"]
    effect = draw(IN_ACTUATOR["input-delay"], np.random.default_rng(2), 1.0, ("pure",))
    y = Actuator(20.0, None, (effect,), 0).read(item, item.dt, item.samples, 0)
    late = np.arange(item.samples) * item.dt - effect.parameters["delay_s"]
    assert y == pytest.approx(20.0 * item(late), abs=1e-9)


@pytest.mark.parametrize("campaign", CAMPAIGNS)
@pytest.mark.parametrize("seed", range(3))
def test_records_as_a_laboratory_takes_them(campaign, seed):
    items = CAMPAIGNS[campaign](np.random.default_rng(seed))
    assert 10 <= len(items) <= 12
    assert sum(item.samples for item in items) == 70_000
    assert {item.use for item in items} == {"fit", "hold-out"}
    names = [item.name for item in items]
    assert len(set(names)) == len(names)
    for item in items:
        u = item.sampled()
        assert u[0] == 0.0
        assert 0.05 < np.abs(u).max() < 0.9
        assert (item(np.array([-1.0, -1e-4])) == 0).all()
        # smooth: next to nothing in the upper half of the band
        window = np.hanning(len(u))
        power = np.abs(np.fft.rfft((u - u.mean()) * window)) ** 2
        assert power[len(power) // 2 :].sum() < 1e-5 * power.sum()
        period = item.period_samples
        if period is not None:
            assert u[-2 * period : -period] == pytest.approx(u[-period:], abs=1e-9)


def test_a_multisine_has_the_lines_it_says():
    items = {i.name: i for i in CAMPAIGNS["other"](np.random.default_rng(0))}
    u = items["pink"].sampled()[-PERIOD_SAMPLES:]
    lines = np.abs(np.fft.rfft(u))
    excited = lines > 1e-9 * lines.max()
    # odd lines of 2 Hz up to 400 Hz
    assert (np.flatnonzero(excited) == np.arange(1, 201, 2)).all()


def test_spread_multiplies_what_shifts_within_physics():
    item = Range(1.0, 2.0, "s", most=4.0)
    one = item.draw(np.random.default_rng(0))
    three = item.draw(np.random.default_rng(0), 3.0)
    assert three == min(3.0 * one, 4.0)
    fixed = Range(1.0, 2.0, "s", shifts=False)
    assert fixed.draw(np.random.default_rng(0), 3.0) == one


@given(st.integers(0, 10**6), st.sampled_from(["pair", "triple", "single"]))
def test_drawn_effects_may_meet(seed, kind):
    for family in ACTUATORS:
        spec = draw_spec(seed, kind, family, 20.0)
        assert len(set(spec.effects)) == {"single": 1, "pair": 2, "triple": 3}[kind]
        assert not any(pair <= set(spec.effects) for pair in APART)
        assert family == "gpi" or "hysteresis-shape" not in spec.effects


@given(st.integers(0, 10**6))
def test_what_is_left_out_is_drawn_nowhere_else(seed):
    for group in GROUPS:
        for of_group in (False, True):
            about = {"group": group, "of_group": of_group}
            spec = draw_spec(seed, "unlisted", "gpi", 20.0, **about)
            assert (spec.effects[0] in GROUPS[group].unlisted) == of_group


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"effects": ("crepe",)}, "did you mean 'creep'"),
        ({"effects": ("creep", "drift"), "kind": "pair"}, "cannot be hidden together"),
        ({"effects": ()}, "0 given, expected 1"),
        ({"family": "preisac"}, "did you mean 'preisach'"),
        ({"effects": ("hysteresis-shape",), "family": "preisach"}, "family 'gpi'"),
        ({"ratio_db": 99.0}, "expected -20 to 60"),
        ({"ratio_db": float("nan")}, "expected -20 to 60"),
        ({"spread": 0.0}, "expected 0.1 to 10"),
        ({"campaign": "others"}, "did you mean 'other'"),
        ({"kind": "singel"}, "did you mean 'single'"),
        ({"seed": -1}, "expected 0 or more"),
    ],
)
def test_what_cannot_be_made_is_refused_in_one_line(change, message):
    with pytest.raises(InputError, match=message) as caught:
        replace(CREEP, **change)
    assert "\n" not in str(caught.value)

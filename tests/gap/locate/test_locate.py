"""Views of the gap: each is found where it was put, and nothing is found in noise."""

from __future__ import annotations

import re
from functools import cache

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from jsonschema import validate

from hystbench.gap.effects import effects as vocabulary
from hystbench.gap.locate import Contribution, View, locate, ranked
from hystbench.gap.locate.distortion import BETWEEN, EVEN, ODD, take_distortion
from hystbench.gap.locate.forms import HELD_SHARE, narrowest_bins
from hystbench.gap.locate.samples import take_samples
from hystbench.gap.records.floor import noise_floor
from hystbench.gap.schema import VIEW
from tests.gap import made
from tests.gap.examples import (
    DT,
    compare,
    effects,
    gap_of,
    hysteretic,
    inputs,
    plain_play,
    straight,
)

#: Records of these tests have no three levels of a broadband input.
KINDS = set(VIEW["properties"]["view"]["enum"]) - {"level"}

# What an engineer would say first of each effect.
FIRST = {
    "input-delay": "delay",
    "drive-lag": "frequency",
    "eddy-diffusion": "frequency",
    "drive-saturation": "amplitude",
    "slew-limit": "rate",
    "dead-zone": "amplitude",
    "hysteresis": "branch",
    "asymmetry": "amplitude",
    "saturation": "amplitude",
    "rate-dependent-hysteresis": "rate",
    "resonance": "frequency",
    "friction": "branch",
    "backlash": "branch",
    "creep": "slow-time",
    "thermal-drift": "slow-time",
    "sensor-lag": "frequency",
    "sensor-nonlinearity": "amplitude",
    "mains-pickup": "unexplained",
    "drift": "unexplained",
    "calibration-error": "amplitude",
}
PLANTS = {"gain": straight, "hysteresis": hysteretic}
CASES = [
    (name, plant)
    for name in FIRST
    for plant in PLANTS
    if (name, plant)
    not in {("hysteresis", "hysteresis"), ("rate-dependent-hysteresis", "gain")}
]


#: Views that are right as well: what depends on the rate is nearly a lag.
AS_WELL = {"slew-limit": "frequency", "rate-dependent-hysteresis": "frequency"}


@cache
def views_of(name, plant, ratio_db=20.0, seed=0):
    compared, _ = gap_of(name, PLANTS[plant], ratio_db, seed)
    return locate(compared, noise_floor(compared))


@cache
def named_views_of(name, plant, ratio_db=20.0, seed=0):
    """With what the effect truly adds, as a search that is right finds it."""
    compared, _ = gap_of(name, PLANTS[plant], ratio_db, seed)
    bare, _ = gap_of(name, PLANTS[plant], 200.0, seed)
    adds = Contribution(name, FIRST[name], tuple(one.residual for one in bare), 2)
    return locate(compared, noise_floor(compared), [adds])


def test_every_effect_shows_in_a_view():
    assert {effect.shows for effect in vocabulary().values()} <= KINDS
    assert set(FIRST) == set(effects(np.random.default_rng(0)))


#: Loud beside a plain gain, nearer the noise beside a hysteresis.
SEEN = {"gain": (20.0, 0), "hysteresis": (10.0, 1)}


@pytest.mark.parametrize(("name", "plant"), CASES)
def test_what_a_named_effect_adds_comes_first(name, plant):
    first = named_views_of(name, plant, *SEEN[plant])[0]
    assert first.view == FIRST[name]
    assert first.named
    assert first.share_of_gap_power > 0.8
    assert first.p_value < 1e-3


@pytest.mark.parametrize(("name", "plant"), CASES)
def test_without_a_name_it_is_among_the_first_three(name, plant):
    views = views_of(name, plant)
    assert {FIRST[name], AS_WELL.get(name)} & {view.view for view in views[:3]}
    assert not any(view.named for view in views)


def test_of_several_effects_the_larger_comes_first_and_behind_them_the_rest():
    compared, _ = gap_of("drive-saturation", straight)
    bare, _ = gap_of("drive-saturation", straight, 200.0)
    whole = [one.residual for one in bare]
    parts = [
        Contribution(
            "drive-saturation", "amplitude", tuple(0.9 * one for one in whole)
        ),
        Contribution("creep", "slow-time", tuple(0.1 * one**2 for one in whole)),
        Contribution("of-tomorrow", None, tuple(whole)),
    ]
    found = locate(compared, noise_floor(compared), parts)
    assert [view.view for view in found[:2]] == ["amplitude", "slow-time"]
    assert [view.named for view in found] == [True, True] + 6 * [False]
    assert "is what drive-saturation adds" in found[0].sentence


@pytest.mark.parametrize(("name", "plant"), CASES)
def test_views_are_of_the_contract_and_say_their_own_numbers(name, plant):
    views = views_of(name, plant)
    assert {view.view for view in views} == KINDS
    assert len(views) == len(KINDS)
    assert views == ranked(views)
    for view in views:
        mapping = view.to_mapping()
        validate(mapping, VIEW)
        assert 0 <= mapping["share_of_gap_power"] <= 1
        told = [float(one) for one in re.findall(r"([\d.e+-]*\d) %", view.sentence)]
        assert round(100 * view.share_of_gap_power) in told
        if view.view in {"amplitude", "rate", "slow-time", "frequency"}:
            for end in (view.start, view.end):
                assert f"{end:.3g}" in view.sentence
            assert view.start <= view.end


def test_a_mode_is_found_around_its_frequency():
    rng = np.random.default_rng(0)
    # One broad record: elsewhere a loud sine above the mode would hold the power.
    name, u, period = inputs(8000)[5]
    clean = effects(rng)["resonance"](straight, u)
    y = clean + 0.02 * rng.standard_normal(len(u))
    compared = [compare(name, u, y, straight(u), period)]
    adds = Contribution("resonance", "frequency", (clean - straight(u),), 3)
    for contributions in ((), (adds,)):
        views = locate(compared, noise_floor(compared), contributions)
        (view,) = [one for one in views if one.view == "frequency"]
        assert 50 < view.start < 70 < view.end < 100
    assert views[0] is view


@given(st.floats(1e-4, 3e-3))
@settings(max_examples=15)
def test_a_delay_is_told_in_seconds(delay):
    found = []
    rng = np.random.default_rng(0)
    for name, u, period in inputs(3000)[:3]:
        t = np.arange(len(u)) * DT
        size, hertz = float(name.split("-")[2]), float(name.split("-")[1])
        y = 6 * size * np.sin(2 * np.pi * hertz * (t - delay))
        y += 0.002 * rng.standard_normal(len(u))
        found.append(compare(name, u, y, 6 * u, period))
    view = next(one for one in locate(found, noise_floor(found)) if one.view == "delay")
    assert view.start < delay < view.end
    assert view.end - view.start < 0.3 * delay


def test_a_mains_line_lies_in_its_range_and_a_hidden_drift_in_time():
    mains = named_views_of("mains-pickup", "gain")[0]
    assert (mains.axis, mains.unit) == ("frequency", "Hz")
    assert mains.start < 50.03 < mains.end < mains.start + 2
    drift = named_views_of("drift", "gain")[0]
    assert (drift.axis, drift.unit) == ("time in the record", "s")


def test_saturation_is_found_at_large_inputs_and_a_dead_zone_is_not():
    saturation = views_of("drive-saturation", "gain")[0]
    # The limit is 0.6; all of the power lies above it.
    assert saturation.start >= 0.6
    dead_zone = views_of("dead-zone", "gain")[0]
    assert dead_zone.start < 0.3


def test_asymmetry_of_one_record_is_told_by_the_record_view():
    rng = np.random.default_rng(0)
    found = []
    for name, u, period in inputs(3000):
        gap = 0.1 * 6 * u if name == "multisine" else 0.0
        y = 6 * u + gap + 0.01 * rng.standard_normal(len(u))
        found.append(compare(name, u, y, 6 * u, period))
    views = locate(found, noise_floor(found))
    assert views[0].view == "record"
    assert (views[0].start, views[0].end) == ("multisine", "multisine")
    told = "It leaves 7 records, sine-1-1.0 among them, alone."
    assert views[0].sentence.endswith(told)


@pytest.mark.parametrize("quiet", [0, 1, 3, 4])
def test_records_without_a_gap_are_left_alone(quiet):
    rng = np.random.default_rng(1)
    found = []
    for number in range(6):
        u = np.sin(2 * np.pi * np.arange(2000) / 400)
        gap = 0.0 if number < quiet else 0.3 * u**2
        y = 6 * u + gap + 0.01 * rng.standard_normal(len(u))
        found.append(compare(f"r{number}", u, y, 6 * u, 400))
    told = told_by(found, "record")
    names = {1: "r0", 3: "r0 and r1 and r2", 4: "4 records, r0 among them,"}
    if quiet:
        assert told.endswith(f" It leaves {names[quiet]} alone.")
    else:
        assert "leaves" not in told


def test_a_wrong_loop_shape_alone_is_told_by_the_branch_view():
    rng = np.random.default_rng(5)
    compared = [
        compare(
            n,
            u,
            hysteretic(u) + 0.02 * rng.standard_normal(len(u)),
            5.5 * plain_play(u, 0.05) + 2.2 * plain_play(u, 0.35),
            p,
        )
        for n, u, p in inputs(3000, 5)
    ]
    assert locate(compared, noise_floor(compared))[0].view == "branch"


def test_white_noise_alone_is_nothing():
    seeds = 12
    p_values = {kind: [] for kind in KINDS}
    for seed in range(seeds):
        rng = np.random.default_rng(seed + 500)
        compared = [
            compare(n, u, 6 * u + 0.1 * rng.standard_normal(len(u)), 6 * u, p)
            for n, u, p in inputs(1500, seed)
        ]
        for view in locate(compared, noise_floor(compared)):
            p_values[view.view].append(view.p_value)
            # Nothing pays for its parameters, and no share is large.
            assert view.saved < 0
            if view.view != "record":
                assert view.share_of_gap_power < 0.5
    for kind, found in p_values.items():
        # A binomial count of 12 at 5 % exceeds 3 in two of a thousand.
        assert np.sum(np.array(found) < 0.05) <= 3, kind
        assert np.min(found) > 1e-4, kind


def test_coloured_noise_is_not_taken_for_a_function_of_the_input():
    count = 0
    for seed in range(20):
        rng = np.random.default_rng(seed)
        compared = []
        for n, u, p in inputs(1500, seed):
            noise = np.convolve(rng.standard_normal(len(u) + 39), np.ones(40) / 20)
            noise = noise[39 : 39 + len(u)]
            compared.append(compare(n, u, 6 * u + noise, 6 * u, p))
        views = {v.view: v for v in locate(compared, noise_floor(compared))}
        kinds = ("amplitude", "rate", "branch", "delay")
        count += sum(views[kind].p_value < 0.01 for kind in kinds)
    # Eighty tests at 1 %: more than five in one of ten thousand.
    assert count <= 5


@pytest.mark.parametrize("scale", [1e-9, 1e9])
def test_units_do_not_matter(scale):
    compared, _ = gap_of("friction", straight)
    scaled = [
        compare(
            c.record.name,
            c.record.u * scale,
            c.record.y / scale,
            c.simulated / scale,
            c.record.period_samples,
        )
        for c in compared
    ]
    plain = views_of("friction", "gain")
    other = locate(scaled, noise_floor(scaled))
    for a, b in zip(plain, other, strict=True):
        assert a.view == b.view
        assert a.share_of_gap_power == pytest.approx(b.share_of_gap_power, abs=1e-6)


def test_degenerate_records_give_views_and_no_warning():
    rng = np.random.default_rng(0)
    t = np.arange(2000) * DT
    u = np.sin(2 * np.pi * 5 * t)
    noise = rng.standard_normal(2000)
    cases = [
        [compare("perfect", u, 6 * u, 6 * u, 400)],
        [compare("still", 0 * u, noise, 0 * u, 400)],
        [compare("constant", 0 * u + 1, noise, 0 * u + 6)],
        [compare("nothing", 0 * u, 0 * u, 0 * u)],
        [compare("quantised", u, np.round(6.3 * u, 1), 6 * u, 400)],
        [compare("short", u[:40], 6.3 * u[:40], 6 * u[:40])],
        [
            compare("fast", u, 6.3 * u, 6 * u),
            compare("slow", u[::4], 6.3 * u[::4], 6 * u[::4], dt=4 * DT),
            compare("brief", u[:300], 6.3 * u[:300], 6 * u[:300]),
        ],
    ]
    for compared in cases:
        for view in locate(compared, noise_floor(compared)):
            validate(view.to_mapping(), VIEW)


@given(
    st.lists(st.floats(0, 1), min_size=1, max_size=30).filter(lambda x: sum(x) > 1e-3)
)
def test_the_narrowest_range_holds_enough_and_no_narrower_one_does(held):
    values = np.array(held)
    first, last = narrowest_bins(values)
    wanted = HELD_SHARE * values.sum()
    assert values[first : last + 1].sum() >= wanted - 1e-9
    width = last - first
    for start in range(len(values) - width + 1):
        assert values[start : start + width].sum() < wanted + 1e-9


def test_within_one_loop_nothing_slower_is_called_a_drift():
    """What a loop of another shape leaves is no path of its own."""
    t = np.arange(2000) / 2000
    loop = np.cos(2 * np.pi * t)
    # Wider than the simulator's: above it on one branch, below it on the other.
    wider = 0.3 * np.sin(2 * np.pi * t)
    noise = 0.01 * np.random.default_rng(0).standard_normal(2000)
    one = made.compared(loop, wider + noise, dt=1e-3)
    views = {item.view: item for item in locate([one], noise_floor([one], 0.01))}
    found = views.get("unexplained")
    assert found is None or found.share_of_gap_power < 0.2
    assert views["branch"].share_of_gap_power > 0.8


def a_view(p_value, saved):
    return View("delay", "delay", 0.0, 1.0, "s", 0.5, p_value, "", saved)


@given(
    st.lists(st.tuples(st.floats(0, 1), st.floats(-99, 999)), min_size=2, max_size=8)
)
def test_no_view_that_chance_may_give_stands_before_one_it_may_not(numbers):
    views = [a_view(p_value, saved) for p_value, saved in numbers]
    order = ranked(views)
    # Bonferroni: with k views tried, below 0.05 / k.
    sure = [view.p_value * len(views) < 0.05 for view in order]
    assert sure == sorted(sure, reverse=True)
    for kind in (True, False):
        saved = [v.saved for v, one in zip(order, sure, strict=True) if one is kind]
        assert saved == sorted(saved, reverse=True)


def told_by(compared, view, floor=None):
    views = locate(compared, noise_floor(compared, floor))
    return next(one.sentence for one in views if one.view == view)


@pytest.mark.parametrize(("square", "cube"), [(0.1, 0.0), (0.05, 0.2), (0.0, 0.2)])
def test_even_and_odd_distortion_are_told_with_their_shares(square, cube):
    """A sine's square is a second harmonic, its cube three parts first, one third."""
    u = np.sin(2 * np.pi * np.arange(4000) / 400)
    residual = square * u**2 + cube * u**3
    noise = 0.001 * np.random.default_rng(0).standard_normal(4000)
    sentence = told_by(
        [made.compared(u, residual + noise, period_samples=400)], "frequency"
    )
    even, first, third = square**2 / 8, (0.75 * cube) ** 2 / 2, (0.25 * cube) ** 2 / 2
    whole = even + first + third
    for share, words in ((even, "even lines"), (third, "odd lines")):
        told = re.search(rf"(\d+) % on {words} beside them \(p < 0.001\)", sentence)
        if share > 0:
            assert int(told[1]) == pytest.approx(100 * share / whole, abs=1)
        else:
            assert told is None
    assert f"{100 * first / whole:.0f} % lies on the input's own lines" in sentence


def test_what_does_not_repeat_is_told():
    """Parts of equal power: a gain error, and a tone that no period holds."""
    t = np.arange(4000) * DT
    u = np.sin(2 * np.pi * 10 * t)
    tone = np.sin(2 * np.pi * 333.3 * t)
    noise = 0.01 * np.random.default_rng(0).standard_normal(4000)
    one = compare("sine", u, 6 * u + 0.2 * (u + tone) + noise, 6 * u, 200)
    sentence = told_by([one], "frequency", 0.01)
    assert "50 % does not repeat with the input" in sentence
    squared = compare("sine", u, 6 * u + 0.2 * u**2 + 0.1 * noise, 6 * u, 200)
    sentence = told_by([squared], "frequency")
    assert "Next to all of the gap of periodic records repeats" in sentence


def test_evidence_of_lines_is_that_of_chance_in_noise():
    chances = {ODD: [], EVEN: [], BETWEEN: []}
    for seed in range(60):
        rng = np.random.default_rng(seed)
        compared = [
            compare(n, u, 6 * u + 0.1 * rng.standard_normal(len(u)), 6 * u, p)
            for n, u, p in inputs(2000, seed)
        ]
        samples = take_samples(compared, noise_floor(compared, 0.1))
        distortion = take_distortion(samples)
        if distortion is not None:
            for kind, found in chances.items():
                found.append(distortion.p_values[kind])
    for kind, found in chances.items():
        assert len(found) > 40, kind
        # A binomial count of 60 at 5 % exceeds 9 in one of a thousand.
        assert np.sum(np.array(found) < 0.05) <= 9, kind
        assert np.min(found) > 1e-4, kind

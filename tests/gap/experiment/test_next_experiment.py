"""The proposed experiment tells most apart, within the limits, and is a signal."""

import dataclasses
from itertools import combinations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from hystbench.blocks import registry
from hystbench.errors import InputError
from hystbench.gap.experiment.candidates import Limits, candidates
from hystbench.gap.experiment.separation import Rival, RivalPair, separation
from hystbench.gap.experiment.tell_apart import (
    CLEAR_FLOORS,
    Experiment,
    next_experiment,
)
from hystbench.gap.schema import EXPERIMENT
from hystbench.model import Model
from hystbench.schema import check_against_schema
from tests.gap.made import CURRENT, DISPLACEMENT, record, sine

LIMITS = Limits(-1.0, 1.0, 800.0, 100.0, 0.001, 4.0)
ITEMS = candidates(LIMITS, "A")


def model(name, *blocks):
    chain = tuple(registry()[kind](**values) for kind, values in blocks)
    return name, Model(name, CURRENT, DISPLACEMENT, chain)


def one_set(*rivals):
    """Rivals in the place of the first."""
    return {rivals[0][0]: {name: Rival(model) for name, model in rivals}}


def size_of(found, existing=False):
    """How far the pair that is hardest to tell apart lies apart."""
    return min((found.existing if existing else found.pairs).values())


GAIN = ("gain", {"value": 2.0})
MODE = (
    "resonance",
    {"frequency_hz": 35.0, "damping_ratio": 0.05, "participation": 0.1},
)


def test_picks_the_sine_where_two_transfer_functions_differ_most():
    rivals = [model("plain", GAIN), model("mode", GAIN, MODE)]
    # long against the mode's ringing of 0.1 s, so that the steady state counts
    limits = dataclasses.replace(LIMITS, duration_s=20.0)
    sines = [
        item
        for item in candidates(limits, "A")
        if item.kind == "sine" and item.parameters["amplitude"]["value"] > 0.99
    ]
    floor = 0.01
    found = next_experiment(one_set(*rivals), [record(sine(1))], floor, sines)
    # In steady state a gain takes away what is in phase with the mean of the two.
    frequency = np.array([item.parameters["frequency_hz"]["value"] for item in sines])
    wn, s = 2 * np.pi * 35.0, 2j * np.pi * frequency
    first = 2.0 + 0 * s
    second = 2 * (0.9 + 0.1 * wn**2 / (s**2 + 2 * 0.05 * wn * s + wn**2))
    mean = (first + second) / 2
    quadrature = np.abs(((first - second) * mean.conj()).imag / np.abs(mean))
    best = int(np.argmax(quadrature))
    assert found.excitation is sines[best]
    assert size_of(found) == pytest.approx(
        quadrature[best] / np.sqrt(2) / floor, rel=0.05
    )
    assert size_of(found, existing=True) < 0.1 * size_of(found)
    assert "plain from mode" in found.sentence


def test_equivalent_models_are_said_to_be_so():
    rivals = [
        model("lag-first", ("drive-lag", {"time_constant_s": 0.002}), GAIN),
        model("lag-last", GAIN, ("drive-lag", {"time_constant_s": 0.002})),
    ]
    found = next_experiment(one_set(*rivals), [record(sine(1))], 0.001, ITEMS)
    assert size_of(found) < 1e-6
    assert "No feasible excitation tells lag-first from lag-last." in found.sentence


def test_rate_and_amplitude_effects_need_other_excitations():
    creep = ("creep", {"magnitudes": [0.1], "time_constants_s": [1.0]})
    slow = next_experiment(
        one_set(model("plain", GAIN), model("creep", GAIN, creep)),
        [record(sine(50, count=4000))],
        0.01,
        ITEMS,
    )
    fast = next_experiment(
        one_set(
            model("plain", GAIN),
            model("lag", GAIN, ("drive-lag", {"time_constant_s": 0.0002})),
        ),
        [record(sine(1, count=4000))],
        0.01,
        ITEMS,
    )

    def middle_hz(item):
        power = np.abs(np.fft.rfft(item.u - item.u.mean())) ** 2
        return np.sum(np.fft.rfftfreq(len(item.u), item.dt) * power) / power.sum()

    assert middle_hz(slow.excitation) < 3 < 10 < middle_hz(fast.excitation)
    assert size_of(slow) > size_of(slow, existing=True)
    assert size_of(fast) > size_of(fast, existing=True)


def test_mapping_holds_what_the_sentence_says():
    rivals = [model("plain", GAIN), model("mode", GAIN, MODE)]
    sets = one_set(*rivals)
    found = next_experiment(sets, [record(sine(1, count=4000))], 0.01, ITEMS)
    content = found.mapping()
    check_against_schema(content, EXPERIMENT, "next_experiment")
    assert f"{content['separation']:.2g}" in content["sentence"]
    assert content["excitation"].replace("-", " ") in content["sentence"]
    (pair,) = content["pairs"]
    assert (pair["of"], pair["names"]) == ("plain", ["plain", "mode"])
    assert pair["largest_separation"] >= pair["separation"] == content["separation"]
    assert all(
        {"value", "unit"} == set(each) for each in content["parameters"].values()
    )


@settings(max_examples=25)
@given(
    st.floats(-5, 5),
    st.floats(0.1, 10),
    st.floats(1, 1e4),
    st.floats(0.5, 400),
    st.floats(0.3, 30),
)
def test_candidates_keep_within_the_limits(low, width, rate, bandwidth, duration):
    limits = Limits(low, low + width, rate, bandwidth, 0.001, duration)
    for item in candidates(limits, "A"):
        assert item.u.min() >= low - 1e-5 * width
        assert item.u.max() <= low + width + 1e-5 * width
        assert np.abs(np.diff(item.u)).max() <= rate * item.dt * (1 + 1e-5)
        assert len(item.u) * item.dt <= duration + item.dt


def test_what_is_slow_lasts_as_long_as_it_may():
    limits = Limits(-1.0, 1.0, 100.0, 200.0, 1e-5, 60.0)
    lasts = {}
    for item in candidates(limits, "A"):
        lasts[item.kind] = max(lasts.get(item.kind, 0.0), len(item.u) * item.dt)
    assert lasts["steps-with-holds"] == pytest.approx(60.0, rel=0.01)
    assert lasts["slow-ramp"] == pytest.approx(60.0, rel=0.01)
    assert lasts["sine"] < 1.0


def test_every_kind_is_offered():
    kinds = {item.kind for item in ITEMS}
    assert kinds == {
        "sine",
        "biased-minor-loops",
        "chirp",
        "multisine",
        "steps-with-holds",
        "slow-ramp",
    }


def test_limits_come_from_the_records():
    limits = Limits.of(
        [record(2 + sine(10, count=1000)), record(sine(50, count=500), dt=0.0005)]
    )
    assert (limits.low, limits.high) == pytest.approx((-1, 3))
    assert limits.dt == 0.0005
    assert limits.duration_s == pytest.approx(1.0)
    assert limits.bandwidth_hz == pytest.approx(100, rel=0.3)  # 50 per 1000 at 2 kHz
    assert limits.rate == pytest.approx(2 * np.pi * 50 * 2, rel=0.6)


def test_the_signal_file_is_the_excitation(tmp_path):
    item = ITEMS[3]
    item.write(CURRENT, tmp_path / "next.csv")
    header = (tmp_path / "next.csv").read_text().splitlines()[0]
    table = np.loadtxt(tmp_path / "next.csv", delimiter=",", skiprows=1)
    assert header == "time_s,current_A"
    assert table[:, 0] == pytest.approx(np.arange(len(item.u)) * item.dt)
    assert table[:, 1] == pytest.approx(item.u, abs=1e-8)


@pytest.mark.parametrize(
    ("name", "values"),
    [
        ("low", (1, 1, 1, 1, 0.001, 1)),
        ("rate", (0, 1, 0, 1, 0.001, 1)),
        ("duration_s", (0, 1, 1, 1, 0.001, 0.05)),
    ],
)
def test_impossible_limits_are_one_clear_line(name, values):
    with pytest.raises(InputError, match=f"^limits: {name}"):
        Limits(*values)


def test_one_sine_tells_no_lag_from_a_delay_that_may_be_refitted():
    lag = ("drive-lag", {"time_constant_s": 0.001})
    diffusion = ("eddy-diffusion", {"time_constant_s": 0.003, "geometry": "slab"})
    rivals = [model("lag", lag, GAIN), model("diffusion", diffusion, GAIN)]
    free = ("drive-lag.time_constant_s", "eddy-diffusion.time_constant_s")
    refitted = {
        "lag": {
            name: Rival.of(each, [own])
            for (name, each), own in zip(rivals, free, strict=True)
        }
    }
    records = [record(sine(1, count=4000))]
    of = {kind: [] for kind in ("sine", "chirp")}
    for item in ITEMS:
        if item.kind in of:
            of[item.kind].append(item)
    size = {}
    for kind, items in of.items():
        for fixed, sets in ((True, one_set(*rivals)), (False, refitted)):
            found = next_experiment(sets, records, 1e-3, items)
            size[kind, fixed] = size_of(found)
    # a sine has one phase, and a time constant takes it; a band has many
    assert size["sine", False] < 0.1 * size["sine", True]
    assert size["chirp", False] > 3 * size["sine", False]


LAG = ("drive-lag", {"time_constant_s": 0.002})
CREEP = ("creep", {"magnitudes": [0.1], "time_constants_s": [1.0]})
SLOW = ("creep", {"magnitudes": [0.1], "time_constants_s": [0.3]})
BOTH = {
    **one_set(model("lag", GAIN, LAG), model("mode", GAIN, MODE)),
    # The name stands in both sets, for two models.
    **one_set(model("creep", GAIN, CREEP), model("mode", GAIN, MODE, SLOW)),
}


@pytest.fixture(scope="module")
def both():
    records = [record(sine(1, count=4000))]
    items = [x for x in ITEMS if x.parameters.get("amplitude")]
    return records, items[::3], next_experiment(BOTH, records, 0.01, items[::3])


def test_one_excitation_is_best_over_the_pairs_of_all_sets(both):
    """By pairs that are told, by what is capped at clear, then by the hardest."""
    _, items, found = both
    sizes = []
    for item in items:
        run = {
            (of, name): rival.run(item.u, item.dt)
            for of, members in BOTH.items()
            for name, rival in members.items()
        }
        sizes.append(
            (
                separation(run["lag", "lag"], run["lag", "mode"], 0.01),
                separation(run["creep", "creep"], run["creep", "mode"], 0.01),
            )
        )
    merits = [
        (sum(x >= 1 for x in each), sum(min(x, CLEAR_FLOORS) for x in each), min(each))
        for each in sizes
    ]
    best = merits.index(max(merits))
    assert found.excitation is items[best]
    pairs = RivalPair("lag", ("lag", "mode")), RivalPair("creep", ("creep", "mode"))
    assert list(found.pairs) == list(pairs)
    for k, pair in enumerate(pairs):
        assert found.pairs[pair] == pytest.approx(sizes[best][k])
        assert found.largest[pair] == pytest.approx(max(each[k] for each in sizes))


def test_a_set_does_not_change_what_is_said_of_another(both):
    records, _, found = both
    for of, members in BOTH.items():
        own = next_experiment({of: members}, records, 0.01, [found.excitation])
        for pair in own.pairs:
            assert found.pairs[pair] == own.pairs[pair]
            assert found.existing[pair] == own.existing[pair]
    told = {(item["of"], *item["names"]) for item in found.mapping()["pairs"]}
    assert told == {("lag", "lag", "mode"), ("creep", "creep", "mode")}


def test_a_pair_that_is_told_counts_more_than_many_that_are_not():
    time = np.arange(1000) / 1000
    base, beside = (np.sin(2 * np.pi * k * time) for k in (1, 2))

    class Off:
        def __init__(self, by):
            self.by = by

        def simulate_near(self, others, u, dt):
            return [base + self.by.get(u[0], 0.0) / np.sqrt(2) * beside]

    # By so much each pair differs on the first excitation and on the second, rms:
    # half to each side, so that no gain takes a part of it away.
    apart = {f"near{k}": {1.0: 0.9} for k in range(4)} | {"clear": {2.0: 9.0}}
    sets = {
        name: {
            side: Rival(Off({level: sign * size for level, size in by.items()}))
            for side, sign in (("one", 1), ("other", -1))
        }
        for name, by in apart.items()
    }
    items = [
        dataclasses.replace(ITEMS[0], u=np.full(1000, level)) for level in (1.0, 2.0)
    ]
    made = record(np.zeros(1000))
    found = next_experiment(sets, [made], 1.0, items)
    assert found.excitation is items[1]
    assert max(found.pairs.values()) == pytest.approx(9.0, rel=0.02)


@pytest.mark.parametrize("refuses", [False, True])
def test_a_rival_that_runs_away_rules_an_excitation_out_and_no_other(refuses):
    class Bounded:
        def simulate_near(self, others, u, dt):
            if refuses and np.abs(u).max() >= 0.5:
                raise InputError("a function of somebody's: too much")
            return [u**2 if np.abs(u).max() < 0.5 else np.full_like(u, np.nan)]

    sets = one_set(("plain", GAIN_MODEL), ("bounded", Bounded()))
    items = ITEMS
    found = next_experiment(sets, [record(sine(1))], 0.01, items)
    assert np.abs(found.excitation.u).max() < 0.5
    # The record goes beyond: it tells nothing of the pair.
    assert size_of(found, existing=True) == 0.0
    large = [item for item in items if np.abs(item.u).max() >= 0.5]
    with pytest.raises(InputError, match=r"^next experiment: none of \d+ excitations"):
        next_experiment(sets, [record(sine(1))], 0.01, large)


_, GAIN_MODEL = model("plain", GAIN)
SIZES = st.floats(0, 9)


@settings(max_examples=200)
@given(
    st.lists(
        st.tuples(st.sampled_from("XY"), SIZES, SIZES, SIZES), min_size=1, max_size=8
    ),
    st.booleans(),
)
def test_the_sentence_says_what_the_numbers_say(rows, left_out):
    pairs = [RivalPair(of, (f"{of}{k}", f"b{k}")) for k, (of, *_) in enumerate(rows)]
    here = {pair: row[1] for pair, row in zip(pairs, rows, strict=True)}
    now = {pair: row[2] for pair, row in zip(pairs, rows, strict=True)}
    most = {pair: max(row[1], row[3]) for pair, row in zip(pairs, rows, strict=True)}
    if len(pairs) == 1:
        most = here  # what is best for all pairs is best for the one
    item = ITEMS[0]
    away = (("X", "drift"),) if left_out else ()
    said = Experiment(item, here, now, most, away).sentence
    assert item.words in said
    told = [pair for pair in pairs if here[pair] >= 1]
    hidden = [pair for pair in pairs if max(here[pair], now[pair]) < 1]
    never = [pair for pair in hidden if most[pair] < 1]
    other = [pair for pair in hidden if most[pair] >= 1]
    assert ("No feasible excitation" in said) == bool(never)
    assert ("drift is new in every record" in said) == left_out
    several = len({pair.of for pair in pairs}) > 1
    assert ("in the place of" in said) == several
    if len(pairs) > 1:
        count = (
            f"all {len(pairs)}"
            if len(told) == len(pairs)
            else (f"{len(told)} of {len(pairs)}")
        )
        assert (f"it separates {count} pairs" in said) == bool(told)
        assert ("Another excitation would tell" in said) == bool(other)
        known = [pair for pair in pairs if here[pair] < 1 <= now[pair]]
        assert ("The existing records tell" in said) == bool(known)
        assert ("and 1 more" in said) == (4 in map(len, (known, never, other)))
    # It is not recommended where the records that are there do as well.
    if all(now[pair] >= here[pair] for pair in pairs):
        assert "Try " not in said
    elif len(pairs) == 1 and told:
        assert said.startswith(f"Try {item.words}: ")


def test_a_large_set_is_told_in_a_sentence_that_ends():
    pairs = [RivalPair("a", names) for names in combinations("abcdefg", 2)]
    none = dict.fromkeys(pairs, 0.5)
    item = ITEMS[0]
    said = Experiment(item, none, none, none).sentence
    assert said.endswith(
        "No feasible excitation tells a from b, a from c, a from d and 18 more."
    )

import dataclasses

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from hystbench.blocks import registry
from hystbench.errors import InputError
from hystbench.gap.excitations import candidates, write_experiment
from hystbench.gap.experiment import (
    next_experiment,
    parameter_tangents,
    separation,
)
from hystbench.gap.limits import Limits
from hystbench.model import Model
from tests.gap.made import CURRENT, DISPLACEMENT, record, sine

LIMITS = Limits(-1.0, 1.0, 800.0, 100.0, 0.001, 4.0)


def model(name, *blocks):
    chain = tuple(registry()[kind](**values) for kind, values in blocks)
    return name, Model(name, CURRENT, DISPLACEMENT, chain)


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
        if item.kind == "sine" and item.parameters["amplitude"][0] > 0.99
    ]
    floor = 0.01
    found = next_experiment(rivals, [record(sine(1))], floor, LIMITS, excitations=sines)
    # In steady state a gain takes away what is in phase with the mean of the two.
    frequency = np.array([item.parameters["frequency_hz"][0] for item in sines])
    wn, s = 2 * np.pi * 35.0, 2j * np.pi * frequency
    first = 2.0 + 0 * s
    second = 2 * (0.9 + 0.1 * wn**2 / (s**2 + 2 * 0.05 * wn * s + wn**2))
    mean = (first + second) / 2
    quadrature = np.abs(((first - second) * mean.conj()).imag / np.abs(mean))
    best = int(np.argmax(quadrature))
    assert found.excitation is sines[best]
    assert found.separation == pytest.approx(
        quadrature[best] / np.sqrt(2) / floor, rel=0.05
    )
    assert found.existing_separation < 0.1 * found.separation
    assert "plain from mode" in found.sentence


def test_a_gain_and_an_offset_separate_nothing():
    u = sine(3)
    assert separation(u, 1.7 * u + 3, 0.1) < 1e-9
    # a sine beside a cosine: orthogonal to their mean, the difference stays whole
    other = sine(3, phase=np.pi / 2)
    assert separation(u, other, 0.1) == pytest.approx(1 / 0.1)
    assert separation(u, other, 0.1, (u - other)[:, None]) < 1e-9


def test_equivalent_models_are_said_to_be_so():
    rivals = [
        model("lag-first", ("drive-lag", {"time_constant_s": 0.002}), GAIN),
        model("lag-last", GAIN, ("drive-lag", {"time_constant_s": 0.002})),
    ]
    found = next_experiment(rivals, [record(sine(1))], 0.001, LIMITS)
    assert found.separation < 1e-6
    assert found.sentence.startswith("No feasible excitation tells lag-first from")


def test_rate_and_amplitude_effects_need_other_excitations():
    creep = ("creep", {"magnitudes": [0.1], "time_constants_s": [1.0]})
    slow = next_experiment(
        [model("plain", GAIN), model("creep", GAIN, creep)],
        [record(sine(50, count=4000))],
        0.01,
        LIMITS,
    )
    fast = next_experiment(
        [
            model("plain", GAIN),
            model("lag", GAIN, ("drive-lag", {"time_constant_s": 0.0002})),
        ],
        [record(sine(1, count=4000))],
        0.01,
        LIMITS,
    )

    def middle_hz(item):
        power = np.abs(np.fft.rfft(item.u - item.u.mean())) ** 2
        return np.sum(np.fft.rfftfreq(len(item.u), item.dt) * power) / power.sum()

    assert middle_hz(slow.excitation) < 3 < 10 < middle_hz(fast.excitation)
    assert slow.separation > slow.existing_separation
    assert fast.separation > fast.existing_separation


def test_mapping_holds_what_the_sentence_says():
    rivals = [model("plain", GAIN), model("mode", GAIN, MODE)]
    found = next_experiment(rivals, [record(sine(1, count=4000))], 0.01, LIMITS)
    content = found.mapping()
    assert f"{content['separation']:.2g}" in content["sentence"]
    assert content["excitation"].replace("-", " ") in content["sentence"]
    assert content["pairs"][0]["names"] == ["plain", "mode"]
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
    kinds = {item.kind for item in candidates(LIMITS, "A")}
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
    item = candidates(LIMITS, "A")[3]
    write_experiment(item, CURRENT, tmp_path / "next.csv")
    header = (tmp_path / "next.csv").read_text().splitlines()[0]
    table = np.loadtxt(tmp_path / "next.csv", delimiter=",", skiprows=1)
    assert header == "time_s,current_A"
    assert table[:, 0] == pytest.approx(np.arange(len(item.u)) * item.dt)
    assert table[:, 1] == pytest.approx(item.u, abs=1e-8)


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (([model("plain", GAIN)], [record(sine(1))], 0.1), "1 rival models; "),
        (([model("a", GAIN)] * 2, [record(sine(1))], 0.0), "noise floor: 0; "),
    ],
)
def test_what_cannot_be_asked_is_one_clear_line(arguments, message):
    with pytest.raises(InputError, match=f"^{message}"):
        next_experiment(*arguments)


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
    tangents = parameter_tangents(
        [
            (rivals[0][1], ["drive-lag.time_constant_s"]),
            (rivals[1][1], ["eddy-diffusion.time_constant_s"]),
        ]
    )
    records = [record(sine(1, count=4000))]
    of = {kind: [] for kind in ("sine", "chirp")}
    for item in candidates(LIMITS, "A"):
        if item.kind in of:
            of[item.kind].append(item)
    size = {}
    for kind, items in of.items():
        for free in (None, tangents):
            found = next_experiment(rivals, records, 1e-3, LIMITS, free, items)
            size[kind, free is None] = found.separation
    # a sine has one phase, and a time constant takes it; a band has many
    assert size["sine", False] < 0.1 * size["sine", True]
    assert size["chirp", False] > 3 * size["sine", False]


def test_a_word_is_no_parameter_to_refit():
    rival = model(
        "d", ("eddy-diffusion", {"time_constant_s": 0.003, "geometry": "rod"})
    )
    with pytest.raises(InputError, match=r"^eddy-diffusion.geometry: 'rod' is no"):
        parameter_tangents([(rival[1], ["eddy-diffusion.geometry"])])

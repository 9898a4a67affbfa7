"""Bases of a laboratory: numbers of a data sheet, channels not read at one time."""

import numpy as np
import pytest
from scipy.signal import lfilter, lsim

from hystbench.blocks.gain import Gain
from hystbench.blocks.input_delay import InputDelay
from hystbench.blocks.prandtl_ishlinskii import PrandtlIshlinskii
from hystbench.blocks.preisach import Preisach
from hystbench.blocks.sensor_lag import SensorLag
from hystbench.blocks.simulated_column import SimulatedColumn
from hystbench.blocks.transfer_function import TransferFunction
from hystbench.gap.asked import Asked
from hystbench.gap.bases.linear import IdentifiedModel
from hystbench.gap.bases.roughly_known import as_it_was, roughly_known
from hystbench.gap.fitting.on_records import start_state
from hystbench.gap.fitting.re_tuning_gain import re_tuned_words
from hystbench.gap.records.evidence import Evidence
from hystbench.gap.run import closed_gap
from hystbench.model import Model
from tests.gap.made import CURRENT, DISPLACEMENT, record
from tests.gap.searched import among

DT, FINE, COUNT, NOISE = 1e-3, 10, 1000, 2e-3
LAG = 7e-3
LATE_BY = 0.8  # samples
LAGS = Asked(vocabulary=among("sensor-lag", "input-delay", "resonance"))
"""A lag beside a base that is off, and what it may be taken for.

Before a linear base the same lag does the same: it would be searched twice.
"""


def second_order(frequency_hz, damping):
    w = 2 * np.pi * frequency_hz
    return TransferFunction(numerator=(w**2,), denominator=(1.0, 2 * damping * w, w**2))


def base(*blocks, **about):
    chain = blocks or (Gain(value=3.0), second_order(40.0, 0.3))
    return Model("data-sheet", CURRENT, DISPLACEMENT, chain, **about)


def device(frequency_hz, late):
    """The device by scipy, in steps ten times as short: its sensor lags."""
    w = 2 * np.pi * frequency_hz
    poles = np.polymul([1.0, 2 * 0.27 * w, w**2], [LAG, 1.0])
    rng = np.random.default_rng(3)
    for k, use in enumerate(["fit", "fit", "hold-out"]):
        lines = np.column_stack([rng.uniform(1, 90, 12), rng.uniform(0, 6, 12)])

        def drive(time, lines=lines):
            sines = sum(np.sin(2 * np.pi * f * time + p) for f, p in lines)
            return sines * np.clip(time / 0.1, 0, 1) ** 2

        fine = np.arange(COUNT * FINE) * DT / FINE
        _, y, _ = lsim(([3.0 * w**2], poles), drive(fine - late * DT), fine)
        u = drive(np.arange(COUNT) * DT)
        y = y[::FINE] + NOISE * rng.standard_normal(COUNT)
        yield record(u, y, name=f"run-{k}", dt=DT, use=use)


def closed(model, frequency_hz=38.5, late=LATE_BY, asked=LAGS):
    *fit, held = device(frequency_hz, late)
    evidence = Evidence("made", tuple(fit), (held,), noise_rms=NOISE)
    return closed_gap(evidence, model, asked).outcome


def test_a_lag_is_named_beside_a_base_that_is_a_little_off():
    found = closed(base())
    content = found.content
    (effect,) = content["effects"]
    assert effect["name"] == "sensor-lag"
    assert content["verdict"] == "named"
    assert found.model.free == ("sensor-lag.time_constant_s",)  # the rest is known now
    told = effect["parameters"]["time_constant_s"]["value"]
    assert told == pytest.approx(LAG, rel=0.02)
    assert content["gap"]["after"] < 1.5 * NOISE
    assert "denominator moved most" in content["reason"]
    assert f"its input counts as {LATE_BY:.2g} samples late" in content["reason"]
    first, _, last = content["base_parameters"]["transfer-function.denominator"][
        "after"
    ]
    assert last / first == pytest.approx((2 * np.pi * 38.5) ** 2, rel=0.01)


def test_a_base_that_calls_itself_exact_stays_as_it_is():
    alone = Asked(vocabulary=among("sensor-lag"))
    content = closed(base(exact=True), asked=alone).content
    assert "re-tuned" not in content["reason"]
    assert content["base_parameters"] == {}
    assert content["gap"]["after"] > 10 * NOISE


def test_beside_an_exact_base_nothing_is_re_tuned():
    exact = base(Gain(value=3.0), second_order(40.0, 0.27))
    content = closed(exact, frequency_hz=40.0, late=0.0).content
    (effect,) = content["effects"]
    assert effect["name"] == "sensor-lag"
    assert content["base_parameters"] == {}


def test_it_simulates_the_same_until_it_is_re_tuned():
    u = np.random.default_rng(0).normal(size=500)
    given = base()
    about = roughly_known(given, [record(u)])
    assert isinstance(about.chain[0], InputDelay)
    np.testing.assert_allclose(about.simulate(u, DT), given.simulate(u, DT), atol=1e-12)
    assert about.tolerances["gain.value"] == pytest.approx(0.1)
    assert "gain.offset" not in about.free  # nobody stated it


def test_the_numbers_of_a_hysteresis_are_free_as_well():
    loop = PrandtlIshlinskii(thresholds=(0.1, 0.2), weights=(1.0, 0.5))
    about = roughly_known(base(loop, SensorLag(time_constant_s=0.01)), [record([0, 1])])
    assert about.free == (
        "prandtl-ishlinskii.thresholds",
        "prandtl-ishlinskii.weights",
        "sensor-lag.time_constant_s",
        "input-delay.delay_s",
    )
    assert as_it_was(about) == base(*about.chain[1:])


def test_a_count_is_no_number_that_may_be_off():
    density = {"centre_spreads": (1.0,), "half_widths": (1.0,)}
    relays = Preisach(
        reversible=0.5,
        limit=5.0,
        weights=(1.0,),
        centres=(0.0,),
        half_width_spreads=(0.5,),
        cells=32,
        **density,
    )
    about = roughly_known(base(relays), [record([0.0, 1.0])])
    assert "preisach.limit" in about.free
    assert "preisach.cells" not in about.free


THRESHOLDS = np.linspace(0.05, 1.0, 8)
WEIGHTS = np.exp(-2 * THRESHOLDS)


def loops(seed, lag, hum=0.0):
    """Plays, written here, whose numbers are up to 5 % off; a sensor may lag or hum."""
    rng = np.random.default_rng(seed)
    off = 1 + rng.uniform(-0.05, 0.05, (2, 8))
    thresholds, weights = off * (THRESHOLDS, WEIGHTS)
    time = np.arange(COUNT) * DT
    kept = np.exp(-DT / lag) if lag else 0.0
    for k, use in enumerate(["fit", "fit", "fit", "hold-out"]):
        lines = np.column_stack([rng.uniform(0.5, 12, 10), rng.uniform(0, 6, 10)])
        u = 0.5 + sum(np.sin(2 * np.pi * f * time + p) for f, p in lines) / 4
        u *= np.clip(time / 0.1, 0, 1)
        play, y = np.zeros(8), np.empty(COUNT)
        for n, x in enumerate(u):
            play = np.clip(play, x - thresholds, x + thresholds)
            y[n] = x + weights @ play
        y = lfilter([1 - kept], [1, -kept], y)
        y += hum * np.sin(2 * np.pi * 50.03 * time + k)
        y += NOISE * np.std(y) * rng.standard_normal(COUNT)
        yield record(u, y, name=f"run-{k}", dt=DT, use=use)


@pytest.mark.parametrize(("lag", "names"), [(0.0, []), (4e-3, ["sensor-lag"])])
def test_a_hysteresis_that_is_a_little_off_is_no_effect(lag, names):
    """That it is split into several plays of the same thresholds does not matter."""
    *fit, held = loops(1, lag)
    parts = 5
    plays = PrandtlIshlinskii(
        thresholds=tuple(np.repeat(THRESHOLDS, parts)),
        weights=tuple(np.repeat(WEIGHTS, parts) / parts),
    )
    evidence = Evidence("made", tuple(fit), (held,))
    # Where there is nothing, no effect at all is named.
    asked = LAGS if names else Asked()
    content = closed_gap(evidence, base(plays), asked).outcome.content
    assert [item["name"] for item in content["effects"]] == names
    assert content["verdict"] == ("named" if names else "parameters")
    assert content["gap"]["after"] < 1.2 * NOISE * np.std(held.y)


def test_beside_a_hum_a_base_that_is_off_is_re_tuned_too():
    *fit, held = loops(0, 0.0, hum=0.05)
    plays = PrandtlIshlinskii(thresholds=tuple(THRESHOLDS), weights=tuple(WEIGHTS))
    evidence = Evidence("made", tuple(fit), (held,))
    likely = Asked(vocabulary=among("mains-pickup", "drift", "sensor-lag", "creep"))
    content = closed_gap(evidence, base(plays), likely).outcome.content
    assert [x["name"] for x in content["effects"]] == ["mains-pickup"]
    assert content["base_parameters"]


def of_a_column():
    other = record([0.0, 1.0], simulated=np.array([0.0, 1.0]))
    return SimulatedColumn(column="y", records=(other,))


@pytest.mark.parametrize(
    "given",
    [
        base(exact=True),
        base(free=("gain.value",)),
        IdentifiedModel("linear", CURRENT, DISPLACEMENT, base().chain),
        base(of_a_column()),
    ],
    ids=["exact", "says what is free", "identified", "a column"],
)
def test_others_are_taken_as_they_say(given):
    assert roughly_known(given, [record([0.0, 1.0])]) is None


def test_an_empty_list_of_free_numbers_calls_a_model_exact():
    content = base().to_mapping()
    assert not Model.from_mapping(content, "model").exact
    exact = Model.from_mapping(content | {"free": []}, "model")
    assert exact.exact
    assert exact.to_mapping()["free"] == []


def test_what_moved_most_is_told_with_the_timing():
    u = np.random.default_rng(1).normal(size=200)
    records = (record(u, dt=DT),)
    start, _ = start_state(records, roughly_known(base(), records), "linear")
    late = start.chain[0].delay_s - 0.5 * DT
    tuned = start.with_values({0: {"delay_s": late}, 1: {"value": 2.88}})
    words = re_tuned_words(start, tuned)
    assert words == "value moved most, by 4 %, its input counts as 0.5 samples early"


def test_what_stands_still_is_not_told_and_a_zero_stays_zero():
    """An integrator has no pole but at zero."""
    integrator = TransferFunction(numerator=(1.0,), denominator=(1.0, 30.0, 0.0))
    u = np.random.default_rng(1).normal(size=200)
    records = (record(u, dt=DT),)
    start, _ = start_state(records, roughly_known(base(integrator), records), "linear")
    assert [free.element for free in start.free[:3]] == [0, 0, 1]
    assert all(np.isfinite([free.low, free.high]).all() for free in start.free)
    assert re_tuned_words(start, start) == "nothing moved far"


SENSOR = {"thresholds": (2.0, 7.0, 15.0), "weights": (0.17, 0.15, 0.12)}


def positioner(frequency_hz, gain):
    mode = second_order(frequency_hz, 0.04)
    return base(PrandtlIshlinskii(**SENSOR), Gain(value=gain), mode)


def swept(model):
    """Records of a positioner in steps a tenth as long: its mode is excited."""
    rng, fine = np.random.default_rng(29), np.arange(40000) / 20000
    for k, use in enumerate(["fit", "fit", "hold-out"]):
        lines = zip(rng.uniform(1, 240, 20), rng.uniform(0, 6, 20), strict=True)
        sines = sum(3 * np.sin(2 * np.pi * f * fine + p) for f, p in lines)
        u = np.clip(fine / 0.2, 0, 1) * (40 + sines)
        y = model.simulate(u, fine[1])[::10]
        y += 0.02 * np.std(y) * rng.standard_normal(len(y))
        yield record(u[::10], y, name=f"run-{k}", dt=10 * fine[1], use=use)


def test_a_mode_and_a_gain_that_are_a_little_off_are_no_two_effects():
    *fit, held = swept(positioner(210.0, 1.0))
    evidence = Evidence("made", tuple(fit), (held,))
    asked = Asked(vocabulary=among("resonance", "calibration-error", "input-delay"))
    content = closed_gap(evidence, positioner(211.5, 1.01), asked).outcome.content
    assert content["effects"] == []
    assert content["verdict"] == "parameters"
    assert content["gap"]["after"] < 0.2 * content["gap"]["before"]

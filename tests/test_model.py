"""Models: the chain, its file, and what is said about a wrong one."""

import subprocess
import sys

import numpy as np
import pytest
import yaml
from hypothesis import given
from hypothesis import strategies as st

from hystbench.blocks import registry
from hystbench.blocks.force import Force
from hystbench.blocks.gain import Gain
from hystbench.blocks.sensor_noise import SensorNoise
from hystbench.blocks.superposed import BesideBlock
from hystbench.blocks.wrapping import WrappingBlock
from hystbench.errors import InputError
from hystbench.model import Model, load_model
from hystbench.model_content import Provenance
from hystbench.record import Channel

from .blocks.examples import EXAMPLES

TEXT = """
name: small
input: {name: current, unit: A}
output: {name: displacement, unit: um}
free: [gain.value, resonance#2.damping_ratio]
chain:
  - gain: {value: 10, offset: 1}
  - resonance: {frequency_hz: 65, damping_ratio: 0.03, participation: 0.1}
  - resonance: {frequency_hz: 300, damping_ratio: 0.05, participation: 0.2}
  - sensor-noise: {rms: 0.05}
provenance:
  gain.value: {source: published, note: It is printed.}
"""


def content():
    return yaml.safe_load(TEXT)


def model():
    return Model.from_mapping(content(), "small.yaml")


def test_the_chain_is_applied_in_order():
    chain = (Gain(value=2.0, offset=1.0), Gain(value=3.0, offset=0.0))
    u = np.array([0.0, 1.0])
    double = Model("m", Channel("u", "A"), Channel("y", "um"), chain)
    np.testing.assert_allclose(double.simulate(u, 1e-3), [3.0, 9.0])


def test_hold_is_set_where_the_file_sets_none():
    text = TEXT.replace("damping_ratio: 0.03,", "damping_ratio: 0.03, hold: linear,")
    given = Model.from_mapping(yaml.safe_load(text), "small.yaml")
    assert [block.holding for block in given.chain[1:3]] == ["linear", "linear"]
    held = given.with_hold("band-limited")
    assert [block.hold for block in held.chain[1:3]] == ["linear", "band-limited"]
    assert held.chain[0] == given.chain[0]
    assert held.provenance == given.provenance
    with pytest.raises(InputError, match=r"'band' is unknown.*band-limited"):
        given.with_hold("band")


def test_a_staircase_ends_at_the_first_dynamic_block():
    chain = [
        {"input-delay": {"delay_s": 0.01}},
        {"drive-lag": {"time_constant_s": 0.01}},
        {"gain": {"value": 2.0}},
        {"sensor-lag": {"time_constant_s": 0.01}},
    ]
    staircase = Model.from_mapping(
        content() | {"chain": chain, "free": [], "provenance": {}}, "m.yaml"
    ).with_hold("zero-order")
    holds = [getattr(block, "hold", None) for block in staircase.chain]
    assert holds == ["zero-order", "zero-order", None, "linear"]


@pytest.mark.parametrize(
    ("before", "expected"),
    [
        (
            [],
            r"block 1 \(hysteresis-shape\): expected hysteresis just before it "
            r"\(bouc-wen, gpi, .*rdgpi\), got none",
        ),
        (["gain"], r"block 2 .*got gain"),
        (["gpi", "gain"], r"block 3 .*got gain"),
    ],
)
def test_a_block_that_wraps_needs_hysteresis_before_it(before, expected):
    names = [*before, "hysteresis-shape"]
    chain = [{name: EXAMPLES[name]} for name in names]
    with pytest.raises(InputError, match=expected):
        Model.from_mapping(
            content() | {"chain": chain, "free": [], "provenance": {}}, "m.yaml"
        )


def test_random_blocks_speak_only_with_a_generator():
    silent, spoken = model(), np.random.default_rng(5)
    u = np.sin(np.arange(4000) / 50)
    mean = silent.simulate(u, 1e-4)
    np.testing.assert_array_equal(mean, silent.simulate(u, 1e-4))
    noise = silent.simulate(u, 1e-4, spoken) - mean
    assert noise.std() == pytest.approx(0.05, rel=5 / np.sqrt(2 * len(u)))


def test_noise_before_dynamics_is_filtered():
    chain = (SensorNoise(rms=1.0), Gain(value=0.0))
    quiet = Model("m", Channel("u", "A"), Channel("y", "um"), chain)
    y = quiet.simulate(np.zeros(10), 1e-3, np.random.default_rng(1))
    np.testing.assert_array_equal(y, np.zeros(10))


def test_parameters_are_read_and_replaced_by_name():
    changed = model().with_values({"gain.value": 7.0, "resonance#2.frequency_hz": 310})
    assert changed.value("gain.value") == 7.0
    assert changed.value("resonance#2.frequency_hz") == 310.0
    assert changed.value("resonance.frequency_hz") == 65.0
    assert model().value("gain.value") == 10.0
    with pytest.raises(InputError, match=r"did you mean 'gain\.value'"):
        model().value("gain.valu")
    with pytest.raises(InputError, match=r"block 4 \(sensor-noise\): rms: -1 is"):
        model().with_values({"sensor-noise.rms": -1.0})


def test_every_parameter_has_a_name():
    names = model().parameter_names()
    assert "resonance#2.participation" in names
    assert len(names) == len(set(names))
    for name in names:
        model().value(name)


@st.composite
def blocks(draw):
    """Draw a block: its example, each parameter scaled by a factor of its own."""
    block = registry()[draw(st.sampled_from(sorted(registry())))]
    values = dict(EXAMPLES[block.name])
    for key, about in block.parameters().items():
        if about.kind == "choice":
            values[key] = draw(st.sampled_from(about.options))
        elif about.kind != "text" and key in values:
            factor = draw(st.floats(0.5, 1.0))
            values[key] = scaled(values[key], factor, about.low, about.high)
    return block.from_mapping(values)


def scaled(value, factor, low, high):
    if isinstance(value, dict):
        return {key: scaled(item, factor, low, high) for key, item in value.items()}
    if isinstance(value, list | tuple):
        return [scaled(item, factor, low, high) for item in value]
    return value if isinstance(value, int) else min(max(factor * value, low), high)


GPI = registry()["gpi"].from_mapping(EXAMPLES["gpi"])
words = st.text("abcdefghijklmnopqrstuvwxyz -µ:#'\"{}[]0123456789.", min_size=1)
units = st.sampled_from(["A", "mV", "um", "µm", "m/s^2", "-", "1", "N*m"])


def host_of(block):
    """Give the block that one has to be attached to, if so."""
    if isinstance(block, Force | BesideBlock):
        return [registry()["mechanism"].from_mapping(EXAMPLES["mechanism"])]
    return [GPI] if isinstance(block, WrappingBlock) else []


@given(st.data())
def test_a_model_file_round_trips(data):
    drawn = data.draw(st.lists(blocks(), min_size=1, max_size=5))
    chain = tuple(item for block in drawn for item in (*host_of(block), block))
    bare = Model("m", Channel("u", "A"), Channel("y", "um"), chain)
    names = bare.parameter_names()
    free = data.draw(st.lists(st.sampled_from(names), unique=True))
    shares = st.none() | st.floats(1e-3, 10.0)
    tolerances = {name: data.draw(shares) for name in free}
    sources = st.sampled_from(["published", "derived", "calibrated"])
    notes = words.filter(str.strip)
    original = Model(
        name=data.draw(words),
        input=Channel(data.draw(words), data.draw(units)),
        output=Channel(data.draw(words), data.draw(units)),
        chain=chain,
        free=tuple(free),
        provenance={
            name: Provenance(data.draw(sources), data.draw(notes)) for name in free
        },
        tolerances={name: x for name, x in tolerances.items() if x is not None},
    )
    text = original.to_yaml()
    assert Model.from_mapping(yaml.safe_load(text), "m.yaml") == original


def test_save_and_load(tmp_path):
    model().save(tmp_path / "m.yaml")
    assert load_model(tmp_path / "m.yaml") == model()


def without(key):
    return lambda c: c.pop(key)


def put(value, *path):
    def change(c):
        for key in path[:-1]:
            c = c[key]
        c[path[-1]] = value

    return change


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (without("chain"), "missing key 'chain'"),
        (put([], "chain"), "chain: expected at least one block"),
        (put({}, "chain"), "chain: expected a list of blocks"),
        (put(7, "chain", 0), "chain: block 1: 7; expected one block and its"),
        (
            put({"gain": {}, "value": 2}, "chain", 0),
            "chain: block 1: 2 keys (gain, value); expected one block",
        ),
        (
            put({"resonanse": {}}, "chain", 1),
            "chain: block 2: unknown block 'resonanse'; did you mean 'resonance'?",
        ),
        (
            put({"gain": {"valeu": 1}}, "chain", 1),
            "chain: block 2 (gain): unknown parameter 'valeu'; did you mean 'value'?",
        ),
        (
            put({"gain": None}, "chain", 1),
            "chain: block 2 (gain): missing parameter 'value' (Y/U): static gain",
        ),
        (
            put({"gain": {"value": "1e-5"}}, "chain", 1),
            "chain: block 2 (gain): value: expected a number, got '1e-5'",
        ),
        (
            put({"gain": {"value": [1]}}, "chain", 1),
            "chain: block 2 (gain): value: expected a number, got [1]",
        ),
        (
            put(-0.5, "chain", 1, "resonance", "damping_ratio"),
            "chain: block 2 (resonance): damping_ratio: -0.5 is out of bounds, "
            "expected 1e-05 to 10 -",
        ),
        (
            put("linaer", "chain", 1, "resonance", "hold"),
            "chain: block 2 (resonance): hold: 'linaer' is unknown; "
            "did you mean 'linear'?",
        ),
        (put(1, "chian"), "unknown key 'chian'; did you mean 'chain'?"),
        (put(3, "name"), "name: expected a word, got 3"),
        (put("A", "input"), "input: expected a mapping of keys, got 'A'"),
        (put(1, "input", "unit"), "input: unit: expected a word, got 1"),
        (put(1, "output", "units"), "output: unknown key 'units'"),
        (put("gain.value", "free"), "free: expected a list of parameters"),
        (
            put(["gain.vale"], "free"),
            "free: unknown parameter 'gain.vale'; did you mean 'gain.value'?",
        ),
        (
            put("guessed", "provenance", "gain.value", "source"),
            "provenance: gain.value: source: 'guessed' is unknown",
        ),
        (
            put(" ", "provenance", "gain.value", "note"),
            "provenance: gain.value: note: expected a sentence",
        ),
        (
            put({"source": "published", "note": "x"}, "provenance", "gain.values"),
            "provenance: unknown parameter 'gain.values'; did you mean 'gain.value'?",
        ),
    ],
)
def test_a_wrong_file_is_refused_in_one_line(change, message):
    wrong = content()
    change(wrong)
    with pytest.raises(InputError) as caught:
        Model.from_mapping(wrong, "small.yaml")
    assert str(caught.value).startswith("small.yaml: " + message)
    assert "\n" not in str(caught.value)


def test_a_file_that_is_a_list_is_refused():
    with pytest.raises(InputError, match=r"a\.yaml: expected a mapping of keys"):
        Model.from_mapping([1], "a.yaml")


def test_importing_models_stays_light():
    # A filter's job is one process; scipy alone would double its start.
    code = "import sys, hystbench.model; print('scipy' in sys.modules)"
    out = subprocess.run(
        [sys.executable, "-c", code], capture_output=True, text=True, check=True
    )
    assert out.stdout.strip() == "False"


def test_a_free_parameter_may_have_a_tolerance():
    free = {"gain.value": 0.1, "gain.offset": None}
    given = Model.from_mapping(content() | {"free": free}, "small.yaml")
    assert given.free == ("gain.value", "gain.offset")
    assert given.tolerances == {"gain.value": 0.1}
    assert given.to_mapping()["free"] == free
    assert model().tolerances == {}


def test_a_number_of_several_is_told_by_what_it_belongs_to():
    envelope = dict.fromkeys([f"a{k}" for k in range(8)], 1.0)
    block = {"gpi": {"envelope": envelope, "thresholds": [0.0], "weights": [1.0]}}
    with pytest.raises(InputError, match=r"it is one of gpi\.envelope"):
        Model.from_mapping(
            content() | {"chain": [block], "free": ["gpi.a0"], "provenance": {}}, "x"
        )


@pytest.mark.parametrize(
    ("free", "expected"),
    [
        ({"gain.valeu": 0.1}, "free: unknown parameter 'gain.valeu'.*gain.value"),
        ({"gain.value": -0.1}, "gain.value: expected a tolerance above 0.*-0.1"),
        ({"gain.value": 0}, "expected a tolerance above 0"),
        ({"gain.value": "10 %"}, "expected a tolerance above 0.*'10 %'"),
        ({"gain.value": True}, "expected a tolerance above 0"),
        ({"gain.value": float("inf")}, "expected a tolerance above 0"),
        ("gain.value", "expected a list of parameters, or a mapping"),
    ],
)
def test_a_tolerance_that_makes_no_sense_is_refused(free, expected):
    with pytest.raises(InputError, match=expected) as caught:
        Model.from_mapping(content() | {"free": free}, "small.yaml")
    assert "\n" not in str(caught.value)


def test_a_tolerance_of_what_is_not_free_is_refused():
    with pytest.raises(InputError, match=r"'gain\.offset', which is not free"):
        Model(
            "m",
            Channel("u", "A"),
            Channel("y", "um"),
            (Gain(value=2.0),),
            free=("gain.value",),
            tolerances={"gain.offset": 0.1},
        )


#: A file as the first version wrote it, before blocks held how their input moves.
EARLY = """
name: early
input: {name: current, unit: A}
output: {name: displacement, unit: um}
free: [gain.value, resonance#2.damping_ratio]
chain:
  - drive-lag: {time_constant_s: 0.002}
  - gpi:
      envelope: [1.2878, 0.36, 0.6025, -0.6671, 0.3223, 1.2233, 0.1104, -0.0248]
      thresholds: [0.0, 0.05, 0.1]
      weights: [1.0, 0.5, 0.25]
  - gain: {value: 10, offset: 1}
  - asymmetry: {coefficient: 0.02}
  - resonance: {frequency_hz: 65, damping_ratio: 0.03, participation: 0.1}
  - resonance: {frequency_hz: 300, damping_ratio: 0.05, participation: 0.2}
  - creep: {magnitudes: [0.05, 0.03], time_constants_s: [0.2, 2.0]}
  - transfer-function: {numerator: [1.0e+3, 4.0e+5], denominator: [1.0, 1.2e+3, 4.0e+5]}
  - calibration-error: {gain: 1.05, offset: 0.1}
  - sensor-noise: {rms: 0.05}
provenance:
  gain.value: {source: published, note: Printed in the data sheet.}
"""
#: Of these samples, what that version simulated (its first commit with kernels).
THEN = {1: 0.29767569, 57: 6.88818629, 123: -2.44326096, 399: -4.31972286}


def test_a_model_file_of_the_first_version_means_what_it_meant(tmp_path):
    (tmp_path / "early.yaml").write_text(EARLY)
    model = load_model(tmp_path / "early.yaml")
    u = 2 * np.sin(2 * np.pi * 20 * np.arange(400) / 4000)
    y = model.simulate(u, 1 / 4000)
    np.testing.assert_allclose(y[list(THEN)], list(THEN.values()), rtol=1e-7)
    assert model.free == ("gain.value", "resonance#2.damping_ratio")

"""Which blocks of a model are drawn where, and whose they are."""

import re

import pytest

from hystbench.errors import InputError
from hystbench.gap.report.parts import Part, Stage, in_one_line, number_words, stages
from hystbench.model import Model


def model(*chain):
    return Model.from_mapping(
        {
            "name": "rig",
            "input": {"name": "force", "unit": "N"},
            "output": {"name": "position", "unit": "mm"},
            "chain": list(chain),
        },
        "rig.yaml",
    )


def effect(name, place="inside", *, blocks=None, **numbers):
    """Give an effect; its block has its name, if nothing else is said."""
    return {
        "blocks": [name] if blocks is None else list(blocks),
        "name": name,
        "place": place,
        "parameters": {
            key: {"value": value, "standard_error": None, "unit": unit}
            for key, (value, unit) in numbers.items()
        },
    }


def numbers(*texts):
    """Write numbers as boxes have them: no line breaks before a unit."""
    return tuple(re.sub(r"(?<=[\d⁷]) (?=\D)", "\u00a0", text) for text in texts)


def gap(*effects, put_in=()):
    return {"effects": list(effects), "built_in": {"effects": list(put_in)}}


MECHANISM = {"mechanism": {"mass": 2.0, "damping": 0.5, "stiffness": 300.0}}
FRICTION = {"friction-force": {"coulomb": 4.5, "presliding_distance": 1e-7}}
IMPEDANCE = {"impedance": {"mass": 0.1, "damping": 2.0, "stiffness": 3.0}}
OTHERS = {"other-modes": {"numerator": [1.0], "denominator": [1.0, 2.0, 900.0]}}
ENVELOPE = [1.0, 1.0, 0.0, 0.0, 1.0, 1.0, 0.0, 0.0]
PLAYS = {"gpi": {"envelope": ENVELOPE, "thresholds": [0.0, 0.1], "weights": [1.0, 0.5]}}
FELT = effect(
    "friction",
    blocks=["friction-force"],
    coulomb=(4.5, "N"),
    presliding_distance=(1e-7, "mm"),
)


def test_a_force_inside_a_mechanism_is_fed_back_with_its_numbers():
    delay = effect("input-delay", "before", delay_s=(0.01, "s"))
    found = stages(
        model({"input-delay": {"delay_s": 0.01}}, MECHANISM, FRICTION),
        gap(FELT, delay),
    )
    before, moved = found
    assert before.core == Part("input delay", numbers("delay 0.01 s"), "added")
    assert moved.core == Part("mechanism")
    assert moved.fed_back == (
        Part(
            "friction",
            numbers("coulomb 4.5 N", "presliding distance 1·10⁻⁷ mm"),
            "added",
        ),
    )
    assert (moved.beside, moved.around, moved.within) == ((), (), ())


def test_a_force_inside_an_impedance_is_beside_it():
    (found,) = stages(model(IMPEDANCE, FRICTION), gap(FELT))
    assert [one.core.words for one in found.beside] == ["friction"]
    assert found.fed_back == ()


def test_other_modes_are_beside_and_of_the_simulator():
    (found,) = stages(model(MECHANISM, FRICTION, OTHERS), gap(FELT))
    assert found.beside == (Stage(Part("other modes")),)
    assert [part.whose for part in found.fed_back] == ["added"]


def test_what_wraps_hysteresis_is_around_it():
    wrapped = {"rate-dependent-hysteresis": {"coefficient": 0.5, "exponent": 0.7}}
    named = effect(
        "rate-dependent-hysteresis",
        "material",
        coefficient=(0.5, "s/V"),
        exponent=(0.7, "-"),
    )
    (found,) = stages(model(PLAYS, wrapped), gap(named))
    assert found.core == Part("gpi")
    assert found.around == (
        Part(
            "rate dependent hysteresis",
            numbers("coefficient 0.5 s/V", "exponent 0.7"),
            "added",
        ),
    )


def test_effects_of_stores_are_in_them_and_what_is_spilt_goes_on():
    upper = {"gain": 1.0, "rate": 0.1, "exponent": 0.6, "height": 8.0}
    upper |= {"caught": 0.25, "output": "outflow"}
    lower = {"gain": 1.0, "rate": 0.2, "exponent": 0.4}
    outflow = effect(
        "outflow",
        blocks=["store", "store#2"],
        **{"exponent": (0.6, "-"), "exponent#2": (0.4, "-")},
    )
    overflow = effect(
        "overflow", blocks=["store"], height=(8.0, "V"), caught=(0.25, "-")
    )
    first, last = stages(
        model({"store": upper}, {"store": lower}), gap(outflow, overflow)
    )
    assert first.core == last.core == Part("store")
    assert first.within == (Part("outflow", ("exponent 0.6",), "added"),)
    assert last.within == (Part("outflow", ("exponent 0.4",), "added"),)
    assert first.spilt == Part(
        "overflow", numbers("height 8 V", "caught 0.25"), "added"
    )
    assert first.caught
    assert last.spilt is None


def test_a_given_store_that_overflows_is_drawn_so():
    (found,) = stages(
        model({"store": {"gain": 1.0, "rate": 0.1, "height": 8.0}}), gap()
    )
    assert found.spilt == Part("overflow")
    assert not found.caught


def test_of_two_blocks_of_one_name_the_one_that_gap_json_has_was_added():
    lags = [{"sensor-lag": {"time_constant_s": value}} for value in (0.02, 0.03)]
    named = effect(
        "sensor-lag", "sensor", blocks=["sensor-lag#2"], time_constant_s=(0.03, "s")
    )
    found = stages(model(*lags), gap(named))
    assert [stage.core.whose for stage in found] == ["simulator", "added"]


def test_a_block_of_the_simulator_with_an_effects_name_stays_its_own():
    """The effect gave way to a later one, and has no block."""
    given = {"sensor-lag": {"time_constant_s": 0.02}}
    named = effect("sensor-lag", blocks=(), time_constant_s=(0.03, "s"))
    (found,) = stages(model(given), gap(named))
    assert found.core == Part("sensor lag")


def test_what_the_user_put_in_is_told_apart_and_has_its_numbers_of_today():
    lag = {"sensor-lag": {"time_constant_s": 0.03}}
    earlier = effect("sensor-lag", "sensor", time_constant_s=(0.02, "s"))
    found = stages(model(MECHANISM, FRICTION, lag), gap(FELT, put_in=[earlier]))
    assert found[-1].core == Part(
        "sensor lag", numbers("time constant 0.03 s"), "put in"
    )
    assert found[0].fed_back[0].whose == "added"


def test_an_offset_before_and_behind_the_hysteresis_is_the_asymmetry():
    bias = {"gain": {"value": 1.0, "offset": 0.2}}
    zero = {"gain": {"value": 1.0, "offset": -1.5}}
    named = effect(
        "asymmetry",
        "material",
        blocks=["gain", "gain#2"],
        bias=(0.2, "N"),
        zero=(-1.5, "mm"),
    )
    found = stages(model(bias, PLAYS, zero), gap(named))
    assert [stage.core.words for stage in found] == ["asymmetry", "gpi", "asymmetry"]
    assert found[2].core.numbers == numbers("zero −1.5 mm")  # noqa: RUF001


def test_a_block_that_is_not_there_is_one_line():
    lost = effect("backlash", blocks=["backlsh"])
    with pytest.raises(InputError, match=r"no block 'backlsh' in model\.yaml; did you"):
        stages(model({"backlash": {"half_width": 0.5}}), gap(lost))


def test_noise_is_not_drawn():
    found = stages(model(MECHANISM, {"sensor-noise": {"rms": 0.1}}), gap())
    assert [stage.core.words for stage in found] == ["mechanism"]


def test_a_simulator_of_ones_own_has_the_name_of_its_function():
    (found,) = stages(model({"external": {"function": "rig.model:run"}}), gap())
    assert found.core.words == "rig.model:run"


@pytest.mark.parametrize(
    ("name", "value", "unit", "expected"),
    [
        ("time_constant_s", 0.0253, "s", "time constant 0.0253 s"),
        ("frequency_hz", 62.96, "Hz", "frequency 63 Hz"),
        ("sharpness", 10.53, "-", "sharpness 10.5"),
        ("contact_stiffness", 2.027e6, "N/m", "contact stiffness 2.03·10⁶ N/m"),
        ("level", -1.2, "um", "level −1.2 µm"),  # noqa: RUF001
    ],
)
def test_numbers_in_words(name, value, unit, expected):
    assert number_words(name, value, unit).replace("\u00a0", " ") == expected


def test_no_line_breaks_between_a_number_and_its_unit():
    assert number_words("coulomb", 4.5, "N").split(" ") == ["coulomb", "4.5\u00a0N"]


def test_the_diagram_in_words():
    rig = model({"input-delay": {"delay_s": 0.01}}, MECHANISM, FRICTION, OTHERS)
    assert in_one_line(rig, stages(rig, gap(FELT))) == (
        "force, then input delay, then mechanism with friction fed back and other "
        "modes beside it, then position"
    )


def test_a_force_behind_a_mechanism_beside_acts_in_that_one():
    beside = {"other-mechanism": MECHANISM["mechanism"]}
    (found,) = stages(model(MECHANISM, FRICTION, beside, FRICTION, OTHERS), gap())
    assert [part.words for part in found.fed_back] == ["friction force"]
    other, rest = found.beside
    assert [part.words for part in other.fed_back] == ["friction force"]
    assert (rest.core.words, rest.fed_back) == ("other modes", ())
    words = in_one_line(model(MECHANISM, FRICTION, beside, FRICTION), (found,))
    assert "other mechanism with friction force fed back" in words

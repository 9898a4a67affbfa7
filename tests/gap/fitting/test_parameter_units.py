"""Metres for micrometres, milliamperes for amperes: nothing else moves."""

from dataclasses import replace

import numpy as np
import pytest

from hystbench.blocks import registry
from hystbench.gap.effects.variant import Variant
from hystbench.gap.fitting.edit_chain import with_effect
from hystbench.gap.fitting.model_score import make_score
from hystbench.gap.fitting.parameter_units import unit_at, unit_behind
from hystbench.gap.judging.effect_rows import effect_mapping
from hystbench.gap.judging.leftover import Leftover
from hystbench.gap.naming.rank import rank
from hystbench.gap.records.floor import Floor
from hystbench.gap.thresholds import PAYS
from tests.gap.small import ENVELOPE, GPI, block, hysteresis, measured, state_of

INPUT, OUTPUT = 2.0**10, 2.0**-20
"""A thousand and a millionth, near enough; powers of two leave every digit alone."""
NOISE = 0.02


def gain(u=1.0, y=1.0):
    return block("gain", value=12.0 * y / u, offset=0.5 * y)


def loop(u=1.0, y=1.0):
    slopes = {key: ENVELOPE[key] / u for key in ("a1", "a5")}
    weights = [weight * y for weight in GPI["weights"]]
    shape = {"envelope": ENVELOPE | slopes, "thresholds": GPI["thresholds"]}
    return block("gpi", **shape, weights=weights)


HIDDEN = {
    "a curve of the sensor": [block("sensor-nonlinearity", quadratic=8e-3, cubic=2e-3)],
    "two of the mechanics": [
        block("creep", magnitudes=[0.05], time_constants_s=[0.2]),
        block("friction", coulomb=0.4, velocity_scale=2.0),
    ],
}


@pytest.mark.parametrize("base", [gain, loop])
@pytest.mark.parametrize("hidden", sorted(HIDDEN))
def test_every_candidate_gains_the_same_in_any_unit(base, hidden):
    given = measured((base(), *HIDDEN[hidden]), NOISE)
    scaled = tuple(replace(one, u=one.u * INPUT, y=one.y * OUTPUT) for one in given)
    found = []
    for records, chain, noise in (
        (given, base(), NOISE),
        (scaled, base(INPUT, OUTPUT), NOISE * OUTPUT),
    ):
        state = state_of((chain,), records)
        ranking = rank(state, make_score(state, Floor(noise, "declared")))
        found.append({item.effect: item for item in ranking})
    before, after = found
    assert list(after) == list(before)
    for name, one in before.items():
        other = after[name]
        # Sixteen numbers of plays end somewhere in a flat valley: there the last digits
        # of the first derivatives count, which powers of two do not leave alone.
        near = PAYS if one.form == "generalized plays" else 0.01
        assert other.gain == pytest.approx(one.gain, abs=near, nan_ok=True), name
        assert bool(other.declined) == bool(one.declined), other.declined
    assert before[next(iter(before))].gain > 50


def test_no_number_that_has_the_unit_of_a_signal_is_bounded_within_reach():
    """No stage in metres nor drive in kilovolts is beyond what a block may be."""
    for name, kind in registry().items():
        for key, about in kind.parameters().items():
            if about.kind not in ("number", "numbers"):
                continue
            if not {"U", "Y"} & set(about.unit):
                continue
            assert about.high >= 1e30, (name, key)
            assert about.low <= 1e-30, (name, key)


def test_the_blocks_are_the_same_in_both_units():
    assert loop() == hysteresis()
    wide = measured(
        (loop(INPUT, OUTPUT),),
        given=[replace(one, u=one.u * INPUT) for one in measured((loop(),))],
    )
    for one, other in zip(measured((loop(),)), wide, strict=True):
        assert (other.y / OUTPUT).tolist() == pytest.approx(one.y.tolist(), rel=1e-12)


LAG, LOOP = block("sensor-lag", time_constant_s=0.01), hysteresis()
GAIN = gain()
FILTER = block("transfer-function", numerator=[12.0], denominator=[0.01, 1.0])


@pytest.mark.parametrize(
    ("chain", "place", "unit"),
    [
        ((GAIN,), 0, "1/A"),  # before the gain a square is of the current
        ((GAIN,), 1, "1/um"),
        ((GAIN, FILTER), 1, "1/um"),  # the gain has given the unit already
        ((FILTER, GAIN), 1, "1/A"),
        ((FILTER, GAIN), 2, "1/um"),
        ((FILTER, FILTER), 1, "1/A"),
        ((FILTER, FILTER), 2, "1/um"),
        ((LAG, LOOP), 1, "1/A"),
        ((LAG, LOOP), 2, "1/um"),
        ((LAG,), 1, "1/um"),
    ],
)
def test_a_number_has_the_unit_of_the_signal_at_its_place(chain, place, unit):
    start = state_of(chain)
    variant = Variant(
        effect="asymmetry",
        place="material",
        form="square",
        start=place,
        build=lambda given: (block("asymmetry", **given), *chain[place:]),
        positions=(0,),
        unit={"coefficient": 1e-3},
        free=("coefficient",),
    )
    state = with_effect(start, variant, {"coefficient": 0.1})
    (item,) = state.added
    told = effect_mapping(
        item, state, np.zeros(1), (), (), Leftover(1.0, 0.0, 1.0, 0.0)
    )
    assert told["parameters"]["coefficient"]["unit"] == unit


def test_what_stands_for_the_whole_base_has_the_outputs_unit():
    start = state_of((FILTER,))
    hard = {"frequency_hz": 60.0, "damping_ratio": 0.05, "participation": 1.0}
    variant = Variant(
        effect="stiffness-hardening",
        place="mechanics",
        form="",
        start=0,
        build=lambda given: (FILTER, block("stiffness-hardening", **given, **hard)),
        positions=(0, 1),
        replaces=True,
        unit={"coefficient": 1e-3},
        free=("coefficient",),
    )
    state = with_effect(start, variant, {"coefficient": 0.1})
    assert unit_behind(1, state) == "um"


def test_behind_a_mechanism_everything_has_the_outputs_unit():
    mass = block("mechanism", mass=1.0, damping=1.0, stiffness=1.0)
    state = state_of((mass, block("stiffness", quadratic=0.0, cubic=1.0), GAIN))
    assert [unit_behind(k, state) for k in range(3)] == ["um"] * 3


MASS = {"mass": 1.0, "damping": 1.0, "stiffness": 1.0}
DRY = ("friction-force", {"coulomb": 1.0, "presliding_distance": 1.0})


@pytest.mark.parametrize(
    ("host", "channels", "number", "unit"),
    [
        (("mechanism", MASS), ("N", "mm"), "coulomb", "N"),
        (("mechanism", MASS), ("N", "mm"), "presliding_distance", "mm"),
        (("mechanism", MASS), ("N", "mm"), "stribeck_velocity", "mm/s"),
        (
            ("mechanism", MASS | {"output": "acceleration"}),
            ("N", "m/s^2"),
            "stribeck_velocity",
            "m/s",
        ),
        (
            ("mechanism", MASS | {"output": "acceleration"}),
            ("N", "m/s^2"),
            "presliding_distance",
            "m",
        ),
        (
            ("mechanism", MASS | {"output": "velocity"}),
            ("V", "V"),
            "presliding_distance",
            "V s",
        ),
        # With 12 N/A this is a newton, and no ampere.
        (("mechanism", MASS | {"gain": 12.0}), ("A", "mm"), "coulomb", "gain*A"),
        (("mechanism", MASS | {"gain": 1.05}), ("N", "mm"), "coulomb", "N"),
        (("impedance", MASS), ("mm", "N"), "coulomb", "N"),
        (("impedance", MASS), ("mm", "N"), "presliding_distance", "mm"),
        (
            ("impedance", MASS | {"input": "velocity"}),
            ("m/s", "kN"),
            "presliding_distance",
            "m",
        ),
    ],
)
def test_a_force_inside_has_units_of_force_and_of_its_coordinate(
    host, channels, number, unit
):
    (name, given), (law, own) = host, DRY
    chain = (block(name, **given), block(law, **own))
    about = chain[1].parameters()[number]
    assert unit_at(about.unit, chain, 1, *channels) == unit


def test_numbers_of_a_host_are_in_units_of_its_coordinate():
    velocity = block("mechanism", **MASS, output="velocity")
    stiffness = velocity.parameters()["stiffness"].unit
    assert unit_at(stiffness, (velocity,), 0, "V", "V") == "V/(V s)"
    driven = block("mechanism", **MASS, gain=12.0)
    assert unit_at(stiffness, (driven,), 0, "A", "mm") == "gain*A/mm"
    impedance = block("impedance", **MASS)
    stiffness = impedance.parameters()["stiffness"].unit
    assert unit_at(stiffness, (impedance,), 0, "mm", "N") == "N/mm"

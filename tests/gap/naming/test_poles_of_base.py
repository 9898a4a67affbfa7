"""Poles of an identified base, judged again beside what was named."""

from dataclasses import replace

import numpy as np
import pytest

from hystbench.blocks.transfer_function import TransferFunction
from hystbench.gap.bases.orders import HIGHEST
from hystbench.gap.fitting.on_records import start_state
from hystbench.gap.fitting.state import Added, Free
from hystbench.gap.naming.add_effects import Named
from hystbench.gap.naming.poles_of_base import named_beside_them, with_poles_named
from hystbench.gap.naming.rounds import Round
from hystbench.model import Model
from tests.gap.made import CURRENT, DISPLACEMENT, record
from tests.gap.small import block, measured, state_of

DT = 1e-3
FILTER = block(
    "transfer-function", numerator=(3.0,), denominator=(0.01, 1.0), hold="linear"
)
GAIN = block("gain", value=1.0, offset=0.2)
BASE = Model("linear", CURRENT, DISPLACEMENT, (FILTER, GAIN))
CURVE = block("saturation", level=1.5)
LINEAR = {
    "creep": block("creep", magnitudes=(0.3,), time_constants_s=(0.2,), hold="linear"),
    "drive-lag": block("drive-lag", time_constant_s=0.004, hold="linear"),
    "sensor-lag": block("sensor-lag", time_constant_s=0.004, hold="linear"),
    "resonance": block(
        "resonance",
        frequency_hz=40.0,
        damping_ratio=0.05,
        participation=0.4,
        hold="linear",
    ),
}


@pytest.fixture(scope="module")
def records():
    u = np.cumsum(np.random.default_rng(0).standard_normal(1500)) / 20
    return (record(u, name="a", dt=DT),)


def named(records, *effects):
    """Give the base with effects behind it, in their order."""
    blocks = [x for _, x in effects]
    chain = (FILTER, *blocks, GAIN)
    added = tuple(
        Added(name, "", "", (1 + k,), {}, 1.0) for k, (name, _) in enumerate(effects)
    )
    return state_of(chain, records, hold="linear", added=added)


@pytest.mark.parametrize("name", LINEAR)
def test_a_linear_effect_beside_a_curve_may_be_the_base_s_own(records, name):
    state = named(records, (name, LINEAR[name]), ("saturation", CURVE))
    base = with_poles_named(BASE, state)
    ratio, gain = base.chain
    assert isinstance(ratio, TransferFunction)
    assert gain == GAIN
    (u,) = (item.u for item in records)
    # One after the other, with what passes between two samples as it is.
    fine = np.interp(np.arange(0, 1499, 0.02), np.arange(1500), u)
    behind = FILTER.simulate(fine, fine, DT / 50)
    expected = LINEAR[name].simulate(behind, behind, DT / 50)[::50]
    found = ratio.simulate(u, u, DT)[: len(expected)]
    assert found == pytest.approx(expected, abs=1e-3 * np.ptp(expected))


@pytest.mark.parametrize(
    "effects",
    [
        [("saturation", CURVE)],
        [("creep", LINEAR["creep"])],
        [
            ("eddy-diffusion", block("eddy-diffusion", time_constant_s=0.01)),
            ("saturation", CURVE),
        ],
    ],
    ids=["no linear one", "nothing else", "many poles"],
)
def test_the_base_stays_where_that_says_nothing(records, effects):
    assert with_poles_named(BASE, named(records, *effects)) is None


def test_a_lag_has_no_zero_that_is_rounding(records):
    state = named(records, ("drive-lag", LINEAR["drive-lag"]), ("saturation", CURVE))
    ratio, _ = with_poles_named(BASE, state).chain
    assert len(ratio.numerator) == 1
    assert len(ratio.denominator) == 3


def test_apart_from_the_ratio_a_block_stays_with_the_numbers_that_were_free(records):
    """A ratio there would have a gain, beside which the curve's level is unknown."""
    state = named(records, ("saturation", CURVE), ("creep", LINEAR["creep"]))
    state = replace(state, free=(Free(2, "time_constants_s", 0),))
    base = with_poles_named(BASE, state)
    assert base.chain == (FILTER, LINEAR["creep"], GAIN)
    assert "creep.time_constants_s" in base.free
    assert "creep.magnitudes" not in base.free
    assert {"transfer-function.numerator", "gain.value"} <= set(base.free)


def test_of_many_poles_the_denominator_is_held_as_in_an_identified_base(records):
    """A step of one coefficient alone may make such a model unstable."""
    many = block(
        "transfer-function",
        numerator=(3.0,),
        denominator=tuple(np.poly(-np.arange(1.0, HIGHEST + 1)).tolist()),
        hold="linear",
    )
    base = replace(BASE, chain=(many, GAIN))
    state = named(records, ("creep", LINEAR["creep"]), ("saturation", CURVE))
    state = replace(state, chain=(many, *state.chain[1:]))
    found = with_poles_named(base, state)
    assert len(found.chain[0].denominator) == HIGHEST + 2
    assert "transfer-function.numerator" in found.free
    assert "transfer-function.denominator" not in found.free


def test_what_is_named_beside_them_is_the_rest_and_leaves_as_little(records):
    """A record of a curve between a filter and creep: only the curve was missing."""
    hidden = (FILTER, CURVE, LINEAR["creep"], GAIN)
    given = measured(hidden, noise=0.01, given=records)
    free = (
        Free(0, "numerator", 0),
        Free(0, "denominator", 0),
        Free(2, "magnitudes", 0),
        Free(2, "time_constants_s", 0),
        Free(1, "level"),
    )
    state = named(given, ("saturation", CURVE), ("creep", LINEAR["creep"]))
    state = replace(state, free=free, chain=hidden).settled()
    base = with_poles_named(BASE, state)
    start, floor = start_state(given, base, "linear", 0.01)
    one = Round(start, 0.0, (), True)
    found = named_beside_them(Named(state, (one, one)), start, floor, print)
    assert [item.effect for item in found.state.added] == ["saturation"]
    assert [item.name for item in found.taken_out] == ["creep"]
    assert found.state.power(1e-4) < 0.1 * 1e-4

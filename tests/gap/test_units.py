"""Metres for micrometres, milliamperes for amperes: nothing else moves."""

from dataclasses import replace

import pytest

from hystbench.blocks import registry
from hystbench.gap.rank import make_score, rank
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
        ranking = rank(state, make_score(state, noise))
        found.append({item.effect: item for item in ranking})
    before, after = found
    assert list(after) == list(before)
    for name, one in before.items():
        other = after[name]
        assert other.gain == pytest.approx(one.gain, abs=0.01, nan_ok=True), name
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

"""What a base leaves free, and how far."""

import numpy as np
import pytest

from hystbench.gap.fitting.on_records import free_numbers, start_state
from hystbench.gap.fitting.refit import refit
from hystbench.model import Model
from tests.gap.made import CURRENT, DISPLACEMENT
from tests.gap.searched import among, search
from tests.gap.small import GPI, block, hysteresis, measured, plain_score

NOISE = 0.02


def base(chain, **tolerances):
    names = {key.replace("__", "."): value for key, value in tolerances.items()}
    given = {key: value for key, value in names.items() if value is not None}
    return Model(
        "base", CURRENT, DISPLACEMENT, chain, free=tuple(names), tolerances=given
    )


def test_a_tolerance_bounds_a_number_on_both_sides():
    model = base(
        (block("gain", value=-4.0, offset=0.0), hysteresis()),
        gain__value=0.1,
        gain__offset=0.1,
        gpi__weights=0.5,
    )
    gain, offset, *weights = free_numbers(model)
    assert (gain.low, gain.high) == pytest.approx((-4.4, -3.6))
    # Of a zero a share says nothing.
    assert (offset.tolerance, offset.low, offset.high) == (None, -np.inf, np.inf)
    for item, weight in zip(weights, GPI["weights"], strict=True):
        assert (item.low, item.high) == pytest.approx((0.5 * weight, 1.5 * weight))


@pytest.mark.parametrize("tolerance", [0.2, 0.05, 1e-4])
def test_a_refit_stays_within_the_tolerance_and_goes_as_far_as_it_may(tolerance):
    """Measured with 12; the base has 11 and may not go beyond its tolerance."""
    chain = (block("gain", value=11.0),)
    given = measured((block("gain", value=12.0),), NOISE)
    state, _ = start_state(given, base(chain, gain__value=tolerance), declared=NOISE)
    after, _ = refit(state, plain_score(state, NOISE**2))
    most = 11.0 * (1 + tolerance)
    assert after.chain[0].value <= most * (1 + 1e-12)
    assert after.chain[0].value == pytest.approx(min(most, 12.0), rel=2e-3)


def test_a_narrow_tolerance_leaves_the_tangent_what_it_is():
    """Of a gain it is the input, however little the gain may change."""
    chain = (block("gain", value=11.0),)
    given = measured((block("gain", value=12.0),), NOISE)
    for tolerance in (0.2, 1e-5):
        model = base(chain, gain__value=tolerance)
        state, _ = start_state(given, model, declared=NOISE)
        u = state.sample.take([item.u for item in given])
        np.testing.assert_allclose(state.tangents[:, 0], u, rtol=1e-6, atol=1e-8)


#: What a gain that is off may be taken for.
GAINS = among("calibration-error", "saturation", "asymmetry", "sensor-nonlinearity")


def test_a_gap_beyond_the_tolerance_is_not_put_down_to_parameters():
    chain = (block("gain", value=11.0),)
    given = measured((block("gain", value=12.0),), NOISE)
    for tolerance, word in ((0.2, "parameters"), (0.01, None)):
        model = base(chain, gain__value=tolerance)
        content = search("made", given, model, declared=NOISE, vocabulary=GAINS).content
        after = content["base_parameters"]["gain.value"]["after"]
        assert after <= 11.0 * (1 + tolerance) * (1 + 1e-12)
        assert (content["verdict"] == "parameters") == (word is not None)


def test_what_moves_the_output_by_rounding_alone_moves_nothing():
    """An offset of a millionth beside 1e11 changes a last digit here and there."""
    chain = (block("gain", value=1e12, offset=0.0),)
    given = measured((block("gain", value=1.2e12),))
    model = base(chain, gain__value=None, gain__offset=None)
    state, _ = start_state(given, model, declared=1.0)
    gain, offset = state.tangents.T
    assert np.sqrt(np.mean(gain**2)) > 0.1
    assert not offset.any()
    after, _ = refit(state, plain_score(state, 1.0))
    assert after.chain[0].value == pytest.approx(1.2e12)
    assert after.chain[0].offset == pytest.approx(0.0, abs=1e-6)

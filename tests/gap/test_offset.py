"""An offset of the output is no bias of the field, though that has an offset too."""

import pytest

from hystbench.gap.effects import effects
from hystbench.gap.naming.rank import make_score, rank
from tests.gap.small import block, measured, records, state_of

NOISE = 0.02


def ranked(chain, more=(), names=("calibration-error", "asymmetry")):
    """Rank some effects beside a base on what a chain gives, slightly disturbed."""
    given = measured(chain, NOISE, given=records() * 3)
    state = state_of(more, given)
    known = [effects()[name] for name in names]
    return rank(state, make_score(state, NOISE), known)


@pytest.mark.parametrize("bias", [0.0, 4e-3, 8e-3])
def test_an_offset_is_no_bias_of_the_field(bias):
    """A bias with the sensor's zero free has an offset and one number more.

    What it takes beyond an offset is a hundredth of the gap at most.
    """
    base = (block("prandtl-ishlinskii", thresholds=[0.0, 0.2, 0.4], weights=[4, 3, 2]),)
    field = (block("gain", value=1.0, offset=bias), *base)
    first, *_ = ranked((*field, block("calibration-error", gain=1.0, offset=0.3)), base)
    assert first.effect == "calibration-error"

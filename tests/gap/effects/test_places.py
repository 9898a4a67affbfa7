"""What comes to rest without overshoot, as a lag of heat does."""

import pytest

from hystbench.blocks.transfer_function import TransferFunction
from hystbench.gap.effects.places import only_lags
from hystbench.gap.simulation.simulation import Simulation
from tests.gap.small import block, records


@pytest.mark.parametrize(
    ("numerator", "denominator", "rests"),
    [
        ((-2.0,), (0.5, 1.0), True),
        # Four equal lags: their poles are hardly told as real.
        ((1.0,), (1.0, 4.0, 6.0, 4.0, 1.0), True),
        ((1.0, 1.5), (1.0, 3.0, 2.0), True),
        # A lead overshoots, a damper's force ends at zero, a mass swings or goes on.
        ((3.0, 1.0), (1.0, 1.0), False),
        ((1.0, 0.0), (1.0, 1.0), False),
        ((1.0,), (1.0, 0.2, 1.0), False),
        ((1.0,), (1.0, 1.0, 0.0), False),
    ],
)
def test_what_overshoots_or_goes_on_is_no_lag(numerator, denominator, rests):
    chain = (TransferFunction(numerator=numerator, denominator=denominator),)
    assert only_lags(Simulation((*chain, block("gain", value=2.0)), records())) == rests

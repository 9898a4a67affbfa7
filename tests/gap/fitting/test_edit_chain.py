"""Numbers that make another thing of an effect at an end of their range."""

import pytest

from hystbench.blocks.drive_lag import DriveLag
from hystbench.gap.fitting.edit_chain import at_end
from hystbench.gap.fitting.state import Added, Free, ModelState
from hystbench.gap.records.scored_samples import ScoredSamples
from tests.gap.made import record

GIVEN = (record([0.0, 1.0, 0.0, 1.0]),)


@pytest.mark.parametrize(
    ("refused", "low", "high"),
    [
        ("", False, False),
        ("lower", True, False),
        ("upper", False, True),
        ("either", True, True),
    ],
)
def test_a_number_is_refused_at_the_ends_that_its_effect_says(refused, low, high):
    def at(value):
        free = (Free(0, "time_constant_s", None, None, 1e-3, 10.0, refused),)
        added = (Added("drive-lag", "drive", "", (0,), {}, 1.0),)
        chain = (DriveLag(time_constant_s=value),)
        sample = ScoredSamples.of(GIVEN)
        return bool(at_end(ModelState(chain, GIVEN, sample, free, added)))

    assert (at(1e-3), at(0.1), at(10.0)) == (low, False, high)

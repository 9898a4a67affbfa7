"""Whether what was named may be the base's own, with other numbers."""

import pytest

from hystbench.gap.fitting.re_tuning_gain import repeats_the_base
from hystbench.gap.fitting.state import Added
from tests.gap.small import MODE, block, hysteresis, state_of

OSCILLATOR = block("mechanism", mass=1e-4, damping=1e-2, stiffness=30.0)
HARDENING = block("stiffness", quadratic=0.0, cubic=1.0)
DRAG = block("drag", coefficient=1e-5)
PLAY = block("backlash", half_width=0.1)
LATER = block("resonance", **{**MODE, "frequency_hz": 150.0})
NEAR = block("resonance", **{**MODE, "frequency_hz": 95.0})
MODES = (hysteresis(), block("resonance", **MODE))


@pytest.mark.parametrize(
    ("base", "added", "told"),
    [
        ((OSCILLATOR, HARDENING), HARDENING, True),
        ((OSCILLATOR, DRAG), HARDENING, False),
        ((OSCILLATOR,), HARDENING, False),
        ((PLAY,), PLAY, True),
        (MODES, NEAR, True),
        (MODES, LATER, False),
        (MODES, PLAY, False),
    ],
)
def test_a_kind_that_the_base_has_is_told(base, added, told):
    effect = Added("any", "inside", "", (len(base),), {}, 1.0)
    state = state_of((*base, added), added=(effect,))
    assert repeats_the_base(state) is told

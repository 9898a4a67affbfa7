"""What leaves more of the fit records than the base is not shown as found."""

import numpy as np

from hystbench.gap import judge_and_tell as module
from hystbench.gap.naming.add_effects import Named
from hystbench.gap.naming.rounds import Round
from hystbench.gap.records.floor import Floor
from tests.gap.small import block, measured, records, state_of

FLOOR = Floor(1e-3, "stated")


def test_a_re_tuning_that_leaves_more_of_the_fit_records_is_dropped():
    given = measured((block("gain", value=12.0),))
    base, near, far = (
        state_of((block("gain", value=value),), given) for value in (11.5, 12.1, 14.0)
    )
    said = []

    def kept(state, rounds):
        named = Named(state, rounds)
        return module._unless_worse(named, base, FLOOR, said.append).state

    rounds = (Round(far, 0.0, (), False),)
    assert kept(near, rounds) is near
    assert not said
    assert kept(far, rounds) is base
    assert kept(far, ()) is base
    assert "leaves more of the fit records" in said[0]


def test_as_much_as_the_base_leaves_may_stay():
    """By less than a hundredth two models are equally good."""
    given = measured((block("gain", value=12.0),), 0.5, given=records())
    base = state_of((block("gain", value=12.0),), given)
    near = state_of((block("gain", value=12.01),), given)
    assert np.mean(near.residual**2) != np.mean(base.residual**2)
    named = Named(near, ())
    assert module._unless_worse(named, base, FLOOR, print) is named

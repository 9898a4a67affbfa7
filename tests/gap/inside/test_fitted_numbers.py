"""What known numbers of a base pay that were fitted all the same."""

from dataclasses import replace

import numpy as np
import pytest

from hystbench.blocks.mechanism import Mechanism
from hystbench.gap.fitting.least_squares import Fitted
from hystbench.gap.fitting.state import Added, Free, ModelState
from hystbench.gap.inside.fitted_numbers import more_for_numbers
from hystbench.gap.inside.host import Host
from hystbench.gap.records.scored_samples import ScoredSamples
from hystbench.gap.thresholds import CERTAIN, FURTHER
from tests.gap.made import record

GIVEN = (record(np.sin(0.1 * np.arange(200))),)
ALONE = Mechanism(mass=1.0, damping=0.5, stiffness=40.0)


def state_with(stiffness, effects, stated=True):
    about = {"tolerance": 4.0, "given": 40.0} if stated else {}
    added = tuple(Added(x, "inside", "", (), {}, 1.0) for x in effects)
    chain = (replace(ALONE, stiffness=stiffness),)
    free = (Free(0, "stiffness", **about),)
    return ModelState(chain, GIVEN, ScoredSamples.of(GIVEN), free, added)


@pytest.mark.parametrize(
    ("stiffness", "effects", "total"),
    [
        (40.8, ["stop"], FURTHER),  # the numbers stand for one of the two
        (40.8, ["stop", "friction"], 0.0),
        (49.0, ["stop"], CERTAIN),
        (49.0, ["stop", "friction"], CERTAIN),
    ],
)
def test_they_pay_where_they_stand_for_an_effect_or_are_far_off(
    stiffness, effects, total
):
    """Two effects are named where the numbers stay as they are."""
    alone = state_with(40.0, [])
    host = Host(alone, Fitted(alone, 0.0), "", charge=FURTHER)
    state = state_with(stiffness, effects)
    assert host.charge + more_for_numbers(host, state, 2) == total


@pytest.mark.parametrize("charge", [0.0, FURTHER])
def test_numbers_that_are_free_or_not_stated_pay_as_their_host(charge):
    alone = state_with(40.0, [])
    host = Host(alone, Fitted(alone, 0.0), "", charge=charge)
    state = state_with(49.0, ["stop"], stated=charge == 0.0)
    assert more_for_numbers(host, state, 2) == 0.0

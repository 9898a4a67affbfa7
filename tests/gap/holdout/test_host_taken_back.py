"""A host that stands for a linear base goes with its forces, and the base comes back.

The device is a plain gain of 12. The identified base is nearly that; the host is worse,
and with the effect in it less bad.
"""

from dataclasses import replace

import numpy as np
import pytest

from hystbench.gap.bases.linear import IdentifiedModel, with_its_numbers_free
from hystbench.gap.fitting.on_records import compared_records
from hystbench.gap.fitting.state import Added
from hystbench.gap.holdout.withdraw import ToShow, show_on_hold_out
from hystbench.gap.naming.ladder import FitResult, Rung
from hystbench.gap.records.black_box import black_box
from hystbench.gap.records.evidence import Evidence
from hystbench.gap.records.floor import Floor
from hystbench.gap.vocabulary import Vocabulary
from hystbench.metrics import rms
from hystbench.model import Model
from tests.gap.made import CURRENT, DISPLACEMENT
from tests.gap.small import block, measured, state_of

FLOOR = Floor(0.01, "stated")


def a_gain(value):
    return (block("gain", value=value),)


@pytest.fixture(scope="module")
def evidence():
    fit = measured(a_gain(12.0), 0.01)
    held = tuple(replace(x, use="hold-out") for x in measured(a_gain(12.0), 0.01, 1))
    return Evidence("rig", fit, held)


def shown(evidence, of_host, of_forces):
    """Show a host in place of a base of 11.5, alone and with an effect in it."""
    first = IdentifiedModel("linear", CURRENT, DISPLACEMENT, a_gain(11.5))
    host = Model("linear", CURRENT, DISPLACEMENT, a_gain(of_host))
    alone = state_of(a_gain(of_host), evidence.fit)
    effect = Added("friction", "inside", "", (), {}, 1.0)
    state = replace(alone, chain=a_gain(of_forces), added=(effect,)).settled()
    rungs = (Rung("base", alone), Rung("friction", state))
    box = black_box(compared_records(alone), FLOOR.rms)
    content = {
        "unit": "um",
        "verdict": "named",
        "reason": "so it is",
        "effects": [{"name": "friction", "confidence": 0.9}],
        "base_parameters": {"gain.value": {"before": of_host, "after": of_host}},
        "fit": {"before": 1.0, "after": 0.5, "explained": 0.75},
        "black_box": {"explained_on_folds": None},
    }
    told = ToShow(
        first=with_its_numbers_free(first),
        fitted=FitResult(host, state, FLOOR, box, rungs),
        content=content,
        vocabulary=Vocabulary.of(),
        put_in=None,
    )
    return show_on_hold_out(told, evidence)


def left_by(evidence, value):
    return rms(np.concatenate([x.y - value * x.u for x in evidence.hold_out]))


def test_forces_that_are_worse_than_the_linear_base_go_with_their_host(evidence):
    found = shown(evidence, 9.0, 10.0)
    taken = found.content["withdrawn"]
    assert taken["names"] == ["friction"]
    assert taken["before"] == pytest.approx(left_by(evidence, 11.5), rel=0.01)
    assert taken["after"] == pytest.approx(left_by(evidence, 10.0), rel=0.01)
    # What is written is the base that was identified, with its figures.
    assert found.content["gap"]["before"] == taken["before"]
    assert found.model.chain == a_gain(11.5)
    numbers = found.content["base_parameters"]
    assert numbers["gain.value"] == {"before": 11.5, "after": 11.5}


def test_forces_that_are_better_than_both_stay(evidence):
    found = shown(evidence, 9.0, 11.9)
    assert found.content["withdrawn"] is None
    assert "the linear base leaves" in found.content["reason"]
    assert found.model.chain == a_gain(11.9)

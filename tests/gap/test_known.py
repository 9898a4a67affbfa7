"""A further effect stays only where the records know a number of it."""

import numpy as np
import pytest

from hystbench.gap import known
from hystbench.gap.change import with_effect
from hystbench.gap.effects import effects
from hystbench.gap.known import without_unknown
from hystbench.gap.say import silent
from tests.gap.small import block, measured, state_of

NOISE = 0.02
LAG_S, BEND = 0.004, 0.2


def with_two(bend):
    """A lag of the drive and a curve of the material added to a gain.

    The records hold the lag, and the curve only where it bends.
    """
    gain = block("gain", value=12.0)
    plant = [
        block("asymmetry", coefficient=bend),
        block("drive-lag", time_constant_s=LAG_S),
        gain,
    ]
    state = state_of((gain,), measured(plant, NOISE))
    values = {
        "drive-lag": {"time_constant_s": LAG_S},
        "asymmetry": {"coefficient": bend},
    }
    for name, own in values.items():
        variant = next(iter(effects()[name].variants(state.scene)))
        state = with_effect(state, variant, own)
    return state.settled()


def names(state):
    return [item.effect for item in state.added]


def test_a_curve_that_is_there_stays_and_one_that_is_not_goes():
    bent = with_two(BEND)
    assert without_unknown(bent, NOISE, silent) is bent
    said = []
    short = without_unknown(with_two(0.0), NOISE, said.append)
    assert names(short) == ["drive-lag"]
    assert [block.name for block in short.chain] == ["drive-lag", "gain"]
    assert said == ["asymmetry goes: each of its numbers is smaller than its error"]


@pytest.mark.parametrize(
    ("errors", "kept"),
    [
        ((9.0, 9.0), ["drive-lag"]),  # the first effect stays in any case
        ((9.0, np.nan), ["drive-lag"]),  # of which the records show nothing
        ((9.0, 0.9 * BEND), ["drive-lag", "asymmetry"]),
    ],
)
def test_an_error_larger_than_the_number_decides(errors, kept, monkeypatch):
    state = with_two(BEND)
    order = [free.block for free in state.free]
    at = dict(zip([item.blocks[0] for item in state.added], errors, strict=True))
    monkeypatch.setattr(
        known, "standard_errors", lambda *given: np.array([at[k] for k in order])
    )
    assert names(without_unknown(state, NOISE, silent)) == kept


def test_one_effect_alone_is_not_looked_at(monkeypatch):
    monkeypatch.delattr(known, "standard_errors")
    gain = block("gain", value=12.0)
    state = state_of((gain,), measured((gain,), NOISE))
    variant = next(iter(effects()["asymmetry"].variants(state.scene)))
    state = with_effect(state, variant, {"coefficient": 0.0})
    assert without_unknown(state, NOISE, silent) is state

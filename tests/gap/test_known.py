"""A further effect stays only where the records know its size."""

import numpy as np
import pytest

from hystbench.gap import known
from hystbench.gap.change import with_effect
from hystbench.gap.effects import effects
from hystbench.gap.fit import refit
from hystbench.gap.known import without_unknown
from hystbench.gap.rank import make_score
from hystbench.gap.say import silent
from hystbench.gap.uncertainty import (
    error_of_size,
    on_more_samples,
    standard_errors,
)
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
    (line,) = said
    assert line.startswith("asymmetry goes: the standard error of its size is")


@pytest.mark.parametrize(
    ("error", "kept"),
    [
        (0.4, ["drive-lag", "asymmetry"]),
        (0.6, ["drive-lag"]),  # the first effect is not asked
        (np.inf, ["drive-lag"]),
    ],
)
def test_an_error_of_more_than_half_the_size_decides(error, kept, monkeypatch):
    monkeypatch.setattr(known, "error_of_size", lambda *given: error)
    assert names(without_unknown(with_two(BEND), NOISE, silent)) == kept


def test_numbers_that_stand_in_for_each_other_do_not_hide_a_size():
    """Of creep's three elements none is known alone, and their sum well."""
    gain = block("gain", value=12.0)
    given = {"magnitudes": [0.02] * 3, "time_constants_s": [0.3, 0.33, 0.36]}
    # a lag first, which the records know as well
    lag = block("drive-lag", time_constant_s=LAG_S)
    state = state_of((gain,), measured((lag, gain, block("creep", **given)), NOISE))
    one = next(iter(effects()["drive-lag"].variants(state.scene)))
    state = with_effect(state, one, {"time_constant_s": LAG_S})
    offered = effects()["creep"].variants(state.scene)
    three = next(item for item in offered if item.form == "three elements")
    values = {f"magnitude {k}": 0.02 for k in (1, 2, 3)} | {"time_constant_s": 0.1}
    state = with_effect(state, three, values).settled()
    state, _ = refit(state, make_score(state, NOISE))
    finer = on_more_samples(state)
    score = make_score(finer, NOISE, forms=False)
    errors = standard_errors(finer, score)
    own = [
        k for k, free in enumerate(finer.free) if free.block in finer.added[1].blocks
    ]
    alone = [abs(finer.value(finer.free[k])) / errors[k] for k in own]
    assert np.nanmin(alone) < 1.0
    assert error_of_size(finer, score, 1) < 0.2
    assert without_unknown(state, NOISE, silent) is state


def test_one_effect_alone_is_not_looked_at(monkeypatch):
    monkeypatch.delattr(known, "error_of_size")
    gain = block("gain", value=12.0)
    state = state_of((gain,), measured((gain,), NOISE))
    variant = next(iter(effects()["asymmetry"].variants(state.scene)))
    state = with_effect(state, variant, {"coefficient": 0.0})
    assert without_unknown(state, NOISE, silent) is state

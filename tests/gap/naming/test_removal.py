"""Effects go out again that are needless, or whose size the records do not know."""

from dataclasses import replace

import numpy as np
import pytest

from hystbench.gap.effects import effects
from hystbench.gap.fitting.edit_chain import with_effect, without_effect
from hystbench.gap.fitting.model_score import make_score
from hystbench.gap.fitting.refit import refit
from hystbench.gap.fitting.uncertainty import (
    on_more_samples,
    size_error,
    standard_errors,
)
from hystbench.gap.naming import removal
from hystbench.gap.naming.add_effects import LITTLE, Named
from hystbench.gap.naming.removal import TakenOut, needless, unknown, without_what_goes
from hystbench.gap.naming.rounds import Round
from hystbench.gap.progress import silent
from hystbench.gap.records.floor import Floor
from hystbench.gap.thresholds import CERTAIN, FURTHER, LOOSE, PAYS, SHAPE
from tests.gap.small import block, hysteresis, measured, state_of

NOISE = 0.02
FLOOR = Floor(NOISE, "declared")
LAG_S, BEND = 0.004, 0.2


def with_two(bend, given=None):
    """A lag of the drive and a curve of the material added to a gain.

    The records hold the lag, and the curve only where it bends; the model has the curve
    with the bend given, or as it is.
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
        "asymmetry": {"coefficient": bend if given is None else given},
    }
    for name, own in values.items():
        variant = next(iter(effects()[name].variants(state.simulation)))
        state = with_effect(state, variant, own)
    return state.settled()


def names(state):
    return [item.effect for item in state.added]


def test_a_curve_that_is_there_stays_and_one_that_is_not_goes():
    assert unknown(with_two(BEND), FLOOR) is None
    gone, short = unknown(with_two(0.0), FLOOR)
    assert gone == TakenOut("asymmetry", "the records show nothing of it")
    assert names(short) == ["drive-lag"]
    assert [block.name for block in short.chain] == ["drive-lag", "gain"]


@pytest.mark.parametrize(
    ("error", "on_folds", "kept"),
    [
        (0.4, 0.0, ["drive-lag", "asymmetry"]),
        (0.6, CERTAIN - 1, ["drive-lag"]),  # the first effect is not asked
        (np.inf, 0.0, ["drive-lag"]),
        (np.nan, 0.0, ["drive-lag"]),
        (0.6, CERTAIN + 1, ["drive-lag", "asymmetry"]),
    ],
)
def test_an_error_of_more_than_half_the_size_decides(
    error, on_folds, kept, monkeypatch
):
    """Unless records that did not fit the effect are foretold beyond doubt."""
    monkeypatch.setattr(removal, "size_error", lambda *given: error)
    monkeypatch.setattr(removal, "gain_on_folds", lambda *given: on_folds)
    found = unknown(with_two(BEND), FLOOR)
    assert names(with_two(BEND) if found is None else found[1]) == kept


def test_numbers_that_stand_in_for_each_other_do_not_hide_a_size():
    """Of creep's three elements none is known alone, and their sum well."""
    gain = block("gain", value=12.0)
    given = {"magnitudes": [0.02] * 3, "time_constants_s": [0.3, 0.33, 0.36]}
    # a lag first, which the records know as well
    lag = block("drive-lag", time_constant_s=LAG_S)
    state = state_of((gain,), measured((lag, gain, block("creep", **given)), NOISE))
    one = next(iter(effects()["drive-lag"].variants(state.simulation)))
    state = with_effect(state, one, {"time_constant_s": LAG_S})
    offered = effects()["creep"].variants(state.simulation)
    three = next(item for item in offered if item.form == "three elements")
    values = {f"magnitude {k}": 0.02 for k in (1, 2, 3)} | {"time_constant_s": 0.1}
    state = with_effect(state, three, values).settled()
    state, _ = refit(state, make_score(state, FLOOR))
    finer = on_more_samples(state)
    score = make_score(finer, FLOOR, forms=False)
    errors = standard_errors(finer, score)
    own = [
        k for k, free in enumerate(finer.free) if free.block in finer.added[1].blocks
    ]
    alone = [abs(finer.value(finer.free[k])) / errors[k] for k in own]
    assert np.nanmin(alone) < 1.0
    assert size_error(finer, NOISE**2, 1) < 0.2
    assert unknown(state, FLOOR) is None


def test_one_effect_alone_is_not_looked_at():
    gain = block("gain", value=12.0)
    state = state_of((gain,), measured((gain,), NOISE))
    variant = next(iter(effects()["asymmetry"].variants(state.simulation)))
    state = with_effect(state, variant, {"coefficient": 0.0})
    assert without_what_goes(state, FLOOR, 1.0, silent) == (state, ())


@pytest.mark.parametrize("given", [BEND, 0.1 * BEND])
def test_an_effect_is_not_needless_for_numbers_found_under_another_score(given):
    """It is refitted as the model without it is, before the two are compared."""
    assert needless(with_two(BEND, given), FLOOR, 1.0) is None


@pytest.mark.parametrize(
    ("effect", "gain", "share", "goes"),
    [
        (SHAPE, PAYS + 1, 2 * LOOSE, False),
        (SHAPE, PAYS + 1, LOOSE / 2, True),
        (SHAPE, PAYS - 1, 2 * LOOSE, True),
        (SHAPE, FURTHER + 1, LOOSE / 2, False),
        ("asymmetry", PAYS + 1, 2 * LOOSE, True),
    ],
)
def test_a_wrong_shape_stays_by_the_rule_by_which_it_came(
    effect, gain, share, goes, monkeypatch
):
    """It is charged for all its directions, so that its gain is small for its size."""
    state = with_two(BEND)
    lag, curve = state.added
    state = replace(state, added=(lag, curve._replace(effect=effect)))
    small = without_effect(state, 1)
    gap = small.power(NOISE**2) - state.power(NOISE**2)

    def fitted(one, score):
        if names(one) == ["drive-lag"]:
            return one, gain
        return one, 0.0 if "drive-lag" in names(one) else 10 * FURTHER

    monkeypatch.setattr(removal, "finished", fitted)
    monkeypatch.setattr(removal, "score_of", lambda one, score: 0.0)
    found = needless(state, FLOOR, gap / share)
    assert (found is not None) == goes
    if found is not None:
        assert found[0].name == effect


def test_what_went_is_told_with_the_reason():
    """The lag gains much, the curve of no size nothing: it is needless before all."""
    said = []
    state, gone = without_what_goes(with_two(0.0), FLOOR, 1.0, said.append)
    assert names(state) == ["drive-lag"]
    (curve,) = gone
    assert curve.name == "asymmetry"
    assert curve.reason.startswith("needless beside the others")
    assert said == [f"asymmetry goes: {curve.reason}"]
    all_of_it = Named(state, (Round(state, 0.0, (), True),), gone).with_none_named()
    assert all_of_it.taken_out == (curve, TakenOut("drive-lag", LITTLE))


def test_what_a_wrong_shape_could_do_as_well_has_a_size_all_the_same():
    """A gain lies among the directions of reshaping, and every record shows it."""
    chain = (hysteresis(),)
    lag, gain = (
        block("drive-lag", time_constant_s=LAG_S),
        block("calibration-error", gain=1.1, offset=0.0),
    )
    state = state_of(chain, measured((lag, *chain, gain), NOISE))
    for name, values in (
        ("drive-lag", {"time_constant_s": LAG_S}),
        ("calibration-error", {"gain": 0.1}),  # beside one
    ):
        offered = effects()[name].variants(state.simulation)
        variant = next(
            item for item in offered if set(values) == {*item.grids, *item.unit}
        )
        state = with_effect(state, variant, values).settled()
    finer = on_more_samples(state)
    score = make_score(finer, FLOOR, forms=False)
    added = without_effect(finer, 1).settled().residual - finer.residual
    inside = score.directions @ (score.directions.T @ added)
    assert np.std(added - inside) < 0.1 * np.std(added)
    assert size_error(finer, NOISE**2, 1) < 0.1
    assert unknown(state, FLOOR) is None

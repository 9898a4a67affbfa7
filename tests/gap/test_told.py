"""What is told of the numbers of effects and of the base."""

from dataclasses import replace

import numpy as np
import pytest
import yaml

from hystbench.gap.augmented import augmented
from hystbench.gap.change import with_effect
from hystbench.gap.effects import effects
from hystbench.gap.name import Named
from hystbench.gap.rank import Candidate, Round
from hystbench.gap.schema import RANK
from hystbench.gap.start import start_state
from hystbench.gap.told import base_parameters, effect_mapping, ranking_rows
from hystbench.gap.verdict import Left
from hystbench.model import Model, load_model
from hystbench.schema import check_against_schema
from tests.gap.made import CURRENT, DISPLACEMENT
from tests.gap.small import MODE, block, hysteresis, measured

NOISE = 0.02
LEFT = Left(100.0, 1.0, 100.0, 1.0)


def started(chain, *free):
    base = Model("base", CURRENT, DISPLACEMENT, tuple(chain), free=free)
    state, _ = start_state(measured(chain, NOISE), base, declared=NOISE)
    return base, state


def with_named(state, effect, form="", **values):
    variants = effects()[effect].variants(state.scene)
    return with_effect(state, next(v for v in variants if v.form == form), values)


def told_of(state, number=0):
    errors = np.arange(1.0, 1 + len(state.free))
    item = state.added[number]
    return effect_mapping(item, state, errors, (), (), LEFT)["parameters"]


def test_a_free_number_of_a_block_that_an_effect_stands_for_is_none_afterwards():
    chain = (block("gain", value=12.0), block("resonance", **MODE))
    free = ("resonance.frequency_hz", "gain.value")
    base, state = started(chain, *free)
    after = with_named(state, "stiffness-hardening", coefficient=1e-3)
    assert base_parameters(base, after) == {
        "resonance.frequency_hz": {"before": MODE["frequency_hz"], "after": None},
        "gain.value": {"before": 12.0, "after": 12.0},
    }
    assert told_of(after)["coefficient"]["value"] == 1e-3


def test_free_numbers_are_found_again_between_the_blocks_of_effects():
    chain = (hysteresis(), block("gain", value=2.0), block("gain", value=3.0))
    names = ("gain#2.value", "gpi.weights", "gain.value")
    base, state = started(chain, *names)
    after = with_named(state, "drive-lag", time_constant_s=1e-3)
    after = with_named(after, "sensor-lag", time_constant_s=1e-3)
    # The free numbers are in the order of the base's list, the blocks in the chain's.
    after = after.with_chain(after.moved({0: 0.5, 2: 0.25}))
    found = base_parameters(base, after)
    assert {key: item["after"] for key, item in found.items()} == {
        "gain#2.value": 3.5,
        "gpi.weights": [0.9, 0.65, 0.3, 0.2],
        "gain.value": 2.0,
    }


def test_an_effect_whose_block_another_took_is_told_without_numbers():
    """The mode was an effect; the hardening spring then has its numbers."""
    base, state = started((block("gain", value=12.0),), "gain.value")
    after = with_named(state, "resonance", **MODE)
    after = with_named(after, "stiffness-hardening", coefficient=1e-3)
    assert told_of(after, 0) == {}
    assert told_of(after, 1)["frequency_hz"]["value"] == MODE["frequency_hz"]
    assert base_parameters(base, after) == {
        "gain.value": {"before": 12.0, "after": 12.0}
    }


def test_the_ranking_gives_every_round_and_keeps_its_order():
    _, state = started((block("gain", value=12.0),))
    lag = Candidate("drive-lag", "drive", "", -90.0, 80.0, state, held_back=55.0)
    creep = Candidate("creep", "mechanics", "two", -60.0, 50.0, state)
    none = Candidate("friction", "mechanics", declined="too short")
    then = replace(creep, score=-95.0, gain=5.0)
    rounds = (
        Round(state, -10.0, (lag, creep, none), True),
        Round(state, -90.0, (then, none), False),
    )
    rows = ranking_rows(Named(state, rounds))
    shown = [(row["round"], row["name"], row["held_back"]) for row in rows]
    assert shown == [
        (1, "drive-lag", 55.0),
        (1, "creep", None),
        (1, "friction", None),
        (2, "creep", None),
        (2, "friction", None),
    ]
    assert [row.get("gain") for row in rows] == [80.0, 50.0, None, 5.0, None]
    for row in rows:
        check_against_schema(row, RANK, "ranking")


def test_a_field_bias_is_told_as_one_and_its_model_runs(tmp_path):
    base, state = started((hysteresis(),))
    after = with_named(state, "asymmetry", "bias", bias=0.1, zero=-1.5)
    found = told_of(after)
    assert set(found) == {"bias", "zero"}
    assert found["bias"] == {"value": 0.1, "standard_error": 1.0, "unit": "A"}
    assert found["zero"] == {"value": -1.5, "standard_error": 2.0, "unit": "um"}
    augmented(base, after).save(tmp_path / "model.yaml")
    chain = yaml.safe_load((tmp_path / "model.yaml").read_text())["chain"]
    assert [next(iter(item)) for item in chain] == ["gain", "gpi", "gain"]
    u = np.linspace(-1, 1, 200)
    shifted = base.simulate(u + 0.1, 1e-3) - 1.5
    model = load_model(tmp_path / "model.yaml")
    assert model.simulate(u, 1e-3) == pytest.approx(shifted, abs=1e-9)

"""What is told of the numbers of effects and of the base."""

import json
import math
from dataclasses import replace

import numpy as np
import pytest
import yaml
from hypothesis import given, settings
from hypothesis import strategies as st

from hystbench.gap.effects import effects
from hystbench.gap.fitting.augmented_model import augmented
from hystbench.gap.fitting.edit_chain import with_effect
from hystbench.gap.fitting.on_records import start_state
from hystbench.gap.fitting.parameters import at_ends, base_parameters
from hystbench.gap.fitting.state import Added, Free
from hystbench.gap.judging.effect_rows import (
    effect_mapping,
    paths_no_surer,
    ranking_rows,
)
from hystbench.gap.judging.leftover import Leftover
from hystbench.gap.naming.add_effects import Named
from hystbench.gap.naming.rounds import Candidate, Round, SecondLook, in_order
from hystbench.gap.schema import RANK
from hystbench.model import Model, load_model
from hystbench.model_content import Provenance
from hystbench.schema import check_against_schema
from tests.gap.made import CURRENT, DISPLACEMENT
from tests.gap.searched import among, search
from tests.gap.small import MODE, block, hysteresis, measured, state_of

NOISE = 0.02
MODE_BLOCK = block("resonance", **MODE)
LEFT = Leftover(100.0, 1.0, 100.0, 1.0)


def started(chain, *free):
    base = Model("base", CURRENT, DISPLACEMENT, tuple(chain), free=free)
    state, _ = start_state(measured(chain, NOISE), base, declared=NOISE)
    return base, state


def with_named(state, effect, form="", **values):
    variants = effects()[effect].variants(state.simulation)
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
    after = after.moved({0: 0.5, 2: 0.25})
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
    lag = Candidate("drive-lag", "drive", "", -90.0, 80.0, state, gain_on_folds=55.0)
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
        assert (row["look"], row["instead_of"], row["beside"]) == (0, None, [])
    assert [row["taken"] for row in rows] == [True] + [False] * 4


def told_by_rows(content, effect):
    """Confidence and ties of an effect, from the numbers in gap.json and no other.

    The last ranking that has it taken counts, and what was refitted there: what was not
    may score better than folds let the others. A rival is e times less
    likely for every four of score (2 % are kept for what is not in the vocabulary), and
    what is left of the gap lowers all by its share. A tie is less than four
    apart. What scores better than a wrong shape that was added is needed beside it, and
    no rival.
    """
    rows = content["ranking"]
    *_, (number, look) = (
        (row["round"], row["look"])
        for row in rows
        if row["taken"] and row["name"] == effect
    )
    here = [row for row in rows if (row["round"], row["look"]) == (number, look)]
    scores = {row["name"]: row["score"] for row in here if row["refitted"]}
    own = scores.pop(effect)
    if effect == "hysteresis-shape" and look == 0:
        scores = {name: x for name, x in scores.items() if x >= own}
    odds = sum(math.exp(min((own - other) / 4, 100)) for other in scores.values())
    ties = [name for name, x in scores.items() if x < own + 4]
    explained = 1 - content["fit"]["left"]
    return 0.98 * explained / (1 + odds), ties


NAMES = ("drive-lag", "hysteresis-shape", "friction", "resonance", "backlash")


ANY = state_of((block("gain", value=1.0),))


@st.composite
def rankings(draw, sure):
    """A ranking, best first; the effect that is sure to be judged may be anywhere."""
    found = [Candidate("drift", "sensor", declined="too short")]
    for name in draw(st.permutations(NAMES)):
        kind = draw(st.sampled_from(["refitted", "grid", "declined"]))
        if name == sure or kind != "declined":
            state = ANY if name == sure or kind == "refitted" else None
            score = draw(st.floats(-50, 50))
            found.append(Candidate(name, "drive", "", score, 1.0, state))
    return tuple(in_order(found))


@st.composite
def histories(draw):
    """Rounds that take effects, each followed by second looks at any of them."""
    rounds, taken = [], []
    for k in range(draw(st.integers(1, 3))):
        ranking = draw(rankings(NAMES[k]))
        own = next(item for item in ranking if item.effect == NAMES[k])
        ranking = (own, *(item for item in ranking if item is not own))
        taken.append(NAMES[k])
        looks = []
        for place in draw(st.lists(st.sampled_from(taken), max_size=3)):
            again = draw(rankings(place))
            # A look that cannot judge leaves the effect to an earlier ranking.
            by = place if draw(st.booleans()) else None
            looks.append(SecondLook(place, (), again, by))
        rounds.append(Round(ANY, 0.0, ranking, True, tuple(looks)))
    return Named(ANY, tuple(rounds)), taken


@settings(max_examples=60)
@given(histories(), st.floats(0, 1))
def test_how_sure_a_name_is_follows_from_the_rows_of_the_ranking(history, loose):
    named, taken = history
    left = Leftover(100.0, 100.0 * loose, 100.0, 100.0)
    fit = {"left": left.share_left}
    content = through_a_file({"ranking": ranking_rows(named), "fit": fit})
    for effect in taken:
        item = Added(effect, "drive", "", (), {}, 1.0)
        ranking = named.reasons[effect]
        shown = effect_mapping(item, ANY, np.zeros(0), (), ranking, left)
        sure, ties = told_by_rows(content, effect)
        assert shown["confidence"] == pytest.approx(sure)
        assert shown["cannot_be_told_from"] == ties


def through_a_file(content):
    return json.loads(json.dumps(content, allow_nan=False))


def found_in(before, *behind):
    """What is found of blocks around a hysteresis, from the hysteresis alone."""
    chain = (hysteresis(),)
    records = measured((before, *chain, *behind), 0.05)
    base = Model("rig", CURRENT, DISPLACEMENT, chain)
    # So little may stay that the search goes on to the last of them.
    likely = among("drive-lag", "eddy-diffusion", "sensor-lag", "resonance")
    content = search(
        *("made", records, base),
        declared=0.05,
        unnamed_share=1e-4,
        vocabulary=likely,
    ).content
    return through_a_file(content)


@pytest.fixture(scope="module")
def found():
    """A lag before a hysteresis and a mode behind it."""
    return found_in(block("drive-lag", time_constant_s=0.004), MODE_BLOCK)


@pytest.fixture(scope="module")
def swapped():
    """Eddy currents, a mode and a lag: alone the lag of the drive does for two."""
    eddy = block("eddy-diffusion", time_constant_s=0.01, geometry="slab")
    return found_in(eddy, MODE_BLOCK, block("sensor-lag", time_constant_s=0.001))


def test_a_second_look_is_seen_in_the_ranking(found):
    """The lag was the best while the mode was missing; is it still?"""
    names = [item["name"] for item in found["effects"]]
    assert names == ["drive-lag", "resonance"]
    looked = {}
    for row in found["ranking"]:
        check_against_schema(row, RANK, "ranking")
        if row["look"]:
            looked.setdefault((row["round"], row["instead_of"]), []).append(row)
    assert list(looked) == [(2, "drive-lag"), (2, "resonance")]
    for (_, effect), rows in looked.items():
        assert [row["name"] for row in rows if row["taken"]] == [effect]
        others = [name for name in names if name != effect]
        assert all(row["beside"] == others for row in rows)
    first = {row["name"]: row for row in found["ranking"] if row["round"] == 1}
    assert all(row["beside"] == [] for row in first.values())
    then = {row["name"]: row for row in looked[2, "drive-lag"]}
    gains = [
        rows["drive-lag"]["gain"] - rows["eddy-diffusion"]["gain"]
        for rows in (first, then)
    ]
    # Of two likely lags the true one is clearer with the mode there.
    assert gains[1] > gains[0] > 0


def test_an_effect_that_no_round_took_is_seen_to_take_a_place(swapped):
    """The three that were put in are named; one of them was the first of no round."""
    names = [item["name"] for item in swapped["effects"]]
    assert set(names) == {"eddy-diffusion", "resonance", "sensor-lag"}
    rows = [row for row in swapped["ranking"] if row["taken"]]
    by_rounds = {row["name"] for row in rows if not row["look"]}
    ((gone, came),) = (
        (row["instead_of"], row["name"])
        for row in rows
        if row["look"] and row["instead_of"] != row["name"]
    )
    assert came not in by_rounds
    assert (by_rounds | {came}) - {gone} == set(names)
    # The rows of that look say by how much.
    (row,) = (x for x in rows if x["look"] and x["instead_of"] != x["name"])
    key = ("round", "look")
    old = next(
        x
        for x in swapped["ranking"]
        if [x[k] for k in key] == [row[k] for k in key] and x["name"] == gone
    )
    assert "declined" in old or row["score"] < old["score"]


@pytest.mark.parametrize("case", ["found", "swapped"])
def test_every_confidence_follows_from_what_gap_json_holds(case, request):
    found = request.getfixturevalue(case)
    for item in found["effects"]:
        sure, ties = told_by_rows(found, item["name"])
        assert item["confidence"] == pytest.approx(sure)
        assert item["cannot_be_told_from"] == ties


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


def test_the_augmented_model_keeps_limits_and_where_numbers_came_from():
    """Also where an effect puts blocks of the same kind before the base's own."""
    chain = (hysteresis(), block("gain", value=1.0, offset=0.5), MODE_BLOCK)
    printed, fitted = Provenance("published", "a"), Provenance("calibrated", "b")
    base = Model(
        "base",
        CURRENT,
        DISPLACEMENT,
        chain,
        free=("gain.value", "gain.offset", "resonance.damping_ratio"),
        tolerances={"gain.value": 0.1, "resonance.damping_ratio": 0.5},
        provenance={"gain.value": fitted, "gain.offset": printed},
    )
    state, _ = start_state(measured(chain, NOISE), base, declared=NOISE)
    after = with_named(state, "asymmetry", "bias", bias=0.1, zero=-1.5)
    (place,) = (k for k, x in enumerate(after.chain) if x == chain[1])
    tuned = replace(chain[1], value=1.05)
    after = after.with_blocks({place: tuned})
    model = augmented(base, after)
    assert model.value("gain#3.value") == 1.05
    assert dict(model.tolerances) == {
        "gain#3.value": 0.1,
        "resonance.damping_ratio": 0.5,
    }
    # the value was re-tuned, the offset not
    assert dict(model.provenance) == {"gain#3.offset": printed}
    hard = with_named(state, "stiffness-hardening", coefficient=1e-3)
    model = augmented(base, hard)
    assert dict(model.tolerances) == {"gain.value": 0.1}
    assert set(model.provenance) == {"gain.value", "gain.offset"}


@pytest.mark.parametrize(("tau", "told"), [(0.002, True), (0.0021, False)])
def test_a_number_at_the_end_of_its_range_is_told(tau, told):
    lag = block("sensor-lag", time_constant_s=tau)
    added = Added("sensor-lag", "sensor", "", (1,), {"time_constant_s": tau}, 1)
    chain = (block("gain", value=12.0), lag)
    free = (Free(1, "time_constant_s", low=1e-4, high=0.002), Free(0, "value"))
    state = state_of(chain, measured(chain, NOISE), free=free, added=(added,))
    sentence = at_ends(state)
    wanted = (
        "time_constant_s of sensor-lag, 0.002 s, lies at the end of the range that was "
        "searched"
    )
    assert sentence == (wanted if told else "")


AT_ITS_BLOCKS_END = [
    ("outflow", "store", {"exponent": 0.1}, "exponent of outflow, 0.1, lies at"),
    ("outflow", "store", {"exponent": 0.11}, ""),
    ("overflow", "store", {"caught": 1.0}, ""),
    ("overflow", "store", {"caught": 0.0}, ""),
    ("sensor-lag", "sensor-lag", {"damping_ratio": 0.0}, ""),
    ("sensor-lag", "sensor-lag", {"damping_ratio": 10.0}, "damping_ratio of sensor"),
]


@pytest.mark.parametrize(("effect", "kind", "number", "told"), AT_ITS_BLOCKS_END)
def test_the_bounds_of_its_block_are_ends_as_well_but_not_physical_ones(
    effect, kind, number, told
):
    """A law of a store searches no range of its own."""
    own = {"gain": 1.0, "rate": 1.0} if kind == "store" else {"time_constant_s": 0.01}
    chain = (block("gain", value=12.0), block(kind, **own, **number))
    (name,) = number
    added = Added(effect, "inside", "", (1,), number, 1)
    state = state_of(
        chain, measured(chain, NOISE), free=(Free(1, name),), added=(added,)
    )
    sentence = at_ends(state)
    assert sentence.startswith(told)
    assert bool(sentence) == bool(told)


def test_a_force_of_zero_is_at_no_end_even_where_the_law_ends_there():
    lag = block("sensor-lag", time_constant_s=1e-3, damping_ratio=0.0)
    added = Added("sensor-lag", "sensor", "", (1,), {}, 1)
    chain = (block("gain", value=12.0), lag)
    free = (Free(1, "damping_ratio", low=0.0, high=2.0),)
    state = state_of(chain, measured(chain, NOISE), free=free, added=(added,))
    assert at_ends(state) == ""


@pytest.mark.parametrize(
    ("laws", "path", "told"),
    [((0.001,), 0.9, 0.001), ((0.2, 0.95), 0.9, 0.9), ((), 0.9, 0.9)],
)
def test_a_path_is_no_surer_than_the_laws_beside_it(laws, path, told):
    rows = [{"name": f"law {k}", "confidence": sure} for k, sure in enumerate(laws)]
    rows.append({"name": "drift", "confidence": path})
    *others, last = paths_no_surer(rows, {"drift"})
    assert others == rows[:-1]
    assert last["confidence"] == told

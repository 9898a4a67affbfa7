"""Naming in jobs, with files between them, beside naming in one process."""

from __future__ import annotations

import json
from dataclasses import replace

import numpy as np
import pytest

from hystbench.errors import InputError
from hystbench.gap.change import with_effect
from hystbench.gap.effects import effects
from hystbench.gap.effects.base import Declined
from hystbench.gap.evidence import Evidence, load_evidence
from hystbench.gap.finding import decide
from hystbench.gap.held_back import gain_held_back
from hystbench.gap.kept import Restorer, progress_mapping, state_mapping
from hystbench.gap.name import name
from hystbench.gap.rank import make_score
from hystbench.gap.search import Attempt, coarse
from hystbench.gap.stages import Recorded, begin, choose, named_by, try_one
from hystbench.gap.start import start_state
from hystbench.gap.thresholds import PAYS
from hystbench.gap.told import ranking_rows
from hystbench.gap.work import Work
from hystbench.model import Model, load_model

from .made import CURRENT, DISPLACEMENT
from .small import MODE, block, hysteresis, measured
from .tiny import LAG_S, write_tiny

KEPT = ("effect", "place", "form", "score", "gain", "declined", "held_back")


def through_a_file(content):
    return json.loads(json.dumps(content, allow_nan=False))


@pytest.fixture(scope="module")
def tiny(tmp_path_factory):
    data, base = write_tiny(tmp_path_factory.mktemp("tiny"))
    evidence = load_evidence(data, "fit")
    model = load_model(base)
    start, floor = start_state(evidence.fit, model, evidence.hold, evidence.noise_rms)
    return evidence, model, start, floor


@pytest.fixture(scope="module")
def whole(tiny):
    _, _, start, floor = tiny
    return name(start, floor.rms)


@pytest.fixture(scope="module")
def staged(tiny):
    """The progress after each round, and what was tried in it."""
    evidence, model, _, _ = tiny
    progress = [through_a_file(begin(evidence, model))]
    tried = []
    while not progress[-1]["done"]:
        before = progress[-1]
        tried.append(
            {
                effect: through_a_file(try_one(evidence, model, before, effect))
                for effect in effects()
            }
        )
        progress.append(through_a_file(choose(evidence, model, before, tried[-1])))
    return progress, tried


def test_both_ways_name_what_was_put_in(whole):
    (item,) = whole.state.added
    assert item.effect == "drive-lag"
    (block,) = (whole.state.chain[k] for k in item.blocks)
    assert block.time_constant_s == pytest.approx(LAG_S, rel=0.02)


def test_jobs_and_one_process_rank_and_name_alike(tiny, whole, staged):
    evidence, model, start, floor = tiny
    progress, _ = staged
    found, kept_floor = named_by(evidence, model, progress[-1], start)
    assert kept_floor == floor
    assert found.state.chain == whole.state.chain
    assert found.state.added == whole.state.added
    assert found.state.free == whole.state.free
    assert len(found.rounds) == len(whole.rounds)
    for here, there in zip(found.rounds, whole.rounds, strict=True):
        assert here.taken == there.taken
        for one, other in zip(here.ranking, there.ranking, strict=True):
            for key in KEPT:
                assert getattr(one, key) == getattr(other, key), one.effect
            assert (one.state is None) == (other.state is None)
    decided = [
        decide("tiny", model, start, floor, named).content for named in (found, whole)
    ]
    assert decided[0] == decided[1]


def test_the_ranking_is_by_what_records_held_back_tell(tiny, whole, staged):
    floor = tiny[-1]
    progress, _ = staged
    ranking = ranking_rows(whole)
    for number, one in enumerate(whole.rounds, start=1):
        rows = [item for item in ranking if item["round"] == number]
        assert {item["name"] for item in rows} == set(effects())
        kept = progress[-1]["rounds"][number - 1]["ranking"]
        score = make_score(one.before, floor.rms)
        for row, item, there in zip(rows, one.ranking, kept, strict=True):
            assert row["name"] == item.effect == there["effect"]
            assert row["held_back"] == item.held_back == there["held_back"]
            if item.held_back is None:
                assert item.state is None or item.gain < PAYS
                continue
            # Judged anew: what is gained there, or less.
            again = gain_held_back(one.before, item.state, score)
            assert item.held_back == pytest.approx(again)
            assert item.gain <= again + 1e-9
        finalists = [item for item in one.ranking if item.state is not None]
        assert finalists == sorted(finalists, key=lambda item: item.score)
        assert one.ranking[0].held_back is not None or not one.taken
    assert whole.rounds[0].taken


def test_the_choice_searches_nothing_again(tiny, staged, monkeypatch):
    evidence, model, _, _ = tiny
    progress, tried = staged
    again: list[str] = []
    added = Work.added

    def added_again(self, state, trial, score):
        again.append(trial.variant.effect)
        return added(self, state, trial, score)

    for step in ("tried", "fine"):
        monkeypatch.setattr(Work, step, lambda self, *given: pytest.fail("again"))
    monkeypatch.setattr(Work, "added", added_again)
    after = through_a_file(choose(evidence, model, progress[0], tried[0]))
    assert after == progress[1]
    # What one process does not search around it refits from the grid: so must we.
    ranking = after["rounds"][0]["ranking"]
    finalists = {item["effect"] for item in ranking if item["state"]}
    assert finalists - set(again)


def test_a_variant_that_a_job_refused_is_missing_and_no_other(tiny, staged):
    """Of three variants the first has no entry: the others keep theirs."""
    evidence, model, _, _ = tiny
    progress, tried = staged
    kept = tried[0]["calibration-error"]["variants"]
    assert [item["number"] for item in kept] == [0, 1, 2]
    restorer = Restorer(evidence.fit, model)
    state = restorer.progress(progress[0]).state
    some = {"calibration-error": tried[0]["calibration-error"] | {"variants": kept[1:]}}
    work = Recorded(some, restorer)
    score = make_score(state, progress[0]["floor"]["rms"])
    found, why = work.tried(effects()["calibration-error"], state, score)
    assert not why
    assert [trial.variant.form for _, trial in found] == ["offset", "gain and offset"]
    for (attempt, trial), entry in zip(found, kept[1:], strict=True):
        assert trial.values == entry["coarse"]["values"]
        assert work.fine(attempt, trial).values == entry["fine"]["values"]


def test_an_effect_without_a_job_is_tried_by_the_choice(tiny, staged):
    evidence, model, _, _ = tiny
    progress, tried = staged
    short = {key: tried[0][key] for key in tried[0] if key != "drive-lag"}
    assert through_a_file(choose(evidence, model, progress[0], short)) == progress[1]


def test_an_effect_that_is_there_declines(staged):
    _, tried = staged
    assert tried[1]["drive-lag"]["declined"] == "added already"


def test_before_the_last_round_nothing_is_decided(tiny, staged):
    evidence, model, start, _ = tiny
    progress, _ = staged
    assert len(progress) == 3
    with pytest.raises(InputError, match="round 1: an effect was added; expected"):
        named_by(evidence, model, progress[1], start)


#: What an effect needs in the chain, and those that a chain with hysteresis refuses.
NEEDS = {"stiffness-hardening": ["resonance"]}
DECLINE = {"hysteresis"}


@pytest.mark.parametrize("added", sorted(effects()))
def test_a_model_comes_back_from_its_file(tiny, added):
    """Every effect, added to a chain that lags: it simulates the same."""
    _, model, state, floor = tiny
    score = make_score(state, floor.rms)
    chain = ["drive-lag", *NEEDS.get(added, []), added]
    for effect in dict.fromkeys(chain):
        try:
            variants = list(effects()[effect].variants(state.scene))
        except Declined:
            assert effect in DECLINE
            return
        trial = coarse(Attempt(state, variants[-1], score))
        state = with_effect(state, trial.variant, trial.values)
    state = state.settled()
    changes = {k: 1e-3 * step for k, step in enumerate(state.steps)}
    moved = replace(state, chain=state.moved(changes))
    restored = Restorer(moved.records, model).state(
        through_a_file(state_mapping(moved))
    )
    assert restored.chain == moved.chain
    assert restored.free == moved.free
    assert restored.added == moved.added
    np.testing.assert_array_equal(restored.residual, moved.residual)
    np.testing.assert_array_equal(restored.beside_columns, moved.beside_columns)


def test_second_looks_go_through_files_and_end_the_same():
    """A lag and a mode: when the second is added both are looked at again."""
    chain = (hysteresis(),)
    lag, mode = block("drive-lag", time_constant_s=0.004), block("resonance", **MODE)
    records = measured((lag, *chain, mode), 0.05)
    base = Model("rig", CURRENT, DISPLACEMENT, chain)
    evidence = Evidence("rig", records, (), "band-limited", 0.05)
    progress = through_a_file(begin(evidence, base))
    while not progress["done"]:
        tried = {
            effect: through_a_file(try_one(evidence, base, progress, effect))
            for effect in effects()
        }
        progress = through_a_file(choose(evidence, base, progress, tried))
    restored = Restorer(evidence.fit, base).progress(progress)
    kept = {"floor": progress["floor"], **progress_mapping(restored)}
    assert through_a_file(kept) == progress
    start, floor = start_state(records, base, "band-limited", 0.05)
    found, _ = named_by(evidence, base, progress, start)
    whole = name(start, floor.rms)
    assert [len(one.looks) for one in whole.rounds] == [0, 2]
    both = [
        json.dumps(decide("rig", base, start, floor, named).content)
        for named in (found, whole)
    ]
    assert both[0] == both[1]

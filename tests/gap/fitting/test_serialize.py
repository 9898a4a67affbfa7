"""A model written by the job that names, as the job that shows reads it."""

from __future__ import annotations

import json
from dataclasses import replace

import numpy as np
import pytest

from hystbench.gap.effects import effects
from hystbench.gap.effects.effect import Declined
from hystbench.gap.fitting.edit_chain import with_effect
from hystbench.gap.fitting.model_score import make_score
from hystbench.gap.fitting.on_records import start_state
from hystbench.gap.fitting.serialize import state_mapping, state_of
from hystbench.gap.fitting.state import Added, Free
from hystbench.gap.fitting.variant_search import Attempt
from hystbench.gap.records.evidence import load_evidence
from hystbench.model import load_model
from tests.gap.small import coarse
from tests.gap.tiny import write_tiny

#: What an effect needs in the chain, and those that a chain with hysteresis refuses.
NEEDS = {"stiffness-hardening": ["resonance"]}
DECLINE = {"hysteresis"}


@pytest.fixture(scope="module")
def tiny(tmp_path_factory):
    data, base = write_tiny(tmp_path_factory.mktemp("tiny"))
    evidence = load_evidence(data, "fit")
    model = load_model(base)
    return start_state(evidence.fit, model, evidence.input_hold, evidence.noise_rms)


def test_what_is_known_of_a_number_comes_back_from_its_file(tiny):
    state, _ = tiny
    place = len(state.chain) - 1
    name = next(iter(state.chain[place].to_mapping()))
    free = (Free(place, name, None, 0.1, given=1.5, refused="upper"),)
    item = Added("outflow", "inside", "root", (place,), {}, 1.0, was_free=free)
    known = replace(state, free=free, added=(item,))
    kept = json.loads(json.dumps(state_mapping(known), allow_nan=False))
    restored = state_of(kept, state)
    assert restored.free == free
    assert restored.added == (item,)


CHAINED = sorted(name for name, item in effects().items() if item.place != "inside")


@pytest.mark.parametrize("added", CHAINED)
def test_a_model_comes_back_from_its_file(tiny, added):
    """Every effect, added to a chain that lags: it simulates the same."""
    start, floor = tiny
    state = start
    score = make_score(state, floor)
    chain = ["drive-lag", *NEEDS.get(added, []), added]
    for effect in dict.fromkeys(chain):
        try:
            variants = list(effects()[effect].variants(state.simulation))
        except Declined:
            assert effect in DECLINE
            return
        trial = coarse(Attempt(state, variants[-1], score))
        state = with_effect(state, trial.variant, trial.values)
    state = state.settled()
    changes = {k: 1e-3 * step for k, step in enumerate(state.steps)}
    moved = state.moved(changes)
    kept = json.loads(json.dumps(state_mapping(moved), allow_nan=False))
    restored = state_of(kept, start)
    assert restored.chain == moved.chain
    assert restored.free == moved.free
    assert restored.added == moved.added
    np.testing.assert_array_equal(restored.residual, moved.residual)
    np.testing.assert_array_equal(restored.beside_columns, moved.beside_columns)

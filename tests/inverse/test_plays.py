"""Exact inverses of play operators."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from hystbench.blocks import registry
from hystbench.inverse.feedforward import Plays
from hystbench.operators import play
from tests.blocks.examples import EXAMPLES

DT = 1e-3


def block_of(name, **more):
    return registry()[name].from_mapping({**EXAMPLES[name], **more})


def walk(seed, count=400, size=1.0):
    """A path with turns of every size."""
    random = np.random.default_rng(seed)
    steps = np.cumsum(random.normal(size=count))
    return size * steps / np.abs(steps).max()


def closed_form(r, w):
    """Give the inverse of plays, which are plays: Krejci and Kuhnen (2001)."""
    slopes = np.cumsum(w)
    own = np.concatenate([[1 / w[0]], -w[1:] / (slopes[1:] * slopes[:-1])])
    return np.concatenate([[0.0], np.cumsum(slopes[:-1] * np.diff(r))]), own


@given(
    seed=st.integers(0, 10**6),
    weights=st.lists(st.floats(-0.4, 2.0), min_size=0, max_size=6),
    apart=st.lists(st.floats(0.01, 0.5), min_size=6, max_size=6),
)
def test_the_inverse_of_plays_is_plays(seed, weights, apart):
    w = np.array([1.0, *weights])
    # No first weights may sum up to zero: the model's slope.
    w[1:] = np.maximum(w[1:], -0.5 * np.cumsum(np.maximum(w, 0))[:-1] / len(w))
    r = np.concatenate([[0.0], np.cumsum(apart)])[: len(w)]
    u = walk(seed)
    y = play(u, r) @ w
    own_r, own_w = closed_form(r, w)
    np.testing.assert_allclose(play(y, own_r) @ own_w, u, atol=1e-9)


@given(seed=st.integers(0, 10**6), size=st.floats(0.05, 0.7))
@pytest.mark.parametrize("name", ["gpi", "prandtl-ishlinskii"])
def test_output_of_the_inverse_is_the_wanted_one(name, seed, size):
    values = {"square_weights": []} if name == "prandtl-ishlinskii" else {}
    block = block_of(name, **values)
    u = walk(seed, size=size)
    y = block.simulate(u, u, DT)
    v, lost = Plays.of(block).invert(y)
    assert lost == 0
    np.testing.assert_allclose(block.simulate(v, v, DT), y, atol=1e-12 * np.ptp(y))


def test_sample_by_sample_it_is_the_inverse_in_closed_form():
    block = block_of(
        "prandtl-ishlinskii",
        weights=[0.5, 0.3, 0.2],
        square_weights=[],
        cube_weights=[],
    )
    u = walk(3)
    y = block.simulate(u, u, DT)
    v, _ = Plays.of(block).invert(y)
    r, w = closed_form(np.array(block.thresholds), np.array([1.5, 0.3, 0.2]))
    np.testing.assert_allclose(v, play(y, r) @ w, atol=1e-12)


def test_a_settled_start_is_inverted_as_one():
    block = block_of("gpi", start="settled")
    u = 0.5 * np.sin(np.linspace(0, 4 * np.pi, 400))
    y = block.simulate(u, u, DT)
    v, _ = Plays.of(block).invert(y)
    np.testing.assert_allclose(block.simulate(v, v, DT), y, atol=1e-9)


def test_out_of_reach_the_input_stands_at_its_limit():
    block = block_of("gpi")
    u = np.linspace(0.0, 1.0, 50)
    y = block.simulate(u, u, DT)
    v, lost = Plays.of(block).invert(y, -0.5, 0.5)
    assert lost == int((u > 0.5).sum())
    assert v.max() == 0.5
    assert (v[u > 0.5] == 0.5).all()


def test_other_blocks_are_not_made_of_plays():
    assert Plays.of(block_of("creep")) is None
    assert Plays.of(object()) is None

"""The block ``gpi`` against a plain loop over Eqs. 3-6 and 9."""

import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from hystbench.blocks.gpi import GeneralizedPrandtlIshlinskii
from hystbench.errors import InputError

ENVELOPE = (1.2878, 0.36, 0.6025, -0.6671, 0.3223, 1.2233, 0.1104, -0.0248)


def plain_loop(v, envelope, thresholds, weights):
    a0, a1, a2, a3, a4, a5, a6, a7 = envelope
    state = [0.0] * len(thresholds)
    out = []
    for value in v:
        left = a0 * math.tanh(a1 * value + a2) + a3
        right = a4 * math.tanh(a5 * value + a6) + a7
        for i, r in enumerate(thresholds):
            state[i] = max(right - r, min(left + r, state[i]))
        out.append(sum(w * s for w, s in zip(weights, state, strict=True)))
    return np.array(out)


@given(
    st.lists(st.floats(-0.65, 0.65), min_size=1, max_size=60),
    st.lists(st.tuples(st.floats(0, 0.3), st.floats(-5, 5)), min_size=1, max_size=8),
)
def test_it_is_the_plain_loop(samples, operators):
    thresholds, weights = zip(*operators, strict=True)
    block = GeneralizedPrandtlIshlinskii(
        envelope=ENVELOPE, thresholds=thresholds, weights=weights
    )
    v = np.array(samples)
    np.testing.assert_allclose(
        block.simulate(v, v, 1e-4),
        plain_loop(samples, ENVELOPE, thresholds, weights),
        rtol=1e-12,
        atol=1e-12,
    )


@pytest.mark.parametrize("start", ["rest", "settled"])
def test_its_operators_add_up_to_it(start):
    block = GeneralizedPrandtlIshlinskii(
        envelope=ENVELOPE,
        thresholds=(0.0, 0.1, 0.25),
        weights=(1.0, 2.0, -1.0),
        start=start,
    )
    v = 0.6 * np.sin(np.arange(300) / 20) * np.linspace(0.2, 1, 300)
    outputs = block.operators(v)
    assert outputs.shape == (300, 3)
    for one, weight in zip(outputs.T, np.eye(3), strict=True):
        alone = replace(block, weights=tuple(weight.tolist()))
        np.testing.assert_allclose(one, alone.simulate(v, v, 1e-4), atol=1e-15)
    total = outputs @ block.weights
    np.testing.assert_allclose(total, block.simulate(v, v, 1e-4), atol=1e-13)


@pytest.mark.parametrize("growth", [None, 1.5])
def test_settled_it_has_passed_the_input_once_before(growth):
    thresholds, weights = (0.0, 0.1, 0.25), (1.0, 2.0, -1.0)
    block = GeneralizedPrandtlIshlinskii(
        envelope=ENVELOPE, thresholds=thresholds, weights=weights, start="settled"
    )
    v = 0.6 * np.sin(np.arange(200) / 30)
    larger = tuple(r * (growth or 1.0) for r in thresholds)
    twice = plain_loop(np.tile(v, 2), ENVELOPE, larger, weights)
    grown = None if growth is None else np.full(len(v), growth)
    y = block.grow(v, v, 1e-4, grown)
    np.testing.assert_allclose(y, twice[200:], rtol=0, atol=1e-12)
    assert abs(y[0] - twice[0]) > 1e-3  # and that is not the start from rest


def test_a_weight_for_each_threshold():
    with pytest.raises(InputError, match="2 numbers, as many as thresholds, got 1"):
        GeneralizedPrandtlIshlinskii(
            envelope=ENVELOPE, thresholds=[0.0, 0.1], weights=[1.0]
        )


def test_an_envelope_has_eight_coefficients():
    with pytest.raises(InputError, match="envelope: expected 8 numbers, got 7"):
        GeneralizedPrandtlIshlinskii(
            envelope=ENVELOPE[:7], thresholds=[0.0], weights=[1.0]
        )


def test_a_file_names_the_coefficients():
    by_name = {f"a{i}": value for i, value in enumerate(ENVELOPE)}
    values = {"envelope": by_name, "thresholds": [0.0], "weights": [1.0]}
    block = GeneralizedPrandtlIshlinskii.from_mapping(values)
    assert block.envelope == ENVELOPE
    assert block.to_mapping() == values
    for change, expected in [
        ({"a8": 1.0}, "envelope: unknown key 'a8'"),
        ({"a3": "x"}, r"envelope\[3\]: expected a number"),
    ]:
        with pytest.raises(InputError, match=expected):
            GeneralizedPrandtlIshlinskii.from_mapping(
                values | {"envelope": by_name | change}
            )
    del by_name["a7"]
    with pytest.raises(InputError, match="envelope: expected the key 'a7'"):
        GeneralizedPrandtlIshlinskii.from_mapping(values)

"""The block ``rdgpi``: at rest it is the generalized Prandtl-Ishlinskii block."""

import numpy as np
import pytest

from hystbench.blocks.rdgpi import RateDependentPrandtlIshlinskii
from hystbench.errors import InputError

from .examples import EXAMPLES

VALUES = EXAMPLES["rdgpi"]


def test_without_dependence_on_the_rate_it_is_a_sum_of_plays():
    still = {**VALUES, "lambda1": 0.0, "lambda2": 0.0, "order": 4}
    block = RateDependentPrandtlIshlinskii.from_mapping(still)
    v = 0.6 * np.sin(np.linspace(0, 12, 500))
    spacing = 1.2 * 8.0 * np.log(1.002)
    loss = 0.08 * np.log(1.25)
    expected = np.zeros_like(v)
    for i in range(5):
        r = i * spacing
        weight = 3.3 / 5 * np.exp(-0.2 * r) * (1 - loss)
        state = 0.0
        for k, value in enumerate(7.0 * v - 0.13):
            state = max(value - r, min(value + r, state))
            expected[k] += weight * state
    np.testing.assert_allclose(block.simulate(v, v, 1e-3), expected, rtol=1e-10)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"order": 2.5}, "order: expected a whole number, got 2.5"),
        ({"alpha1": -8.0}, "thresholds are negative"),
    ],
)
def test_values_that_make_no_model_are_refused(change, message):
    with pytest.raises(InputError, match=message):
        RateDependentPrandtlIshlinskii.from_mapping({**VALUES, **change})

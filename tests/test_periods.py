"""Periods that are known beforehand."""

import numpy as np
import pytest

from hystbench.periods import find_period, repeats

K = np.arange(4000)
RNG = np.random.default_rng(3)
ROUND = RNG.standard_normal(500)
ROUNDED = RNG.uniform(-1, 1, 4000)
TRIANGLE = np.abs((K + 100) % 400 - 200.0) / 100 - 1
FADED = np.minimum(K / 150, 1.0) * TRIANGLE


@pytest.mark.parametrize(
    ("u", "period"),
    [
        (np.sin(2 * np.pi * K / 200), 200),
        (3 + np.sin(2 * np.pi * K / 200), 200),
        (np.sin(2 * np.pi * K / 200) + 0.02 * RNG.standard_normal(4000), 200),
        (np.sin(2 * np.pi * K / 200) + np.sin(2 * np.pi * K / 300), 600),
        (np.tile(ROUND, 8), 500),
        (np.abs(K % 500 - 250.0), 500),
        (1.0 * (K % 400 < 100), 400),
        # Ten periods of 100.3 samples are 1003; three are 300.9.
        (np.sin(2 * np.pi * K / 100.3), 1003),
        (FADED, 400),
        (FADED + 0.01 * RNG.standard_normal(4000), 400),
    ],
)
def test_a_period_is_found(u, period):
    assert find_period(u) == period


@pytest.mark.parametrize(
    "u",
    [
        1.0 * K,
        np.zeros(4000),
        RNG.standard_normal(4000),
        np.cumsum(RNG.standard_normal(4000)),
        np.sin(2 * np.pi * (K / 400) ** 2),
        np.sin(2 * np.pi * K / 3000),  # once and a third
        1.0 * (K > 2000),
        K / 4000 * np.sin(2 * np.pi * K / 125),  # grows
        np.exp(-K / 8000) * np.sin(2 * np.pi * K / 125) + 1e-3 * ROUNDED,
        # A period of 17.86 samples; seven of them do not lie twice in it.
        np.sin(2 * np.pi * K[:200] / 17.86) + 1e-3 * ROUNDED[:200],
    ],
)
def test_what_does_not_repeat_itself_has_none(u):
    assert find_period(u) is None


def test_nothing_contradicts_a_period_that_the_record_holds_once():
    assert repeats(ROUND, len(ROUND))
    assert repeats(np.tile(ROUND, 2)[:700], len(ROUND))

"""The numbers that decide: few, and each with its meaning."""

import ast
from pathlib import Path

import pytest
from scipy.stats import norm

from hystbench.gap import thresholds

WORDS = {"SHAPE", "WORTH_A_WORD"}
"""A name, and what decides only what is told."""
MADE_OF_OTHERS = {
    *("LEAST_WEIGHT", "CERTAIN", "UNKNOWN", "AS_GOOD", "ABOVE_NOISE"),
    *("TIMING_PAYS", "ANOTHER_MODE", "SLIDES"),
}


def test_few_independent_numbers_decide_and_each_has_a_meaning():
    lines = ast.parse(Path(thresholds.__file__).read_text()).body
    numbers = [k for k, line in enumerate(lines) if isinstance(line, ast.Assign)]
    for k in numbers:
        after = lines[k + 1]
        assert isinstance(after, ast.Expr), ast.unparse(lines[k])
        assert isinstance(after.value.value, str), ast.unparse(lines[k])
    names = {lines[k].targets[0].id for k in numbers}
    assert len(names - WORDS - MADE_OF_OTHERS) <= 15


def test_what_is_called_chance_is_one_probability():
    found = 1 / thresholds.UNKNOWN
    assert found == pytest.approx(norm.isf(thresholds.BY_CHANCE / 2), rel=1e-3)

"""The numbers that decide: few, and each with its meaning and the reason of its value.

Figures that the reasons tell are worked out here.
"""

import ast
import math
from pathlib import Path

import pytest
from scipy.stats import chi2, norm

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


def test_a_parameter_is_charged_as_its_reason_says():
    assert math.log(thresholds.RECORD_WEIGHT) == pytest.approx(3.9, abs=0.05)
    assert chi2.sf(thresholds.PARAMETER, 1) == pytest.approx(0.046, abs=5e-4)
    aic = thresholds.RECORD_WEIGHT * -2 * math.log(1 - thresholds.NUMBER_PAYS)
    assert aic == pytest.approx(2.02, abs=5e-3)


@pytest.mark.parametrize(
    ("weight", "gain", "share"),
    [
        (thresholds.RECORD_WEIGHT, thresholds.PAYS, 0.59),
        (thresholds.LEAST_WEIGHT, thresholds.PAYS, 0.14),
        (thresholds.LEAST_WEIGHT, thresholds.FURTHER, 0.29),
    ],
)
def test_an_effect_of_one_number_has_to_take_what_its_reason_says(weight, gain, share):
    asked = gain + thresholds.PARAMETER
    assert 1 - math.exp(-asked / weight) == pytest.approx(share, abs=5e-3)


def test_odds_and_sizes_are_as_their_reasons_say():
    assert math.exp(thresholds.PAYS / thresholds.SCALE) == pytest.approx(22e3, rel=2e-3)
    assert thresholds.FURTHER / thresholds.SCALE == 25
    assert thresholds.LEAST_WEIGHT * math.log(2) == pytest.approx(
        thresholds.CERTAIN, rel=0.05
    )
    above = 10 * math.log10(1 + thresholds.ABOVE_NOISE)
    assert above == pytest.approx(1.8, abs=0.05)
    noise = -20 * math.log10(thresholds.WIDE * thresholds.SLIGHT)
    assert noise == pytest.approx(27, abs=0.5)

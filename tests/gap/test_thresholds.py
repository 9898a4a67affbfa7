"""The numbers that decide: few, and each with its meaning."""

import ast
from pathlib import Path

from hystbench.gap import thresholds

WORDS = {"SHAPE", "WORTH_A_WORD"}
"""A name, and what decides only what is told."""


def test_few_independent_numbers_decide_and_each_has_a_meaning():
    lines = ast.parse(Path(thresholds.__file__).read_text()).body
    numbers = [k for k, line in enumerate(lines) if isinstance(line, ast.Assign)]
    names = {lines[k].targets[0].id: lines[k].value for k in numbers}
    for k in numbers:
        after = lines[k + 1]
        assert isinstance(after, ast.Expr), ast.unparse(lines[k])
        assert isinstance(after.value.value, str), ast.unparse(lines[k])
    own = [name for name, value in names.items() if isinstance(value, ast.Constant)]
    assert len(set(own) - WORDS) <= 15

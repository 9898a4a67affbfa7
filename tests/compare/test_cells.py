"""Cells: ours beside every printed number."""

import math

import pytest

from hystbench.compare.cells import CELL_COLUMNS, compare_cells
from hystbench.compare.rows import or_diverged, write_fields
from hystbench.compare.runs import ClaimEvidence
from tests.conftest import table

from .made import make_run, published_runs

FIRST = ("sine-010hz", "gpo")


def cell(evidence, signal, model, metric="mse"):
    (found,) = [
        c
        for c in compare_cells(evidence)
        if (c.signal, c.model, c.metric) == (signal, model, metric)
    ]
    return found


def test_every_printed_number_has_a_row_even_when_nothing_ran():
    cells = compare_cells(ClaimEvidence())
    assert len(cells) == 124
    assert all(c.ours is None and c.status == "not run" for c in cells)
    assert all(math.isinf(c.distance) and not c.ran for c in cells)


def test_ratio_by_hand():
    # printed 0.0094; ten times that is a log10 ratio of 1
    found = cell(ClaimEvidence(runs={FIRST: make_run(*FIRST, 0.094)}), *FIRST)
    assert found.published == "0.0094"
    assert found.log10_ratio == pytest.approx(1)
    assert found.distance == pytest.approx(1)
    assert found.status == "finite"


def test_digits_stay_as_printed():
    assert cell(ClaimEvidence(), "sine-100hz", "rdgpi", "re").published == "0.1"


def test_a_diverged_run_has_no_number_and_says_where():
    found = cell(ClaimEvidence(runs={FIRST: make_run(*FIRST, None)}), *FIRST)
    assert found.ours is None
    assert found.log10_ratio is None
    assert found.ran
    assert found.status == "diverged at sample 7, mu = 1"


def test_a_perfect_run_is_infinitely_below():
    found = cell(ClaimEvidence(runs={FIRST: make_run(*FIRST, 0.0)}), *FIRST)
    assert found.log10_ratio == -math.inf


def test_consistency_of_the_printed_pair_goes_along():
    evidence = ClaimEvidence()
    assert cell(evidence, "sine-200hz", "delayed").published_consistent == "no"
    assert (
        cell(evidence, "multisine-10-30-50hz", "volterra").published_consistent
        == "undecided"
    )
    assert cell(evidence, *FIRST).published_consistent == "yes"


def test_cells_as_csv(tmp_path):
    runs = published_runs({FIRST: None})
    write_fields(
        tmp_path / "cells.csv",
        CELL_COLUMNS,
        compare_cells(ClaimEvidence(runs=runs)),
        or_diverged,
    )
    rows = table(tmp_path / "cells.csv")
    assert len(rows) == 124
    told = {
        "table": "1",
        "signal": "sine-010hz",
        "model": "gpo",
        "metric": "mse",
        "half": "calibrated",
        "published": "0.0094",
        "published_consistent": "yes",
        "status": "diverged at sample 7, mu = 1",
    }
    empty = ("ours", "log10_ratio", "spread_low", "spread_high")
    assert rows[0] == told | dict.fromkeys((*empty, "draws_low", "draws_high"), "")
    assert rows[2]["ours"] == "0.4248"
    assert float(rows[2]["log10_ratio"]) == 0

"""What other twins say: spreads of the cells, and where claims hold."""

import pytest

from hystbench.compare.beside import Holding, read_holdings, read_spreads
from hystbench.compare.cells import CELL_COLUMNS, compare_cells
from hystbench.compare.claims import CLAIM_COLUMNS, judge_all
from hystbench.compare.rows import or_diverged, write_fields
from hystbench.compare.runs import ClaimEvidence
from tests.conftest import table

from .made import published_runs

ERRORS = """twin,family,signal,model,mse,re,status
gma,gpi,sine-010hz,gpo,0.01,0.1,finite
one,gpi,sine-010hz,gpo,0.03,0.2,finite
two,gpi,sine-010hz,gpo,0.02,0.15,finite
other,preisach,sine-010hz,gpo,9,9,finite
gma,gpi,sine-010hz,delayed,1,0.1,finite
one,gpi,sine-010hz,delayed,,,diverged at sample 3
two,gpi,sine-010hz,delayed,2,0.2,finite
"""
CLAIMS = """twin,family,experiment,claim,holds
gma,gpi,0,sums-gpo-best,yes
gma,gpi,1,sums-gpo-best,no
other,preisach,0,sums-gpo-best,no
gma,gpi,0,stroke,not testable
gma,gpi,0,chirp-gpo-best,yes
"""


@pytest.fixture
def spreads(tmp_path):
    path = tmp_path / "errors.csv"
    path.write_text(ERRORS)
    return read_spreads(path)


@pytest.fixture
def holdings(tmp_path):
    path = tmp_path / "claims.csv"
    path.write_text(CLAIMS)
    return read_holdings(path)


def test_spread_is_over_the_first_twins_family(spreads):
    assert spreads["sine-010hz", "gpo", "mse"] == (0.01, 0.03)
    assert spreads["sine-010hz", "gpo", "re"] == (0.1, 0.2)
    assert spreads["sine-010hz", "delayed", "mse"] == (1, float("inf"))


def test_one_twin_has_no_spread(tmp_path):
    path = tmp_path / "errors.csv"
    path.write_text("".join(ERRORS.splitlines(keepends=True)[:2]))
    assert read_spreads(path) == {}


def test_cells_carry_half_and_spread(spreads, tmp_path):
    evidence = ClaimEvidence(runs=published_runs(), spreads=spreads)
    write_fields(
        tmp_path / "cells.csv",
        CELL_COLUMNS,
        compare_cells(evidence, ["sine-020hz"]),
        or_diverged,
    )
    rows = {
        (row["signal"], row["model"], row["metric"]): row
        for row in table(tmp_path / "cells.csv")
    }
    found = rows["sine-010hz", "gpo", "mse"]
    assert (found["spread_low"], found["spread_high"]) == ("0.01", "0.03")
    assert found["half"] == "calibrated"
    assert rows["sine-010hz", "delayed", "re"]["spread_high"] == "diverged"
    assert rows["sine-020hz", "gpo", "mse"]["half"] == "held-out"
    assert rows["sine-020hz", "gpo", "mse"]["spread_low"] == ""


def test_holdings_are_counted_by_family(holdings):
    assert holdings["sums-gpo-best"] == (
        Holding("gpi", 1, 2),
        Holding("preisach", 0, 1),
    )
    assert "stroke" not in holdings


def test_where_a_claim_holds_stands_beside_its_verdict(holdings, tmp_path):
    evidence = ClaimEvidence(runs=published_runs(), holdings=holdings)
    write_fields(tmp_path / "judged.csv", CLAIM_COLUMNS, judge_all(evidence))
    rows = {row["id"]: row for row in table(tmp_path / "judged.csv")}
    assert rows["sums-gpo-best"]["verdict"] == "reproduced"
    assert rows["sums-gpo-best"]["holds_on"] == "gpi 1 of 2, preisach 0 of 1"
    assert rows["chirp-gpo-best"]["holds_on"] == "gpi 1 of 1; no other family was run"
    assert rows["stroke"]["holds_on"] == ""

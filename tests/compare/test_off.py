"""Cells that are off: which, and what the sentence says of each."""

import numpy as np
import pytest

from hystbench.compare.cells import OFF_COLUMNS, compare_cells, off_cells
from hystbench.compare.rows import write_fields
from hystbench.compare.runs import ClaimEvidence
from tests.conftest import table

from .made import make_record, make_run, published_runs

# printed: 0.0094 for the GPO filter, 0.4248 for the backlash filter at 10 Hz
CELL = ("sine-010hz", "gpo")


def known(cell, evidence):
    found = {
        (o.cell.signal, o.cell.model): o
        for o in off_cells(compare_cells(evidence, ["sine-010hz"]), evidence)
    }
    return found[cell].known


def test_only_mse_beyond_a_factor_of_2_is_off():
    runs = published_runs({CELL: 0.0187, ("sine-010hz", "delayed"): 0.2880 / 2.01})
    evidence = ClaimEvidence(runs=runs)
    found = [
        (o.cell.signal, o.cell.model)
        for o in off_cells(compare_cells(evidence), evidence)
    ]
    assert found == [("sine-010hz", "delayed")]


def test_direction_and_company_by_hand():
    # two more cells are a little high: one in the row, one in the column
    changes = {
        CELL: 0.094,
        ("sine-010hz", "delayed"): 0.29,
        ("sine-020hz", "gpo"): 0.01,
    }
    text = known(CELL, ClaimEvidence(runs=published_runs(changes)))
    assert text.startswith("Ours is too high by a factor of 10;")
    assert "2 of 4 filters on this signal" in text
    assert "on 2 of 13 signals lie on that side" in text
    assert text.endswith(".")
    text = known(CELL, ClaimEvidence(runs=published_runs({CELL: 0.00094})))
    assert text.startswith("Ours is too low by a factor of 10;")


def test_an_inconsistent_pair_is_told():
    # the delayed row of 200 Hz is refuted by the other three
    cell = ("sine-200hz", "delayed")
    assert "cannot be true" in known(
        cell, ClaimEvidence(runs=published_runs({cell: 9.0}))
    )
    assert "cannot" not in known(CELL, ClaimEvidence(runs=published_runs({CELL: 9.0})))


def test_share_of_the_start_by_hand():
    # of a sum of 10 the last three quarters hold 0.75 * 4 = 3
    runs = published_runs()
    runs[CELL] = make_run(*CELL, 10.0, mse_after_transient=4.0, transient_fraction=0.25)
    text = known(CELL, ClaimEvidence(runs=runs))
    assert "the first 25 % of the record hold 70 % of our squared error" in text


def test_rms_and_spread_are_told():
    # the tables imply 9.17 um at 10 Hz
    y = np.full(100, 2 * 9.17)
    evidence = ClaimEvidence(
        runs=published_runs({CELL: 0.094}),
        records={"sine-010hz": make_record("sine-010hz", y, y)},
        spreads={(*CELL, "mse"): (0.001, 0.1)},
    )
    text = known(CELL, evidence)
    assert "the RMS displacement is off by +100.0 %" in text
    assert "0.001 to 0.1, which holds the published value" in text


def written(mse, folder):
    evidence = ClaimEvidence(runs=published_runs({CELL: mse}))
    write_fields(
        folder / "off.csv",
        OFF_COLUMNS,
        off_cells(compare_cells(evidence), evidence),
    )
    (row,) = table(folder / "off.csv")
    return row


def test_a_diverged_run_is_off_and_has_no_ratio(tmp_path):
    row = written(None, tmp_path)
    assert (row["ours"], row["ratio"]) == ("", "")
    assert row["known"] == "Ours diverged at sample 7, mu = 1."


def test_the_ratio_in_the_file(tmp_path):
    row = written(0.094, tmp_path)
    assert float(row["ratio"]) == pytest.approx(10)
    assert row["half"] == "calibrated"


def test_a_displacement_that_is_right_is_no_reason():
    y = np.full(100, 9.17 * (1 - 1e-4))
    evidence = ClaimEvidence(
        runs=published_runs({CELL: 0.094}),
        records={"sine-010hz": make_record("sine-010hz", y, y)},
    )
    assert "displacement" not in known(CELL, evidence)

"""Summary against hand-worked counts."""

import json
import math

import numpy as np
import pytest

from hystbench.compare.cells import ComparedCell, compare_cells
from hystbench.compare.claims import judge_all
from hystbench.compare.claims.claim import Claim, Judgement
from hystbench.compare.evidence import Evidence
from hystbench.compare.summary import (
    claim_counts,
    nearness,
    orderings,
    rms_error_percent,
    summarise,
)
from hystbench.compare.twins import Holding

from .made import PAIRS, make_record, published_runs


def cell(signal, model, published, ours, status="finite", consistent="yes"):
    return ComparedCell(
        table=1,
        signal=signal,
        model=model,
        metric="mse",
        half="calibrated",
        published=published,
        ours=ours,
        spread_low=None,
        spread_high=None,
        published_consistent=consistent,
        status=status,
    )


DIVERGED = ("diverged at sample 3", "yes")


def test_nearness_by_hand():
    cells = [
        cell("a", "gpo", "1", 2.0),  # log10 0.301, just within a factor of 2
        cell("a", "backlash", "1", 0.1),  # log10 -1
        cell("a", "volterra", "1", 1.0),  # log10 0
        cell("a", "delayed", "1", None, *DIVERGED),
        cell("b", "gpo", "1", None, "not run"),
    ]
    found = nearness(cells)
    assert found["cells"] == 4
    assert found["cells_published"] == 5
    assert found["diverged"] == 1
    assert found["within_factor_2"] == 0.5
    # distances 0, 0.301, 1, infinite: the median is the mean of the middle two
    assert found["median_abs_log10_ratio"] == pytest.approx((math.log10(2) + 1) / 2)
    assert found["worst_finite"]["model"] == "backlash"


def test_where_most_diverged_there_is_no_median():
    found = nearness([cell("a", "gpo", "1", None, *DIVERGED)])
    assert found["median_abs_log10_ratio"] is None
    assert found["within_factor_2"] == 0
    assert found["worst_finite"] is None


def test_where_nothing_ran_there_is_no_fraction():
    assert nearness([])["within_factor_2"] is None


def test_orderings_by_hand():
    cells = [
        cell("a", "gpo", "1", 5.0),
        cell("a", "backlash", "2", 6.0),  # as printed: above gpo
        cell("a", "volterra", "3", 4.0),  # wrong against both
        cell("a", "delayed", "4", None, *DIVERGED),  # worst, as printed: 3 right
        cell("b", "gpo", "1", 1.0),
        cell("b", "backlash", "2", None, "not run"),
    ]
    assert orderings(cells) == {"agree": 4, "compared": 6, "published": 7}


def test_two_diverged_runs_and_equal_runs_have_no_order():
    both = [
        cell("a", "gpo", "1", None, *DIVERGED),
        cell("a", "backlash", "2", None, *DIVERGED),
    ]
    assert orderings(both)["agree"] == 0
    equal = [cell("a", "gpo", "1", 1.0), cell("a", "backlash", "2", 1.0)]
    assert orderings(equal)["agree"] == 0


def test_runs_as_printed_agree_everywhere():
    evidence = Evidence(runs=published_runs())
    found = summarise(compare_cells(evidence), judge_all(evidence))
    assert found["cells"] == found["cells_published"] == 52
    assert found["within_factor_2"] == 1
    assert found["median_abs_log10_ratio"] == 0
    # 13 signals, 6 pairs of 4 filters each, no ties in print
    assert found["orderings"] == {"agree": 78, "compared": 78, "published": 78}
    assert found["rdgpi"]["cells"] == 10
    assert {m: p["cells"] for m, p in found["per_model"].items()} == {
        "gpo": 13,
        "backlash": 13,
        "volterra": 13,
        "delayed": 13,
    }
    json.dumps(found, allow_nan=False)


def test_inconsistent_cells_leave_by_rule():
    found = summarise(compare_cells(Evidence()), ())["without_inconsistent"]
    # 4 filter pairs are refuted, 2 more undecided
    assert found["without_no"]["cells_published"] == 48
    assert found["without_no_and_undecided"]["cells_published"] == 46


def test_held_out_signals_stand_apart():
    held_out = {"sine-060hz", "chirp-1-100hz"}
    changed = {(s, m): 1e6 for s in held_out for m in ("gpo", "delayed")}
    evidence = Evidence(runs=published_runs(changed))
    found = summarise(compare_cells(evidence), (), held_out)
    assert found["held_out"]["cells"] == 8
    assert found["held_out"]["within_factor_2"] == 0.5
    assert found["calibrated"]["cells"] == 44
    assert found["calibrated"]["within_factor_2"] == 1
    # of five held-out signals' two, half the cells are as printed, half off by 1e6
    medians = found["held_out"]["median_abs_log10_ratio"]
    assert medians["backlash"] == medians["volterra"] == 0
    assert medians["gpo"] > 6
    assert set(found["calibrated"]["median_abs_log10_ratio"].values()) == {0}
    assert "held_out" not in summarise(compare_cells(evidence), ())


def test_rms_error_by_hand():
    # the rows of the 200 Hz sine that agree imply 6.02 to 6.07 um
    time = np.arange(1000) / 1000
    y = 2 * 6.045 * np.sqrt(2) * np.sin(2 * np.pi * 5 * time)
    record = make_record("sine-200hz", np.sin(time), y)
    measured = make_record("sine-150hz", np.sin(time), y, origin="measured")
    found = rms_error_percent(
        Evidence(records={"sine-200hz": record, "sine-150hz": measured})
    )
    assert found == {"sine-200hz": pytest.approx(100, abs=1)}


def test_rms_errors_of_the_halves_are_not_mixed():
    errors = {"sine-010hz": -1.0, "sine-020hz": 2.0, "sine-060hz": -7.0}
    found = summarise(compare_cells(Evidence()), (), {"sine-060hz"}, errors)
    assert found["calibrated"]["largest_rms_error_percent"] == 2
    assert found["held_out"]["largest_rms_error_percent"] == 7
    assert found["rms_error_percent"] == errors


def test_reproduced_claims_are_counted_by_where_they_hold():
    def judgement(verdict, *holdings):
        claim = Claim("x", "", "", "result", "", lambda _: None)
        return Judgement(claim, verdict, "", "not in tables", "", holdings)

    gpi = Holding("gpi", 3, 3)
    found = claim_counts(
        [
            judgement("reproduced", gpi),
            judgement("reproduced", gpi, Holding("preisach", 1, 1)),
            judgement("reproduced", gpi, Holding("preisach", 0, 1)),
            judgement("not reproduced", gpi, Holding("preisach", 0, 1)),
            judgement("reproduced"),
        ]
    )
    assert found["claims_reproduced_where"] == {
        "every_family": 1,
        "some_families": 1,
        "one_family_run": 1,
    }


def test_re_and_table_4_do_not_count_among_the_filters():
    found = summarise(compare_cells(Evidence()), ())
    assert found["cells_published"] == sum(p.table != 4 for p in PAIRS)


def test_claim_counts_by_hand():
    def judgement(kind, verdict):
        claim = Claim("x", "", "", kind, "", lambda _: None)
        return Judgement(claim, verdict, "", "not in tables", "")

    found = claim_counts(
        [
            judgement("result", "reproduced"),
            judgement("result", "not reproduced"),
            judgement("theory", "not testable"),
            judgement("theory", "reproduced"),
        ]
    )
    assert found["claims_total"] == 4
    assert found["claims_reproduced"] == 2
    assert found["claims_not_reproduced"] == 1
    assert found["claims_not_testable"] == 1
    assert found["claims_by_kind"]["theory"] == {
        "reproduced": 1,
        "not_reproduced": 0,
        "not_testable": 1,
    }

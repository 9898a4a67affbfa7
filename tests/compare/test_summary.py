"""Summary against hand-worked counts."""

import json
import math

import pytest

from hystbench.compare.cells import ComparedCell, compare_cells
from hystbench.compare.claims import judge_all
from hystbench.compare.claims.claim import Claim, Judgement
from hystbench.compare.evidence import Evidence
from hystbench.compare.summary import claim_counts, nearness, orderings, summarise

from .made import PAIRS, published_runs


def cell(signal, model, published, ours, status="finite", consistent="yes"):
    return ComparedCell(1, signal, model, "mse", published, ours, consistent, status)


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
    assert "held_out" not in summarise(compare_cells(evidence), ())


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

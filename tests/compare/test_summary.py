"""Summary against hand-worked counts."""

import json
import math
from dataclasses import replace

import numpy as np
import pytest

from hystbench.compare.beside import Drawn, Edge, Holding, Ranking
from hystbench.compare.cells import ComparedCell, compare_cells
from hystbench.compare.claims import CLAIMS, judge_all
from hystbench.compare.claims.claim import Judgement
from hystbench.compare.runs import ClaimEvidence
from hystbench.compare.summary import (
    claim_counts,
    constant_tap_finding,
    eq19_finding,
    nearness,
    orderings,
    pairs_in_order,
    rms_error_percent,
    summarise,
)
from hystbench.published import FILTERS
from hystbench.published.consistency import check

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
        published_consistent=consistent,
        status=status,
    )


DIVERGED = ("diverged at sample 3", "yes")


def judgement(kind, basis, verdict, alone="", holdings=()):
    claim = replace(CLAIMS[0], id="x", claim="", kind=kind, basis=basis)
    return Judgement(claim, verdict, "", "not in tables", "", holdings, alone)


def summed(evidence=None, held_out=()):
    """Sum up all but the claims."""
    evidence = evidence or ClaimEvidence()
    return summarise(evidence, compare_cells(evidence), (), held_out)


def off_by(errors):
    """Make records whose RMS is off the one that the tables imply, in per cent."""
    return {
        name: make_record(name, *2 * [[rms * (1 + errors[name] / 100)] * 4])
        for name, rms in ((s, check(PAIRS)[s].implied_rms) for s in errors)
    }


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
    evidence = ClaimEvidence(runs=published_runs())
    found = summarise(evidence, compare_cells(evidence), judge_all(evidence))
    assert found["cells"] == found["cells_published"] == 52
    assert found["within_factor_2"] == 1
    assert found["median_abs_log10_ratio"] == 0
    # 13 signals, 6 pairs of 4 filters each, no ties in print
    assert found["orderings"] == {"agree": 78, "compared": 78, "published": 78}
    assert found["rdgpi"]["cells"] == 10
    each = {model: part["cells"] for model, part in found["per_model"].items()}
    assert each == dict.fromkeys(FILTERS, 13)
    json.dumps(found, allow_nan=False)


def test_inconsistent_cells_leave_by_rule():
    found = summed()["without_inconsistent"]
    # 4 filter pairs are refuted, 2 more undecided
    assert found["without_no"]["cells_published"] == 48
    assert found["without_no_and_undecided"]["cells_published"] == 46


def test_held_out_signals_stand_apart():
    held_out = {"sine-060hz", "chirp-1-100hz"}
    changed = {(s, m): 1e6 for s in held_out for m in ("gpo", "delayed")}
    evidence = ClaimEvidence(runs=published_runs(changed))
    found = summed(evidence, held_out)
    assert found["held_out"]["cells"] == 8
    assert found["held_out"]["within_factor_2"] == 0.5
    assert found["calibrated"]["cells"] == 44
    assert found["calibrated"]["within_factor_2"] == 1
    # of five held-out signals' two, half the cells are as printed, half off by 1e6
    medians = found["held_out"]["median_abs_log10_ratio"]
    assert medians["backlash"] == medians["volterra"] == 0
    assert medians["gpo"] > 6
    assert set(found["calibrated"]["median_abs_log10_ratio"].values()) == {0}
    assert "held_out" not in summed(evidence)


def test_rms_error_by_hand():
    # the rows of the 200 Hz sine that agree imply 6.02 to 6.07 um
    time = np.arange(1000) / 1000
    y = 2 * 6.045 * np.sqrt(2) * np.sin(2 * np.pi * 5 * time)
    record = make_record("sine-200hz", np.sin(time), y)
    found = rms_error_percent(ClaimEvidence(records={"sine-200hz": record}))
    assert found == {"sine-200hz": pytest.approx(100, abs=1)}


def test_rms_errors_of_the_halves_are_not_mixed():
    errors = {"sine-010hz": -1.0, "sine-020hz": 2.0, "sine-060hz": -7.0}
    found = summed(ClaimEvidence(records=off_by(errors)), {"sine-060hz"})
    assert found["calibrated"]["largest_rms_error_percent"] == pytest.approx(2)
    assert found["held_out"]["largest_rms_error_percent"] == pytest.approx(7)
    assert found["rms_error_percent"] == pytest.approx(errors)


def test_reproduced_claims_are_counted_by_where_they_hold():
    def judged(verdict, *holdings):
        return judgement("result", "held-out", verdict, holdings=holdings)

    gpi = Holding("gpi", 3, 3)
    throughout, never = Holding("preisach", 1, 1), Holding("preisach", 0, 1)
    found = claim_counts(
        [
            judged("reproduced", gpi),
            judged("reproduced", gpi, throughout),
            judged("reproduced", gpi, never),
            judged("not reproduced", gpi, never),
            judged("reproduced"),
        ]
    )
    assert found["claims_reproduced_where"] == {
        "every_family": 1,
        "some_families": 1,
        "one_family_run": 1,
    }


def test_re_and_table_4_do_not_count_among_the_filters():
    found = summed()
    assert found["cells_published"] == sum(p.table != 4 for p in PAIRS)


def test_claim_counts_by_hand():
    refuted = "refuted by the paper"
    found = claim_counts(
        [
            judgement("result", "held-out", "reproduced"),
            judgement("result", "held-out", "not reproduced"),
            judgement("result", "fitted", "reproduced", "not reproduced"),
            judgement("result", "fitted", refuted, "reproduced"),
            # A trend over few signals that is none over all.
            judgement("result", "fitted", "not reproduced", "reproduced"),
            judgement("condition", "built-in", "reproduced"),
            judgement("theory", "", "not testable"),
        ]
    )
    keys = ("reproduced", "not_reproduced", "not_testable", "refuted_by_the_paper")
    none = dict.fromkeys(keys, 0)
    assert found["claims_total"] == 7
    bases = found["claims_by_basis"]
    assert bases["held-out"] == none | {"reproduced": 1, "not_reproduced": 1}
    assert bases["fitted"] == dict.fromkeys(keys, 1) | {"not_testable": 0}
    assert bases["constrained"] == none
    assert bases["built-in"] == none | {"reproduced": 1}
    assert found["claims_without_basis"] == none | {"not_testable": 1}
    # No number adds held-out results to others.
    alone = [(each["basis"], each["verdict"]) for each in found["claims_on_held_out"]]
    assert alone == [
        ("held-out", "reproduced"),
        ("held-out", "not reproduced"),
        ("fitted", "not reproduced"),
        ("fitted", "not reproduced"),
    ]


def test_the_rms_of_a_drawn_signal_counts_as_used():
    errors = {"sine-010hz": -1.0, "sine-060hz": -7.0, "sine-120hz": 2.0}
    held_out = {"sine-060hz", "sine-120hz"}
    records = off_by(errors)
    drawn = {"sine-060hz": Drawn({}, (float(records["sine-060hz"].y[0]),))}
    found = summed(ClaimEvidence(records=records, drawn=drawn), held_out)
    assert found["calibrated"]["largest_rms_error_percent"] == pytest.approx(7)
    assert found["held_out"]["largest_rms_error_percent"] == pytest.approx(2)


def test_a_drawn_signal_has_the_median_and_the_range_of_its_draws():
    signal = "multisine-random-0-100hz"
    errors = {("gpo", "mse"): (0.3, 0.1, 0.2), ("gpo", "re"): (0.3, 0.1, math.inf)}
    evidence = ClaimEvidence(
        runs=published_runs(), drawn={signal: Drawn(errors, (4.0, 5.0, 7.0))}
    )
    cells = {
        (cell.model, cell.metric): cell
        for cell in compare_cells(evidence)
        if cell.signal == signal and cell.table == 3
    }
    cell = cells["gpo", "mse"]
    assert (cell.ours, cell.draws_low, cell.draws_high) == (0.2, 0.1, 0.3)
    assert cells["gpo", "re"].draws_high == math.inf
    assert cells["delayed", "mse"].draws_low is None


def test_orderings_of_the_halves_are_apart():
    # On one held-out sine all four errors in reverse: its six pairs, and no others.
    sine = "sine-060hz"
    ours = dict(zip(FILTERS, (4.0, 3.0, 2.0, 1.0), strict=True))
    theirs = {p.model: p.mse.value for p in PAIRS if p.signal == sine}
    ranked = sorted(FILTERS, key=lambda model: theirs[model])
    worst = {
        (sine, model): value
        for model, value in zip(ranked, sorted(ours.values())[::-1], strict=True)
    }
    found = summed(ClaimEvidence(runs=published_runs(worst)), {sine, "sine-120hz"})
    assert found["held_out"]["orderings"]["agree"] == 6
    assert found["held_out"]["orderings"]["compared"] == 12
    calibrated = found["calibrated"]["orderings"]
    assert calibrated["agree"] == calibrated["compared"] == 66


def test_the_two_findings_by_hand():
    edge = Edge("sine-010hz", "gpo", 1.0, 1.0, 3.0, 2.0, 2.5, None)
    far = replace(edge, signal="sine-020hz", edge=6.0)
    found = eq19_finding([edge, far])
    assert (found["edges"], found["inside"]) == (2, 1)
    assert found["example"] == {
        "signal": "sine-010hz",
        "model": "gpo",
        "edge": 2.5,
        "bound": 3.0,
    }
    assert eq19_finding([]) is None
    pairs = ("40 of 48", "20 of 30")
    row = Ranking("gma", "gpi", 0.0, 0.0, "yes", 12, 13, "", *pairs, 0, *[1.0] * 4)
    taps = [
        replace(row, constant_tap=size, configured="", gpo_first=first)
        for size, first in ((0.1, 9), (1.0, 5))
    ]
    other = replace(taps[0], twin="other", constant_tap=2.0)
    told = constant_tap_finding([row, *taps, other])
    assert told["without"]["gpo_first"] == 12
    assert [(x["constant_tap"], x["gpo_first"]) for x in told["with"]] == [
        (0.1, 9),
        (1.0, 5),
    ]
    assert told["without"]["pairs_held_out"] == [20, 30]
    assert [x["zero_error_A"] for x in told["zero_errors"]] == [0.0]
    assert constant_tap_finding([row]) is None


def test_every_claim_is_told_once():
    """What held-out signals judge, the others by basis, and what is not judged."""
    listed = judge_all(ClaimEvidence(runs=published_runs()))
    counts = claim_counts(listed)
    others = counts["claims_elsewhere"].values()
    told = len(counts["claims_on_held_out"]) + sum(sum(x.values()) for x in others)
    assert told == counts["claims_total"] == len(listed)


def test_pairs_in_the_order_of_the_paper_by_hand():
    published = {(s, m): v for s in "abc" for m, v in (("gpo", 1.0), ("delayed", 2.0))}
    mse = {
        ("a", "gpo"): 1.0,
        ("a", "delayed"): 4.0,
        ("b", "gpo"): 3.0,
        ("b", "delayed"): 2.0,
        # both diverged: they have no order
        ("c", "gpo"): np.inf,
        ("c", "delayed"): np.inf,
    }
    assert pairs_in_order(mse, published) == (1, 3)

"""What was asked of the speed, held against tables written by hand."""

import pytest

from benchmarks import pipeline, reach
from hystbench.files import write_csv

NOTHING = (None, "not measured")


@pytest.fixture
def told(tmp_path, monkeypatch):
    monkeypatch.setattr(reach, "OUT", tmp_path)

    def write(**tables):
        for name, (columns, *rows) in tables.items():
            write_csv(tmp_path / f"{name}.csv", columns.split(), rows)
        return {row[0]: row[2:] for row in reach.reach()}

    return write


def test_without_tables_nothing_is_measured(told):
    found = told()
    assert set(found.values()) == {NOTHING}
    # peers, NumPy loops, Volterra, C, the same result; batches; streams; Algorithm 1;
    # the pipeline's four, and the gap's median, worst and two powers
    assert len(found) == 6 + 2 + 1 + 7 + 1 + 3 + 2 + 3 + 4 + 4


def test_kernels(told):
    found = told(
        kernels=(
            "kernel peer samples median_ratio same_result",
            ("LMS", "padasip", 20000, 151, "yes"),
            ("LMS", "padasip", 1000000, 149, "yes"),
            # ours takes 1.25 times as long as the best C that counts
            ("LMS", "C, may reorder sums", 20000, 1.1, "yes"),
            ("LMS", "C, may reorder sums, looked ahead", 20000, 0.8, "yes"),
            ("LMS", "C, -ffast-math, looked ahead", 20000, 0.5, "no"),
            ("volterra", "C, same flags", 20000, 0.5, "no"),
        )
    )
    assert found["LMS, 20,000 samples: times padasip"] == (151, "yes")
    assert found["LMS, 1,000,000 samples: times padasip"] == (149, "no")
    assert found["LMS, 20,000 samples: times adaptfilt"] == NOTHING
    assert found["LMS, 20,000 samples: time over the best C"] == (1.25, "yes")
    assert found["LMS, 1,000,000 samples: time over the best C"] == NOTHING
    assert found["volterra, 20,000 samples: time over the best C"] == (2.0, "no")
    # of the two LMS records one row each says yes, of Volterra none
    assert found["all kernels: the same result as plain loops"] == (0, "no")


def test_the_rest(told):
    found = told(
        identification=(
            "method seconds_over_ours error_over_ours",
            ("variable projection", 1, 1),
            ("least squares, 39 parameters", 40, 1.5),
            ("least squares, 39 parameters, thinned as ours", 2.5, 7),
            ("differential evolution, 39 parameters, thinned as ours", 100, 70),
        ),
        pipeline=(
            "what median_seconds",
            (f"{pipeline.CHANGED}, gpo", 5),
            (f"{pipeline.CHANGED}, volterra", 9),
            (pipeline.HELP, 0.15),
        ),
        batch=("batch efficiency", ("orders", 0.95)),
        gap=(
            "what seconds samples candidates",
            ("a case", 0.7, 900, 8),
            ("a case", 1.6, 900, 8),
            ("a case", 3.0, 900, 8),
            # four times the samples twice as long, twice the candidates four times
            ("a round", 5.0, 100, 8),
            ("a round", 10.0, 400, 8),
            ("a round", 2.5, 400, 4),
        ),
        samples=(
            "filter samples seconds peak_mib",
            ("gpo", 1_000_000, 1.0, 40.0),
            ("gpo", 100_000_000, 100.0, 42.0),
            ("delayed", 1_000_000, 1.0, 40.0),
            ("delayed", 100_000_000, 1000.0, 80.0),
        ),
    )
    # the worst row counts, of rivals with the same samples too
    assert found["identification: times faster than least squares"] == (2.5, "no")
    evolution = "identification: times faster than differential evolution"
    assert found[evolution] == (100, "yes")
    best = "identification: error of the best rival over ours"
    assert found[best] == (1.5, "yes")
    assert found[f"{pipeline.CHANGED}: median seconds"] == (9, "no")
    assert found[f"{pipeline.HELP}: median seconds"] == (0.15, "yes")
    assert found[f"{pipeline.NOTHING}: median seconds"] == NOTHING
    orders = "many filters in one call, orders: of two busy loops"
    assert found[orders] == (0.95, "yes")
    power = "a round of naming: power of its cost in"
    assert found[f"{power} samples"] == (pytest.approx(0.5), "yes")
    assert found[f"{power} candidates"] == (pytest.approx(2.0), "no")
    # the worst filter counts
    streams = "samples in chunks to 10^8: power of the cost"
    assert found[streams] == (pytest.approx(1.5), "no")
    memory = "10^8 samples in chunks: peak memory over that of 10^6"
    assert found[memory] == (2.0, "no")
    gap = "a case of the gap workflow, seconds of computing on one core"
    assert found[f"{gap}: median of the cases"] == (1.6, "no")
    assert found[f"{gap}: worst of the cases"] == (3.0, "yes")


def test_a_rival_that_ends_below_our_error_is_not_slower(told):
    found = told(
        identification=(
            "method seconds_over_ours error_over_ours",
            ("differential evolution, 39 parameters", 101, 0.9),
        ),
    )
    evolution = "identification: times faster than differential evolution"
    assert found[evolution] == (0, "no")

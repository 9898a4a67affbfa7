"""Many filters in one call: what the table makes of times written by hand."""

import csv

import pytest
from benchmarks.work import adaptive, record

from benchmarks import batch, timing


def test_efficiency_is_our_gain_over_that_of_the_busy_loops(tmp_path, monkeypatch):
    x, d = record(300)
    seconds = {"one": 3.0, "all": 2.0, "busy one": 5.0, "busy all": 6.0}
    monkeypatch.setattr(timing, "OUT", tmp_path)
    monkeypatch.setattr(batch.os, "sched_getaffinity", lambda _: {3, 5, 6})
    monkeypatch.setattr(
        batch, "batches", lambda: {"one": [(adaptive("gpo", x, 0.1), x, d)]}
    )
    monkeypatch.setattr(batch, "medians", lambda jobs, cores: seconds)
    batch.main()
    with (tmp_path / "batch.csv").open(encoding="utf-8") as stream:
        (row,) = csv.DictReader(stream)
    # three loops at once did in 6 s what one after the other takes 15 s for
    assert float(row["busy_gain"]) == 2.5
    assert float(row["gain"]) == 1.5
    assert float(row["efficiency"]) == pytest.approx(0.6)
    assert row["same_bytes"] == "yes"


def test_times_are_medians_of_turns(monkeypatch):
    loops = iter([1.0, 10.0, 3.0, 30.0, 2.0, 90.0])
    ours = iter([4.0, 0.4, 9.0, 0.5, 5.0, 0.1])
    monkeypatch.setattr(batch, "REPEATS", 3)
    monkeypatch.setattr(batch, "busy", lambda count: next(loops))
    turn = {"one": None, "all": None}
    monkeypatch.setattr(
        batch, "interleaved", lambda *_: {name: [next(ours)] for name in turn}
    )
    expected = {"one": 5.0, "all": 0.4, "busy one": 2.0, "busy all": 30.0}
    assert batch.medians([], 2) == expected
    assert next(loops, None) is None


def test_busy_loops_are_timed_by_their_own_clock(monkeypatch):
    # the second to begin ends first: from the first to begin to the last to end
    lines = iter(["7.0 12.5", "7.25 11.0"])

    def loop():
        return f"print('ready', flush=True); input(); print('{next(lines)}')"

    started = batch.subprocess.Popen

    def popen(words, **options):
        return started([*words[:2], loop()], **options)

    monkeypatch.setattr(batch.subprocess, "Popen", popen)
    assert batch.busy(2) == 5.5

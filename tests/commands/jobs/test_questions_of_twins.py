"""The random sum, the edges of the step sizes and the constants."""

import json

import numpy as np
import pytest

from hystbench.commands.jobs.constants import constants
from hystbench.commands.jobs.random_sum import random_sum
from hystbench.commands.jobs.step_sweep import step_sweep
from hystbench.compare.beside import Edge, Ranking, read_draws
from hystbench.compare.rows import read_items
from hystbench.twins.runs import draw_signals, measure_twin, read_twins
from tests.conftest import table
from tests.twins.conftest import SIGNALS, call


def test_draws_edges_and_constants_are_what_the_comparison_reads(
    settings, two, tmp_path
):
    identified = tmp_path / "identified.json"
    records = []
    (twin, _) = read_twins(two)
    job = settings.constants_job
    identified.write_text("{}")
    for name, record in measure_twin(
        twin, draw_signals(job["signals"], 0).values(), job["measure"], 0
    ).items():
        records.append(tmp_path / f"{name}.npz")
        record.save(records[-1])
    draws = tmp_path / "draws.csv"
    random = settings.random_sum_job
    call(
        random_sum, two[0], "--identified", identified,
        "--settings", json.dumps(random),
        "--draws", draws, "--readings", tmp_path / "readings.csv",
    )  # fmt: skip
    (signal,) = read_draws(draws)
    found = read_draws(draws)[signal]
    assert len(found.rms) == random["draws"]
    assert len(set(found.rms)) == len(found.rms)  # phases and noise are drawn anew
    told = table(tmp_path / "readings.csv")
    assert {row["sines"] for row in told} == {"20", "5"}
    middle = float(told[0]["median"])
    assert middle == pytest.approx(np.median(found.rms), rel=1e-3)

    edges = tmp_path / "edges.csv"
    call(
        step_sweep, *records, "--identified", identified,
        "--settings", json.dumps(settings.step_sweep_job),
        "--edges", edges, "--points", tmp_path / "points.csv",
    )  # fmt: skip
    points = table(tmp_path / "points.csv")
    read = read_items(edges, Edge)
    assert any(edge.edge for edge in read)
    for edge in read:
        mine = [
            p for p in points if (p["signal"], p["model"]) == (edge.signal, edge.model)
        ]
        bad = [p for p in mine if not p["re"] or float(p["re"]) >= 1]
        if not bad:
            assert edge.edge is None
            continue
        assert edge.edge == pytest.approx(float(bad[0]["mu"]), rel=1e-3)
        good = mine[: mine.index(bad[0])]
        assert all(float(p["re"]) < 1 for p in good)

    out = tmp_path / "constants.csv"
    call(
        constants, two[0], "--identified", identified,
        "--settings", json.dumps(job), "--out", out,
    )  # fmt: skip
    ranked = read_items(out, Ranking)
    usual = [row for row in ranked if row.configured]
    assert len(usual) == 1
    assert {row.constant_tap for row in ranked} == {0.0, 1.0}
    assert all(0 <= row.gpo_first <= len(SIGNALS) for row in ranked)
    pairs = (usual[0].pairs_calibrated, usual[0].pairs_held_out)
    assert sum(int(each.partition(" of ")[2]) for each in pairs) == 6 * len(SIGNALS)

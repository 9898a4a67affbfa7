"""One record in a steady state and one from rest: each begins as it does."""

import csv
from dataclasses import replace

import numpy as np
import pytest
from scipy.signal import lsim

from hystbench.blocks.mechanism import Mechanism
from hystbench.blocks.sensor_lag import SensorLag
from hystbench.blocks.simulated_column import SimulatedColumn
from hystbench.blocks.starts import possible_starts
from hystbench.gap.bases.lead import begun_beside
from hystbench.gap.bases.output_error import OutputError
from hystbench.gap.bases.spectral import Ratio
from hystbench.gap.fitting.score import Score
from hystbench.gap.inside.one_coordinate import best_host, one_coordinate
from hystbench.gap.records.evidence import Evidence
from hystbench.gap.records.scored_samples import ScoredSamples
from hystbench.gap.simulation.simulation import Simulation
from hystbench.model import Model
from hystbench.quantities import Quantities
from hystbench.record import Channel, Record
from tests.gap.closing import close_gap
from tests.gap.made import CURRENT, DISPLACEMENT, play_sum, record
from tests.gap.searched import among
from tests.gap.small import block

DT, COUNT, NOISE = 0.01, 800, 1e-3
LAW = ([1.0], [1.0, 2.0, 25.0])
"""It rings for a good part of a record, and no longer than one."""
CHANNELS = Channel("force", "N"), Channel("position", "m")
MASS = Mechanism(
    mass=1.0, damping=2.0, stiffness=25.0, hold="linear", start="repeating"
)
MASKS = [np.ones(COUNT, dtype=bool)] * 2


@pytest.fixture(scope="module")
def records():
    random, time = np.random.default_rng(4), np.arange(4 * COUNT) * DT
    turns = 2 * np.pi * np.arange(1, 25) / (COUNT * DT)
    steady = np.sin(np.outer(time, turns) + random.uniform(0, 6, 24)).sum(axis=1)
    stepped = np.repeat(random.uniform(-3, 3, COUNT // 40), 40)
    stepped[:40] = 0.0
    last = slice(3 * COUNT, None)  # the transient has died out
    found = []
    for u, part, period in ((steady, last, COUNT), (stepped, slice(None), None)):
        _, y, _ = lsim(LAW, u, np.arange(len(u)) * DT)
        y = y[part] + NOISE * random.standard_normal(COUNT)
        about = {"origin": "measured", "period_samples": period}
        found.append(Record(f"run-{period}", DT, u[part], y, *CHANNELS, **about))
    return tuple(found)


def test_one_record_that_repeats_is_enough_for_that_start(records):
    assert possible_starts(records)[-1] == "repeating"
    assert "repeating" not in possible_starts(records[1:])


def test_a_ratio_leaves_noise_of_both_and_knows_how_it_changes(records):
    exact = Ratio(np.array([25.0, 2.0]), np.array([1.0]), 0.0, 0.0)
    task = OutputError(records, "linear", 1.0, "repeating")
    squares = task.squares(exact, MASKS)
    assert squares == pytest.approx(2 * COUNT * NOISE**2, rel=0.2)
    for start in ("rest", "settled"):
        assert replace(task, start=start).squares(exact, MASKS) > 10 * squares
    off = Ratio(exact.a * 1.05, exact.b * 0.9, 0.0, 0.0)
    refined = task.refined(off, MASKS, 20)
    assert refined.a == pytest.approx(exact.a, rel=0.01)


def test_a_mass_is_found_in_both(records):
    score = Score.plain(ScoredSamples.of(records), NOISE**2)
    begun = one_coordinate(records, Quantities("force", "position"), "linear")
    found = best_host(list(begun), score).state
    assert found.chain[0].start == "repeating"
    assert found.chain[0].stiffness == pytest.approx(25.0, rel=0.01)
    assert np.sqrt(np.mean(found.residual**2)) < 1.2 * NOISE


def test_motions_near_are_those_of_whole_simulations(records):
    other = replace(MASS, stiffness=25.0 * (1 + 1e-6))
    near = Simulation((MASS,), records, "linear").near([(other,)])
    first, second = (Simulation((x,), records).output for x in (MASS, other))
    for found, one, changed in zip(near, first, second, strict=True):
        assert found[:, 0] == pytest.approx(one, abs=1e-12)
        slope = changed - one
        assert np.linalg.norm(slope) > 0
        assert np.linalg.norm(found[:, 1] - changed) < 1e-4 * np.linalg.norm(slope)


def test_blocks_of_quick_steps_are_made_once(records):
    chain = (SensorLag(time_constant_s=0.1, hold="band-limited"),)
    quick = Simulation(chain, records, "band-limited", "quick")
    (first,), (second,) = quick._steps(chain), quick._steps(chain)
    assert first.hold == "linear"
    assert first is second


THRESHOLDS, WEIGHTS = [0.0, 0.3, 0.8], [1.0, 0.8, 0.6]
LAG_S, ROUGH = 2.5e-3, 0.02
# The first of the operators is the signal itself.
PLAYS = block("prandtl-ishlinskii", thresholds=THRESHOLDS[1:], weights=WEIGHTS[1:])


@pytest.fixture(scope="module")
def loops():
    """Loops behind a lag of the drive: one from rest, others cut out of a motion."""
    random, found = np.random.default_rng(4), []
    lag = block("drive-lag", time_constant_s=LAG_S)
    begun = (("slow", 800, 0, "fit"), ("fast", 80, 1, "fit"), ("held", 160, 2, ""))
    for name, period, cut, use in begun:
        turns = 2 * np.pi * np.arange(1, 5) / period
        u = np.sin(np.outer(np.arange(800 + cut * period), turns)) @ AMPLITUDES
        y = play_sum(lag.simulate(u, u, 1e-3), THRESHOLDS, WEIGHTS)
        y += ROUGH * random.standard_normal(len(u))
        kept = slice(cut * period, None)
        about = {"name": name, "period_samples": period, "use": use or "hold-out"}
        found.append(record(u[kept], y[kept], **about))
    return Evidence("made", tuple(found[:2]), (found[2],))


AMPLITUDES = 1.2 / np.arange(1, 5)


def test_a_lag_shows_beside_a_loop_that_was_moving_before(loops, tmp_path):
    base = Model("plays", CURRENT, DISPLACEMENT, (PLAYS,))
    alike = among("drive-lag", "sensor-lag", "hysteresis-shape", "drift")
    found = close_gap(loops, base, tmp_path, report=False, vocabulary=alike)
    assert [item["name"] for item in found.outcome.content["effects"]] == ["drive-lag"]
    (held,) = loops.hold_out
    with (tmp_path / "holdout" / "held.csv").open(newline="") as stream:
        rows = list(csv.DictReader(stream))
    assert [float(x["time_s"]) for x in rows] == pytest.approx(held.time)
    assert [float(x["measured"]) for x in rows] == pytest.approx(held.y)
    after = np.array([float(x["after"]) for x in rows])
    assert np.std(held.y - after) < 2 * ROUGH


@pytest.mark.parametrize("periods", [2, 3])
def test_all_records_may_be_cut_out_of_a_motion(loops, tmp_path, periods):
    first = slice(periods * 80)
    fit = [
        replace(record(x.u[first], x.y[first], name=name), period_samples=80)
        for name, x in (("a", loops.fit[1]), ("b", loops.fit[1]))
    ]
    lone = Evidence("made", tuple(fit), loops.hold_out)
    base = Model("plays", CURRENT, DISPLACEMENT, (PLAYS,))
    alike = among("drive-lag", "sensor-lag")
    found = close_gap(lone, base, tmp_path, report=False, vocabulary=alike)
    assert "lag" in found.outcome.content["effects"][0]["name"]
    assert np.isfinite(found.outcome.content["black_box"]["explained_on_folds"])


def test_a_column_of_a_simulator_begins_where_the_record_does(loops):
    columns = [replace(x, simulated=PLAYS.simulate(x.u, x.u, x.dt)) for x in loops.fit]
    chain = (SimulatedColumn(column="simulated", records=tuple(columns)),)
    base = Model("column", CURRENT, DISPLACEMENT, chain)
    assert begun_beside(base, loops.fit) is loops.fit

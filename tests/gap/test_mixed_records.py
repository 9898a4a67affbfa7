"""One record in a steady state and one from rest: each begins as it does."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.signal import lsim

from hystbench.blocks.mechanism import Mechanism
from hystbench.blocks.sensor_lag import SensorLag
from hystbench.blocks.starts import possible_starts
from hystbench.gap.bases.output_error import OutputError
from hystbench.gap.bases.spectral import Ratio
from hystbench.gap.fitting.score import Score
from hystbench.gap.inside.one_coordinate import best_host, one_coordinate
from hystbench.gap.records.scored_samples import ScoredSamples
from hystbench.gap.simulation.simulation import Simulation
from hystbench.quantities import Quantities
from hystbench.record import Channel, Record

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

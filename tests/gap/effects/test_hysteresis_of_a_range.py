"""Play operators of an input that keeps away from zero, as a temperature does."""

import numpy as np
import pytest

from hystbench.blocks.gain import Gain
from hystbench.gap.effects import effects
from hystbench.gap.effects.effect import Declined
from hystbench.gap.simulation.simulation import Simulation
from hystbench.record import Channel, Record

CHANNELS = Channel("temperature", "degC"), Channel("length", "mm")
LOW, HIGH = 20.0, 100.0


@pytest.fixture
def variants():
    """Give both laws of plays as an input between 20 and 100 has them."""
    simulation, u = moved()
    weights = {f"weight {k}": 0.05 for k in range(8)}
    return [
        (x.build(weights)[x.positions[0]], u)
        for x in effects()["hysteresis"].variants(simulation)
        if "plays" in x.form
    ]


def moved():
    """Give a chain on such an input, and the input."""
    u = np.tile(np.concatenate([np.arange(LOW, HIGH), np.arange(HIGH, LOW, -1)]), 2)
    record = Record("run", 0.1, u, u, *CHANNELS, "measured")
    return Simulation((Gain(value=1.0),), (record,)), u


def test_every_play_moves_both_ways(variants):
    for block, u in variants:
        assert max(block.thresholds) < (HIGH - LOW) / 2
        back = block.simulate(u, u, 0.1)[160:]
        assert np.ptp(back) > (HIGH - LOW) / 2


def test_generalized_plays_begin_with_a_slope_of_one_in_the_middle(variants):
    block, _ = next(pair for pair in variants if pair[0].name == "hysteresis")
    a0, a1, a2, a3 = block.envelope[:4]
    middle = (LOW + HIGH) / 2
    assert a0 * np.tanh(a1 * middle + a2) + a3 == pytest.approx(middle)
    assert a0 * a1 / np.cosh(a1 * middle + a2) ** 2 == pytest.approx(1.0)


def test_a_loop_of_bouc_and_wen_yields_within_the_range():
    simulation, _ = moved()
    (found,) = (
        x for x in effects()["hysteresis"].variants(simulation) if x.form == "Bouc-Wen"
    )
    nearest, farthest = found.ends("yield_distance")
    half = (HIGH - LOW) / 2
    assert nearest < found.grids["yield_distance"].min() < half
    assert half < found.grids["yield_distance"].max() < farthest


def test_an_input_that_rests_shows_no_hysteresis():
    u = np.full(50, LOW)
    record = Record("run", 0.1, u, u, *CHANNELS, "measured")
    simulation = Simulation((Gain(value=1.0),), (record,))
    with pytest.raises(Declined, match="does not move"):
        list(effects()["hysteresis"].variants(simulation))

"""The derivatives of a ratio's output are those of what it simulates."""

import numpy as np
import pytest

from hystbench.blocks.starts import STARTS
from hystbench.gap.bases.orders import with_plainest_start
from hystbench.gap.bases.output_error import OutputError
from hystbench.gap.bases.spectral import Ratio
from tests.gap.made import record

# Poles at 0.003, 0.4 and 5 rad/s: the slowest outlasts the record a dozen times.
SLOW = Ratio(
    np.poly([-0.003, -0.4, -5.0])[:0:-1], np.array([1.0, 0.3, 0.02, 0.1]), 0.5, 0.0
)


@pytest.mark.parametrize("start", STARTS)
@pytest.mark.parametrize("hold", ["zero-order", "linear", "band-limited"])
@pytest.mark.parametrize("period", [None, 300])
def test_derivatives_are_those_of_the_simulation(start, hold, period):
    t = 0.1 * np.arange(300)
    u = 1.0 + np.sin(0.7 * t) + 0.5 * np.cos(2.1 * t)
    given = record(u, dt=0.1, period_samples=period)
    task = OutputError((given,), hold, 1.0, start)
    for ratio in (SLOW, Ratio(SLOW.a, SLOW.b[:2], 0.5, 0.0)):
        numbers = np.concatenate([ratio.a, ratio.b, [ratio.offset]])

        def simulated(numbers):
            a, b = numbers[:3], numbers[3:-1]
            return task.simulate(Ratio(a, b, numbers[-1], 0.0))[0]

        steps = 1e-5 * np.diag(numbers)
        expected = np.column_stack(
            [
                (simulated(numbers + step) - simulated(numbers - step)) / 2 / sum(step)
                for step in steps
            ]
        )
        found = task._derivatives(ratio, given)
        assert found == pytest.approx(
            expected, rel=1e-5, abs=1e-6 * abs(expected).max()
        )


def test_a_ratio_whose_derivatives_run_away_is_left_as_it_is(monkeypatch):
    """As of a pole that is faster than numbers hold."""
    t = 0.1 * np.arange(300)
    task = OutputError((record(np.sin(0.7 * t), dt=0.1),), "linear", 1.0, "rest")
    masks = [np.ones(300, dtype=bool)]
    assert task.refined(SLOW, masks, 5).cost < task.squares(SLOW, masks)

    def run_away(*_):
        return np.full((300, 8), 1e300) * np.linspace(1, 1e10, 300)[:, None]

    monkeypatch.setattr(OutputError, "_derivatives", run_away)
    found = task.refined(SLOW, masks, 5)
    assert (found.a == SLOW.a).all()
    assert (found.b == SLOW.b).all()


def test_a_ratio_that_no_block_takes_costs_without_bound():
    """Slow poles are unstable by rounding: as of a drive that turns freely."""
    t = 0.1 * np.arange(300)
    task = OutputError((record(np.sin(0.7 * t), dt=0.1),), "linear", 1.0, "rest")
    masks = [np.ones(300, dtype=bool)]
    poles = [1e-6 + 1e-3j, 1e-6 - 1e-3j, -5.0]
    ratio = Ratio(np.poly(poles).real[:0:-1], np.array([1.0]), 0.0, 0.0)
    assert task.squares(ratio, masks) == np.inf
    found = task.refined(ratio, masks, 5)
    assert (found.a == ratio.a).all()
    assert found.cost == np.inf


def test_a_ratio_that_runs_away_costs_without_bound(monkeypatch):
    """The difference of two numbers beyond all is none; it still is a cost."""
    task = OutputError((record(np.sin(0.07 * np.arange(300)), dt=0.1),), "linear", 1.0)
    left = [np.full(300, np.nan)]
    monkeypatch.setattr(OutputError, "left", lambda *_: left)
    masks = [np.ones(300, dtype=bool)]
    assert task.squares(SLOW, masks) == np.inf
    with_plainest_start(task, SLOW)


@pytest.mark.parametrize(("swing", "seen"), [(31.0, True), (32.0, False)])
def test_poles_that_swing_faster_than_samples_show_cost_without_bound(swing, seen):
    """Half of the sampling frequency is 31.4 rad/s."""
    t = 0.1 * np.arange(300)
    task = OutputError((record(np.sin(0.7 * t), dt=0.1),), "linear", 1.0, "rest")
    poles = [-1.0 + 1j * swing, -1.0 - 1j * swing, -5.0]
    ratio = Ratio(np.poly(poles).real[:0:-1], np.array([1.0]), 0.0, 0.0)
    assert np.isfinite(task.squares(ratio, [np.ones(300, dtype=bool)])) == seen

"""The map over the input and its rate, against what was put in."""

import numpy as np
import pytest

from hystbench.gap.compared import Compared
from hystbench.gap.floor import noise_floor
from hystbench.gap.locate.plane import COLUMNS, FEWEST, over_plane, rate_edges
from hystbench.gap.locate.samples import take_samples
from tests.gap.examples import DT, inputs, straight
from tests.gap.made import record


def plane_of(residual):
    """The map where the measurement is off by a function of input and rate."""
    compared = []
    for name, u, _ in inputs():
        rate = np.gradient(u, DT)
        y = straight(u) + residual(u, rate)
        noise = 0.01 * np.random.default_rng(len(compared)).standard_normal(len(u))
        one = record(u, y + noise, name=name, dt=DT)
        compared.append(Compared(one, straight(u)))
    samples = take_samples(compared, noise_floor(compared, 0.01))
    return over_plane(samples), samples


def centres(edges):
    return 0.5 * (np.array(edges[1:]) + np.array(edges[:-1]))


def test_cells_hold_the_mean_of_what_depends_on_both():
    """A product of amplitude and sign of the rate: zero over either alone."""
    found, _ = plane_of(lambda u, rate: 0.5 * u * np.sign(rate))
    values = np.array(found["mean"], dtype=float)
    u, rate = centres(found["input"]), centres(found["rate"])
    wanted = 0.5 * np.outer(np.sign(rate), u)
    there = np.isfinite(values)
    assert there.mean() > 0.5
    width = found["input"][1] - found["input"][0]
    assert np.abs(values - wanted)[there].max() < 0.5 * 0.5 * width + 0.01
    assert found["share"] > 0.9


def test_what_depends_on_neither_is_not_held():
    hum = iter(np.random.default_rng(3).standard_normal((50, 4000)))
    found, _ = plane_of(lambda u, rate: 0.3 * next(hum)[: len(u)])
    assert found["share"] < 0.05


def test_edges_are_alike_for_both_signs_and_hold_equally_many():
    speed = np.random.default_rng(0).standard_normal(60_000) ** 3
    edges = rate_edges(speed)
    assert edges == pytest.approx(-edges[::-1])
    held, _ = np.histogram(np.abs(speed), edges[len(edges) // 2 :])
    assert held == pytest.approx(np.full(6, 10_000), abs=2)


def test_cells_of_few_samples_hold_nothing():
    found, samples = plane_of(lambda u, rate: 0.5 * u)
    u, speed = samples.input, samples.speed
    for row, low in enumerate(found["rate"][:-1]):
        high = found["rate"][row + 1]
        for column in range(COLUMNS):
            left, right = found["input"][column : column + 2]
            # What stands on an edge may be in either of two cells.
            wide = (u >= left) & (u <= right) & (speed >= low) & (speed <= high)
            tight = (u > left) & (u < right) & (speed > low) & (speed < high)
            if np.sum(wide) < FEWEST:
                assert found["mean"][row][column] is None
            if np.sum(tight) >= FEWEST:
                assert found["mean"][row][column] is not None


def test_an_input_that_never_moves_has_no_map():
    one = record(np.zeros(500), np.random.default_rng(0).standard_normal(500), dt=DT)
    compared = [Compared(one, np.zeros(500))]
    assert over_plane(take_samples(compared, noise_floor(compared, 0.5))) is None

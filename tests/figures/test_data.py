"""What figures draw of a long record keeps its periods, ends and extremes."""

import numpy as np
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from hystbench.figures.data import last_cycles, last_seconds
from hystbench.figures.style import thin
from hystbench.record import Channel, Record


def a_record(u, dt=1e-3):
    return Record("a", dt, u, u.copy(), Channel("u", "A"), Channel("y", "um"), "twin")


@given(
    period=st.integers(20, 400),
    cycles=st.integers(1, 3),
    phase=st.floats(0, 6.28),
    mean=st.floats(-5, 5),
    seed=st.integers(0, 99),
)
def test_last_cycles_of_a_noisy_sine_are_its_periods(period, cycles, phase, mean, seed):
    noise = np.random.default_rng(seed).uniform(-0.01, 0.01, 6 * period)
    k = np.arange(6 * period)
    part = last_cycles(
        a_record(mean + np.sin(2 * np.pi * k / period + phase) + noise), cycles
    )
    # Noise moves a crossing by a few samples at the most.
    assert abs((part.stop - 1 - part.start) - cycles * period) <= 1 + period // 50
    assert 6 * period - part.stop < period * 1.2


def test_last_cycles_take_all_where_there_are_fewer():
    u = np.sin(2 * np.pi * np.arange(150) / 100)
    assert last_cycles(a_record(u), 3) == slice(0, 150)


@given(seconds=st.floats(0.001, 3))
def test_last_seconds_end_with_the_record(seconds):
    record = a_record(np.sin(np.arange(1000.0)))
    part = last_seconds(record, seconds)
    time = record.time[part]
    assert time[-1] == record.time[-1]
    assert abs((time[-1] - time[0]) - min(seconds, record.time[-1])) <= record.dt


@given(
    values=arrays(float, st.integers(1, 500), elements=st.floats(-1e6, 1e6)),
    bins=st.integers(1, 60),
)
def test_thin_keeps_order_ends_and_every_extreme(values, bins):
    x = np.arange(len(values), dtype=float)
    kept, y = thin(x, values, bins)
    assert (np.diff(kept) > 0).all()
    np.testing.assert_array_equal(y, values[kept.astype(int)])
    assert (kept[0], kept[-1]) == (x[0], x[-1])
    assert (y.min(), y.max()) == (values.min(), values.max())
    assert len(kept) <= max(2 * bins + 2, 0) or len(values) <= 2 * bins


def test_thin_leaves_short_lines_alone():
    x = np.arange(10.0)
    assert thin(x, x, 5)[0] is x

"""What reshaping the hysteresis could do: a basis, and what it holds."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from hystbench.gap.simulation.reshape import (
    OPERATORS,
    WEAKEST,
    orthonormal,
    reshapings,
)
from tests.gap.examples import plain_play
from tests.gap.small import chains, records, state_of


@given(st.integers(0, 2**32 - 1), st.integers(1, 8), st.floats(-8, 8))
def test_the_basis_is_orthonormal_and_holds_the_columns(seed, count, size):
    rng = np.random.default_rng(seed)
    columns = rng.standard_normal((60, count)) * 10.0**size
    columns = np.column_stack(
        [
            columns,
            columns[:, :1] * 3.0,
            columns[:, 0] + 1e-9 * columns[:, -1],
            np.zeros(60),
            np.full(60, np.nan),
        ]
    )
    basis = orthonormal(columns)
    assert basis.T @ basis == pytest.approx(np.eye(basis.shape[1]), abs=1e-10)
    assert basis.shape[1] <= count
    usable = columns[:, : count + 2] / np.linalg.norm(columns[:, : count + 2], axis=0)
    outside = usable - basis @ (basis.T @ usable)
    # Dropped: what is weaker than WEAKEST of the strongest, whose square is at most
    # the number of columns.
    limit = WEAKEST * np.sqrt(count + 2) + 1e-9
    assert np.linalg.norm(outside, axis=0).max() < limit


def left_over(basis, signals, sample):
    """RMS of what the basis does not hold, and of the whole."""
    values = sample.take(signals)
    rest = values - basis @ (basis.T @ values)
    return np.sqrt(np.mean(rest**2)), np.sqrt(np.mean(values**2))


@pytest.fixture(scope="module")
def state():
    return state_of(chains()["hysteresis"], count=600)


@pytest.fixture(scope="module")
def basis(state):
    return orthonormal(reshapings(state.simulation, state.sample))


@pytest.mark.parametrize("share", [0.07, 0.2, 0.41, 0.66])
def test_a_play_operator_of_any_threshold_lies_inside(state, basis, share):
    """A play operator moves by no more than its threshold does.

    Between two neighbours an interpolation is off by half of their distance at most:
    A / (OPERATORS + 1) / 2, whatever the input.
    """
    amplitude = max(np.abs(one.u).max() for one in records())
    plays = [plain_play(one.u, share * amplitude) for one in records()]
    rest, whole = left_over(basis, plays, state.sample)
    assert rest < amplitude / (OPERATORS + 1) / 2
    assert rest < 0.1 * whole


def test_a_static_curve_of_the_input_lies_inside(state, basis):
    curves = [np.tanh(1.5 * one.u) for one in records()]
    rest, whole = left_over(basis, curves, state.sample)
    assert rest < 0.03 * whole


def forgets(u, way):
    """Dahl's and Duhem's simplest loop, in many small steps along the way."""
    h, found = 0.0, []
    for step in np.diff(u, prepend=0.0):
        for _ in range(50):
            h += step / 50 - abs(step) / 50 * h / way
        found.append(h)
    return np.array(found)


@pytest.mark.parametrize("share", [0.1, 0.25, 0.6])
def test_a_loop_whose_small_loops_do_not_close_lies_inside(state, basis, share):
    amplitude = max(np.abs(one.u).max() for one in records())
    loops = [forgets(one.u, share * amplitude) for one in records()]
    rest, whole = left_over(basis, loops, state.sample)
    assert rest < 0.01 * whole


@pytest.mark.parametrize("kind", ["delay", "tone", "ramp"])
def test_what_is_no_hysteresis_lies_outside(state, basis, kind):
    signals = {
        "delay": [np.gradient(one.u, one.dt) for one in records()],
        "tone": [np.sin(2 * np.pi * 50 * one.time) for one in records()],
        "ramp": [one.time - one.time[-1] / 2 for one in records()],
    }[kind]
    rest, whole = left_over(basis, signals, state.sample)
    assert rest > 0.3 * whole


def test_reshaping_passes_the_blocks_behind():
    """Behind a mode the span is that of the bare hysteresis, sent through the mode."""
    state = state_of(chains()["hysteresis and mode"], count=600)
    basis = orthonormal(reshapings(state.simulation, state.sample))
    plays = [plain_play(one.u, 0.2) for one in records()]
    sent = state.simulation.run(state.chain[1:], tuple(plays))
    through, whole = left_over(basis, sent, state.sample)
    around, _ = left_over(basis, plays, state.sample)
    assert through < 0.1 * whole
    assert through < around


def test_without_a_hysteresis_nothing_can_be_of_a_wrong_shape():
    state = state_of(chains()["gain and mode"])
    basis = orthonormal(reshapings(state.simulation, state.sample))
    assert basis.shape == (len(state.sample), 0)

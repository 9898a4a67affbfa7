"""What the build must keep: no assumption that numbers are finite, no flush to zero."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from hystbench import kernels
from hystbench.envelope import Envelope
from hystbench.errors import InputError
from hystbench.libraries import Loops
from hystbench.operators import generalized_play, state_space


def lms(x, d, step, limit):
    rows = np.zeros((len(x), kernels.WIDTH))
    rows[:, 0] = x
    weights, y, e = np.zeros(kernels.WIDTH), np.zeros(len(x)), np.zeros(len(x))
    steps = kernels.pad(np.array([step]))
    taken = kernels.call(
        "hb_lms_rows", len(x), 1, rows, kernels.WIDTH, np.asarray(d), steps,
        limit, weights, y, e,
    )  # fmt: skip
    return taken, weights


def test_a_nan_error_ends_the_loop():
    # the first correction overflows to infinity, which times zero is NaN
    taken, _ = lms([1e200, 0.0, 1.0], [1e200, 0.0, 0.0], 1e300, np.inf)
    assert taken == 1


def test_an_infinite_error_ends_the_loop():
    taken, _ = lms([1e200, 1.0, 1.0], [1e200, 0.0, 0.0], 1e300, 1e300)
    assert taken == 1


def test_an_error_at_the_limit_goes_on():
    # the errors are 4 and 4 - 4 * 8 = -28
    assert lms([1.0, 8.0], [4.0, 4.0], 1.0, 28.0)[0] == 2
    assert lms([1.0, 8.0], [4.0, 4.0], 1.0, 27.9)[0] == 1


def test_denormals_are_not_flushed():
    tiny = 2.0**-1060  # half of it is still a number, if a denormal one
    _, weights = lms([1.0], [tiny], 0.5, 1.0)
    assert weights[0] == tiny / 2
    y = state_space([[0.5]], [1.0], [1.0], 0.0, [tiny, 0, 0])
    assert list(y) == [0, tiny, tiny / 2]


def test_denormals_are_not_flushed_in_the_rest_of_the_process():
    # a library linked with fast math sets the whole process to flush them
    assert np.float64(2.0**-1060) / 2 == 2.0**-1061


def test_infinite_envelopes_do_not_move_an_operator():
    outputs = generalized_play([np.inf, 1.0], [-np.inf, 1.0], [0.0, 0.5], [3.0, 3.0])
    np.testing.assert_array_equal(outputs, [[3.0, 3.0], [1.0, 1.5]])


def test_same_bytes_at_any_alignment():
    rng = np.random.default_rng(1)
    n = 500
    x, d = rng.standard_normal((2, n))
    seen = set()
    for shift in range(8):
        space = np.zeros(n + 40)
        rows = space[shift : shift + n + 32]
        rows[32:] = x
        weights = np.zeros(40)[shift : shift + 32]
        y, e = np.empty((2, n))
        kernels.call(
            "hb_lms_rows", n, 4, rows[1:], 1, d, np.full(32, 0.01), 1e9,
            weights, y, e,
        )  # fmt: skip
        seen.add(y.tobytes() + weights.tobytes())
    assert len(seen) == 1


def test_a_missing_library_says_how_to_build_it(tmp_path):
    with pytest.raises(InputError, match="pip install --no-deps") as caught:
        Loops(tmp_path / "_kernels.so", {}, "the compiled kernels")
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize(
    "bad", [np.zeros(4, dtype=np.float32), np.zeros((4, 4))[:, 0], np.zeros(4, int)]
)
def test_arrays_of_another_kind_are_refused(bad):
    with pytest.raises(TypeError, match="float64 in C order"):
        kernels.call("hb_follow_direction", 4, bad, np.zeros(4), np.zeros(4))


@pytest.mark.parametrize(
    ("count", "whole"), [(0, 8), (1, 8), (8, 8), (9, 16), (31, 32)]
)
def test_padding_to_whole_vectors(count, whole):
    values = np.arange(1.0, count + 1)
    back, front = kernels.pad(values, -1), kernels.pad_front(values, -1)
    assert len(back) == len(front) == kernels.padded(count) == whole
    np.testing.assert_array_equal(back[:count], values)
    np.testing.assert_array_equal(front[whole - count :], values)
    assert (back[count:] == -1).all()
    assert (front[: whole - count] == -1).all()


finite = st.floats(allow_nan=False, allow_infinity=False)
anywhere = st.integers(0, 99)


@given(arrays(np.float64, st.integers(0, 100), elements=finite))
def test_the_largest_magnitude(values):
    assert kernels.largest(values) == max(map(abs, values), default=0.0)


@given(
    arrays(np.float64, 100, elements=finite),
    anywhere,
    st.sampled_from([np.nan, np.inf, -np.inf]),
)
def test_no_largest_magnitude_where_one_is_not_finite(values, place, bad):
    values[place] = bad
    assert np.isnan(kernels.largest(values))


def test_a_read_only_array_is_taken():
    values = np.array([1.0, -3.0, 2.0])
    values.flags.writeable = False
    assert kernels.largest(values) == 3.0


ANY = st.floats(-1e300, 1e300) | st.floats(-30, 30) | st.floats(-1e-3, 1e-3)


@given(arrays(float, st.integers(1, 70), elements=ANY))
def test_envelope_functions_are_hyperbolic_tangents(v):
    bent = Envelope(1.0, 1.0, 0.0, 0.0, -3.0, 0.5, 0.25, 7.0)
    np.testing.assert_allclose(bent.left(v), np.tanh(v), rtol=5e-16, atol=0)
    wanted = -3 * np.tanh(0.5 * v + 0.25) + 7
    np.testing.assert_allclose(bent.right(v), wanted, rtol=2e-15, atol=0)


def test_envelope_functions_at_the_ends_of_the_numbers():
    tanh = Envelope(1.0, 1.0, 0.0, 0.0, 1.0, 1.0, 0.0, 0.0).left
    v = [np.inf, -np.inf, 0.0, 5e-324, 2.0**-1060, 709.0, -1e308]
    np.testing.assert_array_equal(tanh(v), np.tanh(v))
    # Every place in a vector, not only the first or those behind the last whole one.
    for place in range(11):
        holed = np.where(np.arange(11) == place, np.nan, 0.5)
        assert np.isnan(tanh(holed)).tolist() == np.isnan(holed).tolist()


def test_envelope_functions_take_any_shape():
    bent = Envelope(1.2, 0.4, 0.6, -0.7, 0.3, 1.2, 0.1, 0.0)
    grid = np.linspace(-3, 3, 24).reshape(4, 6)
    for v in (grid, grid.T, grid[:, ::2], grid[::-1], grid.astype(int), 0.3):
        found = bent.left(v)
        assert np.shape(found) == np.shape(v)
        wanted = 1.2 * np.tanh(0.4 * np.asarray(v) + 0.6) - 0.7
        np.testing.assert_allclose(found, wanted, rtol=1e-14)

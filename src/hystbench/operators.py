"""Play operators, generalized play operators and the models made of them.

Equation numbers are those of Zhang and Ma, "Modeling of Rate-Dependent Hysteresis
Using a GPO-Based Adaptive Filter".
"""

from functools import lru_cache
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike

from hystbench import kernels
from hystbench.errors import InputError
from hystbench.record import FloatArray

Form = Literal["eq4", "eq12"]
FORMS: tuple[Form, ...] = ("eq4", "eq12")


def play(
    v: ArrayLike, thresholds: ArrayLike, state: ArrayLike | None = None
) -> FloatArray:
    """Play operators, Eqs. 1 and 2.

    Parameters
    ----------
    v : array_like, shape (n,)
        Input.
    thresholds : array_like, shape (m,)
        Thresholds in the unit of the input, none negative.
    state : array_like, shape (m,), optional
        Outputs before the first sample; zero by default.

    Returns
    -------
    ndarray, shape (n, m)
        Output of each operator at each sample.
    """
    v = _array(v)
    return generalized_play(v, v, thresholds, state)


def generalized_play(
    left: ArrayLike,
    right: ArrayLike,
    thresholds: ArrayLike,
    state: ArrayLike | None = None,
) -> FloatArray:
    """Generalized play operators, Eq. 4: ``max(right - r, min(left + r, w))``.

    Eq. 12 is the same on envelopes that :func:`follow_direction` rewrote.

    Parameters
    ----------
    left, right : array_like, shape (n,)
        Envelope functions of the input.
    thresholds : array_like, shape (m,)
        Thresholds in the unit of the envelopes, none negative.
    state : array_like, shape (m,), optional
        Outputs before the first sample; zero by default.

    Returns
    -------
    ndarray, shape (n, m)
        Output of each operator at each sample.

    Raises
    ------
    InputError
        If shapes differ or a threshold is negative.
    """
    left, right = _envelopes(left, right)
    r = _thresholds(thresholds)
    end = _state(state, len(r))
    outputs = np.empty((len(left), len(r)))
    kernels.call("hb_play", len(left), len(r), left, right, r, end, outputs)
    return outputs


def generalized_prandtl_ishlinskii(
    left: ArrayLike,
    right: ArrayLike,
    thresholds: ArrayLike,
    weights: ArrayLike,
    growth: ArrayLike | None = None,
) -> FloatArray:
    """Generalized Prandtl-Ishlinskii model, Eq. 9: weighted generalized plays.

    From rest. The outputs of the operators are summed as they come and never stored.

    Parameters
    ----------
    left, right, thresholds
        As for :func:`generalized_play`.
    weights : array_like, shape (m,)
        Weight of each operator.
    growth : array_like, shape (n,), optional
        Factor on all thresholds at each sample, none negative; one by default.

    Returns
    -------
    ndarray, shape (n,)
        Output of the model.

    Raises
    ------
    InputError
        As for :func:`generalized_play`, if weights and thresholds differ in number,
        or if a growth is negative.
    """
    left, right = _envelopes(left, right)
    rest = growth is None
    if isinstance(thresholds, tuple) and isinstance(weights, tuple):  # as of a block
        spaced, weighted, size = _known_plays(thresholds, weights, rest)
    else:
        spaced, weighted, size = _plays(thresholds, weights, rest)
    y, sizes = np.empty(len(left)), (len(left), size // kernels.WIDTH)
    if growth is not None:
        grown = (spaced, weighted, _growth(growth, len(left)), y)
        kernels.call("hb_growing_prandtl_ishlinskii", *sizes, left, right, *grown)
        return y
    arrays = (left, right, spaced, weighted, np.zeros(size), y)
    kernels.call("hb_prandtl_ishlinskii", *sizes, *arrays)
    return y


def enveloped_plays(
    v: FloatArray,
    envelope: tuple[float, ...],
    thresholds: tuple[float, ...],
    weights: tuple[float, ...],
) -> FloatArray:
    """Do the same on the envelope functions of an input, which are not stored.

    Parameters
    ----------
    v : ndarray, shape (n,)
    envelope : tuple of float
        The numbers a0 to a7 of Eqs. 5 and 6.
    thresholds, weights : tuple of float

    Returns
    -------
    ndarray, shape (n,)
    """
    spaced, weighted, size = _known_plays(thresholds, weights, True)
    v, y = np.ascontiguousarray(v, dtype=np.float64), np.empty(len(v))
    arrays = (_numbers(envelope), v, spaced, weighted, y)
    kernels.call("hb_enveloped_plays", len(v), size // kernels.WIDTH, *arrays)
    return y


@lru_cache(maxsize=64)
def _numbers(values: tuple[float, ...]) -> kernels.Fixed:
    return kernels.Fixed(_array(values))


def _plays(
    thresholds: ArrayLike, weights: ArrayLike, stand_still: bool
) -> tuple[kernels.Fixed, kernels.Fixed, int]:
    """Give thresholds and weights as the kernels take them, and their number there."""
    r, w = _thresholds(thresholds), _array(weights)
    if w.shape != r.shape:
        raise InputError(f"weights: {w.shape} given, {len(r)} expected")
    # an operator of infinite threshold never leaves zero
    spaced = kernels.pad(r, np.inf if stand_still else 0.0)
    return kernels.Fixed(spaced), kernels.Fixed(kernels.pad(w)), len(spaced)


_known_plays = lru_cache(maxsize=64)(_plays)


def growing_play(
    v: FloatArray, thresholds: ArrayLike, growth: ArrayLike | None
) -> FloatArray:
    """Play operators from rest whose thresholds may grow from sample to sample.

    Parameters
    ----------
    v : ndarray, shape (n,)
        Input.
    thresholds : array_like, shape (m,)
        Thresholds at a growth of one, none negative.
    growth : array_like, shape (n,), or None
        Factor on all thresholds at each sample, none negative; None for one.

    Returns
    -------
    ndarray, shape (n, m)
        Output of each operator at each sample.

    Raises
    ------
    InputError
        If shapes differ, or a threshold or growth is negative.
    """
    if growth is None:
        return play(v, thresholds)
    v, r = _signal("v", v), _thresholds(thresholds)
    factor = _growth(growth, len(v))
    state, outputs = np.zeros(len(r)), np.empty((len(v), len(r)))
    kernels.call("hb_growing_play", len(v), len(r), v, r, factor, state, outputs)
    return outputs


def rate_dependent_prandtl_ishlinskii(
    left: ArrayLike,
    right: ArrayLike,
    spacing: ArrayLike,
    ratio: ArrayLike,
    count: int,
    state: ArrayLike | None = None,
) -> tuple[FloatArray, FloatArray]:
    """Prandtl-Ishlinskii model whose thresholds and weights follow the rate.

    ``y(k) = sum_i ratio(k)^i F_i(k)`` over ``count`` values of i from zero on,
    where operator ``F_i`` has the threshold ``i * spacing(k)`` at sample k and moves
    by Eq. 4. The weights are a geometric series: any scale stands outside.

    Parameters
    ----------
    left, right : array_like, shape (n,)
        Envelope functions of the input.
    spacing : array_like, shape (n,)
        Distance of neighbouring thresholds at each sample, none negative.
    ratio : array_like, shape (n,)
        Ratio of neighbouring weights at each sample.
    count : int
        Number of operators.
    state : array_like, shape (count,), optional
        Outputs before the first sample; zero by default.

    Returns
    -------
    y : ndarray, shape (n,)
        Output of the model.
    state : ndarray, shape (count,)
        Outputs of the operators after the last sample.

    Raises
    ------
    InputError
        If shapes differ, ``count`` is below 1 or a spacing is negative.
    """
    left, right = _envelopes(left, right)
    spacing, ratio = _array(spacing), _array(ratio)
    for name, array in (("spacing", spacing), ("ratio", ratio)):
        if array.shape != left.shape:
            raise InputError(f"{name}: {array.shape} given, {left.shape} expected")
    if not (spacing >= 0).all():
        raise InputError("spacing: a negative or missing value")
    if count < 1:
        raise InputError(f"count: {count} operators, at least 1 expected")
    end = kernels.pad(_state(state, count))
    y = np.empty(len(left))
    number = np.arange(len(end), dtype=np.float64)
    operators = number, kernels.pad(np.ones(count))
    sizes = (len(left), len(end) // kernels.WIDTH)
    rates = (spacing, ratio, end, y)
    kernels.call("hb_rate_dependent", *sizes, *operators, left, right, *rates)
    return y, end[:count].copy()


def state_space(
    a: ArrayLike,
    b: ArrayLike,
    c: ArrayLike,
    d: float,
    u: ArrayLike,
) -> FloatArray:
    """Simulate a discrete linear system with one input and one output, from rest.

    ``x(k+1) = A x(k) + B u(k)``, ``y(k) = C x(k) + D u(k)``. How the input moves
    between samples (zero- or first-order hold) is in the matrices, not here.

    Parameters
    ----------
    a : array_like, shape (s, s)
        System matrix A.
    b, c : array_like, shape (s,)
        Input and output vectors B and C.
    d : float
        Direct feedthrough D.
    u : array_like, shape (n,)
        Input.

    Returns
    -------
    ndarray, shape (n,)
        Output.

    Raises
    ------
    InputError
        If shapes do not fit.
    """
    u = _signal("u", u)
    matrix = np.asarray(a, dtype=np.float64)
    b, c = _array(b).ravel(), _array(c).ravel()
    size = len(b)
    if matrix.shape != (size, size) or c.shape != (size,):
        raise InputError(
            f"state space: A {matrix.shape}, B {b.shape}, C {c.shape} do not fit"
        )
    x = kernels.pad(np.zeros(size))
    columns = np.zeros((len(x), len(x)))
    columns[:size, :size] = matrix.T
    y = np.empty(len(u))
    arrays = (columns, kernels.pad(b), kernels.pad(c))
    sizes = (len(u), len(x) // kernels.WIDTH, size)
    kernels.call("hb_state_space", *sizes, *arrays, float(d), u, x, y)
    return y


def follow_direction(v: FloatArray, left: FloatArray, right: FloatArray) -> None:
    """Rewrite envelopes in place so that Eq. 4 on them is Eq. 12.

    Eq. 12 lets only a rising input reach the right envelope and only a falling one the
    left. The two agree once ``w`` lies in ``[right - r, left + r]``, as long as the
    envelopes do not cross.

    Where the input rises the left envelope goes to infinity, where it falls the right
    one to minus infinity, where it rests both: Eq. 4 then moves the output just as
    Eq. 12 does. The first sample has no direction and stays as it is.
    """
    kernels.call("hb_follow_direction", len(v), v, left, right)


def _array(values: ArrayLike) -> FloatArray:
    return np.asarray(values, dtype=np.float64, order="C")


def _signal(name: str, values: ArrayLike) -> FloatArray:
    array = _array(values)
    if array.ndim != 1:
        raise InputError(f"{name}: {array.ndim} dimensions given, 1 expected")
    return array


def _thresholds(values: ArrayLike) -> FloatArray:
    r = _signal("thresholds", values)
    if not (r >= 0).all():
        raise InputError("thresholds: a negative or missing value")
    return r


def _growth(values: ArrayLike, count: int) -> FloatArray:
    growth = _signal("growth", values)
    if growth.shape != (count,):
        raise InputError(f"growth: {growth.shape} given, ({count},) expected")
    if not (growth >= 0).all():
        raise InputError("growth: a negative or missing value")
    return growth


def _state(values: ArrayLike | None, count: int) -> FloatArray:
    if values is None:
        return np.zeros(count)
    state = np.array(values, dtype=np.float64)
    if state.shape != (count,):
        raise InputError(f"state: {state.shape} given, ({count},) expected")
    return state


def _envelopes(left: ArrayLike, right: ArrayLike) -> tuple[FloatArray, FloatArray]:
    left, right = _signal("left", left), _signal("right", right)
    if left.shape != right.shape:
        raise InputError(f"right: {right.shape} given, {left.shape} expected")
    return left, right

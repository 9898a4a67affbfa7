"""Play operators, generalized play operators and the models made of them.

Equation numbers are those of Zhang and Ma, "Modeling of Rate-Dependent Hysteresis
Using a GPO-Based Adaptive Filter".
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict, dataclass, fields
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike

from hystbench import kernels
from hystbench.errors import InputError, nearest
from hystbench.record import FloatArray

Form = Literal["eq4", "eq12"]
FORMS: tuple[Form, ...] = ("eq4", "eq12")


@dataclass(frozen=True)
class Envelope:
    """Envelope functions of the generalized play operator, Eqs. 5 and 6.

    The left one, ``a0 tanh(a1 v + a2) + a3``, bounds the output from above where
    the input falls; the right one, ``a4 tanh(a5 v + a6) + a7``, from below where it
    rises.

    Parameters
    ----------
    a0, a1, a2, a3 : float
        Left envelope; ``a0`` and ``a3`` in the unit of the output, ``a1`` in 1 per
        unit of the input.
    a4, a5, a6, a7 : float
        Right envelope, likewise.

    Raises
    ------
    InputError
        If a parameter is not finite.
    """

    a0: float
    a1: float
    a2: float
    a3: float
    a4: float
    a5: float
    a6: float
    a7: float

    def __post_init__(self) -> None:
        """Refuse parameters that are not finite."""
        for name, value in asdict(self).items():
            if not np.isfinite(value):
                raise InputError(f"envelope.{name}: {value} is not a finite number")

    def left(self, v: ArrayLike) -> FloatArray:
        """Left envelope, Eq. 5, at each input."""
        return _curve(self.a0, self.a1, self.a2, self.a3, v)

    def right(self, v: ArrayLike) -> FloatArray:
        """Right envelope, Eq. 6, at each input."""
        return _curve(self.a4, self.a5, self.a6, self.a7, v)

    def gap(self, low: float, high: float, points: int = 2001) -> FloatArray:
        """Left minus right envelope on an even grid from ``low`` to ``high``.

        Where it is negative the envelopes have crossed, and Eqs. 4 and 12 part.
        """
        v = np.linspace(low, high, points)
        return self.left(v) - self.right(v)

    def ordered(self, low: float, high: float, points: int = 2001) -> bool:
        """Tell whether the left envelope lies above the right one on a range."""
        return bool((self.gap(low, high, points) > 0).all())

    def crossings(self, low: float, high: float, points: int = 2001) -> list[float]:
        """Inputs between ``low`` and ``high`` where the envelopes cross.

        Found by the changes of sign on an even grid, then by bisection to the
        last bit; two crossings within one step of the grid go unseen.
        """
        v = np.linspace(low, high, points)
        above = self.gap(low, high, points) > 0
        found = []
        for place in np.flatnonzero(above[1:] != above[:-1]):
            start, stop = float(v[place]), float(v[place + 1])
            while start < (middle := 0.5 * (start + stop)) < stop:
                if (self.left(middle) > self.right(middle)) == above[place]:
                    start = middle
                else:
                    stop = middle
            found.append(start)
        return found

    def to_dict(self) -> dict[str, float]:
        """Give the eight parameters by name."""
        return asdict(self)

    @classmethod
    def from_dict(cls, parameters: Mapping[str, float]) -> Envelope:
        """Make an envelope from its eight parameters by name.

        Raises
        ------
        InputError
            If a name is missing or unknown.
        """
        known = [field.name for field in fields(cls)]
        for name in parameters:
            if name not in known:
                raise InputError(f"envelope.{name}: unknown; {nearest(name, known)}")
        for name in known:
            if name not in parameters:
                raise InputError(f"envelope.{name}: missing")
        return cls(**{name: float(parameters[name]) for name in known})


PUBLISHED_ENVELOPE = Envelope(
    a0=1.2878,
    a1=0.36,
    a2=0.6025,
    a3=-0.6671,
    a4=0.3223,
    a5=1.2233,
    a6=0.1104,
    a7=-0.0248,
)
"""What the paper identified at 1 Hz, input in amperes (section 4)."""


def thresholds(envelope: Envelope, amplitude: float, order: int) -> FloatArray:
    """Thresholds of the generalized play operators, Eq. 10.

    Parameters
    ----------
    envelope : Envelope
        Envelope functions.
    amplitude : float
        Largest magnitude of the input.
    order : int
        Order N.

    Returns
    -------
    ndarray, shape (order + 1,)
        ``i / (N + 1) * max(right(amplitude), left(amplitude))``, i from 0 to N.
    """
    largest = max(float(envelope.right(amplitude)), float(envelope.left(amplitude)))
    return _equal_intervals(largest, order)


def fewest_samples(order: int) -> int:
    """Count the samples that N + 1 weights and an envelope's 8 parameters need.

    Twice the weights, so that a filter sees each more than once, and 8 more.
    """
    return 2 * (order + 1) + 8


def play_thresholds(amplitude: float, order: int) -> FloatArray:
    """Thresholds of the play operators: Eq. 10 with the input as its own envelope.

    Parameters
    ----------
    amplitude : float
        Largest magnitude of the input.
    order : int
        Order N.

    Returns
    -------
    ndarray, shape (order + 1,)
        ``i / (N + 1) * amplitude``, i from 0 to N.
    """
    return _equal_intervals(amplitude, order)


def play(
    v: ArrayLike, thresholds: ArrayLike, state: ArrayLike | None = None
) -> tuple[FloatArray, FloatArray]:
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
    outputs : ndarray, shape (n, m)
        Output of each operator at each sample.
    state : ndarray, shape (m,)
        Outputs after the last sample.
    """
    v = _array(v)
    return generalized_play(v, v, thresholds, state)


def generalized_play(
    left: ArrayLike,
    right: ArrayLike,
    thresholds: ArrayLike,
    state: ArrayLike | None = None,
    form: Form = "eq4",
    v: ArrayLike | None = None,
    v_before: float | None = None,
) -> tuple[FloatArray, FloatArray]:
    """Generalized play operators, Eq. 4 or Eq. 12.

    Eq. 4 is ``max(right - r, min(left + r, w))``. Eq. 12 lets only a rising input
    reach the right envelope and only a falling one the left. The two agree once
    ``w`` lies in ``[right - r, left + r]``, as long as the envelopes do not cross.

    Parameters
    ----------
    left, right : array_like, shape (n,)
        Envelope functions of the input.
    thresholds : array_like, shape (m,)
        Thresholds in the unit of the envelopes, none negative.
    state : array_like, shape (m,), optional
        Outputs before the first sample; zero by default.
    form : {"eq4", "eq12"}
        Which equation.
    v : array_like, shape (n,), optional
        Input; Eq. 12 needs it.
    v_before : float, optional
        Input before the first sample, for Eq. 12; the first sample by default,
        which then changes nothing.

    Returns
    -------
    outputs : ndarray, shape (n, m)
        Output of each operator at each sample.
    state : ndarray, shape (m,)
        Outputs after the last sample.

    Raises
    ------
    InputError
        If shapes differ, a threshold is negative or Eq. 12 has no input.
    """
    left, right = _envelopes(left, right, form, v, v_before)
    r = _thresholds(thresholds)
    end = _state(state, len(r))
    outputs = np.empty((len(left), len(r)))
    kernels.call("hb_play", len(left), len(r), left, right, r, end, outputs)
    return outputs, end


def generalized_prandtl_ishlinskii(
    left: ArrayLike,
    right: ArrayLike,
    thresholds: ArrayLike,
    weights: ArrayLike,
    state: ArrayLike | None = None,
    form: Form = "eq4",
    v: ArrayLike | None = None,
    v_before: float | None = None,
) -> tuple[FloatArray, FloatArray]:
    """Generalized Prandtl-Ishlinskii model, Eq. 9: weighted generalized plays.

    The outputs of the operators are summed as they come and never stored.

    Parameters
    ----------
    left, right, thresholds, state, form, v, v_before
        As for :func:`generalized_play`.
    weights : array_like, shape (m,)
        Weight of each operator.

    Returns
    -------
    y : ndarray, shape (n,)
        Output of the model.
    state : ndarray, shape (m,)
        Outputs of the operators after the last sample.

    Raises
    ------
    InputError
        As for :func:`generalized_play`, or if weights and thresholds differ in number.
    """
    left, right = _envelopes(left, right, form, v, v_before)
    r = _thresholds(thresholds)
    w = _array(weights)
    if w.shape != r.shape:
        raise InputError(f"weights: {w.shape} given, {len(r)} expected")
    end = kernels.pad(_state(state, len(r)))
    # an operator of infinite threshold never leaves zero
    spaced = kernels.pad(r, np.inf)
    y = np.empty(len(left))
    vectors = len(end) // kernels.WIDTH
    arrays = (left, right, spaced, kernels.pad(w), end, y)
    kernels.call("hb_prandtl_ishlinskii", len(left), vectors, *arrays)
    return y, end[: len(r)].copy()


def rate_dependent_prandtl_ishlinskii(
    left: ArrayLike,
    right: ArrayLike,
    spacing: ArrayLike,
    ratio: ArrayLike,
    count: int,
    first: Literal[0, 1] = 0,
    state: ArrayLike | None = None,
) -> tuple[FloatArray, FloatArray]:
    """Prandtl-Ishlinskii model whose thresholds and weights follow the rate.

    ``y(k) = sum_i ratio(k)^i F_i(k)`` over ``count`` values of i from ``first`` on,
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
    first : {0, 1}
        The i of the first operator.
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
    left, right = _envelopes(left, right, "eq4", None, None)
    spacing, ratio = _array(spacing), _array(ratio)
    for name, array in (("spacing", spacing), ("ratio", ratio)):
        if array.shape != left.shape:
            raise InputError(f"{name}: {array.shape} given, {left.shape} expected")
    if not (spacing >= 0).all():
        raise InputError("spacing: a negative or missing value")
    if count < 1:
        raise InputError(f"count: {count} operators, at least 1 expected")
    if first not in (0, 1):
        raise InputError(f"first: {first} given, 0 or 1 expected")
    end = kernels.pad(_state(state, count))
    y = np.empty(len(left))
    number = np.arange(first, first + len(end), dtype=np.float64)
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
    x0: ArrayLike | None = None,
) -> tuple[FloatArray, FloatArray]:
    """Simulate a discrete linear system with one input and one output.

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
    x0 : array_like, shape (s,), optional
        State at the first sample; zero by default.

    Returns
    -------
    y : ndarray, shape (n,)
        Output.
    x : ndarray, shape (s,)
        State after the last sample.

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
    x = kernels.pad(_state(x0, size))
    columns = np.zeros((len(x), len(x)))
    columns[:size, :size] = matrix.T
    y = np.empty(len(u))
    arrays = (columns, kernels.pad(b), kernels.pad(c))
    vectors = len(x) // kernels.WIDTH
    kernels.call("hb_state_space", len(u), vectors, *arrays, float(d), u, x, y)
    return y, x[:size].copy()


def follow_direction(v: FloatArray, left: FloatArray, right: FloatArray) -> None:
    """Rewrite envelopes in place so that Eq. 4 on them is Eq. 12.

    Where the input rises the left envelope goes to infinity, where it falls the
    right one to minus infinity, where it rests both: Eq. 4 then moves the output
    just as Eq. 12 does. The first sample has no direction and stays as it is.
    """
    kernels.call("hb_follow_direction", len(v), v, left, right)


def _curve(
    height: float, slope: float, place: float, offset: float, v: ArrayLike
) -> FloatArray:
    # in place: fresh memory for each step would cost more than the tanh
    v = _array(v)
    curve = np.multiply(v, slope, out=np.empty(v.shape))
    curve += place
    np.tanh(curve, out=curve)
    curve *= height
    curve += offset
    return curve


def _array(values: ArrayLike) -> FloatArray:
    return np.asarray(values, dtype=np.float64, order="C")


def _signal(name: str, values: ArrayLike) -> FloatArray:
    array = _array(values)
    if array.ndim != 1:
        raise InputError(f"{name}: {array.ndim} dimensions given, 1 expected")
    return array


def _equal_intervals(largest: float, order: int) -> FloatArray:
    if order < 0:
        raise InputError(f"order: {order} given, 0 or more expected")
    if not 0 < largest < np.inf:
        raise InputError(f"thresholds: the largest would be {largest}; check amplitude")
    return np.arange(order + 1) / (order + 1) * largest


def _thresholds(values: ArrayLike) -> FloatArray:
    r = _signal("thresholds", values)
    if not (r >= 0).all():
        raise InputError("thresholds: a negative or missing value")
    return r


def _state(values: ArrayLike | None, count: int) -> FloatArray:
    if values is None:
        return np.zeros(count)
    state = np.array(values, dtype=np.float64)
    if state.shape != (count,):
        raise InputError(f"state: {state.shape} given, ({count},) expected")
    return state


def _envelopes(
    left: ArrayLike,
    right: ArrayLike,
    form: str,
    v: ArrayLike | None,
    v_before: float | None,
) -> tuple[FloatArray, FloatArray]:
    left, right = _signal("left", left), _signal("right", right)
    if left.shape != right.shape:
        raise InputError(f"right: {right.shape} given, {left.shape} expected")
    if form == "eq4":
        return left, right
    if form != "eq12":
        raise InputError(f"form: {form!r} unknown; {nearest(form, FORMS)}")
    if v is None:
        raise InputError("v: Eq. 12 needs the input for its direction")
    v = _signal("v", v)
    if v.shape != left.shape:
        raise InputError(f"v: {v.shape} given, {left.shape} expected")
    first = v[:1] if v_before is None else [v_before]
    # one sample more in front, so that the first one has a direction
    long_v = np.concatenate((first, v))
    long_left = np.concatenate((left[:1], left))
    long_right = np.concatenate((right[:1], right))
    follow_direction(long_v, long_left, long_right)
    return long_left[1:], long_right[1:]

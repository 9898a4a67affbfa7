"""Linear blocks: continuous-time state space, discretised for a stated input hold."""

from __future__ import annotations

from abc import abstractmethod
from dataclasses import dataclass
from functools import lru_cache
from typing import NamedTuple, cast

import numpy as np

from hystbench import operators
from hystbench.blocks.band_limited import ComplexArray, sine_series
from hystbench.blocks.held import HeldBlock, Hold
from hystbench.blocks.step import Sampling, Step, smooth_curve, through_samples
from hystbench.record import FloatArray


class StateSpace(NamedTuple):
    """Matrices of ``dx/dt = A x + B v``, ``y = C x + D v``, one input, one output."""

    a: FloatArray  # shape (m, m)
    b: FloatArray  # shape (m,)
    c: FloatArray  # shape (m,)
    d: float

    @property
    def is_diagonal(self) -> bool:
        """Whether the states are modes, each by itself."""
        return not (self.a - np.diag(np.diag(self.a))).any()


@dataclass(frozen=True)
class LinearBlock(HeldBlock):
    """A linear, time-invariant block that starts at rest.

    A subclass defines :meth:`continuous`.
    """

    @abstractmethod
    def continuous(self) -> StateSpace:
        """Return the block in continuous time."""

    def simulate(self, z: FloatArray, u: FloatArray, dt: float) -> FloatArray:
        """Compute the response to ``z`` from rest."""
        return respond(self.continuous(), z, dt, self.holding)

    def step(self, sampling: Sampling) -> Step:
        """Move the state over the interval that has passed."""
        return linear_step(self.continuous(), sampling, self.holding)

    def frequency_response(self, frequency_hz: FloatArray) -> ComplexArray:
        """Evaluate ``C (jwI - A)^-1 B + D`` of the block in continuous time.

        Parameters
        ----------
        frequency_hz : ndarray, shape (n,)

        Returns
        -------
        ndarray of complex, shape (n,)
        """
        system = self.continuous()
        output, _ = _sines(system, frequency_hz, np.zeros(len(frequency_hz)))
        return output


def lag(time_constant_s: float) -> StateSpace:
    """First-order lag of static gain one, with its output as the state."""
    rate = 1.0 / time_constant_s
    return StateSpace(np.array([[-rate]]), np.array([rate]), np.array([1.0]), 0.0)


def low_pass(
    v: FloatArray, dt: float, time_constant_s: float, start: float = 0.0
) -> FloatArray:
    """Send a signal that moves straight between samples through a first-order lag.

    Parameters
    ----------
    v : ndarray, shape (n,)
    dt, time_constant_s : float
        In seconds.
    start : float
        Where signal and lag have rested before.

    Returns
    -------
    ndarray, shape (n,)
    """
    return start + respond(lag(time_constant_s), v - start, dt, "linear")


def respond(system: StateSpace, v: FloatArray, dt: float, hold: Hold) -> FloatArray:
    """Compute the response of a linear system from rest.

    The result is exact for the input that the hold describes: a staircase
    (``zero-order``), straight lines between samples (``linear``), or the
    band-limited signal through the samples (``band-limited``) as
    :func:`~hystbench.blocks.band_limited.sine_series` finds it.

    Parameters
    ----------
    system : StateSpace
    v : ndarray, shape (n,)
        Sampled input.
    dt : float
        Sampling interval in seconds.
    hold : {"zero-order", "linear", "band-limited"}

    Returns
    -------
    ndarray, shape (n,)
    """
    if hold != "band-limited" or len(v) < 3:
        return _step_by_step(system, v, dt, hold, np.zeros(len(system.b)))
    # The sines as if they always had been, and what their not having been costs:
    # a free motion from the opposite of the state that they would have at the start.
    series = sine_series(v)
    response, state = _sines(system, series.frequency_hz(dt), series.amplitudes())
    line = series.line(len(v))
    free = _step_by_step(system, line, dt, "linear", -state)
    return free + series.sines(len(v), response)


def discretise(
    system: StateSpace, dt: float, hold: Hold
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Integrate the state equation over one sampling interval.

    Returns ``phi``, ``now``, ``following`` of ``x(k+1) = phi x(k) + now v(k) +
    following v(k+1)``, by one matrix exponential [1]_.

    References
    ----------
    .. [1] C. F. Van Loan, "Computing integrals involving the matrix exponential",
       IEEE Transactions on Automatic Control 23 (1978) 395-404.
    """
    from scipy.linalg import expm  # late: a filter's process never needs it

    m = len(system.b)
    augmented = np.zeros((m + 2, m + 2))
    augmented[:m, :m] = system.a * dt
    augmented[:m, m] = system.b * dt
    augmented[m, m + 1] = 1.0
    # A fit may try what runs away within an interval: NaN, as of all that runs away.
    with np.errstate(over="ignore", invalid="ignore"):
        exponential = expm(augmented)
    phi = np.ascontiguousarray(exponential[:m, :m])
    step, ramp = exponential[:m, m], exponential[:m, m + 1]
    if hold == "zero-order":
        return phi, step, np.zeros(m)
    return phi, step - ramp, ramp


def discretise_modes(
    system: StateSpace, dt: float, hold: Hold
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Do what :func:`discretise` does where A is diagonal, mode by mode.

    ``phi`` is its diagonal.
    """
    x = np.diag(system.a) * dt
    step = _over(np.expm1(x), x, 1.0)
    # (step - 1) / x loses digits near zero, where it is 1/2 + x/6 + x^2/24 + ...
    series = 1 / 2 + x * (1 / 6 + x * (1 / 24 + x * (1 / 120 + x / 720)))
    ramp = np.where(np.abs(x) < 1e-2, series, _over(step - 1.0, x, 0.5))
    phi, gain = np.exp(x), system.b * dt
    if hold == "zero-order":
        return phi, gain * step, np.zeros(len(x))
    return phi, gain * (step - ramp), gain * ramp


def _over(above: FloatArray, below: FloatArray, at_zero: float) -> FloatArray:
    out = np.full(len(below), at_zero)
    np.divide(above, below, out=out, where=below != 0)
    return out


def linear_step(
    system: StateSpace, sampling: Sampling, hold: Hold, settled: bool = False
) -> Step:
    """Give the step ``x(k) = phi x(k-1) + sum_j b_j v(k-j)``, ``y = c x + d v``.

    The result is exact for a staircase and for straight lines; a band-limited input is
    taken as the polynomial through its newest samples.

    Parameters
    ----------
    system : StateSpace
    sampling : Sampling
    hold : {"zero-order", "linear", "band-limited"}
    settled : bool
        Whether the first value is to have stood there for ever before.
    """
    smooth, ahead = hold == "band-limited", sampling.ahead
    points = sampling.curve_points if smooth else 2
    phi, moments = moments_of(system, sampling.dt, points)
    diagonal = system.is_diagonal
    if hold == "zero-order":
        drive = np.array([np.zeros(len(system.b)), moments[0]])
    else:
        # The moments count from the start of the interval, one before its end.
        start = -1.0 - (ahead if smooth else 0)
        drive = through_samples(points, lambda m: moments[m], start)
    if not smooth:  # of no use alone, but in step with what stands beside it
        points = 2 + ahead
        drive = np.concatenate([np.zeros((ahead, len(system.b))), drive])
    static = 0.0
    if settled:
        static = float(system.d - system.c @ np.linalg.solve(system.a, system.b))
    constants = {
        "size": len(system.b),
        "points": points,
        "ahead": ahead,
        "phi": np.diagonal(phi) if diagonal else phi.ravel(),
        "drive": drive.ravel(),
        "output": system.c,
        "direct": system.d,
        "settled": int(settled),
        "static": static,
    }
    own = ("x",) if diagonal else ("x", "next")
    states = {**dict.fromkeys(own, len(system.b)), "history": 1 + points, "offset": 1}
    differs = smooth_curve(points, ahead) if smooth else ""
    function = "modes" if diagonal else "linear"
    return Step(function, constants, states, forward=smooth, differs=differs)


def moments_of(
    system: StateSpace, dt: float, points: int
) -> tuple[FloatArray, FloatArray]:
    """Give what inputs ``s^m`` add to the state in one interval, s from 0 to 1.

    ``I_m = int exp(X (1 - s)) b s^m ds``, with ``X = A dt`` and ``b = B dt``, fulfils
    ``X I_m = m I_(m-1) - b``. On the Schur form of X that is a recursion for each
    state, the last one first. As for incomplete gamma functions, it keeps its digits
    where m rises up to the size of the eigenvalue, and where m falls to it from far
    above.

    Returns
    -------
    phi : ndarray, shape (n, n)
        What is left of the state.
    moments : ndarray, shape (points, n)
        For m from 0.
    """
    phi, moved = _over_interval(system, dt)
    x, drive = system.a * dt, system.b * dt
    if system.is_diagonal:
        triangle, basis = x, np.eye(len(drive))
    else:
        from scipy.linalg import schur  # late: a filter's process never needs it

        triangle, basis = schur(x, output="complex")
    back = basis.conj().T
    b, top = back @ drive, 2 * points + 60
    found = np.zeros((top + 1, len(drive)), dtype=triangle.dtype)
    found[0] = back @ moved
    for i in reversed(range(len(drive))):
        own, value = found[:, i], triangle[i, i]
        driven = b[i] + found[:, i + 1 :] @ triangle[i, i + 1 :]
        turn = int(min(abs(value), top))
        for m in range(1, turn + 1):
            own[m] = (m * own[m - 1] - driven[m]) / value
        if turn < top:
            own[top] = driven[top] / (top + 1)
        for m in range(top, turn + 1, -1):
            own[m - 1] = (driven[m] + value * own[m]) / m
    return phi, np.ascontiguousarray((found[:points] @ basis.T).real)


def _over_interval(system: StateSpace, dt: float) -> tuple[FloatArray, FloatArray]:
    """Give what is left of the state after one interval, and what a one adds to it."""
    if system.is_diagonal:
        x = np.diag(system.a) * dt
        return np.diag(np.exp(x)), system.b * dt * _over(np.expm1(x), x, 1.0)
    from scipy.linalg import expm  # late: a filter's process never needs it

    n = len(system.b)
    augmented = np.zeros((n + 1, n + 1))
    augmented[:n, :n], augmented[:n, n] = system.a * dt, system.b * dt
    exponential = expm(augmented)
    return exponential[:n, :n], exponential[:n, n]


class Steps(NamedTuple):
    """A system as the loops take it: ``x(k+1) = phi x(k) + b v(k)``, ``y = c x + d v``.

    The state is ``x(k) - following v(k)`` of :func:`discretise`: so the input of the
    next sample is not needed.
    """

    phi: FloatArray  # shape (m, m); where A is diagonal its diagonal, shape (m,)
    b: FloatArray  # shape (m,)
    c: FloatArray  # shape (m,)
    d: float
    following: FloatArray  # shape (m,)


def _steps(system: StateSpace, dt: float, hold: Hold) -> Steps:
    keys = (system.a.tobytes(), system.b.tobytes(), system.c.tobytes())
    return _known_steps(*keys, system.d, dt, hold)


@lru_cache(maxsize=256)
def _known_steps(
    a: bytes, b: bytes, c: bytes, d: float, dt: float, hold: Hold
) -> Steps:
    """Discretise, once for records of the same rate and for every candidate."""
    drive, output = np.frombuffer(b), np.frombuffer(c)
    matrix = np.frombuffer(a).reshape(len(drive), len(drive))
    system = StateSpace(matrix, drive, output, d)
    if system.is_diagonal:
        phi, now, following = discretise_modes(system, dt, hold)
        moved = phi * following
    else:
        phi, now, following = discretise(system, dt, hold)
        moved = phi @ following
    return Steps(phi, now + moved, output, d + float(output @ following), following)


def _step_by_step(
    system: StateSpace, v: FloatArray, dt: float, hold: Hold, start: FloatArray
) -> FloatArray:
    phi, b, c, d, following = _steps(system, dt, hold)
    first = start - following * v[0]
    if phi.ndim == 1:
        return operators.modes(phi, b, c, d, v, first)
    y, _ = operators.state_space(phi, b, c, d, v, first)
    return y


def _sines(
    system: StateSpace, frequency_hz: FloatArray, amplitudes: FloatArray
) -> tuple[ComplexArray, FloatArray]:
    """Frequency response, and the state at time zero under a sum of sines.

    ``(jwI - A)^-1 B`` is solved by back substitution on A's Schur form, for all
    frequencies at once.
    """
    if system.is_diagonal:
        return _sines_of_modes(system, frequency_hz, amplitudes)
    from scipy.linalg import schur  # late: a filter's process never needs it

    triangle, basis = schur(system.a, output="complex")
    b, c = basis.conj().T @ system.b, system.c @ basis
    s = 2j * np.pi * frequency_hz
    states: list[ComplexArray] = []  # the last first
    response = np.full(len(s), system.d, dtype=np.complex128)
    start = np.zeros(len(b), dtype=np.complex128)
    for i in reversed(range(len(b))):
        driven = np.full(len(s), b[i])
        for j, state in zip(range(len(b) - 1, i, -1), states, strict=True):
            driven += triangle[i, j] * state
        states.append(driven / (s - triangle[i, i]))
        response += c[i] * states[-1]
        start[i] = amplitudes @ states[-1]
    return response, cast("FloatArray", (basis @ start).imag.copy())


def _sines_of_modes(
    system: StateSpace, frequency_hz: FloatArray, amplitudes: FloatArray
) -> tuple[ComplexArray, FloatArray]:
    """Do the same mode by mode: ``b / (jw - p) = -b (p + jw) / (w^2 + p^2)``."""
    w = 2 * np.pi * frequency_hz
    poles = np.diag(system.a)
    parts = np.add.outer(poles * poles, w * w)
    np.divide(system.b[:, None], parts, out=parts)
    real = system.d - (system.c * poles) @ parts
    return real - 1j * w * (system.c @ parts), -(parts @ (amplitudes * w))

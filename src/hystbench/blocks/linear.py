"""Linear blocks: continuous-time state space, discretised for a stated input hold."""

from __future__ import annotations

from abc import abstractmethod
from dataclasses import dataclass
from functools import lru_cache
from typing import NamedTuple

import numpy as np

from hystbench import kernels, operators
from hystbench.blocks.curve import AHEAD, POINTS, continued, through_samples
from hystbench.blocks.held import HeldBlock, Hold
from hystbench.blocks.step import Sampling, Step, smooth_curve
from hystbench.record import ComplexArray, FloatArray


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
        return _response(self.continuous(), frequency_hz)


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
    (``zero-order``), straight lines between samples (``linear``), or the smooth curve
    of :mod:`hystbench.blocks.curve` through the samples (``band-limited``).

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
        return _step_by_step(system, v, dt, hold)
    phi, drive = _curve_steps(*_bytes(system), dt)
    n, padded = len(v), len(drive[0])
    y, path = np.empty(n), continued(v)
    c = kernels.pad(system.c)
    name = "hb_curve_modes" if phi.ndim == 1 else "hb_curve_space"
    sizes = (n, POINTS, AHEAD + 1, padded // kernels.WIDTH)
    kernels.call(name, *sizes, phi, drive, c, float(system.d), path, y)
    return y


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

    A band-limited input is taken as the polynomial through the newest samples: the
    simulation's where so many to come are known as that takes.

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
    diagonal = system.is_diagonal
    if hold == "zero-order":
        phi, moments = moments_of(system, sampling.dt, points)
        drive = np.array([np.zeros(len(system.b)), moments[0]])
    else:
        later = ahead if smooth else 0
        phi, drive = curve_drive(system, sampling.dt, points, later)
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
    return Step(function, constants, states, gains=AHEAD * smooth, differs=differs)


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
    x, drive, top = system.a * dt, system.b * dt, 2 * points + 60
    if system.is_diagonal:
        return phi, _moments_of_modes(np.diag(x), drive, moved, points, top)
    from scipy.linalg import schur  # late: a filter's process never needs it

    triangle, basis = schur(x, output="complex")
    back = basis.conj().T
    b = back @ drive
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


def _moments_of_modes(
    poles: FloatArray, drive: FloatArray, first: FloatArray, points: int, top: int
) -> FloatArray:
    """Do so mode by mode, for all at once: upwards to the turn, and down to it."""
    above, below = np.zeros((points, len(poles))), np.zeros((points, len(poles)))
    above[0] = first
    turn = np.minimum(np.abs(poles), top).astype(int)
    # Beyond the turn each recursion runs away, and is not looked at.
    with np.errstate(all="ignore"):
        for m in range(1, points):
            above[m] = (m * above[m - 1] - drive) / poles
        now = drive / (top + 1)
        for m in range(top, 0, -1):
            now = (drive + poles * now) / m
            if m <= points:
                below[m - 1] = now
    rising = np.arange(points)[:, None] <= turn
    return np.where(rising, above, below)


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


def _bytes(system: StateSpace) -> tuple[bytes, bytes, bytes, float]:
    return system.a.tobytes(), system.b.tobytes(), system.c.tobytes(), system.d


def _from_bytes(a: bytes, b: bytes, c: bytes, d: float) -> StateSpace:
    drive, output = np.frombuffer(b), np.frombuffer(c)
    matrix = np.frombuffer(a).reshape(len(drive), len(drive))
    return StateSpace(matrix, drive, output, d)


@lru_cache(maxsize=256)
def _steps(a: bytes, b: bytes, c: bytes, d: float, dt: float, hold: Hold) -> Steps:
    """Discretise, once for records of the same rate and for every candidate."""
    system = _from_bytes(a, b, c, d)
    if system.is_diagonal:
        phi, now, following = discretise_modes(system, dt, hold)
        moved = phi * following
    else:
        phi, now, following = discretise(system, dt, hold)
        moved = phi @ following
    direct = d + float(system.c @ following)
    return Steps(phi, now + moved, system.c, direct, following)


@lru_cache(maxsize=256)
def _curve_steps(
    a: bytes, b: bytes, c: bytes, d: float, dt: float
) -> tuple[FloatArray, FloatArray]:
    """Do so for the curve: padded, the columns of A or its diagonal, and the drive.

    Returns
    -------
    phi : ndarray, shape (m, m) or (m,)
    drive : ndarray, shape (POINTS, m)
        What each sample of the window adds to the state, the oldest first.
    """
    system = _from_bytes(a, b, c, d)
    phi, newest_first = curve_drive(system, dt, POINTS, AHEAD)
    size = len(system.b)
    drive = np.zeros((POINTS, kernels.padded(size)))
    drive[:, :size] = newest_first[::-1]
    if system.is_diagonal:
        return kernels.pad(np.diagonal(phi)), drive
    columns = np.zeros((drive.shape[1], drive.shape[1]))
    columns[:size, :size] = phi.T
    return columns, drive


def curve_drive(
    system: StateSpace, dt: float, points: int, ahead: int
) -> tuple[FloatArray, FloatArray]:
    """Integrate over an interval, driven by the polynomial through samples around it.

    Parameters
    ----------
    system : StateSpace
    dt : float
    points, ahead : int
        Samples that the polynomial goes through; so many of them are later than the
        end of the interval.

    Returns
    -------
    phi : ndarray, shape (m, m)
        What is left of the state.
    drive : ndarray, shape (points, m)
        What each sample adds to the state, the newest first.
    """
    x, b = system.a * dt, system.b * dt
    if not system.is_diagonal:
        if np.abs(x).sum(axis=1).max() > NEAR:
            return _stiff_drive(system, dt, points, ahead)
        terms = [b]
        for _ in range(TERMS - 1):
            terms.append(x @ terms[-1])
        phi, _ = _over_interval(system, dt)
        return phi, _series(points, ahead) @ np.array(terms)
    poles = np.diag(x)
    near = np.abs(poles) <= NEAR
    drive = np.empty((points, len(b)))
    powers = np.vander(poles[near], TERMS, increasing=True).T
    drive[:, near] = _series(points, ahead) @ (powers * b[near])
    if not near.all():
        stiff = ~near
        part = StateSpace(
            np.diag(np.diag(system.a)[stiff]), system.b[stiff], system.c[stiff], 0.0
        )
        drive[:, stiff] = _stiff_drive(part, dt, points, ahead)[1]
    return np.diag(np.exp(poles)), drive


NEAR = 4.0
"""Size of A dt up to which the series of its exponential keeps 14 digits."""
TERMS = 36
"""Terms of that series: 4^36 / 36! is 1e-20."""


@lru_cache(maxsize=64)
def _series(points: int, ahead: int) -> FloatArray:
    """Give what each term of an exponential's series takes of each sample.

    The response to ``s^m`` is ``sum_n X^n b m! / (m + n + 1)!``.

    Returns
    -------
    ndarray, shape (points, TERMS)
    """
    m, n = np.arange(points)[:, None], np.arange(1, TERMS)
    shares = np.cumprod(np.hstack([1.0 / (m + 1), 1.0 / (m + n + 1)]), axis=1)
    return through_samples(points, lambda k: shares[k], -1.0 - ahead)


def _stiff_drive(
    system: StateSpace, dt: float, points: int, ahead: int
) -> tuple[FloatArray, FloatArray]:
    """Do what :func:`curve_drive` does where the series would lose digits."""
    phi, moments = moments_of(system, dt, points)
    # The moments count from the start of the interval, one before its end.
    return phi, through_samples(points, lambda m: moments[m], -1.0 - ahead)


def _step_by_step(
    system: StateSpace, v: FloatArray, dt: float, hold: Hold
) -> FloatArray:
    phi, b, c, d, following = _steps(*_bytes(system), dt, hold)
    first = -following * v[0]
    if phi.ndim == 1:
        return operators.modes(phi, b, c, d, v, first)
    y, _ = operators.state_space(phi, b, c, d, v, first)
    return y


def _response(system: StateSpace, frequency_hz: FloatArray) -> ComplexArray:
    """Evaluate the frequency response.

    ``(jwI - A)^-1 B`` is solved by back substitution on A's Schur form, for all
    frequencies at once.
    """
    s = 2j * np.pi * frequency_hz
    if system.is_diagonal:
        parts = system.b[:, None] / (s - np.diag(system.a)[:, None])
        return np.asarray(system.d + system.c @ parts, dtype=np.complex128)
    from scipy.linalg import schur  # late: a filter's process never needs it

    triangle, basis = schur(system.a, output="complex")
    b, c = basis.conj().T @ system.b, system.c @ basis
    states: list[ComplexArray] = []  # the last first
    response: ComplexArray = np.full(len(s), system.d, dtype=np.complex128)
    for i in reversed(range(len(b))):
        driven: ComplexArray = np.full(len(s), b[i], dtype=np.complex128)
        for j, state in zip(range(len(b) - 1, i, -1), states, strict=True):
            driven += triangle[i, j] * state
        states.append(driven / (s - triangle[i, i]))
        response += c[i] * states[-1]
    return response

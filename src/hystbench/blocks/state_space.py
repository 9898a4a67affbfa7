"""A linear system in continuous time, and how it moves over a sampling interval."""

from functools import lru_cache
from typing import NamedTuple

import numpy as np

from hystbench.blocks.curve import through_samples
from hystbench.blocks.held import Hold
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
        apart = np.count_nonzero(self.a) - np.count_nonzero(self.a.diagonal())
        return int(apart) == 0

    @property
    def static_gain(self) -> float:
        """What an input that has stood for ever is multiplied by: ``D - C A^-1 B``."""
        return float(self.d - self.c @ np.linalg.solve(self.a, self.b))


def lag(time_constant_s: float) -> StateSpace:
    """First-order lag of static gain one, with its output as the state."""
    rate = 1.0 / time_constant_s
    return StateSpace(np.array([[-rate]]), np.array([rate]), np.array([1.0]), 0.0)


def mode(rate: float, damping_ratio: float, share: float = 1.0) -> StateSpace:
    """Mode of second order beside what follows at once, of static gain one together.

    Its states are its output and that one's scaled rate.

    Parameters
    ----------
    rate : float
        Undamped, in rad/s.
    damping_ratio : float
    share : float
        Of the static gain.
    """
    return StateSpace(
        np.array([[0.0, rate], [-rate, -2.0 * damping_ratio * rate]]),
        np.array([0.0, rate]),
        np.array([share, 0.0]),
        1.0 - share,
    )


def discretise(
    system: StateSpace, dt: float, hold: Hold
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Integrate the state equation over one sampling interval.

    Returns ``phi``, ``now``, ``following`` of ``x(k+1) = phi x(k) + now v(k) +
    following v(k+1)``. Of a diagonal A ``phi`` is its diagonal, shape (m,).
    """
    if system.is_diagonal:
        x, gain = np.diag(system.a) * dt, system.b * dt
        phi, step, ramp = np.exp(x), *_of_modes(x)
    else:
        gain = np.ones(len(system.b))  # the matrix exponential has it inside
        phi, step, ramp = _exponential(system, dt)
    if hold == "zero-order":
        return phi, gain * step, np.zeros(len(step))
    return phi, gain * (step - ramp), gain * ramp


def square(phi: FloatArray) -> FloatArray:
    """Give a matrix of which the diagonal may stand alone."""
    return phi if phi.ndim == 2 else np.diag(phi)


def _exponential(
    system: StateSpace, dt: float
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Give what is left of the state after one interval, and what an input adds to it.

    The input is a one, and a ramp from zero to one.
    """
    m = len(system.b)
    weights = after_interval(system.a * dt, system.b * dt)
    return np.ascontiguousarray(weights[:, :m]), weights[:, m], weights[:, m + 1]


def after_interval(a: FloatArray, b: FloatArray) -> FloatArray:
    """Give the state after an interval of one: of the state, a one and a ramp to one.

    By one matrix exponential of each system [1]_.

    Parameters
    ----------
    a : ndarray, shape (..., m, m)
    b : ndarray, shape (..., m)

    Returns
    -------
    ndarray, shape (..., m, m + 2)

    References
    ----------
    .. [1] C. F. Van Loan, "Computing integrals involving the matrix exponential",
       IEEE Transactions on Automatic Control 23 (1978) 395-404.
    """
    from scipy.linalg import expm  # late: a filter's process never needs it

    m = b.shape[-1]
    augmented = np.zeros((*b.shape[:-1], m + 2, m + 2))
    augmented[..., :m, :m] = a
    augmented[..., :m, m] = b
    augmented[..., m, m + 1] = 1.0
    # A fit may try what runs away within an interval: NaN, as of all that runs away.
    with np.errstate(over="ignore", invalid="ignore"):
        return np.asarray(expm(augmented)[..., :m, :])


def _of_modes(x: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Give what a one, and a ramp to one, add to modes of these poles times dt."""
    step = _over(np.expm1(x), x, 1.0)
    # (step - 1) / x loses digits near zero, where it is 1/2 + x/6 + x^2/24 + ...
    series = 1 / 2 + x * (1 / 6 + x * (1 / 24 + x * (1 / 120 + x / 720)))
    return step, np.where(np.abs(x) < 1e-2, series, _over(step - 1.0, x, 0.5))


def _over(above: FloatArray, below: FloatArray, at_zero: float) -> FloatArray:
    out = np.full(len(below), at_zero)
    np.divide(above, below, out=out, where=below != 0)
    return out


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

    The response to ``s^m`` is ``sum_n X^n b m! / (m + n + 1)!``. The shape is (points,
    TERMS).
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
        # The way down to the last that is asked for, written out as a sum.
        ratios = poles / np.arange(points + 1, top + 1)[:, None]
        below[-1] = drive / points * (1 + np.cumprod(ratios, axis=0).sum(axis=0))
        for m in range(points - 1, 0, -1):
            below[m - 1] = (drive + poles * below[m]) / m
    rising = np.arange(points)[:, None] <= turn
    return np.where(rising, above, below)


def _over_interval(system: StateSpace, dt: float) -> tuple[FloatArray, FloatArray]:
    """Give what is left of the state after one interval, and what a one adds to it."""
    phi, step, _ = discretise(system, dt, "zero-order")
    return square(phi), step

"""Linear blocks: continuous-time state space, discretised for a stated input hold."""

from __future__ import annotations

from abc import abstractmethod
from dataclasses import dataclass
from typing import Literal, NamedTuple, cast

import numpy as np
from numpy.typing import NDArray

from hystbench.blocks.base import Block
from hystbench.blocks.parameter import choice
from hystbench.operators import state_space
from hystbench.record import FloatArray

Hold = Literal["zero-order", "linear", "band-limited"]
HOLDS: tuple[str, ...] = ("zero-order", "linear", "band-limited")
OVERSAMPLING = 16


class StateSpace(NamedTuple):
    """Matrices of ``dx/dt = A x + B v``, ``y = C x + D v``, one input, one output."""

    a: FloatArray  # shape (m, m)
    b: FloatArray  # shape (m,)
    c: FloatArray  # shape (m,)
    d: float


@dataclass(frozen=True)
class LinearBlock(Block):
    """A linear, time-invariant block that starts at rest.

    A subclass defines :meth:`continuous`.
    """

    hold: str = choice("how the input moves between two samples", HOLDS, "linear")

    @abstractmethod
    def continuous(self) -> StateSpace:
        """Return the block in continuous time."""

    def simulate(self, z: FloatArray, u: FloatArray, dt: float) -> FloatArray:
        """Compute the response to ``z`` from rest."""
        return respond(self.continuous(), z, dt, cast(Hold, self.hold))

    def frequency_response(self, frequency_hz: FloatArray) -> NDArray[np.complex128]:
        """Evaluate ``C (jwI - A)^-1 B + D`` of the block in continuous time.

        Parameters
        ----------
        frequency_hz : ndarray, shape (n,)

        Returns
        -------
        ndarray of complex, shape (n,)
        """
        a, b, c, d = self.continuous()
        s = 2j * np.pi * frequency_hz
        shifted = s[:, None, None] * np.eye(len(b)) - a
        states = np.linalg.solve(shifted, np.tile(b[:, None], (len(s), 1, 1)))
        return states[..., 0] @ c + d


def respond(system: StateSpace, v: FloatArray, dt: float, hold: Hold) -> FloatArray:
    """Compute the response of a linear system from rest.

    The result is exact for the input that the hold describes: a staircase
    (``zero-order``), straight lines between samples (``linear``), or the
    band-limited signal through the samples (``band-limited``). The last is computed
    as straight lines on a grid 16 times finer; at a quarter of the sampling rate
    that is 0.08 % low in amplitude and less below.

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
    if hold == "band-limited" and len(v) > 2:
        fine = interpolate(v, OVERSAMPLING)
        return respond(system, fine, dt / OVERSAMPLING, "linear")[::OVERSAMPLING].copy()
    phi, now, following = discretise(system, dt, hold)
    # x(k+1) = phi x(k) + now v(k) + following v(k+1); the state x(k) - following v(k)
    # turns this into the usual form, which the kernel takes.
    y, _ = state_space(
        phi,
        now + phi @ following,
        system.c,
        system.d + float(system.c @ following),
        v,
        -following * v[0],
    )
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
    exponential = expm(augmented)
    phi = np.ascontiguousarray(exponential[:m, :m])
    step, ramp = exponential[:m, m], exponential[:m, m + 1]
    if hold == "zero-order":
        return phi, step, np.zeros(m)
    return phi, step - ramp, ramp


def interpolate(v: FloatArray, factor: int) -> FloatArray:
    """Interpolate a sampled signal as band-limited.

    The straight line from the first to the last sample is taken off and what is
    left is continued as an odd function about both ends, so that nothing jumps there.

    Parameters
    ----------
    v : ndarray, shape (n,)
    factor : int

    Returns
    -------
    ndarray, shape ((n - 1) * factor + 1,)
        Equal to ``v`` at every ``factor``-th sample.
    """
    n = len(v)
    line = np.linspace(v[0], v[-1], (n - 1) * factor + 1)
    rest = v - line[::factor]
    odd = np.concatenate([rest[:-1], -rest[:0:-1]])
    spectrum = np.fft.rfft(odd) * factor
    fine = np.fft.irfft(spectrum, len(odd) * factor)
    return cast(FloatArray, line + fine[: len(line)])

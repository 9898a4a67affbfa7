"""Linear blocks: what a state-space system answers to an input, for a stated hold."""

from abc import abstractmethod
from collections.abc import Sequence
from dataclasses import replace
from functools import lru_cache
from itertools import accumulate
from typing import NamedTuple, cast

import numpy as np
from numpy.lib.stride_tricks import sliding_window_view

from hystbench import kernels
from hystbench.blocks.curve import AHEAD, POINTS, continued
from hystbench.blocks.held import HeldBlock, Hold
from hystbench.blocks.parameter import choice
from hystbench.blocks.starts import PASTS, STARTS, path_from
from hystbench.blocks.state_space import (
    StateSpace,
    curve_drive,
    discretise,
    lag,
    moments_of,
    square,
)
from hystbench.blocks.step import Sampling, Step, smooth_curve
from hystbench.record import FloatArray

FEW = 4
"""States of which a loop takes several samples at a time."""


class Loop(NamedTuple):
    """A system as a kernel takes it: what does not change from record to record."""

    kernel: str
    sizes: tuple[int, ...]
    fixed: tuple[kernels.Fixed, ...]
    d: float
    following: FloatArray  # padded
    direct: kernels.Fixed  # d again, for a kernel that is told where all lies

    @property
    def size(self) -> tuple[int, int]:
        """Vectors of states, and states; 0 where A is diagonal."""
        return self.sizes[0], self.sizes[1] if len(self.sizes) > 1 else 0

    @property
    def places(self) -> tuple[int, ...]:
        """Where the system lies, and what follows the input at once."""
        fixed = (item.place for item in self.fixed)
        return (*fixed, self.direct.place, kernels.address(self.following))


class CurveLoop(NamedTuple):
    """A system as a kernel for the curve takes it."""

    kernel: str
    states: int
    fixed: tuple[kernels.Fixed, ...]
    d: float
    passing: FloatArray | None = None
    """What a window of samples gives by states of which nothing outlasts an interval:
    of them no kernel needs to know."""


class LinearBlock(HeldBlock):
    """A linear, time-invariant block.

    With ``start: settled`` the input had its first value for ever before the record.
    With ``moving`` it came through the first sample as it leaves it, the record turned
    about that sample: one that begins in the middle of a motion shows neither jump nor
    kink. With ``repeating`` the same record came before, as whole periods of an input
    do. A subclass defines :meth:`continuous`.
    """

    start: str = choice("state before the first sample", STARTS, "rest")

    @abstractmethod
    def continuous(self) -> StateSpace:
        """Return the block in continuous time."""

    @property
    def static_gain(self) -> float:
        """What an input that has stood for ever is multiplied by."""
        return self.continuous().static_gain

    def simulate(self, z: FloatArray, u: FloatArray, dt: float) -> FloatArray:
        """Compute the response to ``z``."""
        path, before = path_from(z, self.start)
        path = path - before if before else path
        moves = _moved(_loop_of(self, dt, _is_smooth(self.holding, path)), path)
        return self._of_record(moves, before, len(z))

    def _of_record(self, moves: FloatArray, before: float, count: int) -> FloatArray:
        """Give the response of a record from that to what was before it, and to it."""
        if self.start == "rest":
            return moves
        return moves[len(moves) - count :] + _static_gain_of(self) * before

    def simulate_records(
        self, signals: Sequence[FloatArray], dts: Sequence[float]
    ) -> list[FloatArray]:
        """Compute the responses to signals of many records, as :meth:`simulate` does.

        Where the signals move straight or as a staircase all take one call of a kernel:
        of short ones calls are most of the time.
        """
        if self.holding == "band-limited":
            pairs = zip(signals, dts, strict=True)
            return [self.simulate(z, z, dt) for z, dt in pairs]
        loops = {dt: cast(Loop, _loop_of(self, dt, False)) for dt in set(dts)}
        begun = [path_from(z, self.start) for z in signals]
        paths = [path - before if before else path for path, before in begun]
        moves = _moved_records([loops[dt] for dt in dts], paths)
        return [
            self._of_record(moved, before, len(z))
            for moved, (_, before), z in zip(moves, begun, signals, strict=True)
        ]

    def step(self, sampling: Sampling) -> Step:
        """Move the state over the interval that has passed."""
        settled = self.start != "rest"
        step = linear_step(self.continuous(), sampling, self.holding, settled)
        return replace(step, past=PASTS.get(self.start, ""))


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
    if _is_smooth(hold, v):
        return _moved(_curve_loop(*_bytes(system), dt), v)
    return _moved(_loop(*_bytes(system), dt, hold), v)


def _is_smooth(hold: Hold, v: FloatArray) -> bool:
    """Tell whether a signal is long enough to move along a curve, if it is to."""
    return hold == "band-limited" and len(v) > 2


@lru_cache(maxsize=256)
def _static_gain_of(block: LinearBlock) -> float:
    return block.static_gain


@lru_cache(maxsize=256)
def _loop_of(block: LinearBlock, dt: float, smooth: bool) -> Loop | CurveLoop:
    """Give what a block is simulated by, for records of the same rate."""
    system = _bytes(block.continuous())
    return _curve_loop(*system, dt) if smooth else _loop(*system, dt, block.holding)


def _moved(loop: Loop | CurveLoop, v: FloatArray) -> FloatArray:
    """Send a signal through a loop, from rest."""
    n = len(v)
    y = np.empty(n)
    if isinstance(loop, Loop):
        v = np.asarray(v, dtype=np.float64, order="C")
        state = loop.following * -v[0]
        kernels.call(loop.kernel, n, *loop.sizes, *loop.fixed, loop.d, v, state, y)
        return y
    path = continued(v)
    sizes = (n, POINTS, AHEAD + 1, loop.states)
    kernels.call(loop.kernel, *sizes, *loop.fixed, loop.d, path, y)
    if loop.passing is not None:
        passed = np.empty(n)
        kernels.call("hb_weighed", n, POINTS, 1, loop.passing, path, passed)
        y[1:] += passed[1:]
    return y


def _moved_records(
    loops: Sequence[Loop], signals: Sequence[FloatArray]
) -> list[FloatArray]:
    """Send signals through loops of one system at their rates, each from rest."""
    signals = [np.asarray(v, dtype=np.float64, order="C") for v in signals]
    ends = list(accumulate(map(len, signals)))
    out = np.empty(sum(map(len, signals)))
    moved = [out[end - len(v) : end] for end, v in zip(ends, signals, strict=True)]
    rows = [
        (len(v), kernels.address(v), kernels.address(y), *loop.places)
        for loop, v, y in zip(loops, signals, moved, strict=True)
    ]
    if not rows:
        return []
    places = np.array(rows, dtype=np.intp)
    kernels.call("hb_records", len(rows), *loops[0].size, places.ctypes.data)
    return moved


def states_of(system: StateSpace, v: FloatArray, dt: float, hold: Hold) -> FloatArray:
    """Compute the states of a linear system from rest, as :func:`respond` has them.

    Parameters
    ----------
    system : StateSpace
        Its output is not used.
    v : ndarray, shape (n,)
    dt : float
    hold : {"zero-order", "linear", "band-limited"}

    Returns
    -------
    ndarray, shape (n, m)
    """
    size = len(system.b)
    out = np.zeros((len(v), kernels.padded(size)))
    if hold == "band-limited" and len(v) >= 3:
        phi, drive = _curve_steps(*_bytes(system), dt)
        out[1:] = sliding_window_view(continued(v), POINTS)[1:] @ drive
        behind = np.zeros((len(v), size))
    else:
        phi, b, _, _, following = _steps(*_bytes(system), dt, hold)
        out[0, :size] = -following * v[0]
        out[1:, :size] = np.outer(v[:-1], b)
        phi = _padded_columns(square(phi))
        behind = np.outer(v, following)
    columns = square(phi)
    kernels.call("hb_states", len(v), len(columns) // kernels.WIDTH, columns, out)
    return out[:, :size] + behind


def _padded_columns(phi: FloatArray) -> FloatArray:
    """Give the columns of a matrix as the kernels read them, filled up with zeros."""
    size, wide = len(phi), kernels.padded(len(phi))
    columns = np.zeros((wide, wide))
    columns[:size, :size] = phi.T
    return columns


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
    constants = {
        "size": len(system.b),
        "points": points,
        "ahead": ahead,
        "phi": np.diagonal(phi) if diagonal else phi.ravel(),
        "drive": drive.ravel(),
        "output": system.c,
        "direct": system.d,
        "settled": int(settled),
        "static": system.static_gain if settled else 0.0,
    }
    own = ("x",) if diagonal else ("x", "next")
    states = {**dict.fromkeys(own, len(system.b)), "history": 1 + points, "offset": 1}
    differs = smooth_curve(points, ahead) if smooth else ""
    function = "modes" if diagonal else "linear"
    return Step(function, constants, states, gains=AHEAD * smooth, differs=differs)


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
    phi, now, following = discretise(system, dt, hold)
    moved = phi * following if phi.ndim == 1 else phi @ following
    direct = d + float(system.c @ following)
    return Steps(phi, now + moved, system.c, direct, following)


@lru_cache(maxsize=256)
def _curve_steps(
    a: bytes, b: bytes, c: bytes, d: float, dt: float
) -> tuple[FloatArray, FloatArray]:
    """Do so for the curve: padded, the columns of A or its diagonal, and the drive.

    The drive, shape (POINTS, m), is what each sample of the window adds to the state,
    the oldest first.
    """
    system = _from_bytes(a, b, c, d)
    phi, newest_first = curve_drive(system, dt, POINTS, AHEAD)
    size = len(system.b)
    drive = np.zeros((POINTS, kernels.padded(size)))
    drive[:, :size] = newest_first[::-1]
    if system.is_diagonal:
        return kernels.pad(np.diagonal(phi)), drive
    return _padded_columns(phi), drive


@lru_cache(maxsize=256)
def _curve_loop(a: bytes, b: bytes, c: bytes, d: float, dt: float) -> CurveLoop:
    phi, drive = _curve_steps(a, b, c, d, dt)
    output = np.frombuffer(c)
    size = len(output)
    if phi.ndim == 2:
        fixed = tuple(map(kernels.Fixed, (phi, drive, kernels.pad(output))))
        return CurveLoop("hb_curve_space", size, fixed, float(d))
    phi, drive = phi[:size], drive[:, :size]
    lasts = np.abs(phi) > np.finfo(float).eps
    lasts[0] |= not lasts.any()  # a kernel has one state at least
    count = int(lasts.sum())
    own = np.zeros((POINTS, kernels.padded(count)))
    own[:, :count] = drive[:, lasts]
    given = (kernels.pad(phi[lasts]), own, kernels.pad(output[lasts]))
    passing = None if lasts.all() else drive[:, ~lasts] @ output[~lasts]
    fixed = tuple(map(kernels.Fixed, given))
    return CurveLoop("hb_curve_modes", count, fixed, float(d), passing)


@lru_cache(maxsize=256)
def _loop(a: bytes, b: bytes, c: bytes, d: float, dt: float, hold: Hold) -> Loop:
    steps = _steps(a, b, c, d, dt, hold)
    size = len(steps.b)
    sizes: tuple[int, ...] = (kernels.padded(size) // kernels.WIDTH,)
    if steps.phi.ndim == 1 and size > FEW:
        kernel, phi = "hb_modes", kernels.pad(steps.phi)
    else:
        kernel, sizes = "hb_state_space", (*sizes, size)
        phi = _padded_columns(square(steps.phi))
    fixed = (phi, kernels.pad(steps.b), kernels.pad(steps.c))
    places = tuple(map(kernels.Fixed, fixed))
    direct = kernels.Fixed(np.array([steps.d]))
    return Loop(kernel, sizes, places, steps.d, kernels.pad(steps.following), direct)

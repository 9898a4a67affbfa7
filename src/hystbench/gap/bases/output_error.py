"""Least squares of the free-run output of a transfer function and an offset."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Protocol, TypeVar

import numpy as np

from hystbench.blocks.held import Hold
from hystbench.blocks.linear import states_of
from hystbench.blocks.starts import path_from, start_on, started
from hystbench.blocks.state_space import StateSpace
from hystbench.blocks.transfer_function import TransferFunction
from hystbench.errors import InputError
from hystbench.gap.bases.spectral import Ratio, stable, triangle_of
from hystbench.gap.records.first_state import with_free_start
from hystbench.gap.records.scored_samples import without
from hystbench.record import FloatArray, Mask, Record

#: Share of the sum that a step must win for another to follow.
LEAST_GAIN = 1e-4
#: A step is damped so many times before a descent ends.
TRIALS = 8


class Costed(Protocol):
    """A model with its sum of squares, infinite where it cannot be run."""

    @property
    def cost(self) -> float:
        """Sum of squares."""


Fit = TypeVar("Fit", bound=Costed)


def descended(
    fit: Fit,
    steps: Callable[[Fit], Callable[[float], Fit] | None],
    rounds: int,
    damping: float,
) -> Fit:
    """Go down a sum of squares by steps of Levenberg and Marquardt [1]_.

    Parameters
    ----------
    fit : Costed
        Where to start; given back as it is if no step pays.
    steps : callable
        Tells what a step makes of a model, by its damping; None where none is known.
    rounds : int
        Most steps.
    damping : float
        Of the first.

    References
    ----------
    .. [1] D. W. Marquardt, "An algorithm for least-squares estimation of nonlinear
       parameters", J. SIAM 11(2), 431-441, 1963, doi:10.1137/0111030.
    """
    for _ in range(rounds):
        step = steps(fit)
        if step is None:
            break
        for _ in range(TRIALS):
            moved = step(damping)
            if moved.cost < fit.cost:
                break
            damping *= 10.0
        else:
            break
        small = moved.cost > (1 - LEAST_GAIN) * fit.cost
        fit, damping = moved, max(damping / 10.0, 1e-9)
        if small:
            break
    return fit


@dataclass(frozen=True)
class OutputError:
    """Records that a ratio is fitted to by its simulation, as the block gives it."""

    records: tuple[Record, ...]
    hold: Hold
    scale: float
    """Unit of the ratio's s, in rad/s."""
    start: str = "rest"
    """How the records start, as in the block."""
    own_offsets: bool = False
    """Whether each record has a constant of its own, as where a sensor's zero is
    another one every time; a ratio has their mean."""
    free_starts: bool = False
    """Whether records may begin in any state of the ratio."""
    held: int = 0
    """Count of the lowest coefficients of the denominator that stay as they are."""

    def block(self, ratio: Ratio) -> TransferFunction:
        """Give the block of a ratio; its constant is left out."""
        return ratio.block(self.scale, self.hold, self.start)

    def simulate(self, ratio: Ratio) -> list[FloatArray]:
        """Simulate a ratio with its constant, one output a record."""
        block = self.block(ratio)
        return [
            started(block, record).simulate(record.u, record.u, record.dt)
            + ratio.offset
            for record in self.records
        ]

    @cached_property
    def _latest(self) -> list[tuple[Ratio, list[FloatArray]]]:
        """The ratio that was looked at last, with what it leaves."""
        return []

    def left(self, ratio: Ratio) -> list[FloatArray]:
        """Give what a ratio leaves of each output; not to be written to.

        It is kept, as a step that pays is looked at again: the next begins there.
        """
        for known, left in self._latest:
            if ratio.simulates_as(known):
                return left
        simulated = self.simulate(ratio)
        left = [r.y - y for r, y in zip(self.records, simulated, strict=True)]
        self._latest[:] = [(ratio, left)]
        return left

    def squares(self, ratio: Ratio, masks: Sequence[Mask]) -> float:
        """Sum of squares of the error over the masked samples.

        What each record has of its own is what fits its masked samples best. Infinite
        for a ratio that runs away, for one that swings faster than its samples can
        show, and for one that no block takes, as where rounding makes slow poles
        unstable.
        """
        if self._swings_unseen(ratio):
            return np.inf
        with np.errstate(over="ignore", invalid="ignore"):  # of one that runs away
            try:
                left = self.left(ratio)
            except InputError:
                return np.inf
            left = self._masked(left, masks, self._own(ratio))
            squares = float(sum(np.sum(part**2) for part in left))
            return squares if np.isfinite(squares) else np.inf

    def _swings_unseen(self, ratio: Ratio) -> bool:
        """Tell whether poles swing above half of the sampling frequency."""
        fastest = np.pi / min(record.dt for record in self.records)
        return bool(np.any(np.abs(ratio.poles(self.scale).imag) > fastest))

    def _masked(
        self,
        columns: Sequence[FloatArray],
        masks: Sequence[Mask],
        own: Sequence[FloatArray],
    ) -> list[FloatArray]:
        """Give the masked samples, without what each record has of its own."""
        parts = [x[mask] for x, mask in zip(columns, masks, strict=True)]
        beside = [x[mask] for x, mask in zip(own, masks, strict=True)]
        return [without(x, of) for x, of in zip(parts, beside, strict=True)]

    def _own(self, ratio: Ratio) -> tuple[FloatArray, ...]:
        """Give what each record may have of its own beside a ratio."""
        if not self.free_starts:
            return self._of_records
        poles = ratio.poles(self.scale)
        freed = [with_free_start(record, poles) for record in self.records]
        return own_columns(freed, self.own_offsets)

    @cached_property
    def _of_records(self) -> tuple[FloatArray, ...]:
        return own_columns(self.records, self.own_offsets)

    def refined(self, ratio: Ratio, masks: Sequence[Mask], rounds: int) -> Ratio:
        """Go down the sum of squares of the masked samples.

        Parameters
        ----------
        ratio : Ratio
            Where to start; returned as it is if no step pays.
        masks : sequence of ndarray of bool
        rounds : int
            Most steps.
        """

        def steps(ratio: Ratio) -> Callable[[float], Ratio] | None:
            triangle = self._triangle(ratio, masks)
            if not np.all(np.isfinite(triangle)):
                return None  # its derivatives run away though it does not
            return lambda damping: self._moved(ratio, _step(triangle, damping), masks)

        ratio = replace(ratio, cost=self.squares(ratio, masks))
        if not np.isfinite(ratio.cost):
            return ratio
        ratio = descended(ratio, steps, rounds, 1e-6)
        offset = ratio.offset
        if self.own_offsets:
            left = [x[mask] for x, mask in zip(self.left(ratio), masks, strict=True)]
            offset += float(np.mean(np.concatenate(left)))
        return replace(ratio, offset=offset)

    def _moved(self, ratio: Ratio, step: FloatArray, masks: Sequence[Mask]) -> Ratio:
        k = len(ratio.a)
        a = stable(ratio.a + step[:k])
        a[: self.held] = ratio.a[: self.held]  # not what its pole's margin makes of it
        moved = Ratio(a, ratio.b + step[k:-1], ratio.offset + step[-1], np.inf)
        return replace(moved, cost=self.squares(moved, masks))

    def _triangle(self, ratio: Ratio, masks: Sequence[Mask]) -> FloatArray:
        """Triangle of the derivatives, and of the error as its last column."""
        with np.errstate(over="ignore", invalid="ignore"):
            columns = [
                np.column_stack([self._derivatives(ratio, record), rest])
                for record, rest in zip(self.records, self.left(ratio), strict=True)
            ]
        for part, record in zip(columns, self.records, strict=True):
            part[:, : self.held] = 0.0
            if has_constant(record, self.own_offsets):  # the ratio's is one of these
                part[:, -2] = 0.0
        masked = self._masked(columns, masks, self._own(ratio))
        return triangle_of(np.vstack([triangle_of(part) for part in masked]))

    def _derivatives(self, ratio: Ratio, record: Record) -> FloatArray:
        """Change of the output with each a, each b and the constant, column by column.

        With ``x_k = s^k u / A`` the output is ``y = sum b_k x_k``, which changes by
        ``x_k`` with b_k and by ``-s^k y / A`` with a_k.
        """
        a, b = ratio.a, ratio.b
        path, before = path_from(record.u, start_on(record, self.start))
        own, k = slice(len(path) - len(record), None), len(a)
        system = _with_its_derivatives(ratio, self.scale)
        states = states_of(system, path - before, record.dt, self.hold)[own]
        by_b, by_a = states[:, :k], -states[:, k:]
        by_b[:, 0] += before / a[0]
        by_a[:, 0] -= before * b[0] / a[0] ** 2
        if len(b) > k:
            by_b = np.column_stack([by_b, record.u - by_b @ a])
        return np.column_stack([by_a, by_b[:, : len(b)], np.ones(len(record))])


def _with_its_derivatives(ratio: Ratio, scale: float) -> StateSpace:
    """Give the system whose states are ``s^k u / A``, and ``s^k B u / A^2`` after them.

    Both halves are in controller canonical form; the second has the output of the first
    as its input.
    """
    a, b = ratio.a, ratio.b
    k = len(a)
    direct = b[k] if len(b) > k else 0.0
    matrix = np.zeros((2 * k, 2 * k))
    for half in (slice(0, k), slice(k, 2 * k)):
        matrix[half, half] = np.eye(k, k=1)
        matrix[half.stop - 1, half] = -a
    matrix[-1, : len(b[:k])] = b[:k]
    matrix[-1, :k] -= direct * a
    drive = np.zeros(2 * k)
    drive[k - 1], drive[-1] = 1.0, direct
    return StateSpace(scale * matrix, scale * drive, np.zeros(2 * k), 0.0)


def own_columns(records: Sequence[Record], own_offsets: bool) -> tuple[FloatArray, ...]:
    """Give what each record may have of its own, shape (n, k) each.

    A constant where records have offsets. In a window, which begins at zero, the noise
    of its first sample and what its velocity there does. Where a record begins in the
    middle of a motion, what any first state does.
    """
    found = []
    for record in records:
        constants = int(has_constant(record, own_offsets))
        found.append(np.hstack([np.ones((len(record), constants)), record.of_start]))
    return tuple(found)


def has_constant(record: Record, own_offsets: bool) -> bool:
    """Tell whether a record has a constant of its own."""
    return own_offsets or record.decay_s is not None


def _step(triangle: FloatArray, damping: float) -> FloatArray:
    left, right = triangle[:, :-1], triangle[:, -1]
    size = np.linalg.norm(left, axis=0)
    size[size == 0] = 1.0
    damped = np.vstack([left / size, np.sqrt(damping) * np.eye(len(size))])
    wanted = np.concatenate([right, np.zeros(len(size))])
    step: FloatArray = np.linalg.lstsq(damped, wanted, rcond=None)[0] / size
    return step

"""Two transfer functions with a static curve between them, in output error."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import NamedTuple

import numpy as np
from scipy import fft

from hystbench.blocks.held import Hold
from hystbench.blocks.starts import path_from, start_on
from hystbench.gap.bases.output_error import descended
from hystbench.gap.bases.spectral import Rational, below, held, stable
from hystbench.record import ComplexArray, FloatArray, Mask, Record

#: Degree of the polynomial that stands for the curve.
DEGREE = 5
#: Least damping ratio of a pole: a refit changes coefficients by a thousandth to see
#: what they do, and must not make a pole unstable.
MARGIN = 5e-3


@dataclass(frozen=True)
class Halves:
    """A front, a curve ``c_1 w + c_2 w^2 + ..``, a back, and a constant at the end."""

    front: Rational
    back: Rational
    curve: FloatArray = field(default_factory=lambda: np.zeros(DEGREE))
    """Shape (DEGREE,)."""
    offset: float = 0.0
    cost: float = np.inf
    """Sum of squares."""
    limits: tuple[float, float] = (-np.inf, np.inf)
    """Signals between the halves beyond which the curve stays as it is there."""

    @property
    def count(self) -> int:
        """How many numbers there are."""
        return sum(map(len, self._parts)) + 1

    @property
    def _parts(self) -> tuple[FloatArray, ...]:
        return self.front.a, self.front.b, self.back.a, self.back.b, self.curve

    def moved(self, step: FloatArray) -> Halves:
        """Give them after a step in all numbers, with stable poles."""
        ends = np.cumsum([len(item) for item in self._parts])
        numbers = np.concatenate([*self._parts, [self.offset]]) + step
        fa, fb, ba, bb, curve, offset = np.split(numbers, ends)
        front, back = Rational(_stable(fa), fb), Rational(_stable(ba), bb)
        return Halves(front, back, curve, float(offset[0]))

    def send_as(self, other: Halves) -> bool:
        """Tell whether they have another's numbers: the same parts and constant."""
        parts = (self.front, self.back, self.curve)
        others = (other.front, other.back, other.curve)
        same = all(own is its for own, its in zip(parts, others, strict=True))
        return same and (self.offset, self.limits) == (other.offset, other.limits)

    def bend(self, w: FloatArray | float) -> FloatArray:
        """Give what the curve makes of a signal."""
        w = np.clip(w, *self.limits)
        return np.asarray(np.polyval(np.append(self.curve[::-1], 0.0), w), np.float64)


class Sent(NamedTuple):
    """Signals on the way through, over a record and what was before it."""

    w: FloatArray
    behind: ComplexArray
    output: FloatArray


class Way:
    """A record on its way through two halves, behind what was before it."""

    def __init__(self, record: Record, mask: Mask, task: HalvesError) -> None:
        self.record, self.mask = record, mask
        start = start_on(record, task.start)
        path, self.before = path_from(record.u, start)
        self.count = len(path)
        self.length = fft.next_fast_len(2 * self.count, real=True)
        f = np.asarray(fft.rfftfreq(self.length, record.dt), np.float64)
        self.s = np.asarray(2j * np.pi * f / task.scale, dtype=np.complex128)
        self.spectrum = self._lines(path - self.before) * held(f * record.dt, task.hold)
        self._latest: tuple[Halves, Sent] | None = None

    # Rows of a table are signals, which one call transforms together.

    def _lines(self, signal: FloatArray) -> ComplexArray:
        return np.asarray(fft.rfft(signal, self.length))

    def _signal(self, lines: ComplexArray) -> FloatArray:
        signal = fft.irfft(lines, self.length)[..., : self.count]
        return np.asarray(signal, np.float64)

    def _own(self, signal: FloatArray) -> FloatArray:
        """Leave out what was before the record."""
        return signal[..., -len(self.record) :]

    def _powers_of_s(self, lines: ComplexArray, count: int) -> ComplexArray:
        """Multiply lines by so many powers of s, from zero on, a row each."""
        rows = np.empty((count, len(lines)), dtype=np.complex128)
        for row in rows:
            row[:] = lines
            lines = lines * self.s
        return rows

    def between(self, halves: Halves) -> FloatArray:
        """Give the signal between the halves."""
        front = self._signal(halves.front.at(self.s) * self.spectrum)
        return front + self.before * halves.front.static

    def sent(self, halves: Halves) -> Sent:
        """Send the input through.

        The latest is kept, as a step that pays is looked at again.
        """
        if self._latest is not None and halves.send_as(self._latest[0]):
            return self._latest[1]
        self._latest = halves, self._sent(halves)
        return self._latest[1]

    def _sent(self, halves: Halves) -> Sent:
        w, back = self.between(halves), halves.back
        rest = float(halves.bend(self.before * halves.front.static))
        behind = self._lines(halves.bend(w) - rest)
        y = self._signal(back.at(self.s) * behind)
        y += rest * back.static + halves.offset
        return Sent(w, behind, self._own(y))

    def powers(
        self, halves: Halves, w: FloatArray, back: ComplexArray | None = None
    ) -> FloatArray:
        """How the output changes with each number of the curve, and the constant.

        Returns
        -------
        ndarray, shape (samples, DEGREE + 1)
        """
        was = self.before * halves.front.static
        still = halves.back.static
        back = halves.back.at(self.s) if back is None else back
        rests = was ** np.arange(1, DEGREE + 1)[:, None]
        powers = np.multiply.accumulate(np.broadcast_to(w, (DEGREE, len(w))))
        rows = self._signal(back * self._lines(powers - rests)) + still * rests
        return self._own(np.vstack([rows, np.ones(self.count)])).T

    def derivatives(self, halves: Halves, sent: Sent) -> FloatArray:
        """How the output changes with each number, but for what was for ever before.

        Returns
        -------
        ndarray, shape (samples, Halves.count)
        """
        s, front, back = self.s, halves.front, halves.back.at(self.s)
        slopes = np.arange(1, DEGREE + 1) * halves.curve
        steep = np.polyval(slopes[::-1], sent.w)
        by_b = self.spectrum / below(front.a, s)
        lines = self._by_coefficient(front, front.at(s), by_b)
        in_front = self._signal(back * self._lines(steep * self._signal(lines)))
        by_b = sent.behind / below(halves.back.a, s)
        behind = self._signal(self._by_coefficient(halves.back, back, by_b))
        own = self._own(np.vstack([in_front, behind])).T
        return np.hstack([own, self.powers(halves, sent.w, back)])

    def _by_coefficient(
        self, half: Rational, values: ComplexArray, by_b: ComplexArray
    ) -> ComplexArray:
        """Give lines of the change with each coefficient, first the denominator's."""
        by_a = self._powers_of_s(-values * by_b, len(half.a))
        return np.vstack([by_a, self._powers_of_s(by_b, len(half.b))])


@dataclass(frozen=True)
class HalvesError:
    """Records that two halves are fitted to by their simulation."""

    records: tuple[Record, ...]
    masks: tuple[Mask, ...]
    """Samples that count."""
    hold: Hold
    scale: float
    """Unit of s, in rad/s."""
    start: str = "rest"
    """How the records start, as in a transfer function's block."""

    @cached_property
    def ways(self) -> list[Way]:
        """Each record on its way."""
        pairs = zip(self.records, self.masks, strict=True)
        return [Way(record, mask, self) for record, mask in pairs]

    def middle(self, halves: Halves) -> float:
        """Give the point about which the curve is odd: where a cubic through it turns.

        Zero where that lies outside the signal between the halves.
        """
        w = np.concatenate([way.between(halves) for way in self.ways])
        cube, square, *_ = np.polyfit(w, halves.bend(w), 3)
        middle = -square / (3 * cube) if cube else 0.0
        return float(middle) if np.abs(middle) <= np.abs(w).max() else 0.0

    def within(self, halves: Halves) -> Halves:
        """Give halves whose curve goes no farther than the samples that count."""
        w = [way.between(halves)[-len(way.mask) :][way.mask] for way in self.ways]
        every = np.concatenate(w)
        return replace(halves, limits=(float(every.min()), float(every.max())))

    def squares(self, halves: Halves) -> float:
        """Sum of squares of the error over the samples that count."""
        total = 0.0
        for way in self.ways:
            error = (way.record.y - way.sent(halves).output)[way.mask]
            total += float(error @ error)
        return total if np.isfinite(total) else np.inf

    def bent(self, halves: Halves) -> Halves:
        """Give them with the curve and the constant that fit best."""
        tables = [
            way.powers(halves, way.between(halves))[way.mask] for way in self.ways
        ]
        table = np.vstack(tables)
        y = np.concatenate([way.record.y[way.mask] for way in self.ways])
        size = np.linalg.norm(table, axis=0)
        size[size == 0] = 1.0
        gram = (table / size).T @ (table / size)
        found = np.linalg.lstsq(gram, (table / size).T @ y, rcond=1e-14)[0] / size
        fitted = replace(halves, curve=found[:-1], offset=float(found[-1]))
        return replace(fitted, cost=float(np.sum((y - table @ found) ** 2)))

    def refined(self, halves: Halves, rounds: int) -> Halves:
        """Go down the sum of squares in all numbers."""
        halves = replace(halves, cost=self.squares(halves))
        return descended(halves, self._steps, rounds, 1e-4)

    def _steps(self, halves: Halves) -> Callable[[float], Halves]:
        """Give what a step makes of them, from sums of products of the derivatives."""
        gram, slope = np.zeros((halves.count,) * 2), np.zeros(halves.count)
        for way in self.ways:
            sent = way.sent(halves)
            columns = way.derivatives(halves, sent)[way.mask]
            gram += columns.T @ columns
            slope += columns.T @ (way.record.y - sent.output)[way.mask]

        def stepped(damping: float) -> Halves:
            matrix = gram + damping * np.diag(np.diag(gram) + 1e-300)
            step = np.asarray(np.linalg.lstsq(matrix, slope, rcond=1e-14)[0], float)
            moved = halves.moved(step)
            return replace(moved, cost=self.squares(moved))

        return stepped


def _stable(a: FloatArray) -> FloatArray:
    return stable(a, MARGIN) if len(a) else a

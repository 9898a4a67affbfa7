"""Two transfer functions with a static curve between them, in output error."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from hystbench.blocks.held import Hold
from hystbench.blocks.starts import path_from
from hystbench.gap.bases.spectral import stable
from hystbench.record import ComplexArray, FloatArray, Mask, Record

#: Degree of the polynomial that stands for the curve.
DEGREE = 5
#: Least damping ratio of a pole: a refit changes coefficients by a thousandth to see
#: what they do, and must not make a pole unstable.
MARGIN = 5e-3
#: A step is damped so many times before a descent ends.
TRIALS = 8
#: Share of the sum of squares that a step must win for another one to follow.
LEAST_GAIN = 1e-4


@dataclass(frozen=True)
class Halves:
    """A front, a curve ``c_1 w + c_2 w^2 + ..`` and a back, with a constant at the end.

    Coefficients ascend; s is in units of a scale in rad/s. A denominator has one for
    its last coefficient, which is left out.

    Parameters
    ----------
    front_a, front_b, back_a, back_b : ndarray
        Denominator and numerator of either half.
    curve : ndarray, shape (DEGREE,)
    offset : float
    cost : float
        Sum of squares.
    """

    front_a: FloatArray
    front_b: FloatArray
    back_a: FloatArray
    back_b: FloatArray
    curve: FloatArray
    offset: float = 0.0
    cost: float = np.inf

    @property
    def count(self) -> int:
        """How many numbers there are."""
        return len(self._joined)

    @property
    def _joined(self) -> FloatArray:
        parts = (self.front_a, self.front_b, self.back_a, self.back_b, self.curve)
        return np.concatenate([*parts, [self.offset]])

    def moved(self, step: FloatArray) -> Halves:
        """Give them after a step in all numbers, with stable poles."""
        sizes = (self.front_a, self.front_b, self.back_a, self.back_b, self.curve)
        ends = np.cumsum([len(item) for item in sizes])
        fa, fb, ba, bb, curve, offset = np.split(self._joined + step, ends)
        return Halves(_stable(fa), fb, _stable(ba), bb, curve, float(offset[0]))


@dataclass(frozen=True)
class _Sent:
    """Signals on the way through, over a record and what was before it."""

    w: FloatArray
    behind: ComplexArray
    output: FloatArray


@dataclass(frozen=True)
class HalvesError:
    """Records that two halves are fitted to by their simulation.

    Parameters
    ----------
    records : tuple of Record
    masks : tuple of ndarray of bool
        Samples that count.
    hold : {"zero-order", "linear", "band-limited"}
    scale : float
        Unit of s, in rad/s.
    start : {"rest", "settled", "moving", "repeating"}
        As of a transfer function's block.
    """

    records: tuple[Record, ...]
    masks: tuple[Mask, ...]
    hold: Hold
    scale: float
    start: str = "rest"

    @cached_property
    def _paths(self) -> list[tuple[FloatArray, float, ComplexArray, ComplexArray]]:
        """Input with what was before it, as its hold shapes it, and s of its lines."""
        found = []
        for record in self.records:
            path, before = path_from(record.u, self.start)
            n = len(path)
            f = np.asarray(np.fft.rfftfreq(2 * n, record.dt), dtype=np.float64)
            spectrum = np.fft.rfft(path - before, 2 * n) * held(
                f * record.dt, self.hold
            )
            s = np.asarray(2j * np.pi * f / self.scale, dtype=np.complex128)
            found.append((path, before, spectrum, s))
        return found

    def _between(self, halves: Halves, number: int) -> FloatArray:
        path, before, spectrum, s = self._paths[number]
        front = _ratio(halves.front_b, halves.front_a, s)
        was = before * _static(halves.front_b, halves.front_a)
        return _signal(front * spectrum, len(path)) + was

    def _sent(self, halves: Halves, number: int) -> _Sent:
        path, before, _, s = self._paths[number]
        w = self._between(halves, number)
        was = before * _static(halves.front_b, halves.front_a)
        bent, rest = _curve(halves.curve, w), float(_curve(halves.curve, was))
        behind = np.fft.rfft(bent - rest, 2 * len(path))
        back = _ratio(halves.back_b, halves.back_a, s)
        y = _signal(back * behind, len(path))
        y += rest * _static(halves.back_b, halves.back_a) + halves.offset
        return _Sent(w, behind, y[-len(self.records[number]) :])

    def middle(self, halves: Halves) -> float:
        """Give the point about which the curve is odd: where a cubic through it turns.

        Zero where that lies outside the signal between the halves.
        """
        w = np.concatenate([self._between(halves, k) for k in range(len(self.records))])
        cube, square, *_ = np.polyfit(w, _curve(halves.curve, w), 3)
        middle = -square / (3 * cube) if cube else 0.0
        return float(middle) if np.abs(middle) <= np.abs(w).max() else 0.0

    def squares(self, halves: Halves) -> float:
        """Sum of squares of the error over the samples that count."""
        total = 0.0
        for k, (record, mask) in enumerate(zip(self.records, self.masks, strict=True)):
            error = (record.y - self._sent(halves, k).output)[mask]
            total += float(error @ error)
        return total if np.isfinite(total) else np.inf

    def bent(self, halves: Halves) -> Halves:
        """Give them with the curve and the constant that fit best."""
        tables, wanted = [], []
        for k, (record, mask) in enumerate(zip(self.records, self.masks, strict=True)):
            tables.append(self._powers(halves, k, self._between(halves, k))[mask])
            wanted.append(record.y[mask])
        table, y = np.vstack(tables), np.concatenate(wanted)
        size = np.linalg.norm(table, axis=0)
        size[size == 0] = 1.0
        gram = (table / size).T @ (table / size)
        found = np.linalg.lstsq(gram, (table / size).T @ y, rcond=1e-14)[0] / size
        fitted = replace(halves, curve=found[:-1], offset=float(found[-1]))
        return replace(fitted, cost=float(np.sum((y - table @ found) ** 2)))

    def refined(self, halves: Halves, rounds: int) -> Halves:
        """Go down the sum of squares in all numbers (Levenberg and Marquardt)."""
        best = replace(halves, cost=self.squares(halves))
        damping = 1e-4
        for _ in range(rounds):
            gram, slope = self._normal(best)
            for _ in range(TRIALS):
                matrix = gram + damping * np.diag(np.diag(gram) + 1e-300)
                step = np.asarray(np.linalg.lstsq(matrix, slope, rcond=1e-14)[0], float)
                tried = best.moved(step)
                tried = replace(tried, cost=self.squares(tried))
                if tried.cost < best.cost:
                    break
                damping *= 10.0
            else:
                return best
            small = tried.cost > (1 - LEAST_GAIN) * best.cost
            best, damping = tried, max(damping / 10.0, 1e-9)
            if small:
                break
        return best

    def _normal(self, halves: Halves) -> tuple[FloatArray, FloatArray]:
        """Sums of products of the derivatives, and of them with the error."""
        gram, slope = np.zeros((halves.count,) * 2), np.zeros(halves.count)
        for k, (record, mask) in enumerate(zip(self.records, self.masks, strict=True)):
            sent = self._sent(halves, k)
            columns = self._derivatives(halves, k, sent)[mask]
            error = (record.y - sent.output)[mask]
            gram += columns.T @ columns
            slope += columns.T @ error
        return gram, slope

    def _powers(self, halves: Halves, number: int, w: FloatArray) -> FloatArray:
        """How the output changes with each number of the curve, and the constant."""
        path, before, _, s = self._paths[number]
        was = before * _static(halves.front_b, halves.front_a)
        back = _ratio(halves.back_b, halves.back_a, s)
        still = _static(halves.back_b, halves.back_a)
        columns = [
            _signal(back * np.fft.rfft(w**k - was**k, 2 * len(path)), len(path))
            + still * was**k
            for k in range(1, DEGREE + 1)
        ]
        table = np.column_stack([*columns, np.ones(len(path))])
        return table[-len(self.records[number]) :]

    def _derivatives(self, halves: Halves, number: int, sent: _Sent) -> FloatArray:
        """How the output changes with each number, but for what was for ever before."""
        path, _, spectrum, s = self._paths[number]
        n = len(path)
        back = _ratio(halves.back_b, halves.back_a, s)
        slopes = np.arange(1, DEGREE + 1) * halves.curve
        steep = np.polyval(slopes[::-1], sent.w)

        def through(change: ComplexArray) -> FloatArray:
            bent = np.fft.rfft(steep * _signal(change, n), 2 * n)
            return _signal(back * bent, n)

        by_b = spectrum / _below(halves.front_a, s)
        by_a = -_ratio(halves.front_b, halves.front_a, s) * by_b
        columns = [through(by_a * s**k) for k in range(len(halves.front_a))]
        columns += [through(by_b * s**k) for k in range(len(halves.front_b))]
        by_b = sent.behind / _below(halves.back_a, s)
        by_a = -back * by_b
        columns += [_signal(by_a * s**k, n) for k in range(len(halves.back_a))]
        columns += [_signal(by_b * s**k, n) for k in range(len(halves.back_b))]
        own = [column[-len(self.records[number]) :] for column in columns]
        return np.column_stack([*own, self._powers(halves, number, sent.w)])


def held(cycles: FloatArray, hold: Hold) -> FloatArray | ComplexArray:
    """Give what a hold makes of lines, by cycles a sample."""
    if hold == "linear":
        return np.sinc(cycles) ** 2
    if hold == "zero-order":
        return np.asarray(np.sinc(cycles) * np.exp(-1j * np.pi * cycles))
    return np.ones(len(cycles))


def _curve(curve: FloatArray, w: FloatArray | float) -> FloatArray:
    return np.asarray(np.polyval(np.append(curve[::-1], 0.0), w), dtype=np.float64)


def _below(a: FloatArray, s: ComplexArray) -> ComplexArray:
    return np.asarray(np.polyval(np.append(a, 1.0)[::-1], s), dtype=np.complex128)


def _ratio(b: FloatArray, a: FloatArray, s: ComplexArray) -> ComplexArray:
    return np.asarray(np.polyval(b[::-1], s) / _below(a, s), dtype=np.complex128)


def _static(b: FloatArray, a: FloatArray) -> float:
    return float(b[0] / a[0]) if len(a) else float(b[0])


def _signal(spectrum: ComplexArray, n: int) -> FloatArray:
    return np.asarray(np.fft.irfft(spectrum, 2 * n)[:n], dtype=np.float64)


def _stable(a: FloatArray) -> FloatArray:
    return stable(a, MARGIN) if len(a) else a

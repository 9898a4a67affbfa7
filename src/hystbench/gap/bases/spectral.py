"""A rational transfer function from spectra, in output error, with free transients.

Over a finite record the spectra obey ``Y = (B U + T) / A``: T is a polynomial that
stands for the state at both ends of the record [1]_. So a stretch out of the middle of
a motion needs no start from rest, and by Parseval's theorem the sum of squares is that
of the free-run simulation.

References
----------
.. [1] R. Pintelon, J. Schoukens, System Identification: A Frequency Domain Approach,
   2nd ed., Wiley, 2012, sections 2.6 and 6.3.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import cast

import numpy as np

from hystbench.blocks.held import Hold
from hystbench.blocks.transfer_function import TransferFunction
from hystbench.record import ComplexArray, FloatArray, Record

#: Highest order that is fitted.
HIGHEST_ORDER = 12
#: Share of a channel's power that may lie beyond the last line that is used.
BEYOND = 1e-5
#: Fewest lines that are used.
FEWEST = 100
#: Rounds of Sanathanan and Koerner, then of Gauss and Newton.
ROUNDS = 12
REFINED = 25
#: Share of the cost that a round must win for another one to follow.
LEAST_GAIN = 1e-5
#: Damping ratio at which a further mode is begun.
BEGUN_DAMPING = 0.01
#: Peaks of what is left at which a further mode is begun.
PEAKS = 3
#: Lines whose coherence is one number.
TOGETHER = 8
#: Half the width of a band, as a share of its frequency.
BAND = 0.05
#: A pole is kept off the imaginary axis by this share of its size.
MARGIN = 1e-5


@dataclass(frozen=True)
class RecordSpectrum:
    """Spectral lines of one record."""

    s: ComplexArray
    """Shape (l,). ``j w`` over the scale."""
    u: ComplexArray
    y: ComplexArray
    """Shape (l,). Input as its hold shapes it, and output; the sum of ``|y|^2`` is the
    sum of squares of the samples."""
    constant: FloatArray
    """Shape (l,). Spectrum of a constant of one."""

    @cached_property
    def powers(self) -> ComplexArray:
        """Powers of s from zero on, shape (l, HIGHEST_ORDER + 1)."""
        return np.vander(self.s, HIGHEST_ORDER + 1, increasing=True)


@dataclass(frozen=True)
class Spectra:
    """Lines of all records, over one scale of frequency in rad/s."""

    lines: tuple[RecordSpectrum, ...]
    scale: float

    @classmethod
    def of(cls, records: Sequence[Record], hold: Hold) -> Spectra:
        """Transform records.

        The images of the input that a staircase or straight lines leave above half
        the sampling rate are not seen.
        """
        raw = [_transformed(item, hold) for item in records]
        power = sum(float(np.sum(np.abs(y[1:]) ** 2)) for _, _, y, _ in raw)
        moment = sum(float(np.sum((w * np.abs(y)) ** 2)) for w, _, y, _ in raw)
        scale = float(np.sqrt(moment / power))
        lines = []
        for w, u, y, constant in raw:
            cut = slice(0, max(_lines_that_matter(u), _lines_that_matter(y)))
            s = np.asarray(1j * w[cut] / scale, dtype=np.complex128)
            lines.append(RecordSpectrum(s, u[cut], y[cut], constant[cut]))
        return cls(tuple(lines), scale)


@dataclass(frozen=True)
class Rational:
    """``(b_0 + .. + b_m s^m) / (a_0 + .. + a_{k-1} s^{k-1} + s^k)``.

    Coefficients ascend; s is in units of a scale in rad/s.
    """

    a: FloatArray
    b: FloatArray

    def poles(self, scale: float) -> ComplexArray:
        """Give the poles in 1/s, for a scale in rad/s."""
        return np.asarray(scale * np.roots(np.append(self.a, 1.0)[::-1]), complex)

    @property
    def static(self) -> float:
        """Give the value at s = 0."""
        return float(self.b[0] / self.a[0]) if len(self.a) else float(self.b[0])

    def at(self, s: ComplexArray) -> ComplexArray:
        """Give its values."""
        up = _by_horner(np.full(s.shape, self.b[-1], np.complex128), self.b[:-1], s)
        return up / below(self.a, s)

    def block(self, scale: float, hold: Hold, start: str) -> TransferFunction:
        """Write it as a block, the last coefficient of whose denominator is one."""
        down = np.append(self.a, 1.0) / scale ** np.arange(len(self.a) + 1)
        up = self.b / scale ** np.arange(len(self.b))
        return TransferFunction(
            numerator=tuple((up[::-1] / down[0]).tolist()),
            denominator=tuple((down[::-1] / down[0]).tolist()),
            hold=hold,
            start=start,
        )


@dataclass(frozen=True)
class Ratio(Rational):
    """A rational function and a constant, and the sum of squares that these leave."""

    offset: float
    cost: float

    def simulates_as(self, other: Ratio) -> bool:
        """Tell whether it has another's numbers: the same arrays, but for the cost."""
        same = self.a is other.a and self.b is other.b
        return same and self.offset == other.offset


def fit_ratio(spectra: Spectra, order: int, zeros: int) -> Ratio:
    """Find the stable ratio with the least squares of output error.

    Sanathanan and Koerner's rounds [1]_ give a start; Gauss and Newton's steps on the
    denominator alone follow, with numerator, constant and transients solved for each
    time (variable projection). Poles that cross the axis are reflected.

    Parameters
    ----------
    spectra : Spectra
    order, zeros : int
        Degrees of denominator and numerator, ``zeros <= order``, ``order >= 1``.

    References
    ----------
    .. [1] C. K. Sanathanan, J. Koerner, "Transfer function synthesis as a ratio of
       two complex polynomials", IEEE Trans. Automatic Control 8 (1963) 56-58.
    """
    problem = _Problem(spectra, order, zeros)
    slow = np.asarray(np.poly(-np.ones(order)), dtype=np.float64)
    best = problem.solved(slow[:0:-1])
    a = best.a
    for _ in range(ROUNDS):
        a = stable(problem.denominator(a))
        found = problem.solved(a)
        if found.cost < best.cost:
            small = found.cost > (1 - 1e-3) * best.cost
            best = found
            if small:
                break
    for _ in range(REFINED):
        step = problem.denominator(best.a, best) - best.a
        for share in (1.0, 0.5, 0.25, 0.1, 0.02):
            found = problem.solved(stable(best.a + share * step))
            if found.cost < best.cost:
                break
        else:
            return best
        small = found.cost > (1 - LEAST_GAIN) * best.cost
        best = found
        if small:
            break
    return best


def with_poles(spectra: Spectra, a: FloatArray, zeros: int) -> Ratio:
    """Find the numerator and the constant of a ratio whose denominator is given."""
    return _Problem(spectra, len(a), zeros).solved(a)


def with_a_mode(
    spectra: Spectra, ratio: Ratio, left: Sequence[FloatArray]
) -> Iterator[Ratio]:
    """Give a ratio a further pair of poles, at each of the peaks of what it leaves.

    Numerator, constant and transients are solved for.

    Parameters
    ----------
    spectra : Spectra
    ratio : Ratio
    left : sequence of ndarray, shape (n,) each
        What it leaves of the output, by record.
    """
    order = len(ratio.a) + 2
    problem = _Problem(spectra, order, order)
    for s in _peaks(spectra, left):
        pair = [1.0, 2 * BEGUN_DAMPING * s, s**2]
        a = np.polymul(np.append(ratio.a, 1.0)[::-1], pair)[:0:-1]
        yield problem.solved(np.asarray(a))


def _peaks(spectra: Spectra, left: Sequence[FloatArray]) -> Iterator[float]:
    """Give where most coherent power is left in a band of a tenth.

    That is the power which follows the input by one frequency response [1]_, of some
    lines next to each other: noise and distortion have more power where the output has.
    Frequencies are in units of the scale.

    References
    ----------
    .. [1] J. S. Bendat, A. G. Piersol, Random Data, 4th ed., Wiley, 2010, chapter 6.
    """
    s = np.concatenate([lines.s.imag for lines in spectra.lines])
    u = np.concatenate([lines.u for lines in spectra.lines])
    rest = np.concatenate(
        [
            np.fft.rfft(rest)[: len(lines.s)] / np.sqrt(len(rest))
            for rest, lines in zip(left, spectra.lines, strict=True)
        ]
    )
    order = np.argsort(s)[np.sum(s <= 0) :]
    order = order[: len(order) - len(order) % TOGETHER]
    s, u, rest = (x[order].reshape(-1, TOGETHER) for x in (s, u, rest))
    driven = np.sum(np.abs(u) ** 2, axis=1)
    follows = np.abs(np.sum(rest * u.conj(), axis=1)) ** 2
    follows = np.divide(follows, driven, out=np.zeros(len(u)), where=driven > 0)
    # Of noise one line's share of all follows by chance.
    every = np.sum(np.abs(rest) ** 2, axis=1)
    power = np.maximum(TOGETHER * follows - every, 0.0) / (TOGETHER - 1)
    s = s.mean(axis=1)
    for _ in range(PEAKS):
        total = np.concatenate([[0.0], np.cumsum(power)])
        first, end = (np.searchsorted(s, s * k) for k in (1 - BAND, 1 + BAND))
        best = int(np.argmax(total[end] - total[first]))
        near = slice(first[best], end[best])
        if not np.any(power[near]):
            return
        yield float(np.average(s[near], weights=power[near]))
        power[near] = 0.0


def stable(a: FloatArray, margin: float = MARGIN) -> FloatArray:
    """Reflect the poles of ``s^k + a_{k-1} s^{k-1} + .. + a_0`` to the left.

    They are kept off the axis by a share ``margin`` of their size.
    """
    poles = np.roots(np.append(a, 1.0)[::-1])
    damping = np.maximum(np.abs(poles.real), margin * np.abs(poles) + 1e-9)
    return cast(FloatArray, np.poly(-damping + 1j * poles.imag).real[:0:-1].copy())


@dataclass(frozen=True)
class _Problem:
    spectra: Spectra
    order: int
    zeros: int

    def solved(self, a: FloatArray) -> Ratio:
        """Give the best numerator and constant for a denominator."""
        triangles = [
            _triangle(*self._linear(lines, 1 / below(a, lines.s)), lines.y)
            for lines in self.spectra.lines
        ]
        found, cost = _least(triangles)
        b, moved = found[: self.zeros + 1], found[-1]
        return Ratio(a, b, float(moved / a[0]), cost)

    def denominator(self, a: FloatArray, now: Ratio | None = None) -> FloatArray:
        """Take a round of Sanathanan and Koerner, or of Gauss and Newton from there."""
        triangles = []
        for lines in self.spectra.lines:
            weight = 1 / below(a, lines.s)
            linear, transients = self._linear(lines, weight)
            powers = lines.powers[:, : self.order]
            if now is None:
                moved = powers * (weight * lines.y)[:, None]
                target = lines.powers[:, self.order] * weight * lines.y
            else:
                modelled = linear @ np.append(now.b, now.offset * a[0])
                basis, triangle = np.linalg.qr(_real(transients))
                inside = basis.T @ _real(lines.y - modelled)
                # Of fewer lines than the transient has numbers: the least numbers.
                moved_by, *_ = np.linalg.lstsq(triangle, inside, rcond=None)
                modelled = modelled + transients @ moved_by
                moved = powers * (weight * modelled)[:, None]
                target = -(lines.y - modelled)
            columns = np.column_stack([-moved, linear])
            triangles.append(_triangle(columns, transients, target))
        found, _ = _least(triangles)
        change = found[: self.order]
        return change if now is None else a - change

    def _linear(
        self, lines: RecordSpectrum, weight: ComplexArray
    ) -> tuple[ComplexArray, ComplexArray]:
        """Columns of numerator and constant, and those of the transient."""
        weighted = lines.powers[:, : self.order + 1] * weight[:, None]
        own = weighted[:, : self.zeros + 1] * lines.u[:, None]
        return np.column_stack([own, weighted[:, 0] * lines.constant]), weighted


def below(a: FloatArray, s: ComplexArray) -> ComplexArray:
    """Give the values of a denominator."""
    return _by_horner(np.ones(s.shape, np.complex128), a, s)


def _by_horner(found: ComplexArray, a: FloatArray, s: ComplexArray) -> ComplexArray:
    """Go on from the highest power's coefficient to the others, which ascend; in place.

    As polyval does, without an array for each step: many are short.
    """
    for number in a[::-1].tolist():
        found *= s
        found += number
    return found


def _transformed(
    item: Record, hold: Hold
) -> tuple[FloatArray, ComplexArray, ComplexArray, FloatArray]:
    n = len(item.u)
    f = np.asarray(np.fft.rfftfreq(n, item.dt), dtype=np.float64)
    # every line but the first stands for itself and its mirror image
    size = np.sqrt(np.where(f > 0, 2.0, 1.0) / n)
    constant: FloatArray = np.where(f > 0, 0.0, n * size)
    u, y = np.fft.rfft(item.u), np.fft.rfft(item.y)
    return 2 * np.pi * f, u * held(f * item.dt, hold) * size, y * size, constant


def held(cycles: FloatArray, hold: Hold) -> FloatArray | ComplexArray:
    """Give what a hold makes of lines, by cycles a sample."""
    if hold == "linear":
        return np.sinc(cycles) ** 2
    if hold == "zero-order":
        return np.asarray(np.sinc(cycles) * np.exp(-1j * np.pi * cycles))
    return np.ones(len(cycles))


def _lines_that_matter(spectrum: ComplexArray) -> int:
    tail = np.cumsum((np.abs(spectrum[1:]) ** 2)[::-1])[::-1]
    return 1 + max(int(np.sum(tail > BEYOND * tail[0])), FEWEST)


def _real(values: ComplexArray) -> FloatArray:
    return np.concatenate([values.real, values.imag])


def _triangle(
    columns: ComplexArray, transients: ComplexArray, target: ComplexArray
) -> FloatArray:
    """Triangle of a record's equations, without what its transient can do."""
    every = triangle_of(_real(np.column_stack([transients, columns, target])))
    own = transients.shape[1]
    return every[own:, own:]


def triangle_of(equations: FloatArray) -> FloatArray:
    """Triangle whose least squares, the last column being the target, are the same."""
    return np.asarray(np.linalg.qr(equations, mode="r"))


def _least(triangles: Sequence[FloatArray]) -> tuple[FloatArray, float]:
    """Least squares over all records: the solution, and what is left."""
    all_of_them = triangle_of(np.vstack(triangles))
    left, right = all_of_them[:, :-1], all_of_them[:, -1]
    size = np.linalg.norm(left, axis=0)
    size[size == 0] = 1.0
    found = np.linalg.lstsq(left / size, right, rcond=1e-13)[0] / size
    rest = right - left @ found
    return found, float(rest @ rest)

"""Whether a record is a copy of another: all of it or a piece, as it is or rounded."""

from functools import cached_property
from typing import NamedTuple, Self

import numpy as np
from numpy.typing import NDArray

from hystbench.record import FloatArray, Record

DIGITS = 12
"""Digits behind which numbers count as not rounded."""
PROBED = 2000
"""Samples of a record from which its last digit is read."""
FINE = 0.05
"""Share of an input's rms beyond which rounding leaves no record to compare."""
MOST_PLACES = 20
"""Places at which a piece is compared in full; a periodic record has many alike."""
MOST_RATIO = 64
"""Times by which one record may be sampled more coarsely than another."""

Rows = NDArray[np.float64]  # shape (2, n): input and output


class CommonPiece(NamedTuple):
    """Samples that stand in a row in two records."""

    samples: int
    """Of the record with fewer of them there."""
    first: int
    other_first: int
    """Where they begin in each."""
    exact: bool
    """Whether they are equal, and not only up to rounding."""

    def turned(self) -> Self:
        """Give the same piece, seen from the other record."""
        return self._replace(first=self.other_first, other_first=self.first)


class Written:
    """A record and the digits to which it is written, which are read once.

    Parameters
    ----------
    record : Record
    """

    def __init__(self, record: Record) -> None:
        self.dt = record.dt
        self.rows: Rows = np.stack([record.u, record.y])

    @cached_property
    def steps(self) -> Rows:
        """Step of the last digit of each value."""
        return np.stack([_last_digit(row) for row in self.rows])

    def every(self, step: int, start: int = 0) -> tuple[Rows, Rows]:
        """Give every so manyth sample, and the steps of their last digits."""
        return self.rows[:, start::step], self.steps[:, start::step]


def common_piece(one: Written, two: Written) -> CommonPiece | None:
    """Find a piece that two records share: half of the shorter one or more.

    Input and output must both be equal, each up to the last digit that is written in
    the record of fewer digits; time does not count. Where one record is sampled more
    coarsely by a whole number, every so manyth sample of the other is looked at too.

    Returns
    -------
    CommonPiece or None
        As seen from the first record.
    """
    ratio = one.dt / two.dt
    for coarse, other, step in (
        (one, two, round(ratio)),
        (two, one, round(1 / ratio) if ratio > 0 else 1),
    ):
        for every in {1, step} if 1 < step <= MOST_RATIO else {1}:
            if every == 1 and other is one:
                continue  # the first pair has compared them as they are
            for start in range(every):
                ours, theirs = coarse.every(1), other.every(every, start)
                found = _shared(ours[0], theirs[0], ours[1], theirs[1])
                if found is not None:
                    inside = start + every * found.other_first
                    piece = found._replace(other_first=inside)
                    return piece if coarse is one else piece.turned()
    return None


def _shared(one: Rows, two: Rows, one_step: Rows, two_step: Rows) -> CommonPiece | None:
    """Find half or more of the shorter of two runs of samples in the other."""
    if one.shape[1] > two.shape[1]:
        found = _shared(two, one, two_step, one_step)
        return None if found is None else found.turned()
    count = one.shape[1]
    least = count // 2 + count % 2
    if count < 4:
        return None
    # A run of half the samples holds the second quarter of them or the third.
    quarter = count // 4
    for first in (quarter, count // 2):
        block = slice(first, first + quarter)
        for place in _places(one[:, block], two, one_step[:, block], two_step):
            away = place - first
            low, high = max(0, -away), min(count, two.shape[1] - away)
            ours, theirs = slice(low, high), slice(low + away, high + away)
            alike = _equal(
                one[:, ours], two[:, theirs], one_step[:, ours], two_step[:, theirs]
            )
            start, stop = _run_around(alike, first - low)
            if stop - start >= least:
                start, stop = start + low, stop + low
                exact = np.array_equal(
                    one[:, start:stop], two[:, start + away : stop + away]
                )
                return CommonPiece(stop - start, start, start + away, exact)
    return None


def _last_digit(values: FloatArray) -> FloatArray:
    """Give the step of the last digit to which each value is written.

    Either all have the same number of decimals or the same number of digits.
    """
    largest = float(np.abs(values).max()) or 1.0
    some = values[:: max(1, len(values) // PROBED)]
    top = int(np.floor(np.log10(largest)))
    for digits in range(1, DIGITS + 1):
        step = 10.0 ** (top + 1 - digits)
        if _whole(some / step) and _whole(values / step):
            return np.full(len(values), step)
        if _whole(some / (_size(some) * 10.0 ** (1 - digits))):
            return _size(values) * 10.0 ** (1 - digits)
    return np.full(len(values), largest * 10.0**-DIGITS)


def _size(values: FloatArray) -> FloatArray:
    """Give the power of ten of the first digit of each value."""
    return np.asarray(10.0 ** np.floor(np.log10(np.where(values == 0, 1, abs(values)))))


def _whole(values: FloatArray) -> bool:
    return bool(np.all(np.abs(values - np.rint(values)) < 1e-3))


def _equal(a: Rows, b: Rows, a_step: Rows, b_step: Rows) -> NDArray[np.bool_]:
    """Tell sample by sample whether both rows agree up to the coarser last digit."""
    near = np.abs(a - b) <= 0.51 * np.maximum(a_step, b_step)
    return np.asarray(near.all(axis=0))


def _near(block: FloatArray, row: FloatArray) -> NDArray[np.intp]:
    """Find where in a longer row a block may stand, up to any rounding that is fine."""
    count, length = len(row), len(block)
    middle = row.mean()
    piece, long = block - middle, row - middle
    size = 2 ** int(np.ceil(np.log2(count + length)))
    spectrum = np.fft.rfft(long, size) * np.conj(np.fft.rfft(piece, size))
    product = np.fft.irfft(spectrum, size)[: count - length + 1]
    squares = np.concatenate([[0.0], np.cumsum(long**2)])
    apart = squares[length:] - squares[:-length] - 2 * product + piece @ piece
    return np.flatnonzero(apart <= length * FINE**2 * squares[-1] / count)


def _places(block: Rows, rows: Rows, block_step: Rows, step: Rows) -> list[int]:
    """Give places where a block may stand: by a few samples, then by all of the input.

    Few samples leave next to none where nothing is copied.
    """
    found = np.arange(rows.shape[1] - block.shape[1] + 1)
    for k in np.linspace(0, block.shape[1] - 1, 32).astype(int):
        own, there = [k], found + k
        found = found[
            _equal(block[:, own], rows[:, there], block_step[:, own], step[:, there])
        ]
        if not len(found):
            return []
    found = found[np.isin(found, _near(block[0], rows[0]), assume_unique=True)]
    return [int(place) for place in found[:MOST_PLACES]]


def _run_around(alike: NDArray[np.bool_], inside: int) -> tuple[int, int]:
    """Give the run of true values that holds a place."""
    if not alike[inside]:
        return 0, 0
    wrong = np.flatnonzero(~alike)
    after = int(np.searchsorted(wrong, inside))
    start = int(wrong[after - 1]) + 1 if after > 0 else 0
    stop = int(wrong[after]) if after < len(wrong) else len(alike)
    return start, stop

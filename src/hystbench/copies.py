"""Whether a record is a copy of another: all of it or a piece, as it is or rounded."""

from typing import NamedTuple, Self

import numpy as np
from numpy.typing import NDArray

from hystbench.record import FloatArray, Record

DIGITS = 12
"""Written behind which numbers count as not rounded."""
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
    """Samples of the shared piece, in the record that has fewer of them there."""
    first: int
    other_first: int
    """First sample of the piece in each record."""
    exact: bool
    """Whether they are equal, and not only up to rounding."""

    def turned(self) -> Self:
        """Give the same piece, seen from the other record."""
        return self._replace(first=self.other_first, other_first=self.first)


class Written(NamedTuple):
    """Samples of a record, and to which digit each is written."""

    dt: float
    rows: Rows
    steps: Rows
    """Step of the last digit of each value."""

    @classmethod
    def of(cls, record: Record) -> Self:
        """Read the digits of a record."""
        rows = np.stack([record.u, record.y])
        return cls(record.dt, rows, np.stack([_last_digit(row) for row in rows]))

    def at(self, places: slice | NDArray[np.intp]) -> Self:
        """Give some of the samples."""
        return self._replace(rows=self.rows[:, places], steps=self.steps[:, places])


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
    found = _shared(one, two) or _in_finer(one, two)
    if found is None and (other := _in_finer(two, one)) is not None:
        found = other.turned()
    return found


def _in_finer(coarse: Written, fine: Written) -> CommonPiece | None:
    """Look among every so manyth sample of a record that is sampled more finely."""
    every = round(coarse.dt / fine.dt)
    for start in range(every) if 1 < every <= MOST_RATIO else ():
        found = _shared(coarse, fine.at(slice(start, None, every)))
        if found is not None:
            return found._replace(other_first=start + every * found.other_first)
    return None


def _shared(one: Written, two: Written) -> CommonPiece | None:
    """Find half or more of the shorter of two runs of samples in the other."""
    count, longer = one.rows.shape[1], two.rows.shape[1]
    if count > longer:
        found = _shared(two, one)
        return None if found is None else found.turned()
    if count < 4:
        return None
    # A run of half the samples holds the second quarter of them or the third.
    quarter = count // 4
    for first in (quarter, count // 2):
        for place in _places(one.at(slice(first, first + quarter)), two):
            away = place - first
            low, high = max(0, -away), min(count, longer - away)
            ours, theirs = slice(low, high), slice(low + away, high + away)
            start, stop = _run_around(_equal(one.at(ours), two.at(theirs)), first - low)
            if stop - start >= count - count // 2:
                start, stop = start + low, stop + low
                exact = np.array_equal(
                    one.rows[:, start:stop], two.rows[:, start + away : stop + away]
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


def _equal(a: Written, b: Written) -> NDArray[np.bool_]:
    """Tell sample by sample whether both rows agree up to the coarser last digit."""
    near = np.abs(a.rows - b.rows) <= 0.51 * np.maximum(a.steps, b.steps)
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


def _places(block: Written, whole: Written) -> list[int]:
    """Give places where a block may stand: by a few samples, then by all of the input.

    Few samples leave next to none where nothing is copied.
    """
    length = block.rows.shape[1]
    found = np.arange(whole.rows.shape[1] - length + 1)
    for k in np.linspace(0, length - 1, 32).astype(int):
        found = found[_equal(block.at(slice(k, k + 1)), whole.at(found + k))]
        if not len(found):
            return []
    near = _near(block.rows[0], whole.rows[0])
    found = found[np.isin(found, near, assume_unique=True)]
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

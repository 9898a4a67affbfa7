"""Whether a record is a copy of another: all of it or a piece, as it is or rounded."""

from __future__ import annotations

from typing import NamedTuple

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


class Piece(NamedTuple):
    """Samples that stand in a row in two records.

    Parameters
    ----------
    samples : int
        Of the record with fewer of them there.
    first, other_first : int
        Where they begin in each.
    exact : bool
        Whether they are equal, and not only up to rounding.
    """

    samples: int
    first: int
    other_first: int
    exact: bool


def common_piece(record: Record, other: Record) -> Piece | None:
    """Find a piece that two records share: half of the shorter one or more.

    Input and output must both be equal, each up to the last digit that is written in
    the record of fewer digits; time does not count. Where one record is sampled more
    coarsely by a whole number, every so manyth sample of the other is looked at too.

    Returns
    -------
    Piece or None
    """
    ratio = record.dt / other.dt
    for one, two, step in (
        (record, other, round(ratio)),
        (other, record, round(1 / ratio) if ratio > 0 else 1),
    ):
        for every in {1, step} if 1 < step <= MOST_RATIO else {1}:
            if every == 1 and two is record:
                continue  # the first pair has compared them as they are
            for start in range(every):
                found = _shared(_rows(one), _rows(two)[:, start::every])
                if found is not None:
                    inside = start + every * found.other_first
                    piece = found._replace(other_first=inside)
                    return piece if one is record else _turned(piece)
    return None


def _turned(piece: Piece) -> Piece:
    """Give the same piece, seen from the other record."""
    return piece._replace(first=piece.other_first, other_first=piece.first)


def _rows(record: Record) -> Rows:
    return np.stack([record.u, record.y])


def _shared(one: Rows, two: Rows) -> Piece | None:
    """Find half or more of the shorter of two runs of samples in the other."""
    if one.shape[1] > two.shape[1]:
        found = _shared(two, one)
        return None if found is None else _turned(found)
    count = one.shape[1]
    least = count // 2 + count % 2
    if count < 4:
        return None
    # A run of half the samples holds the second quarter of them or the third.
    quarter = count // 4
    blocks = {first: slice(first, first + quarter) for first in (quarter, count // 2)}
    near = {first: _near(one[0, blocks[first]], two[0]) for first in blocks}
    if not any(map(len, near.values())):
        return None
    steps = [np.stack([_last_digit(row) for row in rows]) for rows in (one, two)]
    for first, block in blocks.items():
        for place in _places(
            near[first], one[:, block], two, steps[0][:, block], steps[1]
        ):
            away = place - first
            low, high = max(0, -away), min(count, two.shape[1] - away)
            ours, theirs = slice(low, high), slice(low + away, high + away)
            alike = _equal(
                one[:, ours], two[:, theirs], steps[0][:, ours], steps[1][:, theirs]
            )
            start, stop = _run_around(alike, first - low)
            if stop - start >= least:
                start, stop = start + low, stop + low
                exact = np.array_equal(
                    one[:, start:stop], two[:, start + away : stop + away]
                )
                return Piece(stop - start, start, start + away, exact)
    return None


def _last_digit(values: FloatArray) -> FloatArray:
    """Give the step of the last digit to which each value is written.

    Either all have the same number of decimals or the same number of digits.
    """
    largest = float(np.abs(values).max()) or 1.0
    some = values[:: max(1, len(values) // PROBED)]
    top = int(np.floor(np.log10(largest)))
    sizes = [10.0 ** np.floor(np.log10(np.where(x == 0, 1, np.abs(x)))) for x in
             (some, values)]  # fmt: skip
    for digits in range(1, DIGITS + 1):
        step = 10.0 ** (top + 1 - digits)
        if _whole(some / step) and _whole(values / step):
            return np.full(len(values), step)
        own = sizes[0] * 10.0 ** (1 - digits)
        if _whole(some / own):
            return np.asarray(sizes[1] * 10.0 ** (1 - digits))
    return np.full(len(values), largest * 10.0**-DIGITS)


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


def _places(
    found: NDArray[np.intp], block: Rows, rows: Rows, block_step: Rows, step: Rows
) -> list[int]:
    """Sort out places of a block by a few of its samples, before any is compared."""
    for k in np.linspace(0, block.shape[1] - 1, 32).astype(int):
        if not len(found):
            break
        there = found + k
        own = slice(k, k + 1)
        found = found[
            _equal(block[:, own], rows[:, there], block_step[:, own], step[:, there])
        ]
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

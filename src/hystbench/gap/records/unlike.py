"""Records that are unlike the others, and what would make them like those.

Columns that are exchanged in one file, or a sign or a factor of ten that is wrong
there. Nothing of the record itself tells that: a linear model of the other records
does, as it predicts the record with its columns exchanged, or times a factor.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from hystbench.blocks.linear import low_pass
from hystbench.doubts import THOUSAND
from hystbench.gap.records.black_box import ringing
from hystbench.gap.records.scored_samples import ScoredSamples
from hystbench.gap.thresholds import LOOSE
from hystbench.record import FloatArray, Record

LOW_PASSES, MODES = 8, 12
"""Columns of the linear model beside the input: first-order lags from a sampling
interval to a third of the longest record, and damped modes from three periods in it to
a fifth of the sampling frequency."""
RIDGE = 1e-3
"""Share of the power of the strongest column: what is weaker is not learned, as between
the frequencies of a few sines nothing tells it."""
ROWS = 2000
"""Samples of a record that are looked at: neighbours say the same."""
TEN = 10**0.5
"""A factor that is nearer to ten than to one: less may be the amplitude's."""

EXCHANGE = (
    "Exchange the two columns in its file, or their names in the header, if they are "
    "the wrong way round"
)
MULTIPLY = (
    "Was its sign, its unit or the range of an amplifier another? Then multiply a "
    "column of its file, input or output"
)


@dataclass(frozen=True)
class Unlike:
    """A record that is unlike the others as it is, but not once it is mended."""

    name: str
    exchanged: bool
    """Whether the columns of input and output have to be exchanged."""
    factor: float
    """With which the output has to be multiplied; one where they are exchanged."""
    left: float
    mended: float
    """Share of the output's rms that the model of the others leaves of the record, as
    it is and mended."""

    @property
    def words(self) -> str:
        """Say what it is like, and what to do."""
        mended, mend = (
            ("if input and output are exchanged", EXCHANGE)
            if self.exchanged
            else (f"of its output times {self.factor:.2g}", MULTIPLY)
        )
        return (
            f"{self.name}: a linear model of the other records leaves "
            f"{100 * self.left:.0f} % of its output's rms, but {100 * self.mended:.2g} "
            f"% {mended}. {mend}"
        )


class _Products(NamedTuple):
    """Products of the columns with each other and with the output, of power one."""

    columns: FloatArray
    output: FloatArray

    def left(self, weights: FloatArray) -> float:
        """Share of the output's power that a model leaves."""
        crossed = 2 * weights @ self.output
        return max(float(1 - crossed + weights @ self.columns @ weights), 0.0)

    def scaled(self, weights: FloatArray) -> tuple[float, float]:
        """Factor of the output by which a model leaves least, and what it leaves."""
        crossed = float(weights @ self.output)
        power = float(weights @ self.columns @ weights)
        if not (crossed and power > 0):
            return 1.0, 1.0
        return power / crossed, max(1 - crossed**2 / power, 0.0)


def unlike_the_others(records: Sequence[Record]) -> list[Unlike]:
    """Find records that the others would predict if they were mended.

    Records are dropped, fewer than half, until each that remains is predicted by a
    linear model of the rest to half of its rms. A dropped one is told if more than half
    of it is left as it is, and less than half of that, and of its output, with the
    columns exchanged or times a factor. A factor above zero has to be nearer to ten
    than to one: a nonlinear device has another gain at another amplitude. About another
    mean its gain may even change sign. So no factor is told where the mean input lies
    outside the others' range.

    Parameters
    ----------
    records : sequence of Record
        Fewer than three tell nothing. One that stands still where it is looked at is
        left out.
    """
    looked_at = [ScoredSamples.of([record], ROWS).positions[0] for record in records]
    moving = [
        (record, own)
        for record, own in zip(records, looked_at, strict=True)
        if np.ptp(record.u[own]) > 0 and np.ptp(record.y[own]) > 0
    ]
    if len(moving) < 3:
        return []
    records, rows = zip(*moving, strict=True)
    step = min(record.dt for record in records)
    longest = max(record.dt * len(record) for record in records)
    slowest_clock = max(record.dt for record in records)
    lags = np.geomspace(step, max(longest / 3, 2 * step), LOW_PASSES)
    # Of few samples the fastest is an octave above the slowest.
    modes = np.geomspace(3 / longest, max(0.2 / slowest_clock, 6 / longest), MODES)
    of = [
        _products(x.u, x.y, x.dt, lags, modes, own)
        for x, own in zip(records, rows, strict=True)
    ]
    rest = _alike(of)
    if not rest:
        return []
    found = []
    for k, record in enumerate(records):
        if k in rest:
            continue
        weights = _model([of[j] for j in rest])
        turned = _products(record.y, record.u, record.dt, lags, modes, rows[k])
        left, exchanged = of[k].left(weights), turned.left(weights)
        factor, times = of[k].scaled(weights)
        about = [records[j].u[rows[j]] for j in rest]
        low, high = min(map(np.min, about)), max(map(np.max, about))
        comparable = low <= np.mean(record.u[rows[k]]) <= high
        # A factor of a thousand is told already, by the range of the record.
        strange = factor < 0 or TEN <= max(factor, 1 / factor) < THOUSAND
        # Exchanged columns have no free number: they may leave twice the rms.
        turn = LOOSE * exchanged <= times or not (comparable and strange)
        least = exchanged if turn else times
        if left > LOOSE and least <= LOOSE * min(left, 1.0):
            numbers = 1.0 if turn else factor, float(np.sqrt(left))
            found.append(Unlike(record.name, turn, *numbers, float(np.sqrt(least))))
    return found


def _alike(of: Sequence[_Products]) -> list[int]:
    """Give the records that predict each other; none where half of them do not."""
    rest = list(range(len(of)))

    def left_of_each(chosen: Sequence[int]) -> float:
        weights = _model([of[j] for j in chosen])
        return sum(of[j].left(weights) for j in chosen)

    while 2 * len(rest) > len(of) and len(rest) > 1:
        others = [[j for j in rest if j != k] for k in rest]
        if all(
            of[k].left(_model([of[j] for j in but])) <= LOOSE
            for k, but in zip(rest, others, strict=True)
        ):
            return rest
        rest = min(others, key=left_of_each)
    return []


def _products(
    u: FloatArray,
    y: FloatArray,
    dt: float,
    lags: FloatArray,
    modes: FloatArray,
    rows: NDArray[np.intp],
) -> _Products:
    """Give the products of a record, each signal about its mean: zeros may differ."""
    moved = u - u[0]
    columns = [moved[rows], *(low_pass(moved, dt, tau, 0.0)[rows] for tau in lags)]
    for frequency in modes:
        columns += [part[rows] for part in ringing(moved, dt, float(frequency))]
    table = np.array(columns).T
    table -= table.mean(axis=0)
    output = y[rows] - y[rows].mean()
    power = float(output @ output)
    return _Products(table.T @ table / power, table.T @ output / power)


def _model(of: Sequence[_Products]) -> FloatArray:
    """Give the weights of the linear model of some records, each of which counts once.

    What no column of power tells is not learned.
    """
    columns = np.sum([item.columns for item in of], axis=0)
    output = np.sum([item.output for item in of], axis=0)
    size = np.sqrt(np.diag(columns))
    size[size == 0] = 1.0
    powers, ways = np.linalg.eigh(columns / size / size[:, None])
    along = (ways.T @ (output / size)) / (powers + RIDGE * powers[-1])
    return np.asarray(ways @ along / size)

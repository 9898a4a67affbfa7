"""How far the gap has closed on hold-out records: before, after, and how sure.

What is new in every record (a path of drift, the phase of the mains) is estimated on
its first 30 % and scored on the rest, before and after alike. Where the model runs away
there is no residual after, and nothing of the gap counts as gone.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from hystbench.gap.records.nuisance import Nuisance, left_over
from hystbench.metrics import rms
from hystbench.record import FloatArray, Record

if TYPE_CHECKING:
    from hystbench.gap.records.floor import Floor

#: Draws of the bootstrap, and the part of them that its interval holds.
BOOTSTRAP_DRAWS = 400
INTERVAL_SHARE = 0.95
#: Blocks of a record that the bootstrap draws from: each longer than what a residual
#: remembers, and enough of them to vary.
BOOTSTRAP_BLOCKS = 12

#: Share of the power above the floor that is gone: a number, a range where the floor
#: is only an upper bound, None where there is no power above it.
Explained = float | list[float] | None


class Shrink(NamedTuple):
    """The gap on hold-out records, before and after."""

    gap: dict[str, Any]
    """What gap.json holds under ``gap``, of all records together."""
    records: list[dict[str, Any]]
    """What it holds under ``records``: zero is explained where the model runs away."""
    residuals: list[tuple[FloatArray, FloatArray | None]]
    """Shape (n,) each, what is new in the record taken off; no second one where the
    model runs away."""


def shrink(
    records: Sequence[Record],
    before: Sequence[FloatArray],
    after: Sequence[FloatArray | None],
    floor: Floor,
    nuisance: Nuisance | None = None,
) -> Shrink:
    """Compare a base and an augmented model on hold-out records.

    Parameters
    ----------
    records : sequence of Record
    before : sequence of ndarray, shape (n,) each
        Simulated outputs, in free run over the whole record.
    after : sequence of ndarray or None
        The same; None where the augmented model runs away.
    floor : Floor
    nuisance : callable, optional
        Gives regressors of what is new in a record. With them the first 30 % of each
        record estimate and the rest is scored, for both models alike; without them
        every sample is scored.
    """
    known = floor.rms, floor.method == "upper-bound"
    rows: list[dict[str, Any]] = []
    residuals: list[tuple[FloatArray, FloatArray | None]] = []
    olds, news = [], []
    for record, old_output, new_output in zip(records, before, after, strict=True):
        old, scored = left_over(record, old_output, nuisance)
        olds.append(old[scored])
        row: dict[str, Any] = {"name": record.name, "before": rms(olds[-1])}
        row |= {"after": None, "explained": 0.0}
        new = None
        if new_output is not None:
            new, _ = left_over(record, new_output, nuisance)
            news.append(new[scored])
            row["after"] = rms(news[-1])
            row["explained"] = share_explained(row["before"], row["after"], *known)
        rows.append(row)
        residuals.append((old, new))
    bounded = len(news) == len(olds)
    drawn = resampled_rms(list(zip(olds, news, strict=True) if bounded else zip(olds)))
    size, left = rms(*olds), rms(*news) if bounded else None
    gap = {
        "before": size,
        "after": left,
        "noise_floor": floor.rms,
        "floor_method": floor.method,
        "explained": 0.0 if left is None else share_explained(size, left, *known),
        "before_interval": rms_interval(drawn[0]),
    }
    if bounded:
        gap["after_interval"] = rms_interval(drawn[1])
        # Of the same draws; where the floor is an upper bound, of the whole range.
        interval = share_interval(drawn[0], drawn[1], *known)
        gap |= {} if interval is None else {"interval": interval}
    return Shrink(gap, rows, residuals)


def share_explained(
    before: float, after: float, floor: float, upper_bound: bool = False
) -> Explained:
    """Share of the power above the floor that is gone.

    ``(before^2 - after^2) / (before^2 - floor^2)``. Where the floor is only an upper
    bound the truth lies between the share over no floor and the share over this one.

    Parameters
    ----------
    before, after, floor : float
        RMS in output units.
    upper_bound : bool

    Returns
    -------
    float, list of float or None
        None where there is no power above the floor. Below zero where the gap grew.
    """
    gone = before**2 - after**2
    if upper_bound:
        if before == 0:
            return None
        least = gone / before**2
        # With the floor as high as it may be, nothing says how much was left to gain.
        above = before**2 - min(floor, after) ** 2
        most = gone / above if above > 0 else least
        return [min(least, most), max(least, most)]
    above = before**2 - floor**2
    return gone / above if above > 0 else None


def resampled_rms(residuals: Sequence[Sequence[FloatArray]]) -> FloatArray:
    """RMS of residuals over all records, of draws of records and blocks within them.

    Each draw takes as many records as there are, with replacement, and rebuilds each
    from overlapping blocks drawn from it, whose end is followed by its beginning
    (circular blocks, so that no sample is drawn less than another): neighbouring
    samples of a residual are not independent, nor are the samples of one record.

    Parameters
    ----------
    residuals : sequence of (ndarray, ...), shape (n,) each
        Of each record, those of one or more models: the same draws serve them all.

    Returns
    -------
    ndarray, shape (models, draws)

    References
    ----------
    D. N. Politis, J. P. Romano, "A circular block-resampling procedure for stationary
    data", in: Exploring the Limits of Bootstrap, Wiley, 1992.
    """
    random = np.random.default_rng(0)
    lengths = np.array([len(models[0]) for models in residuals])
    blocks = np.maximum(1, lengths // BOOTSTRAP_BLOCKS)
    # Sums over a block are differences of cumulative sums.
    sums = [
        np.stack([_sums(np.square(each), block) for each in models])
        for models, block in zip(residuals, blocks.tolist(), strict=True)
    ]
    counts = lengths // blocks
    powers = np.zeros((len(sums), BOOTSTRAP_DRAWS, len(residuals[0])))
    for place, total in enumerate(sums):
        block, count = blocks[place], counts[place]
        starts = random.integers(0, lengths[place], (BOOTSTRAP_DRAWS, count))
        powers[place] = (total[:, starts + block] - total[:, starts]).sum(axis=-1).T
        powers[place] *= lengths[place] / (block * count)
    drawn = random.integers(0, len(sums), (BOOTSTRAP_DRAWS, len(sums)))
    # A record that is drawn twice is rebuilt twice.
    rebuilt = random.integers(0, BOOTSTRAP_DRAWS, drawn.shape)
    power = powers[drawn, rebuilt].sum(axis=1)
    power /= lengths[drawn].sum(axis=1)[:, None]
    # Differences of sums may fall below zero by rounding.
    drawn_rms: FloatArray = np.sqrt(np.maximum(power, 0.0)).T
    return drawn_rms


def rms_interval(drawn: FloatArray) -> list[float]:
    """Interval that holds 95 % of the draws of an RMS, shape (draws,)."""
    return _between(drawn, drawn)


def share_interval(
    before: FloatArray, after: FloatArray, floor: float, upper_bound: bool = False
) -> list[float] | None:
    """Interval of the share explained.

    Parameters
    ----------
    before, after : ndarray, shape (draws,)
        RMS residuals, of the same draws.
    floor : float
        RMS of the noise.
    upper_bound : bool
        Whether it is one.

    Returns
    -------
    list of float or None
        None where more draws than the interval leaves out have no power above the
        floor.
    """
    pairs = zip(before.tolist(), after.tolist(), strict=True)
    shares = [share_explained(old, new, floor, upper_bound) for old, new in pairs]
    known = [each for each in shares if each is not None]
    if len(known) < INTERVAL_SHARE * len(shares):
        return None
    ends = np.array(
        [each if isinstance(each, list) else [each, each] for each in known]
    )
    return _between(ends[:, 0], ends[:, 1])


def _between(lowest: FloatArray, highest: FloatArray) -> list[float]:
    outside = (1 - INTERVAL_SHARE) / 2
    ends = np.quantile(lowest, outside), np.quantile(highest, 1 - outside)
    return [float(end) for end in ends]


def _sums(values: FloatArray, block: int) -> FloatArray:
    """Give cumulative sums from zero on, the first block of values once more behind."""
    return np.concatenate([[0.0], np.cumsum(np.concatenate([values, values[:block]]))])

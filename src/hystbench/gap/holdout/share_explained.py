"""The share of a gap that is gone, and how sure it is."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from hystbench.record import FloatArray

#: Draws of the bootstrap, and the part of them that its interval holds.
DRAWS = 400
LEVEL = 0.95
#: Blocks of a record that the bootstrap draws from: each longer than what a residual
#: remembers, and enough of them to vary.
BLOCKS = 12

#: Share of the power above the floor that is gone: a number, a range where the floor
#: is only an upper bound, None where there is no power above it.
Explained = float | tuple[float, float] | None


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
    float, pair of float or None
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
        return (min(least, most), max(least, most))
    above = before**2 - floor**2
    return gone / above if above > 0 else None


def resampled_rms(
    residuals: Sequence[Sequence[FloatArray]],
) -> FloatArray:
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
    blocks = np.maximum(1, lengths // BLOCKS)
    # Sums over a block are differences of cumulative sums.
    sums = [
        np.stack([_sums(np.square(each), block) for each in models])
        for models, block in zip(residuals, blocks.tolist(), strict=True)
    ]
    counts = lengths // blocks
    powers = np.zeros((len(sums), DRAWS, len(residuals[0])))
    for place, total in enumerate(sums):
        block, count = blocks[place], counts[place]
        starts = random.integers(0, lengths[place], (DRAWS, count))
        powers[place] = (total[:, starts + block] - total[:, starts]).sum(axis=-1).T
        powers[place] *= lengths[place] / (block * count)
    drawn = random.integers(0, len(sums), (DRAWS, len(sums)))
    # A record that is drawn twice is rebuilt twice.
    rebuilt = random.integers(0, DRAWS, drawn.shape)
    power = powers[drawn, rebuilt].sum(axis=1)
    power /= lengths[drawn].sum(axis=1)[:, None]
    # Differences of sums may fall below zero by rounding.
    drawn_rms: FloatArray = np.sqrt(np.maximum(power, 0.0)).T
    return drawn_rms


def rms_interval(drawn: FloatArray) -> tuple[float, float]:
    """Interval that holds 95 % of the draws of an RMS, shape (draws,)."""
    return _between(drawn, drawn)


def share_interval(
    before: FloatArray, after: FloatArray, floor: float, upper_bound: bool = False
) -> tuple[float, float] | None:
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
    pair of float or None
        None where more draws than the interval leaves out have no power above the
        floor.
    """
    pairs = zip(before.tolist(), after.tolist(), strict=True)
    shares = [share_explained(old, new, floor, upper_bound) for old, new in pairs]
    known = [each for each in shares if each is not None]
    if len(known) < LEVEL * len(shares):
        return None
    ends = np.array(
        [each if isinstance(each, tuple) else (each, each) for each in known]
    )
    return _between(ends[:, 0], ends[:, 1])


def _between(lowest: FloatArray, highest: FloatArray) -> tuple[float, float]:
    outside = (1 - LEVEL) / 2
    return (
        float(np.quantile(lowest, outside)),
        float(np.quantile(highest, 1 - outside)),
    )


def _sums(values: FloatArray, block: int) -> FloatArray:
    """Give cumulative sums from zero on, the first block of values once more behind."""
    return np.concatenate([[0.0], np.cumsum(np.concatenate([values, values[:block]]))])

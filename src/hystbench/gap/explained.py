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


def bootstrap_interval(
    pairs: Sequence[tuple[FloatArray, FloatArray]],
    floor: float,
    upper_bound: bool = False,
    draws: int = DRAWS,
    seed: int = 0,
) -> tuple[float, float] | None:
    """Interval of the share explained, by drawing records and blocks within them.

    Each draw takes as many records as there are, with replacement, and rebuilds each
    from overlapping blocks drawn from it, whose end is followed by its beginning
    (circular blocks, so that no sample is drawn less than another): neighbouring
    samples of a residual are not independent, nor are the samples of one record.

    Parameters
    ----------
    pairs : sequence of (ndarray, ndarray), shape (n,) each
        Residuals before and after, a pair a record.
    floor : float
        RMS of the noise.
    upper_bound : bool
        Whether it is one.
    draws, seed : int

    Returns
    -------
    pair of float or None
        None where more draws than the interval leaves out have no power above the
        floor.

    References
    ----------
    D. N. Politis, J. P. Romano, "A circular block-resampling procedure for stationary
    data", in: Exploring the Limits of Bootstrap, Wiley, 1992.
    """
    random = np.random.default_rng(seed)
    lengths = np.array([len(before) for before, _ in pairs])
    blocks = np.maximum(1, lengths // BLOCKS)
    # Sums over a block are differences of cumulative sums.
    sums = [
        np.stack([_sums(np.square(each), block) for each in pair])
        for pair, block in zip(pairs, blocks.tolist(), strict=True)
    ]
    counts = lengths // blocks
    powers = np.zeros((len(sums), draws, 2))
    for place, total in enumerate(sums):
        block, count = blocks[place], counts[place]
        starts = random.integers(0, lengths[place], (draws, count))
        powers[place] = (total[:, starts + block] - total[:, starts]).sum(axis=-1).T
        powers[place] *= lengths[place] / (block * count)
    drawn = random.integers(0, len(sums), (draws, len(sums)))
    # A record that is drawn twice is rebuilt twice.
    rebuilt = random.integers(0, draws, drawn.shape)
    power = powers[drawn, rebuilt].sum(axis=1)
    power /= lengths[drawn].sum(axis=1)[:, None]
    shares = [
        share_explained(before, after, floor, upper_bound)
        for before, after in np.sqrt(power).tolist()
    ]
    known = [each for each in shares if each is not None]
    outside = (1 - LEVEL) / 2
    if len(known) < LEVEL * draws:
        return None
    ends = np.array(
        [each if isinstance(each, tuple) else (each, each) for each in known]
    )
    return (
        float(np.quantile(ends[:, 0], outside)),
        float(np.quantile(ends[:, 1], 1 - outside)),
    )


def _sums(values: FloatArray, block: int) -> FloatArray:
    """Give cumulative sums from zero on, the first block of values once more behind."""
    return np.concatenate([[0.0], np.cumsum(np.concatenate([values, values[:block]]))])

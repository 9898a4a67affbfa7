"""How far the gap has closed on hold-out records: before, after, and how sure.

What is new in every record (a path of drift, the phase of the mains) is estimated on
its first 30 % and scored on the rest, before and after alike.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from hystbench.errors import InputError
from hystbench.gap.compared import rms
from hystbench.gap.folds import Mask
from hystbench.gap.nuisance import Nuisance, left_over
from hystbench.record import FloatArray, Record

#: Draws of the bootstrap, and the part of them that its interval holds.
DRAWS = 400
LEVEL = 0.95
#: Blocks of a record that the bootstrap draws from: each longer than what a residual
#: remembers, and enough of them to vary.
BLOCKS = 12

#: Share of the power above the floor that is gone: a number, a range where the floor
#: is only an upper bound, None where there is no power above it.
Explained = float | tuple[float, float] | None


@dataclass(frozen=True, repr=False)
class Spectra:
    """Power spectral densities of a residual before and after, shape (m,) each.

    In output units squared per hertz.
    """

    frequency_hz: FloatArray
    before: FloatArray
    after: FloatArray
    floor: float


@dataclass(frozen=True, repr=False)
class RecordShrink:
    """A hold-out record before and after, over the samples that are scored.

    Parameters
    ----------
    name : str
    before, after : float
        RMS residual in output units.
    explained : float, pair of float or None
    scored : ndarray of bool, shape (n,)
    residual_before, residual_after : ndarray, shape (n,)
        What is new in the record is taken off.
    spectra : Spectra
    """

    name: str
    before: float
    after: float
    explained: Explained
    scored: Mask
    residual_before: FloatArray
    residual_after: FloatArray
    spectra: Spectra


@dataclass(frozen=True, repr=False)
class Shrink:
    """The gap over all hold-out records together.

    Parameters
    ----------
    before, after, noise_floor : float
        RMS in output units.
    explained : float, pair of float or None
        Share of the power above the floor that is gone.
    interval : pair of float or None
        Of ``explained``: 95 % of the bootstrap's draws; where the floor is an upper
        bound, of the whole range.
    records : tuple of RecordShrink
    """

    before: float
    after: float
    noise_floor: float
    floor_method: str
    explained: Explained
    interval: tuple[float, float] | None
    records: tuple[RecordShrink, ...]


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


def shrink(
    records: Sequence[Record],
    before: Sequence[FloatArray],
    after: Sequence[FloatArray],
    noise_floor: float,
    floor_method: str,
    nuisance: Nuisance | None = None,
) -> Shrink:
    """Compare a base and an augmented model on hold-out records.

    Parameters
    ----------
    records : sequence of Record
    before, after : sequence of ndarray, shape (n,) each
        Simulated outputs, in free run over the whole record.
    noise_floor : float
        RMS in output units.
    floor_method : {"repeats", "declared", "upper-bound"}
    nuisance : callable, optional
        Gives regressors of what is new in a record. With them the first 30 % of each
        record estimate and the rest is scored, for both models alike; without them
        every sample is scored.

    Raises
    ------
    InputError
        If there is no hold-out record or one is too short.
    """
    if not records:
        raise InputError("no hold-out records; expected at least one")
    upper = floor_method == "upper-bound"
    shrunk = []
    for record, *simulated in zip(records, before, after, strict=True):
        (old, scored), (new, _) = (
            left_over(record, output, nuisance) for output in simulated
        )
        size = rms(old[scored]), rms(new[scored])
        shrunk.append(
            RecordShrink(
                record.name,
                *size,
                share_explained(*size, noise_floor, upper),
                scored,
                old,
                new,
                spectra(old[scored], new[scored], record.dt, noise_floor),
            )
        )
    pairs = [
        (item.residual_before[item.scored], item.residual_after[item.scored])
        for item in shrunk
    ]
    olds, news = zip(*pairs, strict=True)
    size = rms(np.concatenate(olds)), rms(np.concatenate(news))
    return Shrink(
        *size,
        noise_floor,
        floor_method,
        share_explained(*size, noise_floor, upper),
        bootstrap_interval(pairs, noise_floor, upper),
        tuple(shrunk),
    )


def bootstrap_interval(
    pairs: Sequence[tuple[FloatArray, FloatArray]],
    floor: float,
    upper_bound: bool = False,
    draws: int = DRAWS,
    seed: int = 0,
) -> tuple[float, float] | None:
    """Interval of the share explained, by drawing records and blocks within them.

    Each draw takes as many records as there are, with replacement, and rebuilds each
    from overlapping blocks drawn from it (moving blocks): neighbouring samples of a
    residual are not independent, and neither are the samples of one record.

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
    H. R. Kuensch, "The jackknife and the bootstrap for general stationary
    observations", Annals of Statistics 17(3), 1989.
    """
    random = np.random.default_rng(seed)
    # Sums over a block are differences of cumulative sums: no sample is copied.
    sums = [
        np.stack([np.concatenate([[0], np.cumsum(np.square(each))]) for each in pair])
        for pair in pairs
    ]
    lengths = np.array([total.shape[1] - 1 for total in sums])
    blocks = np.maximum(1, lengths // BLOCKS)
    counts = lengths // blocks
    powers = np.zeros((len(sums), draws, 2))
    for place, total in enumerate(sums):
        block, count = blocks[place], counts[place]
        starts = random.integers(0, lengths[place] - block + 1, (draws, count))
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


def spectra(
    before: FloatArray, after: FloatArray, dt: float, noise_floor: float
) -> Spectra:
    """Power spectral densities by Welch's method, and a white floor's.

    Parameters
    ----------
    before, after : ndarray, shape (n,)
    dt : float
        Sampling interval in seconds.
    noise_floor : float
        RMS; spread evenly up to half the sampling frequency.
    """
    from scipy.signal import welch

    segment = min(len(before), max(16, len(before) // 4))
    frequency, power_before = welch(before, 1 / dt, nperseg=segment, detrend=False)
    _, power_after = welch(after, 1 / dt, nperseg=segment, detrend=False)
    return Spectra(frequency, power_before, power_after, 2 * dt * noise_floor**2)


def ladder(
    records: Sequence[Record],
    stages: Sequence[tuple[str, Sequence[FloatArray]]],
    nuisance: Nuisance | None = None,
) -> tuple[tuple[str, float], ...]:
    """RMS residual after each effect that was added, over all records together.

    Parameters
    ----------
    records : sequence of Record
    stages : sequence of (str, sequence of ndarray)
        Name of a stage (the base first, then the effect added) and its simulated
        output of each record.
    nuisance : callable, optional
        As for :func:`shrink`.

    Returns
    -------
    tuple of (str, float)
    """
    steps = []
    for name, simulated in stages:
        left = []
        for record, output in zip(records, simulated, strict=True):
            residual, scored = left_over(record, output, nuisance)
            left.append(residual[scored])
        steps.append((name, rms(np.concatenate(left))))
    return tuple(steps)


def mapping(shrunk: Shrink) -> dict[str, Any]:
    """Give what gap.json holds under ``gap``."""
    content: dict[str, Any] = {
        "before": shrunk.before,
        "after": shrunk.after,
        "noise_floor": shrunk.noise_floor,
        "floor_method": shrunk.floor_method,
        "explained": _plain(shrunk.explained),
    }
    if shrunk.interval is not None:
        content["interval"] = list(shrunk.interval)
    return content


def records_mapping(shrunk: Shrink) -> list[dict[str, Any]]:
    """Give what gap.json holds under ``records``."""
    return [
        {
            "name": item.name,
            "before": item.before,
            "after": item.after,
            "explained": _plain(item.explained),
        }
        for item in shrunk.records
    ]


def _plain(explained: Explained) -> float | list[float] | None:
    return list(explained) if isinstance(explained, tuple) else explained

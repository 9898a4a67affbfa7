"""How far the gap has closed on hold-out records: before, after, and how sure.

What is new in every record (a path of drift, the phase of the mains) is estimated on
its first 30 % and scored on the rest, before and after alike. Where the model runs away
there is no residual after, and nothing of the gap counts as gone.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from hystbench.errors import InputError
from hystbench.gap.holdout.share_explained import (
    Explained,
    resampled_rms,
    rms_interval,
    share_explained,
    share_interval,
)
from hystbench.gap.records.nuisance import Nuisance, left_over
from hystbench.gap.records.residual import rms
from hystbench.record import FloatArray, Mask, Record


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
        RMS residual in output units; no ``after`` where the model runs away.
    explained : float, pair of float or None
        Zero where the model runs away: nothing of the gap counts as gone.
    scored : ndarray of bool, shape (n,)
    residual_before, residual_after : ndarray, shape (n,)
        What is new in the record is taken off.
    """

    name: str
    before: float
    after: float | None
    explained: Explained
    scored: Mask
    residual_before: FloatArray
    residual_after: FloatArray | None


@dataclass(frozen=True, repr=False)
class Shrink:
    """The gap over all hold-out records together.

    Parameters
    ----------
    before, after, noise_floor : float
        RMS in output units; no ``after`` where the model runs away on a record.
    explained : float, pair of float or None
        Share of the power above the floor that is gone; zero where the model runs away
        on a record.
    before_interval, after_interval : pair of float
        95 % of the bootstrap's draws.
    interval : pair of float or None
        Of ``explained``, of the same draws; where the floor is an upper bound, of the
        whole range.
    records : tuple of RecordShrink
    """

    before: float
    after: float | None
    noise_floor: float
    floor_method: str
    explained: Explained
    before_interval: tuple[float, float]
    after_interval: tuple[float, float] | None
    interval: tuple[float, float] | None
    records: tuple[RecordShrink, ...]


def shrink(
    records: Sequence[Record],
    before: Sequence[FloatArray],
    after: Sequence[FloatArray | None],
    noise_floor: float,
    floor_method: str,
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
    for record, old_output, new_output in zip(records, before, after, strict=True):
        old, scored = left_over(record, old_output, nuisance)
        size, new, left = rms(old[scored]), None, None
        share: Explained = 0.0
        if new_output is not None:
            new, _ = left_over(record, new_output, nuisance)
            left = rms(new[scored])
            share = share_explained(size, left, noise_floor, upper)
        shrunk.append(RecordShrink(record.name, size, left, share, scored, old, new))
    olds = [item.residual_before[item.scored] for item in shrunk]
    news = [
        item.residual_after[item.scored]
        for item in shrunk
        if item.residual_after is not None
    ]
    size = rms(np.concatenate(olds))
    if len(news) < len(olds):
        (drawn,) = resampled_rms([(old,) for old in olds])
        whole = (size, None, noise_floor, floor_method, 0.0)
        return Shrink(*whole, rms_interval(drawn), None, None, tuple(shrunk))
    drawn, left_drawn = resampled_rms(list(zip(olds, news, strict=True)))
    left = rms(np.concatenate(news))
    return Shrink(
        size,
        left,
        noise_floor,
        floor_method,
        share_explained(size, left, noise_floor, upper),
        rms_interval(drawn),
        rms_interval(left_drawn),
        share_interval(drawn, left_drawn, noise_floor, upper),
        tuple(shrunk),
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
    stages: Sequence[tuple[str, Sequence[FloatArray | None]]],
    nuisance: Nuisance | None = None,
) -> tuple[tuple[str, float | None], ...]:
    """RMS residual after each effect that was added, over all records together.

    Parameters
    ----------
    records : sequence of Record
    stages : sequence of (str, sequence of ndarray or None)
        Name of a stage (the base first, then the effect added) and its simulated
        output of each record; None where it runs away.
    nuisance : callable, optional
        As for :func:`shrink`.

    Returns
    -------
    tuple of (str, float or None)
        None where a stage runs away on a record.
    """
    steps: list[tuple[str, float | None]] = []
    for name, simulated in stages:
        left = []
        for record, output in zip(records, simulated, strict=True):
            if output is not None:
                residual, scored = left_over(record, output, nuisance)
                left.append(residual[scored])
        whole = len(left) == len(records)
        steps.append((name, rms(np.concatenate(left)) if whole else None))
    return tuple(steps)


def mapping(shrunk: Shrink) -> dict[str, Any]:
    """Give what gap.json holds under ``gap``."""
    content: dict[str, Any] = {
        "before": shrunk.before,
        "after": shrunk.after,
        "noise_floor": shrunk.noise_floor,
        "floor_method": shrunk.floor_method,
        "explained": plain(shrunk.explained),
        "before_interval": list(shrunk.before_interval),
    }
    for key in ("after_interval", "interval"):
        ends = getattr(shrunk, key)
        if ends is not None:
            content[key] = list(ends)
    return content


def records_mapping(shrunk: Shrink) -> list[dict[str, Any]]:
    """Give what gap.json holds under ``records``."""
    return [
        {
            "name": item.name,
            "before": item.before,
            "after": item.after,
            "explained": plain(item.explained),
        }
        for item in shrunk.records
    ]


def plain(explained: Explained) -> float | list[float] | None:
    """Give a share, or the ends of its range, as JSON holds it."""
    return list(explained) if isinstance(explained, tuple) else explained

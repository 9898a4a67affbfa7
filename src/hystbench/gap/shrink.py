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
from hystbench.gap.explained import (
    Explained,
    bootstrap_interval,
    share_explained,
)
from hystbench.gap.folds import Mask
from hystbench.gap.nuisance import Nuisance, left_over
from hystbench.record import FloatArray, Record


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
    """

    name: str
    before: float
    after: float
    explained: Explained
    scored: Mask
    residual_before: FloatArray
    residual_after: FloatArray


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
        "explained": plain(shrunk.explained),
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
            "explained": plain(item.explained),
        }
        for item in shrunk.records
    ]


def plain(explained: Explained) -> float | list[float] | None:
    """Give a share, or the ends of its range, as JSON holds it."""
    return list(explained) if isinstance(explained, tuple) else explained

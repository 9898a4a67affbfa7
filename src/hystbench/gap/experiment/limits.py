"""What an experiment may ask of the actuator."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from hystbench.errors import InputError
from hystbench.record import Record

#: Part of the input's power below its bandwidth.
IN_BAND = 0.999


@dataclass(frozen=True)
class Limits:
    """What an experiment may ask of the actuator.

    Parameters
    ----------
    low, high : float
        Range of the input, in its unit.
    rate : float
        Largest rate of the input, in its unit per second.
    bandwidth_hz : float
        Highest frequency.
    dt : float
        Sampling interval in seconds.
    duration_s : float
        Longest record.
    """

    low: float
    high: float
    rate: float
    bandwidth_hz: float
    dt: float
    duration_s: float

    def __post_init__(self) -> None:
        """Refuse limits that no excitation fits."""
        if not self.low < self.high:
            raise InputError(
                f"limits: low {self.low:g} and high {self.high:g}; expected low < high"
            )
        for name in ("rate", "bandwidth_hz", "dt", "duration_s"):
            value = getattr(self, name)
            if not (np.isfinite(value) and value > 0):
                raise InputError(f"limits: {name}: {value:g}; expected above 0")
        if self.duration_s < 100 * self.dt:
            raise InputError(
                f"limits: duration_s: {self.duration_s:g}; expected at least 100 "
                f"sampling intervals, {100 * self.dt:g} s"
            )

    @classmethod
    def of(cls, records: Sequence[Record]) -> Limits:
        """Take the limits from records: what was done once can be done again."""
        return cls(
            min(float(record.u.min()) for record in records),
            max(float(record.u.max()) for record in records),
            max(
                float(np.abs(np.diff(record.u)).max()) / record.dt for record in records
            ),
            max(_bandwidth(record) for record in records),
            min(record.dt for record in records),
            max(len(record) * record.dt for record in records),
        )

    @classmethod
    def within(cls, records: Sequence[Record], asked: Mapping[str, float]) -> Limits:
        """Take what is asked, by name, and the rest from records.

        Raises
        ------
        InputError
            If no excitation fits.
        """
        return replace(cls.of(records), **asked)


def _bandwidth(record: Record) -> float:
    """Frequency below which nearly all of the input's power lies."""
    power = np.square(np.abs(np.fft.rfft(record.u - record.u.mean())))
    total = np.cumsum(power)
    line = int(np.searchsorted(total, IN_BAND * total[-1])) if total[-1] > 0 else 1
    return max(line, 1) / (len(record) * record.dt)

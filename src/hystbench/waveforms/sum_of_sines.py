"""Sines that start at zero phase (Table 3, Figures 10 and 11)."""

from collections.abc import Mapping, Sequence
from typing import Any, ClassVar

import numpy as np

from hystbench.errors import InputError
from hystbench.record import FloatArray
from hystbench.waveforms.base import Waveform, times


class SumOfSines(Waveform):
    """Sines that start at zero phase (Table 3, Figures 10 and 11)."""

    name: ClassVar[str] = "sum-of-sines"
    example: ClassVar[Mapping[str, Any]] = {
        "frequencies_hz": [10, 30, 50],
        "amplitudes": [0.1, 0.2, 0.3],
    }
    any_sign: ClassVar[tuple[str, ...]] = ("amplitudes", "gain")

    @staticmethod
    def samples(
        *,
        frequencies_hz: Sequence[float],
        amplitudes: Sequence[float],
        gain: float,
        duration_s: float,
        sampling_frequency_hz: float,
    ) -> FloatArray:
        """Add sines that start at zero phase (Table 3, Figures 10 and 11).

        Parameters
        ----------
        frequencies_hz, amplitudes : sequence of float
            One of each a sine.
        gain : float
            Turns the unit in which the sum is written into the actuator's input unit:
            1 if the paper's sums are in amperes, the amplifier's gain if in volts.

        Raises
        ------
        InputError
            If there are not as many amplitudes as frequencies.
        """
        if len(frequencies_hz) != len(amplitudes):
            raise InputError(
                f"{len(frequencies_hz)} frequencies_hz but "
                f"{len(amplitudes)} amplitudes; expected as many"
            )
        time = times(duration_s, sampling_frequency_hz)
        total = np.zeros_like(time)
        for frequency, amplitude in zip(frequencies_hz, amplitudes, strict=True):
            total += amplitude * np.sin(2 * np.pi * frequency * time)
        return np.asarray(gain * total)

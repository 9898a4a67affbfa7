"""A sine (Table 1, Figures 7 and 8)."""

from collections.abc import Mapping
from typing import Any, ClassVar

import numpy as np

from hystbench.record import FloatArray
from hystbench.waveforms.base import Waveform, times


class Sine(Waveform):
    """A sine (Table 1, Figures 7 and 8)."""

    name: ClassVar[str] = "sine"
    example: ClassVar[Mapping[str, Any]] = {"frequency_hz": 40}
    any_sign: ClassVar[tuple[str, ...]] = ("amplitude",)

    @staticmethod
    def samples(
        *,
        frequency_hz: float,
        amplitude: float,
        duration_s: float,
        sampling_frequency_hz: float,
    ) -> FloatArray:
        """Compute ``amplitude * sin(2 pi f t)`` (Table 1, Figures 7 and 8).

        Returns
        -------
        ndarray, shape (round(duration_s * sampling_frequency_hz),)
            In the unit of ``amplitude``.
        """
        time = times(duration_s, sampling_frequency_hz)
        return np.asarray(amplitude * np.sin(2 * np.pi * frequency_hz * time))

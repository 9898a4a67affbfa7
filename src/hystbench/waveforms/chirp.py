"""A sine whose frequency rises linearly (Table 2, Figure 9)."""

from collections.abc import Mapping
from typing import Any, ClassVar

import numpy as np

from hystbench.record import FloatArray
from hystbench.waveforms.base import Waveform, times


class Chirp(Waveform):
    """A sine whose frequency rises linearly (Table 2, Figure 9)."""

    name: ClassVar[str] = "chirp"
    example: ClassVar[Mapping[str, Any]] = {"from_hz": 1, "to_hz": 100}
    any_sign: ClassVar[tuple[str, ...]] = ("amplitude",)

    @staticmethod
    def samples(
        *,
        from_hz: float,
        to_hz: float,
        amplitude: float,
        duration_s: float,
        sampling_frequency_hz: float,
    ) -> FloatArray:
        """Sweep the frequency linearly over the record (Table 2, Figure 9).

        ``amplitude * sin(2 pi (from t + (to - from) t^2 / (2 duration)))``.

        Returns
        -------
        ndarray, shape (round(duration_s * sampling_frequency_hz),)
            In the unit of ``amplitude``.
        """
        time = times(duration_s, sampling_frequency_hz)
        slope = (to_hz - from_hz) / duration_s
        return np.asarray(
            amplitude * np.sin(2 * np.pi * (from_hz * time + slope * time**2 / 2))
        )

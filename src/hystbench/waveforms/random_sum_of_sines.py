"""Sines of random phase in a band (Table 3, Figure 12)."""

from collections.abc import Mapping, Sequence
from typing import Any, ClassVar

import numpy as np

from hystbench.errors import InputError
from hystbench.record import FloatArray
from hystbench.waveforms.base import Waveform, times


class RandomSumOfSines(Waveform):
    """Sines of random phase in a band (Table 3, Figure 12)."""

    name: ClassVar[str] = "random-sum-of-sines"
    example: ClassVar[Mapping[str, Any]] = {
        "band": [0.0, 0.02],
        "level": 0.5,
        "sines": 10,
        "trials": 10,
        "seed": 1,
    }
    any_sign: ClassVar[tuple[str, ...]] = ("gain",)
    may_be_zero: ClassVar[tuple[str, ...]] = ("band", "seed")

    @staticmethod
    def samples(
        *,
        band: Sequence[float],
        level: float,
        sines: int,
        trials: int,
        seed: int,
        gain: float,
        duration_s: float,
        sampling_frequency_hz: float,
    ) -> FloatArray:
        """Add sines of random phase in a band (Table 3, Figure 12).

        The paper names MATLAB's ``idinput``, whose sums of sinusoids take lines of the
        record's own frequency grid, spread evenly over the band, with random phases:
        of ``trials`` draws the one with the smallest peak-to-peak is kept and scaled
        so that it spans ``[-level, level]``.

        Parameters
        ----------
        band : sequence of two float
            Lower and upper end as fractions of the Nyquist frequency.
        level : float
            The largest absolute value before ``gain``.
        sines, trials, seed : int
            How many lines, how many draws of the phases, and where the draws start.
        gain : float
            As in a sum of sines.

        Raises
        ------
        InputError
            If the band holds fewer lines than ``sines``.

        References
        ----------
        L. Ljung, System Identification Toolbox, function ``idinput``.
        """
        time = times(duration_s, sampling_frequency_hz)
        count = len(time)
        if len(band) != 2 or not 0 <= band[0] < band[1] <= 1:
            raise InputError(
                f"band: {band}; expected two fractions of the Nyquist frequency"
            )
        low, high = (edge * count / 2 for edge in band)
        lines = np.arange(max(1, int(np.ceil(low))), int(np.floor(high)) + 1)
        if len(lines) < sines:
            raise InputError(
                f"the band {list(band)} holds {len(lines)} lines in "
                f"{duration_s:g} s; expected at least {sines} (key 'sines')"
            )
        # Evenly spaced, counted from the band's upper end so that its edge is excited.
        chosen = lines[len(lines) - 1 - (len(lines) // sines) * np.arange(sines)][::-1]
        generator = np.random.default_rng(seed)
        phases = generator.uniform(0, 2 * np.pi, (trials, sines))
        # Lines of the record's own grid: a transform adds them up, all draws at once.
        spectrum = np.zeros((trials, count // 2 + 1), complex)
        spectrum[:, chosen] = count / 2 * np.exp(1j * phases)
        spectrum[:, chosen[2 * chosen == count]] *= 2  # has no mirror image
        draws = np.fft.irfft(spectrum, count)
        best = draws[np.argmin(np.ptp(draws, axis=1))]
        middle = (best.max() + best.min()) / 2
        return np.asarray(gain * level * (best - middle) / (np.ptp(best) / 2))

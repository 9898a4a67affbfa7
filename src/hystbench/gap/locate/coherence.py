"""What of the gap is coherent with the input, and what is not."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy import special

from hystbench.gap.locate.picture import (
    FREQUENCY,
    Axis,
    Panel,
    Picture,
    series,
    thinned,
)
from hystbench.gap.locate.spectra import R, Spectra, U
from hystbench.gap.locate.view import MATTERS, chance, percent
from hystbench.record import FloatArray

ODDS = 0.05
"""How often an unrelated residual exceeds the curve of chance."""


@dataclass(frozen=True)
class Coherence:
    """Coherence of the residual with the input, in the bins that the input excites.

    Parameters
    ----------
    frequency, coherence : ndarray, shape (m,)
        In Hz; from 0 to 1, as estimated.
    count : ndarray, shape (m,)
        Independent facts of each bin.
    share : float
        Of the gap above the noise, what is coherent with the input; the estimate's
        bias, 1 / count, is taken off. Less than the truth where a response bends within
        a bin, as that of a lightly damped mode.
    """

    frequency: FloatArray
    coherence: FloatArray
    count: FloatArray
    share: float

    @property
    def p_value(self) -> float:
        """How often a residual unrelated to the input would be as coherent.

        The chance of each bin, ``(1 - coherence) ** (count - 1)``, is combined by
        Fisher's method.
        """
        left = np.log(np.maximum(1 - self.coherence, 1e-300))
        squares = -2 * float(np.sum((self.count - 1) * left))
        return float(special.chdtrc(2 * len(left), squares))

    @property
    def told(self) -> str:
        """How much of the gap is linear in the input, and how much is not."""
        if self.share < MATTERS:
            return (
                " Next to none of the gap is coherent with the input: it is distortion "
                "or no doing of the input."
            )
        return (
            f" At least {percent(self.share)} of the gap is coherent with the input "
            f"({chance(self.p_value)}), as what a linear path from it leaves; the other "
            f"{percent(1 - self.share)} is distortion or no doing of the input."
        )

    @property
    def picture(self) -> Picture:
        """The coherence over frequency, and what chance gives."""
        at, found, count = thinned(self.frequency, self.coherence, self.count)
        lines = (
            series("measurement", at, found, "gap with input"),
            series("noise", at, 1 - ODDS ** (1 / (count - 1)), "chance, 1 of 20"),
        )
        panel = Panel(FREQUENCY, Axis("coherence"), lines)
        return Picture("coherence", "Coherence of the gap with the input", (panel,))


def take_coherence(spectra: Spectra, gap: float) -> Coherence | None:
    """Estimate it over all records.

    Parameters
    ----------
    spectra : Spectra
    gap : float
        Mean square of the residual above the noise.

    Returns
    -------
    Coherence or None
        None where the input excites no bin often enough.
    """
    there = spectra.excited
    if not np.any(there):
        return None
    found, count = spectra.coherence(R, U)[there], spectra.count[there]
    unbiased = (count * found - 1) / (count - 1)
    coherent = float(np.sum(unbiased * spectra.power(R)[there]))
    share = float(np.clip(coherent / gap, 0.0, 1.0))
    return Coherence(spectra.frequency[there], found, count, share)

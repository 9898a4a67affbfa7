"""The area of the loop at each frequency: measurement against simulation."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy import special

from hystbench.gap.locate.forms import narrowest_bins
from hystbench.gap.locate.picture import (
    FREQUENCY,
    Axis,
    Panel,
    Picture,
    in_units,
    series,
)
from hystbench.gap.locate.samples import Samples
from hystbench.gap.locate.spectra import Lines, R, S, Spectra, U
from hystbench.gap.locate.view import MATTERS, SIGNIFICANT, chance, number, percent
from hystbench.record import FloatArray

BANDS_A_DECADE = 10
"""Third-octave bands, as in acoustics (IEC 61260)."""
PRESENT = 1e-3
"""Of the power of a record's input, that a band holds for the record to count in it."""
SURE = 3.0
"""Standard errors by which areas differ."""


@dataclass(frozen=True)
class Loops:
    """Area of output over input in third-octave bands that the input excites.

    A band's area is that of the loop a cycle, positive where the output lags: for sines
    of amplitudes a and b, ``pi a b sin(phase)``.

    Parameters
    ----------
    frequency, low, high : ndarray, shape (m,)
        Mean of each band in Hz, weighted by the input's power, and its edges.
    measured, simulated : ndarray, shape (m,)
        Areas, in units of input times output.
    error : ndarray, shape (m,)
        Standard error of their difference: of the noise floor, or of what is not
        coherent with the input where that is more.
    share : ndarray, shape (m,)
        Of the gap's power, what lies in the difference of areas: in the residual's
        part a quarter of a period off the input.
    unit : str
    """

    frequency: FloatArray
    low: FloatArray
    high: FloatArray
    measured: FloatArray
    simulated: FloatArray
    error: FloatArray
    share: FloatArray
    unit: str

    @property
    def p_value(self) -> float:
        """How often noise alone would make the areas differ as much."""
        squares = float(np.sum(((self.measured - self.simulated) / self.error) ** 2))
        return float(special.chdtrc(max(len(self.error), 1), squares))

    @property
    def told(self) -> str:
        """Where the loops of measurement and simulation differ, and by how much."""
        if not len(self.error):
            return ""
        # A loop turns the other way where the output leads.
        wider = np.sign(self.simulated) * (self.measured - self.simulated)
        parts = []
        for sense, word in ((1, "more"), (-1, "less")):
            here = np.where(sense * wider > SURE * self.error, self.share, 0.0)
            held = float(np.sum(here))
            if held >= MATTERS:
                first, last = narrowest_bins(here)
                inside = np.flatnonzero(here[first : last + 1]) + first
                measured, simulated = (
                    abs(float(np.sum(areas[inside])))
                    for areas in (self.measured, self.simulated)
                )
                ends = number(float(self.low[first])), number(float(self.high[last]))
                parts.append(
                    f"{word} area than the simulation's in bands from {ends[0]} to "
                    f"{ends[1]} Hz: {number(measured)} against {number(simulated)} "
                    f"{self.unit} a cycle, {percent(held)} of the gap"
                )
        if not parts or self.p_value >= SIGNIFICANT:
            return " The loops of measurement and simulation have much the same area."
        return f" The measurement's loops have {'; '.join(parts)} ({chance(self.p_value)})."

    @property
    def pictures(self) -> tuple[Picture, ...]:
        """The areas over frequency; none where the input never moves."""
        if not len(self.error):
            return ()
        lines = (
            series("simulation", self.frequency, self.simulated, "simulation"),
            series(
                "measurement", self.frequency, self.measured, "measurement", self.error
            ),
        )
        panel = Panel(FREQUENCY, Axis("loop area a cycle", self.unit), lines)
        words = "Area of the loop, output over input, at each frequency"
        return (Picture("loops", words, (panel,)),)


def take_loops(samples: Samples, spectra: Spectra) -> Loops:
    """Work out the loops of all records.

    The area a cycle is ``-2 pi`` times the imaginary part of the cross-spectrum of
    output and input.
    """
    low, high = spectra.edges[0], spectra.edges[-1]
    # Edges lie between the preferred frequencies 1, 1.25, 1.6, 2, ... Hz.
    first = np.floor(np.log10(low) * BANDS_A_DECADE) - 0.5
    count = int(np.ceil(np.log10(high / low) * BANDS_A_DECADE)) + 2
    edges = 10 ** ((first + np.arange(count + 1)) / BANDS_A_DECADE)
    sums = np.sum([_sums(one, edges, samples.noise) for one in spectra.lines], axis=0)
    there = sums[0] > 0
    weight, power, centre, residual, simulated, variance, held = sums[:, there]
    total = sum(one.samples for one in spectra.lines)
    return Loops(
        frequency=centre / power,
        low=edges[:-1][there],
        high=edges[1:][there],
        measured=-2 * np.pi * (residual + simulated) / weight,
        simulated=-2 * np.pi * simulated / weight,
        error=np.maximum(2 * np.pi * np.sqrt(variance) / weight, 1e-300),
        share=held / total / samples.gap_power,
        unit=in_units(samples.units),
    )


def _sums(one: Lines, edges: FloatArray, noise: float) -> FloatArray:
    """Give a record's sums in each band that it excites, weighted by its length."""

    def banded(values: FloatArray) -> FloatArray:
        return np.histogram(one.frequency, edges, weights=values)[0]

    power, cross = one.matrix[U, U].real, one.matrix[R, U]
    coherent = np.abs(cross) ** 2 / np.maximum(power, 1e-300)
    left = np.maximum(one.matrix[R, R].real - coherent, 0.0)
    left *= one.count / max(one.count - 1, 1.0)
    # Of the cross-spectrum's imaginary part: half of that of the whole.
    square = power * np.maximum(left, noise / len(one.frequency))
    variance = square * one.spread / one.count / 2
    held, residual = banded(power), banded(cross.imag)
    rows = [
        np.ones_like(held),
        held,
        banded(power * one.frequency),
        residual,
        banded(one.matrix[S, U].imag),
        one.samples * banded(variance),
        residual**2 / np.maximum(held, 1e-300),
    ]
    here = held > max(PRESENT * float(np.sum(power)), 1e-300)
    return np.where(here, one.samples * np.array(rows), 0.0)

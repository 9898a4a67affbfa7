"""The area of the loop at each frequency: measurement against simulation."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy import fft, special

from hystbench.gap.compared import Compared
from hystbench.gap.locate.listed import listed
from hystbench.gap.locate.regression import narrowest_bins
from hystbench.gap.locate.samples import Samples
from hystbench.gap.locate.spectra import HANN_INFLATION
from hystbench.gap.locate.view import MATTERS, SIGNIFICANT, chance, number, percent
from hystbench.gap.periods import settled
from hystbench.record import FloatArray

# Third-octave bands, ten in about a decade, as in acoustics (IEC 61260).
BANDS_A_DECADE = 10
# A record counts in a band that holds this share of its input's power.
PRESENT = 1e-3
# Below this share of the measurement's area a loop of the simulation is none.
NONE = 0.05


@dataclass(frozen=True)
class Loops:
    """Area of output over input in third-octave bands that the input excites.

    A band's area is that of the loop a cycle, positive where the output lags: for sines
    of amplitudes a and b, ``pi a b sin(phase)``; a mean over the records that excite
    the band, by their lengths.

    Parameters
    ----------
    frequency : ndarray, shape (m,)
        Mean of each band in Hz, weighted by the input's power.
    low, high : ndarray, shape (m,)
        Its edges in Hz.
    measured, simulated : ndarray, shape (m,)
        Areas, in units of input times output.
    error : ndarray, shape (m,)
        Standard error of their difference: of the noise floor, or of what differs
        from period to period where that is more.
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
        squares = float(np.sum((self.difference / self.error) ** 2))
        return float(special.chdtrc(max(len(self.error), 1), squares))

    @property
    def turned(self) -> FloatArray:
        """Minus one where the loop turns the other way, as where the output leads."""
        there = np.abs(self.simulated) > NONE * np.abs(self.measured)
        return np.sign(np.where(there, self.simulated, self.measured))

    @property
    def difference(self) -> FloatArray:
        """Measured less simulated area."""
        return self.measured - self.simulated


def take_loops(samples: Samples) -> Loops:
    """Work out the loops of all records.

    The area a cycle is ``-2 pi`` times the imaginary part of the cross-spectrum of
    output and input: of whole periods where a record repeats, else under a Hann window.
    """
    found = [_spectra(item) for item in samples.compared]
    low = min(float(spectra.frequency[0]) for spectra in found)
    high = max(float(spectra.frequency[-1]) for spectra in found)
    count = int(np.ceil(np.log10(high / low) * BANDS_A_DECADE)) + 1
    # Edges lie between the preferred frequencies 1, 1.25, 1.6, 2, ... Hz.
    start = np.floor(np.log10(low) * BANDS_A_DECADE) - 0.5
    edges = 10 ** ((start + np.arange(count + 2)) / BANDS_A_DECADE)
    rows = [
        _banded(item, spectra, edges, samples.noise)
        for item, spectra in zip(samples.compared, found, strict=True)
    ]
    sums = np.sum(rows, axis=0)
    used = sums[0] > 0
    weight, centre, residual, simulated, variance, power = sums[:, used]
    n = sum(len(item.record) for item in samples.compared)
    record = samples.compared[0].record
    return Loops(
        frequency=centre / weight,
        low=edges[:-1][used],
        high=edges[1:][used],
        measured=(residual + simulated) / weight,
        simulated=simulated / weight,
        error=np.maximum(np.sqrt(variance) / weight, 1e-300),
        share=power / n / max(samples.gap_power, 1e-300),
        unit=f"{record.input.unit} {record.output.unit}",
    )


@dataclass(frozen=True)
class _Spectra:
    """A record's input, residual and simulated output, run by run.

    Scaled so that the power of a band is the input's mean square in it; the imaginary
    parts of the cross-spectra with it alike. Runs are periods, or the record under a
    window that spreads noise by ``spread``.
    """

    frequency: FloatArray
    power: FloatArray
    residual: FloatArray
    simulated: FloatArray
    samples: int
    spread: float


def _spectra(item: Compared) -> _Spectra:
    n, period = len(item.record), item.record.period_samples
    repeats = period is not None and n >= 2 * period
    size = period if repeats and period else n
    window = np.ones(size) if repeats else np.hanning(size)
    signals = np.stack([item.record.u, item.residual, item.simulated])
    runs = settled(signals, size)
    runs = runs - runs.mean(axis=(1, 2), keepdims=True)
    u, r, s = fft.rfft(runs * window, axis=2)[:, :, 1:]
    scale = 2 / (size * float(np.sum(window**2)))
    return _Spectra(
        fft.rfftfreq(size, item.record.dt)[1:],
        scale * np.abs(u) ** 2,
        scale * np.imag(r * np.conj(u)),
        scale * np.imag(s * np.conj(u)),
        runs[0].size,
        1.0 if repeats else HANN_INFLATION,
    )


def _banded(
    item: Compared, spectra: _Spectra, edges: FloatArray, noise: float
) -> FloatArray:
    """Give a record's sums in each band: weight, frequency, areas, variance, power."""
    band = np.digitize(spectra.frequency, edges) - 1

    def gather(values: FloatArray) -> FloatArray:
        return np.array([np.bincount(band, row, len(edges) - 1) for row in values])

    n = float(len(item.record))
    each = gather(spectra.power)
    held = np.maximum(each.mean(axis=0), 1e-300)
    here = held > max(PRESENT * float(np.sum(each[0])), 1e-300)
    apart = gather(spectra.residual)
    residual = apart.mean(axis=0)
    # What the noise does to the area, or what differs from period to period.
    variance = spectra.spread * noise * held / spectra.samples
    if len(apart) > 1:
        scatter = apart.var(axis=0, ddof=1) / len(apart)
        variance = np.maximum(variance, scatter)
    rows = [
        np.ones(len(held)),
        gather(spectra.power * spectra.frequency).mean(axis=0) / held,
        -2 * np.pi * residual,
        -2 * np.pi * gather(spectra.simulated).mean(axis=0),
        n * (2 * np.pi) ** 2 * variance,
        residual**2 / held,
    ]
    return np.where(here, n * np.array(rows), 0.0)


def loop_curve(loops: Loops) -> dict[str, list[float]] | None:
    """Give what the picture draws; none where the input never moves."""
    if not len(loops.frequency):
        return None
    return {
        name: listed(getattr(loops, name))
        for name in ("frequency", "measured", "simulated", "error")
    }


def told(loops: Loops) -> str:
    """Tell where the loops of measurement and simulation differ, and by how much."""
    if not len(loops.error):
        return ""
    parts = []
    for sense, word in ((1, "more"), (-1, "less")):
        differs = sense * loops.turned * loops.difference > 3 * loops.error
        here = np.where(differs, loops.share, 0.0)
        if float(np.sum(here)) >= MATTERS:
            parts.append((float(np.sum(here)), _band(loops, here, word)))
    if not parts or loops.p_value >= SIGNIFICANT:
        return " The loops of measurement and simulation have much the same area."
    parts.sort(reverse=True)
    texts = "; ".join(text for _, text in parts)
    return f" The measurement's loops have {texts} ({chance(loops.p_value)})."


def _band(loops: Loops, here: FloatArray, word: str) -> str:
    """Tell the areas of the bands that hold four fifths of a sense, added."""
    first, last = narrowest_bins(here)
    inside = (np.arange(len(here)) >= first) & (np.arange(len(here)) <= last)
    inside &= here > 0
    measured, simulated = (
        float(np.sum((loops.turned * areas)[inside]))
        for areas in (loops.measured, loops.simulated)
    )
    against, by = f"{number(simulated)} {loops.unit} a cycle", ""
    if abs(simulated) <= NONE * abs(measured):
        against = f"next to none ({loops.unit} a cycle)"
    elif simulated > 0:
        by = f", {percent(abs(measured / simulated - 1))} {word}"
    return (
        f"{word} area than the simulation's in bands from "
        f"{number(float(loops.low[first]))} to {number(float(loops.high[last]))} Hz: "
        f"{number(measured)} against "
        f"{against}{by}, {percent(float(np.sum(here)))} of the gap"
    )

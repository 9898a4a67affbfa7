"""The frequency view: what is linear in the simulated output, and in which band."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise

import numpy as np
from scipy import fft

from hystbench.gap.locate.distortion import take_distortion
from hystbench.gap.locate.forms import View, fit_form, named_or, narrowest_bins
from hystbench.gap.locate.picture import (
    FREQUENCY,
    Axis,
    Panel,
    ViewPicture,
    series,
    thinned,
)
from hystbench.gap.locate.samples import ViewSamples
from hystbench.gap.records.scored_samples import Compared, whole_periods
from hystbench.record import ComplexArray, FloatArray, Mask
from hystbench.sentences import percent, shortly
from hystbench.spectra import averaged_powers, hann, periodogram

BANDS = 12
"""Bands that have a gain and a phase of their own."""
EDGES = 401
"""Edges of the common axis, evenly spaced in the logarithm of frequency."""


def frequency(samples: ViewSamples) -> View:
    """Fit a linear filter of the simulated output: a gain and a phase of each band.

    The range is the narrowest band that holds four fifths of what is explained. The
    p-value is that of the filter.
    """
    spectra, distortion = take_spectra(samples), take_distortion(samples)
    bands = _bands(samples, spectra)
    whole = [signals for band in bands for signals in band]
    # A mode that is missing lies in one band.
    passed = {0: whole, **dict(enumerate(bands, start=1))}
    linear = "linear in the simulated output"
    filters = {
        key: fit_form(samples, linear, list(map(samples.thinned, each)), bool(key))
        for key, each in passed.items()
    }
    best = max(filters, key=lambda key: filters[key].saved)
    form = named_or(samples, "frequency", [filters[best]], [filters[0]])
    signals = form.added or [
        np.tensordot(form.weights, parts, axes=1)
        for parts in zip(*passed[best], strict=True)
    ]
    power, edges = _power(samples, signals)
    first, last = narrowest_bins(power)
    start, end = float(edges[first]), float(edges[last + 1])
    held = float(np.sum(power[first : last + 1])) / max(float(power.sum()), 1e-300)
    inside = percent(form.share * held)
    told = (
        f"is {form.words}; {inside} of the gap lies between {shortly(start)} and "
        f"{shortly(end)} Hz."
    )
    drawn = [_spectrum(samples, spectra), _response(spectra)]
    if distortion is not None:
        told += distortion.told
        drawn.append(distortion.picture(samples.units[1]))
    return form.seen("frequency", "frequency", (start, end), "Hz", told, *drawn)


def _bands(samples: ViewSamples, spectra: BinSpectra) -> list[list[list[FloatArray]]]:
    """Give what passes each excited band, and the same a quarter of a period later."""
    lines = [
        (fft.rfft(item.simulated), fft.rfftfreq(len(item.record), item.record.dt))
        for item in samples.compared
    ]
    counts = [len(item.record) for item in samples.compared]

    def passed(low: float, high: float, turn: complex) -> list[FloatArray]:
        inside = [turn * x * ((at >= low) & (at < high)) for x, at in lines]
        return [fft.irfft(x, n) for x, n in zip(inside, counts, strict=True)]

    excited = np.flatnonzero(spectra.excited)
    if not len(excited):
        return [[passed(0.0, np.inf, 1.0)]]
    low, high = spectra.low[excited[0]], spectra.high[excited[-1]]
    bands = pairwise(np.geomspace(low, high, BANDS + 1))
    return [[passed(*ends, turn) for turn in (1, 1j)] for ends in bands]


def _power(
    samples: ViewSamples, signals: Sequence[FloatArray]
) -> tuple[FloatArray, FloatArray]:
    """Give the power of signals in bins of frequency, and the edges of these."""
    pairs = zip(signals, samples.compared, strict=True)
    found = [periodogram(signal, item.record.dt) for signal, item in pairs]
    power = np.concatenate([each[1:] for each, _ in found])
    at = np.concatenate([each[1:] for _, each in found])
    edges = np.geomspace(0.999 * at.min(), 1.001 * at.max(), EDGES)
    return np.histogram(at, edges, weights=power)


def _spectrum(samples: ViewSamples, spectra: BinSpectra) -> ViewPicture:
    """Draw amplitude densities of simulation, residual, its linear part and floor."""
    # White noise of variance s^2 at a sampling interval dt has the density 2 s^2 dt.
    lengths = [len(item.record) for item in samples.compared]
    steps = [item.record.dt for item in samples.compared]
    density = 2 * samples.noise * np.average(steps, weights=lengths) / spectra.noise
    linear = spectra.power(R) * spectra.coherence(R, S)
    rows = (spectra.power(S), spectra.power(R), linear, spectra.noise)
    at, *lines = thinned(spectra.frequency, *(density * row for row in rows))
    simulated, residual, part, floor = (np.sqrt(line) for line in lines)
    drawn = (
        series("simulation", at, simulated, "simulation"),
        series("residual", at, residual, "residual"),
        series("linear part", at, part, "its part linear in the simulation"),
        series("noise", at, floor, "noise floor"),
    )
    y = Axis("amplitude density", f"{samples.units[1]}/√Hz", logarithmic=True)
    words = "Spectrum of the residual beside the simulation and the floor"
    return ViewPicture("spectrum", words, (Panel(FREQUENCY, y, drawn),))


def _response(spectra: BinSpectra) -> ViewPicture:
    """Draw measurement over simulation where the input has power.

    A harmonic that the simulation makes by itself has no response.
    """
    there = spectra.excited & (spectra.power(S) > 0)
    ratio = 1 + spectra.matrix[R, S] / np.maximum(spectra.power(S), 1e-300)
    found = spectra.frequency, ratio.real, ratio.imag, spectra.coherence(R, U)
    at, real, imaginary, coherence = thinned(*(row[there] for row in found))
    ratio = real + 1j * imaginary
    rows = (
        (Axis("magnitude"), np.abs(ratio), 1.0),
        (Axis("phase", "degrees"), np.degrees(np.angle(ratio)), 0.0),
        (Axis("coherence of the gap"), coherence, None),
    )
    panels = []
    for axis, values, right in rows:
        lines = [series("measurement", at, values)]
        if right is not None and len(at):
            lines.append(series("right", at[[0, -1]], [right, right]))
        panels.append(Panel(FREQUENCY, axis, tuple(lines)))
    words = (
        "Best linear approximation of measurement over simulation, dashed where the "
        "simulation is right, and coherence of the gap with the input: one where a "
        "linear path leaves it, less where distortion or something else does"
    )
    return ViewPicture("response", words, tuple(panels))


U, R, S = range(3)
"""Input, residual and simulated output, as rows and columns of a spectral matrix."""
SEGMENTS = 4
"""Segments of a record without as many periods; they overlap by half."""
EXCITED_POWER = 1e-5
"""Least input power of an excited bin, as a share of the strongest bin's."""


@dataclass(frozen=True)
class BinSpectra:
    """Spectra summed over the lines of all records in each bin."""

    low: FloatArray
    high: FloatArray
    """Shape (m,). Edges in Hz of the bins that hold lines."""
    matrix: ComplexArray
    """Shape (3, 3, m). Auto- and cross-spectra of input, residual and simulation: row
    times the conjugate of column. Sums over bins are mean squares over all samples."""
    noise: FloatArray
    """Shape (m,). Mean square that the noise floor gives a bin."""

    @property
    def frequency(self) -> FloatArray:
        """Middle of each bin, in Hz."""
        return np.asarray(np.sqrt(self.low * self.high))

    def power(self, row: int) -> FloatArray:
        """Mean square of a signal in each bin."""
        return np.asarray(self.matrix[row, row].real)

    @cached_property
    def excited(self) -> Mask:
        """Bins in which the input has power."""
        power = self.power(U)
        return np.asarray(power > EXCITED_POWER * float(np.max(power)))

    def coherence(self, a: int, b: int) -> FloatArray:
        """Coherence of two signals in each bin, from 0 to 1."""
        both = np.maximum(self.power(a) * self.power(b), 1e-300)
        return np.asarray(np.clip(np.abs(self.matrix[a, b]) ** 2 / both, 0.0, 1.0))


def take_spectra(samples: ViewSamples) -> BinSpectra:
    """Average the spectra of each record by Welch's method, and add the records."""
    lines = [_lines(item) for item in samples.compared]
    frequencies = np.concatenate([frequency for frequency, _ in lines])
    edges = np.geomspace(0.999 * frequencies.min(), 1.001 * frequencies.max(), EDGES)
    total = sum(len(item.record) for item in samples.compared)
    # The noise is white: each line of a record has as much of it.
    weights = [
        len(item.record) / total * np.vstack([matrix, np.full_like(matrix[:1], share)])
        for item, (_, matrix) in zip(samples.compared, lines, strict=True)
        for share in [samples.noise / matrix.shape[1]]
    ]
    place = np.digitize(frequencies, edges) - 1
    held = np.zeros((len(edges) - 1, 10), dtype=np.complex128)
    np.add.at(held, place, np.hstack(weights).T)
    there = np.bincount(place, minlength=len(held)) > 0
    *matrix, noise = held[there].T
    found = np.array(matrix).reshape(3, 3, -1)
    return BinSpectra(edges[:-1][there], edges[1:][there], found, noise.real)


def _lines(item: Compared) -> tuple[FloatArray, ComplexArray]:
    """Average over whole periods where there are enough, else over segments.

    Give frequencies, shape (m,), and spectral matrices, shape (9, m).
    """
    record = item.record
    signals = np.stack([record.u, item.residual, item.simulated])
    n, period = len(record), record.period_samples
    if period and n >= SEGMENTS * period:
        signals = whole_periods(signals, period).reshape(3, -1)
        size = step = period
        window = np.ones(size)
    else:
        size, step = n // SEGMENTS, n // SEGMENTS - n // SEGMENTS // 2
        window = hann(size)
    centred = signals - signals.mean(axis=1, keepdims=True)
    matrix = averaged_powers(centred, window, step)
    frequency = np.arange(matrix.shape[-1]) / (size * record.dt)
    return frequency[1:], matrix.reshape(9, -1)[:, 1:]

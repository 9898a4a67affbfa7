"""The frequency view: what is linear in the simulated output, and in which band."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import partial
from itertools import pairwise

import numpy as np
from scipy import fft

from hystbench.gap.locate.distortion import take_distortion
from hystbench.gap.locate.forms import fit_form, named_or, narrowest_bins
from hystbench.gap.locate.picture import (
    FREQUENCY,
    Axis,
    Panel,
    Picture,
    series,
    thinned,
)
from hystbench.gap.locate.samples import ViewSamples
from hystbench.gap.locate.spectra import R, S, Spectra, U, take_spectra
from hystbench.gap.locate.view import View, number, percent, view_of
from hystbench.gap.records.floor import periodogram
from hystbench.gap.records.residual import Compared
from hystbench.record import FloatArray

BANDS = 12
"""With a gain and a phase of their own."""
BINS = 401
"""Edges of bins over which a range is sought."""
NO_DISTORTION = "distortion, as no record repeats with a gap above the noise"


def frequency(samples: ViewSamples) -> View:
    """Fit a linear filter of the simulated output: a gain and a phase of each band.

    The range is the narrowest band that holds four fifths of what is explained. The
    p-value is that of the filter.
    """
    spectra, distortion = take_spectra(samples), take_distortion(samples)
    bands = _bands(spectra)
    pairs = [(band, [samples.thin(of) for of in band]) for band in bands]
    whole = [of for band in bands for of in band]
    filtered = fit_form(samples, "linear", [c for _, columns in pairs for c in columns])
    # A mode that is missing lies in one band.
    found = [(fit_form(samples, "linear", c, 1), band) for band, c in pairs]
    own, passed = max([(filtered, whole), *found], key=lambda one: one[0].saved)
    form = named_or(samples, "frequency", [own])
    signals = form.added or [
        np.sum(
            [w * of(item) for w, of in zip(own.weights, passed, strict=True)], axis=0
        )
        for item in samples.compared
    ]
    power, edges = _power(samples, signals)
    first, last = narrowest_bins(power)
    start, end = float(edges[first]), float(edges[last + 1])
    inside = form.share * float(
        np.sum(power[first : last + 1]) / max(power.sum(), TINY)
    )
    like = form.words if form.named else "linear in the simulated output"
    told = (
        f"is {like}; {percent(form.share * held)} of the gap lies between {number(start)} and "
        f"{number(end)} Hz."
    )
    drawn = [_spectrum(samples, spectra), _response(spectra)]
    lacks = (NO_DISTORTION,)
    if distortion is not None:
        told += distortion.told + distortion.told_repeating
        drawn.append(distortion.picture(samples.units[1]))
        lacks = ()
    axis, ends = "frequency", (start, end)
    return view_of(
        samples, "frequency", form, axis, ends, "Hz", told, [filtered], drawn, lacks
    )


Passed = Callable[[Compared], FloatArray]


def _bands(spectra: Spectra) -> list[list[Passed]]:
    """Give what passes each excited band, and the same a quarter of a period later."""
    excited = np.flatnonzero(spectra.excited)
    if not len(excited):
        return [[partial(_passed, band=(0.0, np.inf), turn=1.0)]]
    low, high = spectra.low[excited[0]], spectra.high[excited[-1]]
    bands = pairwise(np.geomspace(low, high, BANDS + 1))
    return [
        [partial(_passed, band=ends, turn=turn) for turn in (1, 1j)] for ends in bands
    ]


def _passed(item: Compared, band: tuple[float, float], turn: complex) -> FloatArray:
    """Let a band of the simulated output pass."""
    count = len(item.record)
    frequency = fft.rfftfreq(count, item.record.dt)
    inside = (frequency >= band[0]) & (frequency < band[1])
    return np.asarray(fft.irfft(turn * inside * fft.rfft(item.simulated), count))


def _power(
    samples: ViewSamples, signals: Sequence[FloatArray]
) -> tuple[FloatArray, FloatArray]:
    """Give the power of signals in bins of frequency, and the edges of these."""
    pairs = zip(signals, samples.compared, strict=True)
    found = [periodogram(signal, item.record.dt) for signal, item in pairs]
    power = np.concatenate([each[1:] for each, _ in found])
    at = np.concatenate([each[1:] for _, each in found])
    edges = np.geomspace(0.999 * at.min(), 1.001 * at.max(), BINS)
    return np.histogram(at, edges, weights=power)


def _spectrum(samples: ViewSamples, spectra: Spectra) -> Picture:
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
    return Picture("spectrum", words, (Panel(FREQUENCY, y, drawn),))


def _response(spectra: Spectra) -> Picture:
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
    return Picture("response", words, tuple(panels))

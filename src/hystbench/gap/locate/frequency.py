"""The frequency view: what is linear in the simulated output, and in which band."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import cast

import numpy as np
from scipy import fft

from hystbench.gap.compared import Compared
from hystbench.gap.locate.distortion import Distortion, told
from hystbench.gap.locate.regression import (
    Form,
    colour_count,
    f_test,
    fit_form,
    narrowest_bins,
    saved,
)
from hystbench.gap.locate.samples import Samples
from hystbench.gap.locate.spectra import HANN_INFLATION, ComplexArray, Spectra
from hystbench.gap.locate.view import View, number, percent
from hystbench.record import FloatArray

GROUPS = 12
DAMPINGS = (0.01, 0.02, 0.05, 0.1, 0.2)
MODES = 80


def frequency_view(
    samples: Samples, spectra: Spectra, distortion: Distortion | None
) -> View:
    """Fit linear dynamics to residual against simulated output.

    The forms are a mode, a first-order lag, diffusion and any gain and phase in a few
    bands. The range is the narrowest band, in the logarithm of frequency, that holds
    four fifths of what is linear. The p-value is that of a gain and a phase in each
    of six bands of equal simulated power; it errs to the large side, as the window
    may smear a line over less than it is charged for.
    """
    forms = linear_forms(samples, spectra)
    kind = max(forms, key=lambda name: forms[name].saved)
    form = forms[kind]
    power = np.minimum(form.fitted, spectra.residual)
    first, last = narrowest_bins(power)
    start, end = float(spectra.low[first]), float(spectra.high[last])
    share = samples.share(form.explained, form.freedom)
    inside = share * float(np.sum(power[first : last + 1]) / max(power.sum(), 1e-300))
    return View(
        view="frequency",
        axis="frequency",
        start=start,
        end=end,
        unit="Hz",
        share_of_gap_power=share,
        p_value=_p_value(samples, spectra),
        sentence=(
            f"{percent(share)} of the gap is linear in the simulated output and looks "
            f"like {kind}; {percent(inside)} of the gap lies between {number(start)} "
            f"and {number(end)} Hz.{told(distortion)}"
        ),
        saved=form.saved,
    )


def linear_forms(samples: Samples, spectra: Spectra) -> dict[str, Form]:
    """Fit every linear form, by what it is in words.

    Each is searched in the pooled spectra, and the best of a lag, of diffusion and of
    a mode is then run in time, where a record's ends do no harm. ``fitted`` of these
    forms is the power explained in each bin.
    """
    excited = spectra.simulated >= 1e-4 * float(np.max(spectra.simulated))
    low = float(spectra.frequency[excited][0])
    high = float(spectra.frequency[excited][-1])
    times = np.geomspace(0.01 / high, 3 / low, 60) / (2 * np.pi)
    modes = [(f, z) for f in np.geomspace(low / 1.5, high * 2, MODES) for z in DAMPINGS]
    return {
        "a lag": _shaped(samples, spectra, _lag, times[:, np.newaxis]),
        "diffusion": _shaped(samples, spectra, _slab, times[:, np.newaxis]),
        "a mode": _shaped(samples, spectra, _mode, np.array(modes)),
        "a gain and phase of each band's own": _banded(samples, spectra),
    }


def _lag(frequency: FloatArray, parameters: FloatArray) -> ComplexArray:
    """Give 1 / (1 + s tau) - 1 for each tau."""
    s = 2j * np.pi * frequency
    return cast(ComplexArray, 1 / (1 + s * parameters[:, :1]) - 1)


def _slab(frequency: FloatArray, parameters: FloatArray) -> ComplexArray:
    """Give tanh(q) / q - 1, q^2 = s tau, for each tau: diffusion into a slab."""
    root = np.sqrt(2j * np.pi * np.maximum(frequency, 1e-9) * parameters[:, :1])
    return cast(ComplexArray, np.tanh(root) / root - 1)


def _mode(frequency: FloatArray, parameters: FloatArray) -> ComplexArray:
    """Give wn^2 / (s^2 + 2 zeta wn s + wn^2) - 1 for each pair of Hz and zeta."""
    ratio = frequency / parameters[:, :1]
    response = 1 / (1 - ratio**2 + 2j * parameters[:, 1:] * ratio)
    return cast(ComplexArray, response - 1)


def _shaped(
    samples: Samples,
    spectra: Spectra,
    shape: Callable[[FloatArray, FloatArray], ComplexArray],
    grid: FloatArray,
) -> Form:
    """Fit a shape with one real factor at each row of parameters; keep the best."""
    shapes = shape(spectra.frequency, grid)
    moment = np.real(np.conj(shapes) @ spectra.cross)
    energy = np.abs(shapes) ** 2 @ spectra.simulated
    row = int(np.argmax(moment**2 / np.maximum(energy, 1e-300)))
    explained = float(moment[row] ** 2 / max(float(energy[row]), 1e-300))
    factor = moment[row] / max(float(energy[row]), 1e-300)
    power = np.abs(factor * shapes[row]) ** 2 * spectra.simulated
    freedom = 1 + grid.shape[1]
    pooled = Form(power, explained, freedom, saved(samples, explained, freedom))
    if explained < 0.3 * samples.gap_power:
        return pooled
    run = samples.thin(lambda item: _run(item, shape, grid[row : row + 1]))
    timed = fit_form(samples, [run], searched=grid.shape[1])
    return replace(timed, fitted=power)


def _run(
    item: Compared,
    shape: Callable[[FloatArray, FloatArray], ComplexArray],
    parameters: FloatArray,
) -> FloatArray:
    """Send the simulated output, at rest before, through a shape."""
    n = len(item.simulated)
    length = fft.next_fast_len(2 * n, real=True)
    start = item.simulated[0]
    spectrum = fft.rfft(item.simulated - start, length)
    frequency = fft.rfftfreq(length, item.record.dt)
    response = shape(frequency, parameters)[0]
    return cast(FloatArray, fft.irfft(spectrum * response, length)[:n])


def _banded(samples: Samples, spectra: Spectra) -> Form:
    """Fit a gain and a phase in bands that hold equal shares of the linear power."""
    power, explained, bands = _in_bands(spectra, spectra.linear, GROUPS)
    freedom = 2 * bands
    return Form(power, explained, freedom, saved(samples, explained, freedom))


def _in_bands(
    spectra: Spectra, weight: FloatArray, count: int
) -> tuple[FloatArray, float, int]:
    """Cut the axis at equal shares of a weight; fit a complex gain in each band."""
    total = np.cumsum(weight)
    place = (total - 0.5 * weight) / max(float(total[-1]), 1e-300)
    band = np.minimum((place * count).astype(np.int64), count - 1)
    _, band = np.unique(band, return_inverse=True)
    cross = np.bincount(band, spectra.cross.real) + 1j * np.bincount(
        band, spectra.cross.imag
    )
    energy = np.maximum(np.bincount(band, spectra.simulated), 1e-300)
    power = np.abs(cross / energy)[band] ** 2 * spectra.simulated
    return power, float(np.sum(np.abs(cross) ** 2 / energy)), len(energy)


def _p_value(samples: Samples, spectra: Spectra) -> float:
    """Test six bands, cut without a look at the residual."""
    fitted, explained, bands = _in_bands(spectra, spectra.simulated, 6)
    share = explained / max(float(np.sum(spectra.residual)), 1e-300)
    n = sum(len(item.record) for item in samples.compared)
    # What any linear system leaves tells the colour; bins of the axis are unlike wide.
    width = spectra.noise
    freest, _, _ = _in_bands(spectra, spectra.linear, GROUPS)
    left = np.maximum(spectra.residual - freest, 0.0)
    count = colour_count(n, left / width, fitted / width, width)
    return f_test(share, 2 * bands, count / HANN_INFLATION)

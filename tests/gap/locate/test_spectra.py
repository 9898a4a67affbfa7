"""Spectra beside those of ``scipy.signal``, which takes long to load."""

import numpy as np
import pytest
from scipy import signal

from hystbench.gap.locate.frequency import SEGMENTS, _lines
from hystbench.gap.records.scored_samples import Compared
from tests.gap.made import record


@pytest.mark.parametrize("count", [400, 403, 1001])
@pytest.mark.parametrize("period", [None, 40, 37])
def test_spectra_are_those_of_scipy(count, period):
    u, y, simulated = np.random.default_rng(1).normal(size=(3, count))
    item = record(u, y, dt=0.01, period_samples=period)
    frequency, matrix = _lines(Compared(item, simulated))
    signals = np.stack([u, y - simulated, simulated])
    size = period or count // SEGMENTS
    if period:
        signals = signals[:, count % period + period :]  # the way from rest is left out
    signals = signals - signals.mean(axis=1, keepdims=True)
    lines, expected = signal.csd(
        signals[None],
        signals[:, None],
        100.0,
        window="boxcar" if period else "hann",
        nperseg=size,
        noverlap=0 if period else size // 2,
        detrend=False,
    )
    np.testing.assert_allclose(frequency, lines[1:])
    power = expected.reshape(9, -1)[:, 1:] * lines[1]
    np.testing.assert_allclose(matrix, power, rtol=1e-9, atol=1e-12)

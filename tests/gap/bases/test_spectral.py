"""Where a further mode of a base is looked for."""

import numpy as np

from hystbench.blocks.resonance import Resonance
from hystbench.gap.bases.spectral import Spectra, fit_ratio, with_a_mode
from tests.gap.made import record

DT = 1e-3


def test_a_further_mode_is_begun_where_what_is_left_follows_the_input():
    """Noise about the first mode has a hundred times the power of a second one."""
    rng = np.random.default_rng(2)
    u = rng.standard_normal(8000)
    low, high = (
        Resonance(frequency_hz=f, damping_ratio=0.02, participation=1.0, hold="linear")
        for f in (20.0, 180.0)
    )
    second = 0.01 * high.simulate(u, u, DT)
    noise = low.simulate(rng.standard_normal(8000), u, DT)
    noise *= 10 * np.std(second) / np.std(noise)
    y = low.simulate(u, u, DT) + second + noise
    spectra = Spectra.of((record(u, y, dt=DT),), "linear")
    ratio = fit_ratio(spectra, 2, 2)
    wider = next(with_a_mode(spectra, ratio, [second + noise]))
    poles = np.roots(np.append(wider.a, 1.0)[::-1]) * spectra.scale / (2 * np.pi)
    assert abs(abs(poles).max() - 180.0) < 9.0

"""The linear base of a mass that no spring holds, from windows of its records."""

import numpy as np
import pytest

from hystbench.gap.bases.linear import identified_linear
from hystbench.gap.records.evidence import Evidence
from hystbench.gap.records.free_mass import decay_of_free_mass, windows
from hystbench.quantities import Quantities
from hystbench.record import Channel, Record

DT, COUNT = 1e-3, 6000
MASS, DAMPING = 5e-3, 4e-3  # N s2/mm, N s/mm
GAIN, RATE_GAIN = 4.0, 0.08  # N/mm, N s/mm
NOISE = 0.004  # mm


def held_by_a_controller(seed):
    """Force and position of a mass on an air bearing, exact for a force in steps."""
    rng, time = np.random.default_rng(seed), np.arange(COUNT) * DT
    tones = [np.sin(2 * np.pi * f * time + rng.uniform(0, 6)) for f in (0.3, 1.7, 4.1)]
    wanted = 8 * sum(tones) * np.minimum(time / 0.1, 1.0)
    decay = np.exp(-DT * DAMPING / MASS)
    way = (1 - decay) * MASS / DAMPING
    force, position = np.empty(COUNT), np.empty(COUNT)
    q = v = 0.0
    for k, goal in enumerate(wanted.tolist()):
        f = GAIN * (goal - q) - RATE_GAIN * v
        force[k], position[k] = f, q
        steady = f / DAMPING
        q += steady * DT + (v - steady) * way
        v = steady + (v - steady) * decay
    about = Channel("force", "N"), Channel("position", "mm"), "twin", "fit"
    noise = NOISE * rng.standard_normal(COUNT)
    return Record(f"run-{seed}", DT, force, position + noise, *about)


def test_a_free_mass_is_found_to_the_noise_though_windows_begin_in_motion():
    records = [held_by_a_controller(seed) for seed in (1, 2)]
    quantities = Quantities("force", "position")
    decay = decay_of_free_mass(records, quantities)
    cut = tuple(window for x in records for window in windows(x, decay))
    assert len(cut) > 10
    evidence = Evidence("stage", cut, (), "zero-order", quantities=quantities)
    found = identified_linear(evidence)
    assert found.fit_rms == pytest.approx(NOISE, rel=0.05)
    ratio = found.model.chain[0]
    second, first, _ = ratio.denominator
    assert second / ratio.numerator[-1] == pytest.approx(MASS, rel=0.01)
    assert first / ratio.numerator[-1] == pytest.approx(DAMPING, rel=0.1)
    assert found.model.chain[-1].offset == 0.0

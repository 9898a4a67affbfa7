"""Blocks of the sensor that add a signal, against their definitions."""

import math

import numpy as np
import pytest

from hystbench.blocks.drift import Drift
from hystbench.blocks.mains_pickup import MainsPickup
from hystbench.errors import InputError

DT = 1e-3
Z = np.array([1.0, -1.0, 0.5, 0.0, 2.0, 1.0, 0.0])


def test_mains_pickup_is_its_harmonics():
    block = MainsPickup(frequency_hz=50.0, amplitudes=[0.2, 0.1], phases=[0.3, -1.0])
    expected = [
        z
        + 0.2 * math.sin(2 * math.pi * 50 * k * DT + 0.3)
        + 0.1 * math.sin(2 * math.pi * 100 * k * DT - 1.0)
        for k, z in enumerate(Z)
    ]
    np.testing.assert_allclose(block.simulate(Z, Z, DT), expected, rtol=0, atol=1e-14)
    with pytest.raises(InputError, match=r"phases: expected 1 numbers.* got 2"):
        MainsPickup(frequency_hz=50.0, amplitudes=[0.2], phases=[0.3, 1.0])


def test_drift_by_hand():
    steady = Drift(slope=2.0).simulate(Z, Z, DT)
    np.testing.assert_allclose(steady - Z, 0.002 * np.arange(7), rtol=0, atol=1e-15)
    # Six steps, three parts: values at samples 2, 4 and 6, straight between them.
    path = Drift(slope=0.0, path=[1.0, -1.0, 0.0]).simulate(Z, Z, DT) - Z
    np.testing.assert_allclose(
        path, [0.0, 0.5, 1.0, 0.0, -1.0, -0.5, 0.0], rtol=0, atol=1e-15
    )

"""Blocks without memory, and the random one, against their definitions."""

import numpy as np
import pytest

from hystbench.blocks.asymmetry import Asymmetry
from hystbench.blocks.calibration_error import CalibrationError
from hystbench.blocks.gain import Gain
from hystbench.blocks.sensor_noise import SensorNoise
from hystbench.blocks.sensor_nonlinearity import SensorNonlinearity

Z = np.array([-2.0, 0.0, 0.5, 3.0])


@pytest.mark.parametrize(
    ("block", "expected"),
    [
        (Gain(value=3.0, offset=1.0), [-5.0, 1.0, 2.5, 10.0]),
        (Gain(value=3.0), [-6.0, 0.0, 1.5, 9.0]),
        (CalibrationError(gain=2.0, offset=-1.0), [-5.0, -1.0, 0.0, 5.0]),
        (Asymmetry(coefficient=0.5), [0.0, 0.0, 0.625, 7.5]),
        (SensorNonlinearity(quadratic=0.5, cubic=-1.0), [8.0, 0.0, 0.5, -19.5]),
    ],
)
def test_values_worked_out_by_hand(block, expected):
    np.testing.assert_allclose(block.simulate(Z, Z, 1e-3), expected, rtol=1e-15)


def test_sensor_noise_is_white_and_of_the_stated_rms():
    n = 100_000
    noise = SensorNoise(rms=0.3).draw(n, np.random.default_rng(7))
    # Five standard errors of mean, rms and lag-one correlation of white noise.
    assert abs(noise.mean()) < 5 * 0.3 / np.sqrt(n)
    assert abs(noise.std() / 0.3 - 1) < 5 / np.sqrt(2 * n)
    assert abs(np.corrcoef(noise[1:], noise[:-1])[0, 1]) < 5 / np.sqrt(n)


def test_sensor_noise_adds_nothing_by_itself():
    np.testing.assert_array_equal(SensorNoise(rms=0.3).simulate(Z, Z, 1e-3), Z)

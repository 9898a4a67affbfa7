"""A sensor that is a filter of second order, beside a delay and a lag."""

import numpy as np
import pytest
from scipy.signal import lsim

from hystbench.blocks.gain import Gain
from hystbench.blocks.transfer_function import TransferFunction
from hystbench.model import Model
from hystbench.record import Channel, Record
from tests.gap.searched import among, search

DT, COUNT, NOISE = 1e-3, 1500, 0.003
FORCE, PLACE = Channel("force", "N"), Channel("position", "mm")
POLE = TransferFunction(numerator=(1.0,), denominator=(0.02, 1.0), hold="linear")
CORNER = 1.0 / (2 * np.pi * 40.0)
T = DT * np.arange(COUNT)
LAGS = among("sensor-lag", "drive-lag", "input-delay", "resonance", "creep")


def records(down):
    """Give records of one over a polynomial, written without a block."""
    random = np.random.default_rng(5)
    found = []
    for k in range(2):
        slow = np.convolve(random.standard_normal(COUNT + 12), np.hanning(13), "valid")
        u = slow / np.std(slow)
        y = lsim(([1.0], down), u, T)[1] + NOISE * random.standard_normal(COUNT)
        found.append(Record(f"run-{k}", DT, u, y, FORCE, PLACE, "measured", "fit"))
    return tuple(found)


POLES = {
    "a lag": (POLE, [0.02, 1.0]),
    "a gain": (Gain(value=1.0), [1.0]),
}


@pytest.mark.parametrize("damping", [0.71, 0.87])
@pytest.mark.parametrize("base", POLES)
def test_a_filter_of_second_order_is_a_sensor_that_lags(damping, base):
    block, down = POLES[base]
    given = records(np.polymul(down, [CORNER**2, 2 * damping * CORNER, 1.0]))
    base = Model("base", FORCE, PLACE, (block,))
    answer = search("sensor", given, base, "linear", vocabulary=LAGS)
    (effect,) = answer.content["effects"]
    # Behind a linear base the drive's filter and the sensor's are one and the same.
    assert {effect["name"], *effect["cannot_be_told_from"]} == {
        "sensor-lag",
        "drive-lag",
    }
    found = effect["parameters"]
    assert found["time_constant_s"]["value"] == pytest.approx(CORNER, rel=0.03)
    assert found["damping_ratio"]["value"] == pytest.approx(damping, rel=0.05)


def test_a_lag_of_first_order_has_no_damping():
    given = records(np.polymul([0.02, 1.0], [0.004, 1.0]))
    base = Model("base", FORCE, PLACE, (POLE,))
    answer = search("sensor", given, base, "linear", vocabulary=LAGS)
    (effect,) = answer.content["effects"]
    assert "sensor-lag" in (effect["name"], *effect["cannot_be_told_from"])
    assert list(effect["parameters"]) == ["time_constant_s"]

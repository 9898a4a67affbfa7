"""A drive that goes no faster than a rate: hard, or as one that also lags."""

import itertools

import numpy as np
import pytest
from scipy.signal import lfilter

from hystbench.blocks.transfer_function import TransferFunction
from hystbench.model import Model
from hystbench.record import Channel
from tests.gap.made import bent_first
from tests.gap.searched import among, search

DRIVE, OUTPUT = Channel("drive", "V"), Channel("output", "V")
POLE = TransferFunction(numerator=(1.0,), denominator=(4e-3, 1.0), hold="linear")
BASE = Model("pole", DRIVE, OUTPUT, (POLE,))
CURVES = among(
    *("slew-limit", "drive-lag", "sensor-lag", "eddy-diffusion", "input-delay"),
    *("drive-saturation", "saturation", "creep", "calibration-error"),
)
DT, FINE = 1e-3, 64
RATE, LAG = 120.0, 5e-3


def lagging(u, rate, curve):
    """Follow straight lines in short steps, each of them by half of the last rate."""
    now, out, step = u[0], [u[0]], DT / FINE
    for before, after in itertools.pairwise(u):
        for part in range(FINE):
            ahead = before + (after - before) * (part + 0.5) / FINE
            half = now + 0.5 * step * rate * curve((ahead - now) / (rate * LAG))
            now += step * rate * curve((ahead - half) / (rate * LAG))
        out.append(now)
    return np.array(out)


def finely(u):
    return np.interp(np.arange((len(u) - 1) * FINE + 1) / FINE, np.arange(len(u)), u)


def hard(u, falling=1.0):
    now, out = u[0], []
    for wanted in finely(u).tolist():
        now += min(max(wanted - now, -falling * RATE * DT / FINE), RATE * DT / FINE)
        out.append(now)
    return np.array(out)[::FINE]


def lagged(u):
    keep = np.exp(-DT / FINE / LAG)
    fine = finely(u) - u[0]
    return u[0] + lfilter([1 - keep], [1, -keep], fine)[::FINE]


def found(bend):
    given = bent_first(
        POLE, bend, (0.4, 1.5), 41, 0.004, (DRIVE, OUTPUT), DT, count=600
    )
    answer = search("amplifier", given, BASE, "linear", vocabulary=CURVES)
    (effect,) = answer.content["effects"]
    told = {name: item["value"] for name, item in effect["parameters"].items()}
    return effect["name"], told


@pytest.mark.parametrize(
    ("curve", "form"),
    [(np.tanh, "rounded"), (lambda x: np.clip(x, -1.0, 1.0), "sharp")],
    ids=["an amplifier", "a servo"],
)
def test_one_that_lags_is_told_with_its_rate_its_lag_and_its_law(curve, form):
    name, told = found(lambda u: lagging(u, RATE, curve))
    assert (name, told.get("form", "rounded")) == ("slew-limit", form)
    assert told["rate"] == pytest.approx(RATE, rel=0.02)
    assert told["time_constant_s"] == pytest.approx(LAG, rel=0.05)


def test_a_hard_limit_has_no_lag():
    name, told = found(hard)
    assert name == "slew-limit"
    assert told == {"rate": pytest.approx(RATE, rel=0.02)}


def test_a_lag_is_no_limit_of_the_rate():
    name, _ = found(lagged)
    assert name in ("drive-lag", "sensor-lag")


def test_a_hard_limit_may_fall_at_another_rate():
    """As a cylinder of two areas does, or an arm that has weight."""
    name, told = found(lambda u: hard(u, 0.6))
    assert name == "slew-limit"
    assert told["rate"] == pytest.approx(RATE, rel=0.02)
    assert told["falling"] == pytest.approx(0.6 * RATE, rel=0.02)

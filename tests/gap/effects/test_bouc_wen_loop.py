"""A loop of Bouc and Wen before linear dynamics, made without its block."""

import numpy as np
import pytest

from hystbench.blocks.transfer_function import TransferFunction
from hystbench.model import Model
from hystbench.record import Channel, Record
from tests.gap.searched import among, search

DT, COUNT, NOISE = 1e-3, 1500, 0.004
FINE = 40
"""Steps of the equations between two samples."""
WEIGHT, YIELD, LAG_S = -0.45, 0.4, 8e-3
VOLTAGE, POSITION = Channel("voltage", "V"), Channel("position", "um")
BASE = Model(
    "stage",
    VOLTAGE,
    POSITION,
    (TransferFunction(numerator=(5.0,), denominator=(LAG_S, 1.0), hold="linear"),),
    free=("transfer-function.numerator", "transfer-function.denominator"),
)


def inputs():
    t = np.arange(COUNT) * DT
    yield 0.9 * np.sin(2 * np.pi * 1.7 * t) * np.minimum(1.0, 2 * t)
    yield 0.5 * np.sin(2 * np.pi * 3.1 * t) + 0.4 * np.sin(2 * np.pi * 7.3 * t)
    yield 0.25 * np.sin(2 * np.pi * 5.0 * t) + 0.6 * np.sin(2 * np.pi * 0.4 * t)


def bouc_wen(u, sharing):
    """Give the loop beside the path by small steps of Euler's."""
    h, out = 0.0, []
    for way in np.diff(u, prepend=0.0):
        share = sharing + (1 - sharing) * np.sign(h * way)
        h += way * (1 - abs(h) / YIELD * share)
        out.append(h)
    return u + WEIGHT * np.array(out)


def plays(u):
    """Give three plays beside the path."""
    total = u.copy()
    for threshold, weight in ((0.05, 0.3), (0.2, -0.2), (0.45, 0.5)):
        w = 0.0
        for k, z in enumerate(u.tolist()):
            w = min(max(w, z - threshold), z + threshold)
            total[k] += weight * w
    return total


def records(loop):
    """Measure a lag behind a loop, finely."""
    random = np.random.default_rng(3)
    places = np.arange((COUNT - 1) * FINE + 1) / FINE
    for k, u in enumerate(inputs()):
        bent = loop(np.interp(places, np.arange(COUNT), u))
        x, position = 0.0, []
        for z in bent:
            x += DT / FINE / LAG_S * (5.0 * z - x)
            position.append(x)
        y = np.array(position)[::FINE] + NOISE * random.standard_normal(COUNT)
        yield Record(f"run-{k}", DT, u, y, VOLTAGE, POSITION, "measured", "fit")


def named(loop):
    """Search a gap; give the one effect that is named, and its form."""
    likely = among("hysteresis", "backlash", "asymmetry", "saturation", "sensor-lag")
    content = search(
        "stage", tuple(records(loop)), BASE, "linear", vocabulary=likely
    ).content
    (effect,) = content["effects"]
    first = content["ranking"][0]
    assert first["name"] == effect["name"] == "hysteresis"
    return effect, first["form"]


@pytest.mark.parametrize("sharing", [0.5, 0.2])
def test_it_is_named_with_its_numbers(sharing):
    effect, form = named(lambda u: bouc_wen(u, sharing))
    assert (form, effect["blocks"]) == ("Bouc-Wen", ["bouc-wen"])
    found = {name: x["value"] for name, x in effect["parameters"].items()}
    assert found["yield_distance"] == pytest.approx(YIELD, rel=0.05)
    assert found["weight"] == pytest.approx(WEIGHT, rel=0.05)
    assert found["sharing"] == pytest.approx(sharing, abs=0.05)
    assert effect["parameters"]["yield_distance"]["unit"] == "V"


def test_a_loop_of_plays_is_still_one_of_plays():
    effect, form = named(plays)
    assert form in ("plays", "generalized plays")
    assert effect["blocks"] != ["bouc-wen"]

"""A servo that turns no faster than its pump lets it."""

import numpy as np

from hystbench.gap.asked import Asked
from hystbench.record import Channel, Record
from tests.gap.closing import closed_beside
from tests.gap.made import evidence_of
from tests.gap.searched import among
from tests.gap.solved import motion

DT, COUNT, NOISE = 0.1, 1500, 0.1
RATE, LAG, PUMP = 3.2, 1.1, 0.12  # deg/s, s, s
LIKELY = Asked(
    vocabulary=among("slew-limit", "drag", "drive-saturation", "drive-lag"),
)
"""What a servo's limit may be taken for."""


def turned(order):
    """A rudder by a general solver; the order is a staircase."""

    def slope(t, state):
        angle, rate = state
        now = order[min(int(t / DT + 1e-9), COUNT - 1)]
        asked = min(max((now - angle) / LAG, -RATE), RATE)
        return [rate, (asked - rate) / PUMP]

    time = np.arange(COUNT) * DT
    return motion(slope, [0.0, 0.0], time, DT / 2, rtol=1e-6, atol=1e-8)


def orders():
    rng, time = np.random.default_rng(12), np.arange(COUNT) * DT
    yield "zigzag", np.repeat(rng.choice([-10.0, 0.0, 10.0], COUNT // 100), 100)
    lines = zip(rng.uniform(0.01, 0.12, 9), rng.uniform(0, 6, 9), strict=True)
    yield "autopilot", sum(2.5 * np.sin(2 * np.pi * f * time + p) for f, p in lines)
    yield "steps", np.repeat(rng.uniform(-20, 20, COUNT // 75), 75)


def test_a_servo_that_goes_no_faster_is_a_slew_limit():
    rng, records = np.random.default_rng(13), []
    about = Channel("order", "deg"), Channel("rudder", "deg"), "twin"
    for (name, u), use in zip(orders(), ["fit", "fit", "hold-out"], strict=True):
        y = turned(u) + NOISE * rng.standard_normal(COUNT)
        records.append(Record(name, DT, u, y, *about, use))
    told = "zero-order", NOISE, "position", "position"
    content = closed_beside("linear", evidence_of("gear", records, *told), LIKELY)
    (effect,) = content["effects"]
    assert content["verdict"] == "named"
    # The loop of a servo lies in its block, or in the mass that stands for the base.
    assert effect["name"] == "slew-limit"
    assert effect["place"] in ("drive", "inside")
    assert abs(effect["parameters"]["rate"]["value"] / RATE - 1) < 0.03
    assert content["gap"]["after"] < 2 * NOISE

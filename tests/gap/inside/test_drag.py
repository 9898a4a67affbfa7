"""A motion that a fluid damps more than anything else."""

import numpy as np
from scipy.integrate import odeint

from hystbench.gap.asked import Asked
from hystbench.gap.effects import effects
from hystbench.gap.effects.law import Moved
from hystbench.record import Channel, Record
from tests.gap.closing import closed_beside
from tests.gap.made import evidence_of
from tests.gap.searched import among

DT, COUNT, NOISE = 0.01, 700, 0.3
MASS, DAMPING, SPRING, DRAG = 0.5, 0.05, 20.0, 3.0
LIKELY = Asked(vocabulary=among("drag", "friction", "saturation"))


def accelerated(u):
    """Give the acceleration of a mass on a spring in water, by a general solver."""
    time = np.arange(COUNT) * DT

    def pull(t, q, v):
        drive = np.interp(t, time, u)
        return (drive - DAMPING * v - SPRING * q - DRAG * v * abs(v)) / MASS

    def slope(t, state):
        return [state[1], pull(t, *state)]

    about = {"tfirst": True, "hmax": DT, "rtol": 1e-8, "atol": 1e-9}
    q, v = odeint(slope, [0.0, 0.0], time, **about).T
    drive = u - DAMPING * v - SPRING * q
    return (drive - DRAG * v * np.abs(v)) / MASS


def sines(seed, size):
    rng, time = np.random.default_rng(seed), DT * np.arange(COUNT)
    lines = zip(rng.uniform(0.2, 4.0, 9), rng.uniform(0, 6, 9), strict=True)
    waves = (np.sin(2 * np.pi * f * time + p) for f, p in lines)
    return size * sum(waves) * np.clip(time, 0, 1)


def test_a_drag_that_is_most_of_the_damping_is_named_alone():
    rng = np.random.default_rng(5)
    given = []
    for k, (size, use) in enumerate([(20.0, "fit"), (60.0, "fit"), (40.0, "hold-out")]):
        u = sines(k, size)
        y = accelerated(u) + NOISE * rng.standard_normal(COUNT)
        about = Channel("force", "N"), Channel("acceleration", "m/s^2"), "twin", use
        given.append(Record(f"r{k}", DT, u, y, *about))
    told = "linear", NOISE, "force", "acceleration"
    evidence = evidence_of("diver", given, *told)
    content = closed_beside("linear", evidence, LIKELY)
    (found,) = content["effects"]
    assert found["name"] == "drag"
    # Beside a mass of one, as no record of force and acceleration tells more.
    assert content["gap"]["after"] < 1.3 * NOISE


def test_a_drag_begins_weak_and_as_what_limits_the_speed():
    moved = Moved(reach=0.1, speed=2.0, force=8.0)
    shares = [
        law.block.coefficient * 2.0**2 / 8.0
        for law in effects()["drag"].in_mechanism(moved)
    ]
    assert min(shares) < 0.1 < max(shares) < 1.0

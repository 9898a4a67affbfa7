"""Motions that are moved along with one near them: their differences are derivatives.

The independent value is a central difference of whole simulations.
"""

from dataclasses import replace

import numpy as np
import pytest

from hystbench.blocks import registry
from hystbench.blocks.attached import attached, near, through_near
from hystbench.blocks.drive_lag import DriveLag
from hystbench.blocks.force import Force
from hystbench.blocks.gain import Gain
from hystbench.blocks.gpi import GeneralizedPrandtlIshlinskii
from hystbench.blocks.impedance import Impedance
from hystbench.blocks.mechanism import Mechanism
from hystbench.blocks.other_modes import OtherModes
from hystbench.blocks.store import Store

DT = 0.017
MACHINE = Mechanism(mass=2.0, damping=1.5, stiffness=200.0, hold="linear", bias=3.0)
MOVED = Impedance(mass=0.02, damping=1.5, stiffness=2.0, bias=1.0, hold="band-limited")
LAWS = {
    "stiffness": {"quadratic": 50.0, "cubic": 300.0},
    "exponential-stiffness": {"coefficient": 80.0, "reach": 0.3},
    "saturating-stiffness": {"stiffness": 80.0, "reach": 0.3},
    "transverse-springs": {"stiffness": 80.0, "reach": 0.3},
    "stop": {"contact_stiffness": 300.0, "gap": 0.2, "centre": 0.05},
    "friction-force": {"coulomb": 20.0, "presliding_distance": 0.02},
    "smooth-friction": {
        "coulomb": 20.0,
        "velocity_scale": 0.3,
        "static_excess": 8.0,
        "stribeck_velocity": 0.9,
    },
    "drag": {"coefficient": 0.8},
    "velocity-limit": {"rate": 0.5, "damping": 20.0},
    "hysteretic-force": {"largest": 30.0, "yield_distance": 0.1, "sharing": 0.3},
    "bouc-wen-force": {"stiffness": 100.0, "beta": 3.0, "gamma": -1.0},
    "iwan-force": {"stiffness": 100.0, "slip_distance": 0.3, "exponent": -0.5},
    "lugre-force": {
        "coulomb": 20.0,
        "presliding_distance": 0.05,
        "static_excess": 8.0,
        "stribeck_velocity": 0.9,
    },
    "relaxation-force": {"stiffness": 50.0, "relaxation_time_s": 0.1},
    "attached-mass": {"mass": 0.5, "damping": 1.0, "stiffness": 60.0},
    "gravity": {"amplitude": 50.0, "angle": 0.5},
    "slider-with-gap": {"contact_stiffness": 300.0, "slip_force": 20.0, "gap": 0.1},
}

OTHER_FORMS = {"hysteretic-force": {"exponent": 2.0}}
"""Numbers that choose another formula, and are no derivative's."""
EVERY = [(law, {}) for law in LAWS] + list(OTHER_FORMS.items())


def test_every_force_is_among_them():
    forces = (name for name, block in registry().items() if issubclass(block, Force))
    assert set(forces) == set(LAWS)


def drive():
    t = DT * np.arange(400)
    return 120 * np.sin(9 * t) + 60 * np.sin(5.1 * t + 1)


def moved(chain, place, name, factor):
    chain = list(chain)
    value = getattr(chain[place], name)
    chain[place] = replace(chain[place], **{name: value * factor})
    return tuple(chain)


def outputs(chains, u):
    """Send an input through chains, of which it is one record."""
    return [y for (y,) in through_near(chains, (u,), (DT,))]


def alongside(step, u, others):
    """Simulate a step and others near on one record."""
    us = (u,)
    every = [(other, us if z is u else (z,)) for other, z in others]
    return [y for (y,) in near(step, us, us, (DT,), every)]


def check(chain, u, names, most=2e-4):
    """Compare the derivative with each number to that of whole simulations."""
    steps = attached(chain)
    (plain,) = outputs([steps], u)
    size = 1e-6
    chains = [moved(chain, *name, 1 + size) for name in names]
    first, *others = outputs([steps, *map(attached, chains)], u)
    assert np.array_equal(first, plain)
    for name, other in zip(names, others, strict=True):
        ends = [
            outputs([attached(moved(chain, *name, 1 + sign * size))], u)[0]
            for sign in (1, -1)
        ]
        expected = (ends[0] - ends[1]) / (2 * size)
        found = (other - first) / size
        assert np.linalg.norm(expected) > 0
        off = np.linalg.norm(found - expected) / np.linalg.norm(expected)
        # One step of Newton's method a step: at a corner it is off by a bit each time.
        assert off < most, (name, off)


@pytest.mark.parametrize("host", [MACHINE, MOVED], ids=["mechanism", "impedance"])
@pytest.mark.parametrize(("law", "form"), EVERY)
def test_differences_of_motions_near_are_derivatives(law, form, host):
    force = registry()[law].from_mapping(LAWS[law] | form)
    chain = (DriveLag(time_constant_s=0.05), host, force, Gain(value=2.0, offset=1.0))
    names = [(0, "time_constant_s"), (3, "value"), (3, "offset")]
    names += [(1, name) for name in ("mass", "damping", "stiffness", "bias")]
    names += [(2, name) for name in LAWS[law]]
    # A whole simulation takes the slope of its own force into its spring: what a step
    # misses changes with that.
    most = 2e-3 if law in ("gravity", "saturating-stiffness") else 2e-4
    check(chain, drive() / (1 if host is MACHINE else 300), names, most)


def test_so_are_those_of_two_forces_and_of_other_modes_beside():
    chain = (
        replace(MACHINE, hold="band-limited", start="settled"),
        registry()["stiffness"].from_mapping(LAWS["stiffness"]),
        registry()["friction-force"].from_mapping(LAWS["friction-force"]),
        OtherModes(numerator=(3.0,), denominator=(1.0, 2.0, 900.0)),
        OtherModes(numerator=(1.0,), denominator=(1.0, 2.0, 2500.0)),
    )
    names = [(0, "mass"), (0, "damping"), (0, "gain"), (1, "cubic"), (2, "coulomb")]
    check(chain, drive(), names)
    steps, size = attached(chain), 1e-6
    other = moved(chain, 0, "mass", 1 + size)
    slower = replace(chain[3], denominator=(1.0, 2.0, 900.0 * (1 + size)))
    both = [attached(x) for x in (other, (*chain[:3], slower, chain[4]))]
    first, mass, mode = outputs([steps, *both], drive())
    alone = attached((chain[0], slower))[0].simulate(drive(), drive(), DT)
    before = attached((chain[0], chain[3]))[0].simulate(drive(), drive(), DT)
    assert mode - first == pytest.approx(alone - before, abs=1e-12)
    assert np.abs(mass - first).max() > 0


@pytest.mark.parametrize("start", ["rest", "settled"])
def test_plays_near_are_as_each_alone_and_run_once_for_all_weights(start, monkeypatch):
    plays = GeneralizedPrandtlIshlinskii(
        envelope=(1.2, 0.4, 0.6, -0.6, 0.4, 1.1, 0.1, -0.1),
        thresholds=(0.0, 0.05, 0.1),
        weights=(2.0, -0.3, 0.7),
        start=start,
    )
    u = drive()
    heavier = replace(plays, weights=(2.0, -0.3, 0.9))
    wider = replace(plays, thresholds=(0.0, 0.06, 0.1))
    bent = replace(plays, envelope=(1.3, *plays.envelope[1:]))
    every = [(heavier, u), (bent, u), (wider, u), (heavier, 2 * u)]
    expected = [x.simulate(z, z, DT) for x, z in [(plays, u), *every]]
    runs = []
    alone = GeneralizedPrandtlIshlinskii.grow
    monkeypatch.setattr(
        GeneralizedPrandtlIshlinskii,
        "grow",
        lambda self, *given: runs.append(self) or alone(self, *given),
    )
    found = alongside(plays, u, every)
    assert runs == [bent, wider, heavier]
    for y, right in zip(found, expected, strict=True):
        assert y == pytest.approx(right, abs=1e-12)


def test_what_is_equal_is_simulated_once():
    class Counted:
        def __init__(self, size):
            self.size, self.runs = size, 0

        def __eq__(self, other):
            return self.size == other.size

        __hash__ = None

        def simulate(self, z, u, dt):
            self.runs += 1
            return self.size * z

    u = drive()
    one, same, other = Counted(2.0), Counted(2.0), Counted(3.0)
    y, again, larger = alongside(one, u, [(same, u), (other, u)])
    assert again is y
    assert np.array_equal(larger, 3 * u)
    assert (one.runs, same.runs, other.runs) == (1, 0, 1)
    y, further = alongside(one, u, [(same, 2 * u)])
    assert np.array_equal(further, 2 * y)


@pytest.mark.parametrize("hold", ["zero-order", "linear", "band-limited"])
@pytest.mark.parametrize(("exponent", "rim"), [(0.5, 0.4), (0.7, 0.45), (1.0, 0.55)])
def test_so_are_those_of_stores_that_overflow_and_run_empty(exponent, rim, hold):
    numbers = {"rate": 30.0, "exponent": exponent, "bias": 3.0, "hold": hold}
    upper = Store(gain=1.0, height=0.6, caught=0.4, output="outflow", **numbers)
    chain = (upper, Store(gain=0.6, height=rim, start_level=0.2, **numbers))
    names = [
        (place, name)
        for place in (0, 1)
        for name in ("gain", "rate", "exponent", "height", "bias")
    ]
    check(chain, np.repeat(drive()[:200:5], 5) / 5, [*names, (0, "caught")])


@pytest.mark.parametrize("hold", ["zero-order", "linear", "band-limited"])
@pytest.mark.parametrize("exponent", [0.5, 1.0])
def test_so_are_those_of_stores_that_run_over_a_weir(exponent, hold):
    numbers = {"rate": 30.0, "exponent": exponent, "bias": 3.0, "hold": hold}
    upper = Store(
        gain=1.0, height=0.6, weir=40.0, caught=0.4, output="outflow", **numbers
    )
    chain = (
        upper,
        Store(gain=0.6, height=0.35, weir=60.0, start_level=0.2, **numbers),
    )
    names = [
        (place, name)
        for place in (0, 1)
        for name in ("gain", "rate", "exponent", "height", "weir", "bias")
    ]
    check(chain, np.repeat(drive()[:200:5], 5) / 5, [*names, (0, "caught")])

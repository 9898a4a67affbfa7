"""A spring in series with a damper, inside a mechanism."""

from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest

from hystbench.blocks.impedance import Impedance
from hystbench.blocks.mechanism import Mechanism
from hystbench.blocks.relaxation_force import RelaxationForce
from hystbench.blocks.transfer_function import TransferFunction

BARE = Impedance(mass=0.0, damping=0.0, stiffness=0.0)
HOST = Mechanism(mass=2.0, damping=1.5, stiffness=200.0, hold="linear")
BRANCH = RelaxationForce(stiffness=150.0, relaxation_time_s=0.08)


def drive(t):
    return 120 * np.sin(9 * t) + 60 * np.sin(23 * t)


@pytest.mark.parametrize("time_s", [1e-9, 0.02, 0.3, 1e9])
def test_a_place_that_is_held_is_relaxed_from(time_s):
    """A ramp of 0.1 s to 2, then rest: the closed solution of Maxwell's equation."""
    dt, tau = 0.01, time_s
    t = np.arange(60) * dt
    q = 20.0 * np.minimum(t, 0.1)
    found = RelaxationForce(stiffness=3.0, relaxation_time_s=tau)
    force = found.attach(BARE).simulate(q, None, dt)
    top = 3.0 * 20.0 * tau * -np.expm1(-0.1 / tau)
    wanted = np.where(
        t <= 0.1,
        3.0 * 20.0 * tau * -np.expm1(-np.minimum(t, 0.1) / tau),
        top * np.exp(-np.maximum(t - 0.1, 0.0) / tau),
    )
    np.testing.assert_allclose(force, wanted, rtol=1e-9, atol=1e-12 * 60 * min(tau, 1))


@pytest.mark.parametrize("output", ["position", "velocity"])
def test_half_the_step_makes_a_quarter_of_the_error(output):
    """Against the exact transfer function of third order, along straight lines."""
    # The force of a motion: m s^2 + c s + k + stiffness time s / (1 + time s).
    slow = [BRANCH.relaxation_time_s, 1.0]
    spring = [BRANCH.stiffness * BRANCH.relaxation_time_s, 0.0]
    alone = [HOST.mass, HOST.damping, HOST.stiffness]
    down = np.polyadd(np.polymul(alone, slow), spring)
    exact = TransferFunction(
        numerator=tuple(slow if output == "position" else [*slow, 0.0]),
        denominator=tuple(down.tolist()),
        hold="linear",
    )
    coarse = np.linspace(0, 2, 26)
    errors = []
    for count in (800, 1600, 3200):
        t = np.linspace(0, 2, count + 1)
        z = np.interp(t, coarse, drive(coarse))
        wanted = exact.simulate(z, z, t[1])
        found = BRANCH.attach(replace(HOST, output=output)).simulate(z, None, t[1])
        errors.append(np.abs(found - wanted).max() / np.ptp(wanted))
    assert errors[-1] < 1e-4
    for before, after in pairwise(errors):
        assert 3.3 < before / after < 4.7


@pytest.mark.parametrize("time_s", [1e-4, 0.05, 10.0])
def test_a_free_motion_loses_energy_with_what_the_spring_holds(time_s):
    free = Mechanism(mass=2.0, damping=0.0, stiffness=200.0, start_position=1.0)
    branch = RelaxationForce(stiffness=150.0, relaxation_time_s=time_s)
    moved = free.motion(np.zeros(3000), 0.06, (branch,))
    energy = moved.velocity**2 + 100 * moved.position**2 + moved.force**2 / 300.0
    assert np.diff(energy).max() < 1e-9 * energy[0]
    assert energy[-1] < 0.9 * energy[0]


def test_it_is_stable_however_stiff_it_is():
    free = Mechanism(mass=2.0, damping=0.0, stiffness=200.0, start_position=1.0)
    branch = RelaxationForce(stiffness=1e12, relaxation_time_s=0.01)
    moved = free.motion(np.zeros(3000), 0.06, (branch,))
    energy = moved.velocity**2 + 100 * moved.position**2
    assert energy.max() <= energy[0] * (1 + 1e-9)


def test_a_settled_start_has_relaxed():
    host = Mechanism(mass=2.0, damping=1.5, stiffness=200.0, start="settled")
    y = BRANCH.attach(host).simulate(np.full(200, 100.0), None, 0.01)
    np.testing.assert_allclose(y, 0.5, rtol=1e-12)

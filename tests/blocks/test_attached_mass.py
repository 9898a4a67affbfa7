"""A second mass behind a spring and a damper, inside a mechanism."""

from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from hystbench.blocks.attached_mass import AttachedMass
from hystbench.blocks.mechanism import Mechanism
from hystbench.blocks.smooth_friction import SmoothFriction
from hystbench.blocks.transfer_function import TransferFunction

MOTOR = Mechanism(mass=0.01, damping=0.05, stiffness=0.0, output="velocity")
LOAD = AttachedMass(mass=0.03, damping=0.05, stiffness=60.0)


def torque(t):
    return np.sin(2 * np.pi * 3 * t) + 0.8 * np.sin(2 * np.pi * 11 * t)


def test_half_the_step_makes_a_quarter_of_the_error():
    """Against the exact transfer function of two masses, along straight lines."""
    across, load = [LOAD.damping, LOAD.stiffness], [LOAD.mass, 0.0]
    below = np.polyadd([LOAD.mass, 0.0, 0.0], across)
    above = np.polyadd(
        np.polymul([MOTOR.mass, MOTOR.damping], below),
        np.polymul(load, across),
    )
    exact = TransferFunction(
        numerator=tuple(below.tolist()),
        denominator=tuple(above.tolist()),
        hold="linear",
    )
    coarse, errors = np.linspace(0, 2, 101), []
    for count in (4000, 8000, 16000):
        t = np.linspace(0, 2, count + 1)
        z = np.interp(t, coarse, torque(coarse))
        wanted = exact.simulate(z, z, t[1])
        host = replace(MOTOR, hold="linear")
        found = LOAD.attach(host).simulate(z, z, t[1])
        errors.append(np.abs(found - wanted).max() / np.ptp(wanted))
    assert errors[-1] < 1e-3
    for before, after in pairwise(errors):
        assert 3.3 < before / after < 4.7


def test_friction_at_the_motor_follows_a_fine_solution():
    friction = SmoothFriction(coulomb=0.3, velocity_scale=0.5)

    def moves(t, x):
        v, w, lag = x
        shaft = LOAD.stiffness * lag + LOAD.damping * (v - w)
        held = 0.3 * np.tanh(v / 0.5)
        motor = (torque(t) - shaft - MOTOR.damping * v - held) / MOTOR.mass
        return [motor, shaft / LOAD.mass, v - w]

    errors = []
    for count in (4000, 8000):
        t = np.linspace(0, 2, count + 1)
        host = replace(MOTOR, hold="linear")
        found = friction.attach(LOAD.attach(host)).simulate(torque(t), None, t[1])
        fine = solve_ivp(moves, (0, 2), [0.0] * 3, "LSODA", t, rtol=1e-9, atol=1e-11)
        errors.append(np.abs(found - fine.y[0]).max() / np.ptp(fine.y[0]))
    assert errors[-1] < 3e-3
    assert 3.0 < errors[0] / errors[1] < 5.0


@pytest.mark.parametrize("stiffness", [0.0, 60.0, 1e12])
@pytest.mark.parametrize("damping", [0.0, 0.05, 1e6])
def test_a_free_motion_never_gains_energy(stiffness, damping):
    """The momentum that the motor loses is the load's, and so is the energy."""
    free = replace(MOTOR, damping=0.0, start_velocity=5.0)
    load = replace(LOAD, stiffness=stiffness, damping=damping)
    dt = 0.002
    moved = free.motion(np.zeros(2000), dt, (load,))
    v = moved.velocity
    carried = MOTOR.mass * (5.0 - v) / LOAD.mass
    energy = MOTOR.mass * v**2 + LOAD.mass * carried**2
    assert energy.max() <= MOTOR.mass * 25.0 * (1 + 1e-9)


def test_where_it_is_settled_it_rests_beside_the_coordinate():
    host = replace(MOTOR, stiffness=20.0, output="position", start="settled")
    y = LOAD.attach(host).simulate(np.full(200, 3.0), None, 0.01)
    np.testing.assert_allclose(y, 0.15, rtol=1e-12)

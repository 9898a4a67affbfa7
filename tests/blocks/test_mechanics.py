"""Blocks of material and mechanics against integrators and closed forms."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.integrate import solve_ivp

from hystbench.blocks.backlash import Backlash
from hystbench.blocks.friction import Friction
from hystbench.blocks.resonance import Resonance
from hystbench.blocks.saturation import Saturation
from hystbench.blocks.stiffness_hardening import StiffnessHardening
from hystbench.blocks.thermal_drift import ThermalDrift

DT = 1e-3
MODE = StiffnessHardening(
    coefficient=0.4, frequency_hz=65.0, damping_ratio=0.03, participation=0.3
)


def drive(t):
    return 1.3 * np.sin(2 * np.pi * 40 * t) + 0.5 * np.sin(2 * np.pi * 90 * t)


def solved(block, n, given_input):
    """Integrate the mode by an integrator that controls its error."""
    wn = 2 * np.pi * block.frequency_hz

    def motion(t, state):
        x, speed = state
        spring = x + block.coefficient * x**3
        damper = 2 * block.damping_ratio * wn * speed
        return [speed, wn**2 * (given_input(t) - spring) - damper]

    t = np.arange(n) * DT
    found = solve_ivp(
        motion, (0, t[-1]), [0, 0], t_eval=t, rtol=1e-10, atol=1e-12, max_step=DT / 2
    )
    share = block.participation
    return (1 - share) * given_input(t) + share * found.y[0]


@pytest.mark.parametrize(
    "change",
    [
        {},
        {"coefficient": -0.005},
        {"coefficient": 5.0},
        {"frequency_hz": 400.0},
        {"damping_ratio": 3.0},
        {"participation": -0.5, "frequency_hz": 20.0},
    ],
)
def test_hardening_is_the_solution_for_straight_lines(change):
    block = replace(MODE, **change)
    t = np.arange(60) * DT
    z = drive(t)
    expected = solved(block, 60, lambda at: np.interp(at, t, z))
    found = block.simulate(z, z, DT)
    np.testing.assert_allclose(found, expected, rtol=0, atol=2e-5 * np.ptp(expected))


def test_hardening_of_a_band_limited_input():
    # Against the smooth input itself, 11 samples a period: straight lines alone are
    # more than ten times further off.
    t = np.arange(200) * DT
    expected = solved(MODE, 200, drive)
    scale = np.ptp(expected)
    errors = {
        hold: np.abs(replace(MODE, hold=hold).simulate(drive(t), t, DT) - expected)
        for hold in ("linear", "band-limited")
    }
    middle = slice(0, 180)  # the record's end is not the sines' end
    assert errors["band-limited"][middle].max() < 3e-3 * scale
    assert errors["linear"][middle].max() > 10 * errors["band-limited"][middle].max()


@pytest.mark.parametrize(
    ("hold", "error"), [("zero-order", 1e-6), ("linear", 1e-6), ("band-limited", 2e-3)]
)
def test_without_hardening_it_is_the_resonance(hold, error):
    z = drive(np.arange(800) * DT)
    linear = Resonance(
        frequency_hz=65.0, damping_ratio=0.03, participation=0.3, hold=hold
    )
    found = replace(MODE, coefficient=0.0, hold=hold).simulate(z, z, DT)
    expected = linear.simulate(z, z, DT)
    np.testing.assert_allclose(found, expected, rtol=0, atol=error * np.ptp(expected))


def test_a_hardened_spring_settles_where_its_force_balances():
    # x + 0.4 x^3 = 3.2 at x = 2 by hand would need 0.15: 2 + 0.15 * 8 = 3.2.
    block = replace(MODE, coefficient=0.15, damping_ratio=1.0, participation=1.0)
    z = np.full(400, 3.2)
    assert block.simulate(z, z, DT)[-1] == pytest.approx(2.0, rel=1e-9)


def test_a_mode_that_runs_away_has_no_output_from_there_on():
    # x - 0.4 x^3 is never 3: the softened spring cannot hold the load.
    z = np.full(400, 3.0)
    y = replace(MODE, coefficient=-0.4).simulate(z, z, DT)
    first = int(np.argmax(np.isnan(y)))
    assert 0 < first < 100
    assert np.isfinite(y[:first]).all()
    assert np.isnan(y[first:]).all()


def test_a_sharp_limit_of_a_huge_signal_is_its_level():
    block = Saturation(level=0.5, sharpness=20.0)
    z = np.array([-1e200, -0.5, 0.0, 0.5, 1e200])
    at_the_level = 0.5 / 2 ** (1 / 20)
    wanted = [-0.5, -at_the_level, 0.0, at_the_level, 0.5]
    np.testing.assert_allclose(block.simulate(z, z, 1e-3), wanted, rtol=1e-12)


def test_saturation_by_hand():
    z = np.array([-100.0, 0.0, 1e-6, 2.0 * np.arctanh(0.5)])
    y = Saturation(level=2.0).simulate(z, z, DT)
    np.testing.assert_allclose(y, [-2.0, 0.0, 1e-6, 1.0], rtol=1e-12)


def test_friction_by_hand():
    # A ramp of 3 a second at a scale of 3 / artanh(1/2): half of the friction.
    u = 3.0 * DT * np.arange(20)
    block = Friction(coulomb=4.0, velocity_scale=3.0 / np.arctanh(0.5))
    np.testing.assert_allclose(block.simulate(10 * u, u, DT), 10 * u + 2.0, rtol=1e-12)
    np.testing.assert_allclose(
        block.simulate(10 * u, -u, DT), 10 * u - 2.0, rtol=1e-12, atol=1e-12
    )


joints = st.lists(st.floats(-5, 5), min_size=1, max_size=60).map(np.array)


@given(joints, st.floats(0, 3))
def test_backlash_stays_in_its_gap_and_moves_only_at_its_edges(z, half_width):
    y = Backlash(half_width=half_width).simulate(z, z, DT)
    assert y[0] == z[0]
    assert (np.abs(y - z) <= half_width + 1e-12).all()
    for k in np.flatnonzero(np.diff(y)):
        # It was pushed: by the far edge, the way it went.
        way = np.sign(y[k + 1] - y[k])
        assert (z[k + 1] - y[k + 1]) * way == pytest.approx(half_width, abs=1e-12)


def test_backlash_by_hand():
    z = np.array([1.0, 2.0, 1.5, 0.5, -1.0])
    y = Backlash(half_width=0.5).simulate(z, z, DT)
    np.testing.assert_array_equal(y, [1.0, 1.5, 1.5, 1.0, -0.5])


def test_thermal_drift_warms_up_by_its_time_constant():
    t = np.arange(3000) * DT
    y = ThermalDrift(coefficient=0.3, time_constant_s=0.7).simulate(
        t, np.full(len(t), -2.0), DT
    )
    expected = t + 0.3 * 4.0 * (1 - np.exp(-t / 0.7))
    np.testing.assert_allclose(y, expected, rtol=0, atol=1e-12)


def test_of_two_bodies_the_second_is_warmed_by_the_first():
    t = np.arange(3000) * DT
    first, second = 0.7, 0.2
    block = ThermalDrift(
        coefficient=0.3, time_constant_s=first, second_time_constant_s=second
    )
    y = block.simulate(t, np.full(len(t), -2.0), DT)
    # 1 / ((1 + s first) (1 + s second)) answers a step by partial fractions.
    decays = first * np.exp(-t / first) - second * np.exp(-t / second)
    expected = t + 0.3 * 4.0 * (1 - decays / (first - second))
    # Straight lines between the samples of the first body's warmth: (dt / tau)^2.
    np.testing.assert_allclose(y, expected, rtol=0, atol=1e-5)

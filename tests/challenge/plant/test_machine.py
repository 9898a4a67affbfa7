"""Machines against closed forms of textbooks."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from hystbench.challenge.plant import around_machine
from hystbench.challenge.plant.kind import Reach
from hystbench.challenge.plant.machine import (
    FINE,
    MovingPart,
    Tank,
    decimated,
    fill,
    move,
    resist,
)

DT = 1e-4


def free_decay(part, seconds, q=1.0, dt=DT):
    return move(part, np.zeros(round(seconds / dt)), dt, (q, 0.0)).position


def turns(q):
    """Where the motion turns, the first sample among them."""
    moving = np.flatnonzero(np.diff(q))
    way = np.sign(np.diff(q)[moving])
    return q[np.concatenate([[0], moving[1:][way[1:] != way[:-1]]])]


@pytest.mark.parametrize("frequency", [2.0, 9.0, 10.5, 30.0])
def test_a_linear_part_has_the_frequency_response_of_its_equation(frequency):
    m, c, k = 2.0, 8.0, 2.0 * (2 * np.pi * 10) ** 2
    time = np.arange(0, 12.0, DT)
    w = 2 * np.pi * frequency
    motion = move(MovingPart(m, c, k), np.sin(w * time), DT)
    late = time >= 10.0  # transients have died out by exp(-2 * 10)
    design = np.exp(1j * w * time[late])
    exact = 1 / (k - m * w**2 + 1j * c * w)
    for signal, factor in (
        (motion.position, 1.0),
        (motion.velocity, 1j * w),
        (motion.acceleration, -(w**2)),
    ):
        # of A sin(w t + phi) the mean of signal times exp(-j w t) is A e^{j phi} / 2j
        found = 2j * np.mean(signal[late] * design.conj())
        assert found == pytest.approx(exact * factor, rel=2e-3)


def test_coulomb_friction_takes_four_times_its_force_over_stiffness_a_cycle():
    part = MovingPart(1.0, 0.0, 400.0, coulomb=8.0)  # 4 F / k = 0.08 a cycle
    found = turns(free_decay(part, 4.0, q=1.0))
    expected = [(-1) ** i * (1.0 - 0.04 * i) for i in range(20)]
    assert found[:20] == pytest.approx(expected, abs=2e-4)


def test_a_part_that_friction_holds_stands_still():
    part = MovingPart(1.0, 0.0, 400.0, coulomb=8.0)
    q = free_decay(part, 2.0, q=0.019)  # the spring pulls with 7.6
    assert (q == q[0]).all()


def test_stribeck_holds_with_the_static_force_and_slides_with_less():
    # 400 q is between the sliding force 4 and the static one 8
    part = MovingPart(1.0, 0.0, 400.0, coulomb=4.0, surplus=4.0, stribeck_speed=1e-3)
    held = free_decay(part, 0.1, q=0.0199)
    assert (held == held[0]).all()
    # begun beyond, it slides as if the friction were 4: to 2 * 4 / 400 - q
    slid = turns(free_decay(part, 0.3, q=0.1))[1]
    assert slid == pytest.approx(2 * 4.0 / 400 - 0.1, abs=5e-4)


def test_presliding_is_a_spring_until_it_slips():
    part = MovingPart(1.0, 40.0, 0.0, coulomb=5.0, presliding=0.01)
    ends = [
        move(part, np.full(60000, force), DT).position[-1] for force in (2.0, 4.0, 6.0)
    ]
    assert ends[0] == pytest.approx(2.0 / 500.0, rel=1e-6)
    assert ends[1] == pytest.approx(4.0 / 500.0, rel=1e-6)
    # behind the slip 1 newton is left for the damper: 1/40 a second
    assert ends[2] == pytest.approx(6.0 / 40.0, rel=0.1)


@pytest.mark.parametrize(
    ("more", "stored"),
    [
        ({"cubic": 300.0}, lambda q: 300.0 * q**4 / 4),
        ({"quadratic": 90.0}, lambda q: 90.0 * q**3 / 3),
        (
            {"sinh_force": 30.0, "sinh_reach": 0.4},
            lambda q: 30.0 * (0.4 * (np.cosh(q / 0.4) - 1) - q**2 / 0.8),
        ),
        (
            {"wall_right": 0.3, "wall_left": 0.2, "wall_stiffness": 3000.0},
            lambda q: 1500.0 * (max(q - 0.3, 0) ** 2 + max(-0.2 - q, 0) ** 2),
        ),
        (
            {"pendulum": 150.0, "angle": 0.0},
            lambda q: 150.0 * (1 - np.cos(q) - q**2 / 2),
        ),
    ],
)
def test_a_spring_of_any_law_keeps_its_energy(more, stored):
    part = MovingPart(1.0, 0.0, 400.0, **more)
    q = move(part, np.zeros(20000), DT, (0.0, 10.0)).position
    for end in (q.max(), q.min()):
        assert 200.0 * end**2 + stored(end) == pytest.approx(50.0, rel=1e-3)


def test_a_pendulum_swings_with_the_period_of_its_elliptic_integral():
    # Released from rest at 2 rad: a period of 4 K(sin 1) / w.
    from scipy.special import ellipk

    part = MovingPart(1.0, 0.0, 100.0, pendulum=100.0)
    q = free_decay(part, 3.0, q=2.0)
    crossings = np.flatnonzero((q[1:] < 0) & (q[:-1] >= 0))
    period = np.mean(np.diff(crossings)) * DT
    assert period == pytest.approx(4 * ellipk(np.sin(1.0) ** 2) / 10.0, rel=1e-3)


def test_drag_brakes_a_free_mass_by_one_over_time():
    v = move(MovingPart(2.0, drag=3.0), np.zeros(20000), DT, (0.0, 5.0)).velocity
    time = np.arange(20000) * DT
    assert v == pytest.approx(5.0 / (1 + 3.0 / 2.0 * 5.0 * time), rel=3e-4)


@given(st.floats(0.3, 8.0))
@settings(max_examples=20, deadline=None)
def test_bouc_wen_takes_the_energy_of_its_exponentials(reach):
    # Of sharpness 1 and slope 1 on the way back both branches are exponentials,
    # z = 1 - (1 + z1) exp(-(x + X) / y), z1 = tanh(X / y), so that a closed loop
    # takes 4 F (X - y tanh(X / y)).
    part = MovingPart(0.0, remembered=3.0, yield_distance=0.5)
    x = reach * np.sin(2 * np.pi * np.arange(0, 4, 1e-5))
    force = resist(part, x, 1e-5)
    last = slice(-100001, None)
    found = np.trapezoid(force[last], x[last])
    expected = 4 * 3.0 * (reach - 0.5 * np.tanh(reach / 0.5))
    assert found == pytest.approx(expected, rel=1e-3)


def test_a_slider_behind_a_clearance_takes_the_area_of_its_loop():
    # After a turn the spring unloads over slip - clearance, nothing over twice the
    # clearance, and loads again: a loop of K (slip - clearance) to either side.
    part = MovingPart(0.0, slider_stiffness=10.0, slip=0.3, clearance=0.1)
    x = np.sin(2 * np.pi * np.arange(0, 4, 1e-5))
    force = resist(part, x, 1e-5)
    assert np.max(force) == pytest.approx(2.0, rel=1e-6)
    # rectangle of 2 * 2 by the way 2, less both corners that are passed by
    area = 2 * (2.0 * (2.0 - 0.4 - 0.2) + 2.0 * 0.2 / 2 - 2.0 * 0.2 / 2)
    last = slice(-100001, None)
    assert np.trapezoid(force[last], x[last]) == pytest.approx(area, rel=1e-3)


@given(
    st.sampled_from(
        [
            {"coulomb": 0.4},
            {"coulomb": 0.4, "presliding": 0.02},
            {"coulomb": 0.2, "surplus": 0.3, "stribeck_speed": 0.1},
            {"remembered": 0.5, "yield_distance": 0.1, "sharpness": 1.7},
            {"slider_stiffness": 5.0, "slip": 0.1, "clearance": 0.03},
            {"drag": 0.3},
        ]
    ),
    st.integers(0, 1000),
)
@settings(max_examples=30, deadline=None)
def test_forces_only_take_energy_out(more, seed):
    force = np.cumsum(np.random.default_rng(seed).standard_normal(20000)) * 0.02
    part = MovingPart(1.0, 0.05, 20.0, **more)
    m = move(part, force, DT)
    given_in = np.cumsum(m.force * m.velocity) * DT
    held = 0.5 * m.velocity**2 + 10.0 * m.position**2
    assert (held <= given_in + 1e-3 * (1 + np.max(held))).all()


def test_a_controlled_mass_follows_its_reference_as_its_transfer_function_says():
    part, kp, kd = MovingPart(2.0, 1.0), 800.0, 60.0
    time = np.arange(0, 6.0, DT)
    w = 2 * np.pi * 1.5
    m = move(part, np.sin(w * time), DT, gains=(kp, kd))
    late = time >= 4.0
    s = 1j * w
    exact = (kp + kd * s) / (2 * s**2 + (1 + kd) * s + kp)
    found = 2j * np.mean(m.position[late] * np.exp(-s * time[late]))
    assert found == pytest.approx(exact, rel=2e-3)
    left = m.force - 2 * m.acceleration - m.velocity
    assert np.max(np.abs(left[1:-1])) < 1e-6 * np.max(np.abs(m.force))


def test_an_impedance_answers_as_its_equation():
    part = MovingPart(0.5, 2.0, 30.0, coulomb=1.5)
    time = np.arange(0, 1.0, DT)
    w = 2 * np.pi * 3.0
    force = resist(part, np.sin(w * time), DT)
    v = w * np.cos(w * time)
    exact = (30.0 - 0.5 * w**2) * np.sin(w * time) + 2.0 * v + 1.5 * np.sign(v)
    inner = (np.abs(v) > 0.05 * w) & (time > DT) & (time < 1 - 2 * DT)
    assert force[inner] == pytest.approx(exact[inner], abs=2e-3)


def test_a_tank_empties_by_torricelli():
    tank = Tank(area=2.0, coefficient=0.7, exponent=0.5)
    level = fill((tank,), np.zeros(80000), DT, (1.5,))
    time = np.arange(80000) * DT
    exact = np.maximum(np.sqrt(1.5) - 0.7 * time / 4.0, 0.0) ** 2
    assert level == pytest.approx(exact, abs=1e-6)


def test_tanks_in_a_row_of_linear_outflow_are_lags_in_a_row():
    tanks = (Tank(2.0, 1.0), Tank(0.5, 1.0))
    time = np.arange(0, 5.0, DT)
    level = fill(tanks, np.ones_like(time), DT, (0.0, 0.0))
    exact = 1 - (2.0 * np.exp(-time / 2.0) - 0.5 * np.exp(-time / 0.5)) / 1.5
    assert level == pytest.approx(exact, abs=1e-8)


def test_what_runs_over_the_rim_is_lost_or_caught():
    """All water: what came in is what stands, flowed out, and was spilt."""
    flow = np.full(50000, 3.0)
    alone = fill((Tank(1.0, 0.5, rim=2.0),), flow, DT, (0.0,))
    assert np.max(alone) == 2.0
    # The second holds what it gets: out of the first flows at most 0.5 * 2, and of
    # 3 - 1 that run over a half is caught.
    caught = fill(
        (Tank(1.0, 0.5, rim=2.0, caught=0.5), Tank(1.0, 0.0)), flow, DT, (2.0, 0.0)
    )
    time = np.arange(50000) * DT
    assert caught == pytest.approx((1.0 + 0.5 * 2.0) * time, abs=2e-4)


def test_decimation_keeps_what_lies_below_half_the_rate():
    fine = np.arange(32 * 400)
    slow = np.sin(2 * np.pi * fine / 32 / 10.0) * np.hanning(len(fine))
    fast = np.sin(2 * np.pi * fine / 32 * 0.8) * np.hanning(len(fine))
    assert decimated(slow) == pytest.approx(slow[::32], abs=1e-3)
    assert np.max(np.abs(decimated(fast))) < 1e-2


def test_a_coil_off_its_magnet_rests_where_its_lesser_force_meets_the_spring():
    part = MovingPart(1.0, 40.0, 400.0, coil_width=0.5, coil_shift=0.1)
    q = move(part, np.full(20000, 300.0), DT).position[-1]
    assert q < 0.6  # 0.75 with the same force everywhere
    assert 400.0 * q == pytest.approx(300.0 / (1 + ((q - 0.1) / 0.5) ** 2), rel=1e-6)


def test_a_stiffness_that_swings_twice_a_period_drives_the_mass():
    # Mathieu: with k (1 + e sin 2 w t) the motion grows by e w / 4 a second.
    w, e = 2 * np.pi * 10, 0.1
    part = MovingPart(1.0, 0.0, w**2, ripple=e, ripple_rate=2 * w, ripple_phase=0.0)
    q = free_decay(part, 4.0)
    early, late = (np.max(np.abs(q[round(t / DT) :][:1000])) for t in (2.0, 3.5))
    assert np.log(late / early) / 1.5 == pytest.approx(e * w / 4, rel=0.02)
    x = np.sin(np.arange(0, 1, DT))
    expected = w**2 * x * (1 + e * np.sin(2 * w * np.arange(0, 1, DT)))
    massless = MovingPart(0.0, 0.0, w**2, ripple=e, ripple_rate=2 * w)
    assert resist(massless, x, DT) == pytest.approx(expected, rel=1e-9)


def test_a_clearance_wears_with_the_way():
    part = MovingPart(0.0, loose_stiffness=10.0, loose=0.1, wear=0.02)
    force = resist(part, np.sin(2 * np.pi * np.arange(0, 4, DT)), DT)
    peaks = force.reshape(4, -1).max(axis=1)
    # at the n-th peak the part has gone 1 + 4 n
    expected = [10.0 * (1 - 0.1 - 0.02 * (1 + 4 * n)) for n in range(4)]
    assert peaks == pytest.approx(expected, rel=1e-3)


def test_coupled_tanks_fill_as_their_linear_equations():
    from scipy.linalg import expm

    tanks = (Tank(2.0, 1.0, back=1.0), Tank(2.0, 1.0, back=1.0))
    level = fill(tanks, np.full(40001, 3.0), 1e-3, (0.0, 0.0))
    flows = np.array([[-1.0, 1.0], [1.0, -2.0]]) / 2.0
    rest = np.array([6.0, 3.0])  # 3 through each outlet
    for seconds in (0.5, 2.0, 10.0):
        expected = rest - expm(flows * seconds) @ rest
        assert level[round(seconds * 1e3)] == pytest.approx(expected[1], rel=1e-6)


def test_a_seal_leaks_by_the_level_and_by_how_long_it_was_wet():
    inflow = np.full(40001, 2.0)
    # c h + leak c h^2 = inflow, once the seal is as wet as the level
    wet = fill((Tank(1.0, 1.0, leak=0.5, leak_time=0.5),), inflow, 1e-3, (0.0,))
    assert wet[-1] == pytest.approx((np.sqrt(1 + 4 * 0.5 * 2.0) - 1) / (2 * 0.5))
    dry = fill((Tank(1.0, 1.0, leak=0.5, leak_time=1e9),), inflow, 1e-3, (0.0,))
    assert dry[-1] == pytest.approx(2.0, rel=1e-5)


REACH = Reach(position=1.0, velocity=1.0, force=2.0, output=2.0, stiffness=1.0)


def test_a_flood_wave_runs_ahead_of_the_water_that_is_left():
    n, late = 100 * FINE, math.ceil(20.0 * (0.5**-0.4 - 1.0) * FINE)
    risen = np.where(np.arange(2 * n) < n, 1.0, 2.0)
    # the largest flow comes at once, and overtakes
    rise = around_machine.flood_wave(risen, {"delay": 20.0}, REACH)
    assert (rise[late : n - 1] == 1.0).all()
    assert (rise[n + late :] == 2.0).all()
    fall = around_machine.flood_wave(3.0 - risen, {"delay": 20.0}, REACH)
    # half of the flow follows by its own delay, and what lies between comes between
    assert fall[n - 1] == 2.0
    assert fall[round(n + late / 2)] == pytest.approx(1.5, abs=0.01)
    assert fall[n + late :] == pytest.approx(1.0)


def test_a_strained_sensor_reads_another_value_on_the_way_back():
    y = 2.0 * np.sin(2 * np.pi * np.arange(0, 3, DT))
    told = around_machine.strained(y, {"weight": 0.3, "half_width": 0.2}, REACH)
    beside = (told - y)[-10000:]
    # the square over the largest output runs ahead of its play by the half width
    assert np.max(beside) == pytest.approx(0.3 * 2.0 * 0.2)
    assert np.min(beside) == pytest.approx(-0.3 * 2.0 * 0.2)

"""Each piece of the plant's physics against what a textbook says of it."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.special import iv

from hystbench.challenge.plant import drive, material, mechanics, sensor, unlisted
from hystbench.challenge.plant.kind import PlantRun

DT = 1.0 / 16000.0
TIME = np.arange(16000) * DT


def run(u=None, time=TIME, dt=DT, seed=0):
    u = np.zeros_like(time) if u is None else u
    return PlantRun(time, u, dt, np.random.default_rng(seed))


def response(act, parameters, frequency):
    """Complex gain at a frequency, over the second half of a second."""
    y = act(np.sin(2 * np.pi * frequency * TIME), run(), parameters)
    late = TIME >= 0.5
    angle = 2 * np.pi * frequency * TIME[late]
    design = np.stack([np.sin(angle), np.cos(angle)], axis=1)
    real, imaginary = np.linalg.lstsq(design, y[late])[0]
    return real + 1j * imaginary


FREQUENCIES = [2.0, 40.0, 200.0, 500.0]


@pytest.mark.parametrize("frequency", FREQUENCIES)
@pytest.mark.parametrize("tau", [6e-4, 6e-3])
def test_diffusion_into_a_slab(frequency, tau):
    q = np.sqrt(2j * np.pi * frequency * tau)
    found = response(drive.slab, {"time_constant_s": tau}, frequency)
    assert found == pytest.approx(np.tanh(q) / q, abs=2e-3)


@pytest.mark.parametrize("frequency", FREQUENCIES)
@pytest.mark.parametrize("tau", [6e-4, 6e-3])
def test_diffusion_into_a_rod(frequency, tau):
    q = np.sqrt(2j * np.pi * frequency * tau)
    expected = 2 * iv(1, q) / (q * iv(0, q))
    found = response(drive.rod, {"time_constant_s": tau}, frequency)
    assert found == pytest.approx(expected, abs=2e-3)


@pytest.mark.parametrize("frequency", FREQUENCIES)
def test_a_lag_of_half_order(frequency):
    found = response(drive.square_root, {"time_constant_s": 6e-4}, frequency)
    s = 2j * np.pi * frequency
    assert found == pytest.approx((1.0 + s * 6e-4) ** -0.5, rel=0.01)


@pytest.mark.parametrize("frequency", FREQUENCIES)
def test_lag(frequency):
    tau = 8e-4
    found = response(drive.lag, {"time_constant_s": tau}, frequency)
    assert found == pytest.approx(1 / (1 + 2j * np.pi * frequency * tau), abs=1e-4)


@pytest.mark.parametrize("frequency", FREQUENCIES)
def test_mode(frequency):
    p = {"frequency_hz": 150.0, "damping_ratio": 0.03, "participation": 0.2}
    wn, s = 2 * np.pi * 150.0, 2j * np.pi * frequency
    expected = 0.8 + 0.2 * wn**2 / (s**2 + 2 * 0.03 * wn * s + wn**2)
    assert response(mechanics.mode, p, frequency) == pytest.approx(expected, abs=1e-3)


def test_a_step_rings_at_the_damped_frequency_and_dies_with_the_damping():
    zeta, omega = 0.05, 2 * np.pi * 120.0
    x = mechanics.oscillate(np.ones_like(TIME), DT, 120.0, zeta, 0.0)
    damped = omega * np.sqrt(1 - zeta**2)
    swing = np.cos(damped * TIME) + zeta / np.sqrt(1 - zeta**2) * np.sin(damped * TIME)
    assert x == pytest.approx(1 - np.exp(-zeta * omega * TIME) * swing, abs=1e-4)


@given(st.floats(1e-4, 3e-3), st.floats(2.0, 20.0))
def test_a_hardening_spring_keeps_its_energy_without_damping(alpha, force):
    # From rest under a constant force: at the farthest point x, the spring holds
    # what the force gave, x^2 / 2 + alpha x^4 / 4 = force x.
    path = mechanics.oscillate(np.full(4000, force), DT, 100.0, 0.0, alpha)
    k = 1 + int(path[1:-1].argmax())
    # Between samples, at the top of a parabola through the three highest.
    low, top, high = path[k - 1 : k + 2]
    x = top + (high - low) ** 2 / (8 * (2 * top - low - high))
    assert x**2 / 2 + alpha * x**4 / 4 == pytest.approx(force * x, rel=2e-4)


def test_a_hardening_spring_comes_to_rest_where_it_holds_the_force():
    x = mechanics.oscillate(np.full_like(TIME, 15.0), DT, 100.0, 0.2, 1e-3)[-1]
    assert x + 1e-3 * x**3 == pytest.approx(15.0, rel=1e-6)


def test_kelvin_voigt_elements_creep_by_their_exponentials():
    p = {"magnitude": 0.09, "time_constant_s": 0.05, "ratio": 4.0}
    expected = 1 + sum(0.03 * (1 - np.exp(-TIME / tau)) for tau in (0.05, 0.2, 0.8))
    assert mechanics.creep(np.ones_like(TIME), run(), p) == pytest.approx(expected)
    single = {"magnitude": 0.1, "time_constant_s": 0.3}
    expected = 1 + 0.1 * (1 - np.exp(-TIME / 0.3))
    assert mechanics.creep(np.ones_like(TIME), run(), single) == pytest.approx(expected)


def test_a_constant_current_heats_with_its_square():
    p = {"coefficient": 10.0, "time_constant_s": 0.4}
    y = mechanics.heat(np.zeros_like(TIME), run(np.full_like(TIME, -0.5)), p)
    assert y == pytest.approx(10 * 0.25 * (1 - np.exp(-TIME / 0.4)))


def test_friction_is_coulomb_far_from_rest_and_odd_in_the_speed():
    u = np.sin(2 * np.pi * 3 * TIME)
    fast = np.abs(np.cos(2 * np.pi * 3 * TIME)) > 0.2
    p = {"coulomb": 0.7, "velocity_scale": 0.1}
    for act in (mechanics.coulomb, mechanics.coulomb_algebraic):
        y = act(np.zeros_like(u), run(u), p)
        expected = 0.7 * np.sign(np.cos(2 * np.pi * 3 * TIME))
        assert y[fast] == pytest.approx(expected[fast], abs=2e-3)
        assert act(np.zeros_like(u), run(-u), p) == pytest.approx(-y)


signals = st.lists(st.floats(-5.0, 5.0), min_size=2, max_size=60).map(np.array)


@given(signals, st.floats(0.0, 3.0))
def test_a_joint_moves_only_when_its_flank_is_touched(x, half_width):
    y = mechanics.joint(x, run(), {"half_width": half_width})
    assert (np.abs(x - y) <= half_width + 1e-12).all()
    moved = np.flatnonzero(np.diff(y) != 0) + 1
    assert np.abs(x - y)[moved] == pytest.approx(half_width, abs=1e-12)


@given(signals, st.floats(0.1, 20.0))
def test_the_amplifier_never_slews_faster_and_catches_up(x, rate):
    held = np.concatenate([x, np.full(2000, x[-1])])
    y = drive.slew(held, run(dt=0.1), {"rate": rate})
    assert (np.abs(np.diff(y)) <= rate * 0.1 + 1e-12).all()
    assert y[-1] == pytest.approx(x[-1])
    assert drive.slew(x, run(dt=1e6), {"rate": rate}) == pytest.approx(x)


@given(signals, st.floats(0.0, 2.0))
def test_a_dead_zone_is_silent_inside_and_shifted_outside(x, half_width):
    y = drive.dead_zone(x, run(), {"half_width": half_width})
    assert (y[np.abs(x) <= half_width] == 0).all()
    out = np.abs(x) > half_width
    assert y[out] == pytest.approx((x - np.sign(x) * half_width)[out])


@pytest.mark.parametrize(
    ("act", "more"),
    [(material.hyperbolic, {}), (material.algebraic, {"sharpness": 2.5})],
)
def test_saturation_is_odd_soft_and_bounded(act, more):
    p = {"level": 20.0, **more}
    z = np.linspace(-200, 200, 4001)
    y = act(z, run(), p)
    assert y == pytest.approx(-y[::-1])
    assert (np.diff(y) > -1e-12).all()
    assert np.abs(y).max() <= 20.0
    assert y[-1] == pytest.approx(20.0, rel=2e-3)
    assert act(np.array([1e-3]), run(), p) == pytest.approx(1e-3, rel=1e-6)


def test_a_gap_is_read_by_its_inverse():
    z = np.array([-20.0, 0.0, 20.0])
    y = sensor.gap_law(z, run(), {"gap": 400.0})
    # the quadratic and the cubic of its series, up to the fourth power
    assert y == pytest.approx(z + z**2 / 400 + z**3 / 400**2, abs=20**4 / 400**3 * 1.1)


def test_excess_field_opposes_the_motion_with_its_power():
    u = 3.0 * TIME
    p = {"coefficient": 0.01, "exponent": 0.5}
    lost = u - material.excess_field(u, run(), p)
    assert lost[0] == 0.0
    assert lost[1:] == pytest.approx(0.01 * np.sqrt(3.0))
    assert material.growth(-u, run(), p) == pytest.approx(1 + 0.01 * np.sqrt(3.0))


def test_mains_has_its_harmonics_and_a_phase_of_each_record():
    p = {"frequency_hz": 50.0, "amplitude": 0.4, "share_2": 0.3, "share_3": 0.2}
    zero = np.zeros_like(TIME)
    y = sensor.mains(zero, run(), p)
    lines = np.abs(np.fft.rfft(y)) / len(y) * 2
    assert lines[[50, 100, 150]] == pytest.approx([0.4, 0.12, 0.08])
    lines[[50, 100, 150]] = 0
    assert lines.max() < 1e-9
    assert (sensor.mains(zero, run(), p) == y).all()
    assert not np.allclose(sensor.mains(zero, run(seed=1), p), y)


def test_a_drift_path_starts_at_zero_is_slow_and_new_in_each_record():
    time = np.arange(60 * 1600) / 1600.0
    zero, p = np.zeros_like(time), {"size": 1.0}
    y = sensor.path(zero, run(time=time), p)
    assert y[0] == 0
    # the fastest of 12 cosines, all in step, at its steepest
    fastest = 2 * np.pi * 0.25 * 12 / np.sqrt(6)
    assert np.abs(np.gradient(y, time)).max() < fastest
    assert not np.allclose(sensor.path(zero, run(time=time, seed=1), p), y)


def test_flicker_has_the_stated_size():
    time = np.arange(400_000) * DT
    p = {"coefficient": 0.05, "time_constant_s": 2e-3}
    y = unlisted.multiplicative(np.full_like(time, 2.0), run(time=time), p)
    assert np.std(y) == pytest.approx(0.1, rel=0.1)


def test_stick_slip_jumps():
    z = np.linspace(0, 10, 16000)
    y = unlisted.stick_slip(z, run(), {"hold": 1.0, "release": 0.1})
    off = z - y
    assert off.max() == pytest.approx(1.0, abs=0.01)
    # after the first slip it is within release to hold
    later = off[np.argmax(off) + 200 :]
    assert later.min() > 0.05
    assert len(np.unique(np.round(y, 6))) < len(y)


def test_held_samples_repeat_the_last_good_one():
    y = np.arange(5000.0)
    p = {"probability": 0.05, "samples": 3.0}
    out = unlisted.held(y, run(), p)
    assert out[0] == 0
    assert (out <= y).all()
    lost = out < y
    # each of three samples in a row is lost unless no run begins at any of them
    assert lost.mean() == pytest.approx(1 - 0.95**3, abs=0.02)
    assert (out[lost] == out[np.flatnonzero(lost) - 1]).all()

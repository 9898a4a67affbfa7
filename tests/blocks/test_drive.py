"""Blocks of the drive against plain references and closed forms."""

import itertools
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.integrate import solve_ivp

from hystbench.blocks.dead_zone import DeadZone
from hystbench.blocks.drive_lag import DriveLag
from hystbench.blocks.drive_saturation import DriveSaturation
from hystbench.blocks.input_delay import InputDelay, later
from hystbench.blocks.slew_limit import SlewLimit
from hystbench.errors import InputError

DT = 1e-3
Z = np.array([-2.0, -0.3, 0.0, 0.3, 1.0, 3.0])
inputs = st.lists(st.floats(-1, 1), min_size=1, max_size=50).map(np.array)


def test_saturation_and_dead_zone_worked_out_by_hand():
    np.testing.assert_array_equal(
        DriveSaturation(limit=1.0).simulate(Z, Z, DT), [-1.0, -0.3, 0.0, 0.3, 1.0, 1.0]
    )
    np.testing.assert_array_equal(
        DeadZone(half_width=0.5).simulate(Z, Z, DT), [-1.5, 0.0, 0.0, 0.0, 0.5, 2.5]
    )


def test_a_dead_zone_is_rounded_and_never_falls():
    rounded = DeadZone(half_width=0.5, rounding=0.5)
    z = np.linspace(-4.0, 4.0, 801)
    v = rounded.simulate(z, z, DT)
    assert np.diff(v).min() > 0
    assert np.gradient(v, z)[400] == pytest.approx(0.0, abs=1e-3)
    np.testing.assert_allclose(v[[0, -1]], [-3.5, 3.5], atol=1e-6)
    nearly = DeadZone(half_width=0.5, rounding=1e6).simulate(z, z, DT)
    np.testing.assert_allclose(nearly, z, atol=1e-5)
    with pytest.raises(InputError, match="expected 0 or at least half_width"):
        DeadZone(half_width=0.5, rounding=0.4)


def follow(z, step, parts=500, falling=1.0):
    """Follow straight lines in many small steps, each of them limited."""
    now, out = z[0], [z[0]]
    for before, after in itertools.pairwise(z):
        for part in range(1, parts + 1):
            wanted = before + (after - before) * part / parts
            now += np.clip(wanted - now, -falling * step / parts, step / parts)
        out.append(now)
    return np.array(out)


@given(inputs.map(lambda z: z[:12]), st.floats(0.01, 1.5))
def test_slew_limit_is_the_limit_of_small_steps(z, step):
    v = SlewLimit(rate=step / DT).simulate(z, z, DT)
    # A small step looks at its end alone: an error of its size, 2 / 500.
    np.testing.assert_allclose(v, follow(z, step), rtol=0, atol=5e-3)


@given(inputs.map(lambda z: z[:12]), st.floats(0.01, 1.0), st.floats(0.2, 3.0))
def test_slew_limit_may_fall_at_another_rate_than_it_rises(z, step, falling):
    v = SlewLimit(rate=step / DT, falling=falling * step / DT).simulate(z, z, DT)
    error = 2 * max(falling, 1.0) / 500
    expected = follow(z, step, falling=falling)
    np.testing.assert_allclose(v, expected, rtol=0, atol=1.3 * error)


@given(inputs, st.floats(0.01, 3.0))
def test_slew_limit_never_exceeds_its_rate(z, step):
    v = SlewLimit(rate=step / DT).simulate(z, z, DT)
    assert v[0] == z[0]
    assert (np.abs(np.diff(v)) <= step * (1 + 1e-12)).all()
    assert v.min() >= z.min() - 1e-12
    assert v.max() <= z.max() + 1e-12


@given(inputs)
def test_a_drive_that_is_fast_enough_follows(z):
    fast = SlewLimit(rate=2.01 / DT)
    np.testing.assert_array_equal(fast.simulate(z, z, DT), z)


def test_slew_limit_catches_up_within_an_interval_and_turns():
    # From (0) towards 1 at 0.5 an interval: at 1 it is half-way. The input then falls
    # by 2: they meet where 1 - 2t = 0.5 + 0.5t, t = 0.2, at 0.6, and on at -0.5.
    z = np.array([0.0, 1.0, -1.0])
    v = SlewLimit(rate=0.5 / DT).simulate(z, z, DT)
    np.testing.assert_allclose(v, [0.0, 0.5, 0.6 - 0.8 * 0.5], rtol=1e-14)


CURVES = {"rounded": np.tanh, "sharp": lambda x: np.clip(x, -1.0, 1.0)}


def lagging(z, rate, lag, curve, falling=1.0):
    """Solve the law of a lag of limited rate for straight lines, finely."""

    def law(t, v):
        ahead = np.interp(t, times, z) - v
        own = rate * np.where(ahead < 0, falling, 1.0)
        return own * curve(ahead / (own * lag))

    times = DT * np.arange(len(z))
    fine = {"t_eval": times, "rtol": 1e-10, "atol": 1e-12, "max_step": DT / 4}
    return solve_ivp(law, (0.0, times[-1]), z[:1], **fine).y[0]


@pytest.mark.parametrize("form", CURVES)
@pytest.mark.parametrize(
    ("rate", "falling"), [(20.0, 1.0), (200.0, 1.0), (2000.0, 1.0), (20.0, 1.7)]
)
def test_a_lag_with_a_limit_of_its_rate_is_of_second_order(rate, falling, form):
    z = np.sin(2 * np.pi * 10 * DT * np.arange(200))  # 63 a second at most
    errors = []
    for parts in (1, 4):  # both steps are shorter than an eighth of the lag
        fine = np.interp(np.arange(0, 199, 1 / parts), np.arange(200), z)
        block = SlewLimit(
            rate=rate, time_constant_s=9 * DT, form=form, falling=falling * rate
        )
        v = block.simulate(fine, fine, DT / parts)[::parts]
        true = lagging(z, rate, 9 * DT, CURVES[form], falling)[:199]
        errors.append(np.abs(v - true).max())
    assert errors[0] < 1e-3
    assert errors[1] < errors[0] / 12


def test_a_soft_limit_that_nothing_reaches_is_a_lag():
    z = 1e-6 * np.sin(2 * np.pi * 10 * DT * np.arange(300))
    soft = SlewLimit(rate=1.0, time_constant_s=8 * DT).simulate(z, z, DT)
    lag = DriveLag(time_constant_s=8 * DT).simulate(z, z, DT)
    np.testing.assert_allclose(soft, lag, atol=2e-3 * 1e-6)


def test_a_soft_limit_of_no_lag_is_the_hard_one():
    z = np.sin(2 * np.pi * 10 * DT * np.arange(300))
    hard = SlewLimit(rate=30.0).simulate(z, z, DT)
    soft = SlewLimit(rate=30.0, time_constant_s=1e-9).simulate(z, z, DT)
    near = SlewLimit(rate=30.0, time_constant_s=DT / 30).simulate(z, z, DT)
    np.testing.assert_array_equal(soft, hard)
    np.testing.assert_allclose(near, hard, atol=30.0 * DT / 10)


@pytest.mark.parametrize("delay", [-1.6, -1.0, -0.5, 0.0, 0.4, 1.0, 7.3, 63.5])
def test_a_sine_is_a_sine_later_or_earlier(delay):
    # A burst that starts and ends smoothly: nothing depends on what was before it.
    k = np.arange(400)

    def burst(at):
        inside = (at > 20) & (at < 300)
        window = np.where(inside, np.sin(np.pi * (at - 20) / 280) ** 4, 0.0)
        return window * np.sin(2 * np.pi * 0.2 * at + 0.3)

    block = InputDelay.by(delay * DT)
    found = block.simulate(burst(k), burst(k), DT)
    np.testing.assert_allclose(found, burst(k - delay), rtol=0, atol=1e-5)
    if delay % 1:  # straight lines lose a good part of a sine of five samples
        lines = replace(block, hold="linear").simulate(burst(k), burst(k), DT)
        assert np.abs(lines - burst(k - delay)).max() > 0.1


@pytest.mark.parametrize("hold", ["zero-order", "linear", "band-limited"])
@given(z=inputs, whole=st.integers(-3, 60))
def test_whole_samples_of_delay_shift_the_samples(hold, z, whole):
    block = InputDelay.by(whole * DT, hold=hold)
    expected = z[np.clip(np.arange(len(z)) - whole, 0, len(z) - 1)]
    np.testing.assert_allclose(block.simulate(z, z, DT), expected, rtol=0, atol=1e-12)


@given(inputs, st.floats(0.0, 0.99))
def test_straight_lines_by_hand(z, share):
    block = InputDelay(delay_s=share * DT, hold="linear")
    expected = (1 - share) * z[1:] + share * z[:-1]
    found = block.simulate(z, z, DT)[1:]
    np.testing.assert_allclose(found, expected, rtol=0, atol=1e-12)


def test_before_the_record_the_start_value_is_held():
    z = 1.5 + np.sin(np.arange(100) / 5)
    v = InputDelay(delay_s=10.5 * DT).simulate(z, z, DT)
    np.testing.assert_array_equal(v[:11], z[0])


def test_a_lead_leaves_a_signal_at_rest_behind_its_last_sample():
    z = np.sin(np.linspace(0.0, 3.0, 60))
    led = later(z, -2.25)
    # What comes 2.25 samples early has reached the last value two samples before it.
    np.testing.assert_array_equal(led[-2:], z[-1])
    # What comes as much late has not left the first one three samples behind it.
    np.testing.assert_array_equal(later(z, 2.25)[:3], z[0])
    np.testing.assert_allclose(led[30], np.interp(32.25, np.arange(60), z), atol=1e-3)

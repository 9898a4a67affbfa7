"""A store against Torricelli, exponentials and the conservation of volume."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from hystbench.blocks.store import Store
from hystbench.errors import InputError

TANK = Store(gain=1.0, rate=0.8)


def inflow(t):
    return 0.5 + 0.4 * np.sin(3 * t)


def test_an_empty_inflow_drains_the_tank_as_torricelli_says():
    # sqrt(h) falls in a straight line, from 2 at a rate of 0.4.
    for count, allowed in ((200, 1e-3), (2000, 1e-5)):
        t = np.linspace(0, 8, count + 1)
        z = np.zeros(count + 1)
        tank = replace(TANK, start_level=4.0)
        level = tank.simulate(z, z, t[1])
        wanted = np.maximum(2 - 0.4 * t, 0) ** 2
        np.testing.assert_allclose(level, wanted, atol=allowed)
        outflow = replace(tank, output="outflow").simulate(z, z, t[1])
        np.testing.assert_allclose(outflow, 0.8 * np.sqrt(level), atol=1e-12)


@pytest.mark.parametrize("exponent", [0.5, 1.0, 2.0])
def test_half_the_step_makes_a_quarter_of_the_error(exponent):
    errors = []
    for count in (125, 250, 500):
        t = np.linspace(0, 10, count + 1)
        found = solve_ivp(
            lambda at, h: inflow(at) - 0.8 * h**exponent,
            (0, 10),
            [0.3],
            t_eval=t,
            rtol=1e-10,
            atol=1e-12,
        )
        tank = replace(TANK, exponent=exponent, start_level=0.3)
        level = tank.simulate(inflow(t), t, t[1])
        errors.append(np.abs(level - found.y[0]).max())
    ratios = np.array(errors[:-1]) / errors[1:]
    assert errors[-1] < 1e-3
    assert (ratios > 3.4).all()
    assert (ratios < 4.6).all()


def test_with_an_exponent_of_one_it_is_a_low_pass():
    t = np.arange(1000) * 0.01
    level = replace(TANK, exponent=1.0, gain=2.0, bias=0.4).simulate(
        np.ones(1000), t, 0.01
    )
    np.testing.assert_allclose(level, 3 * (1 - np.exp(-0.8 * t)), atol=2e-5)


@pytest.mark.parametrize("hold", ["zero-order", "linear", "band-limited"])
@pytest.mark.parametrize("exponent", [0.5, 1.0])
def test_no_volume_is_lost_over_the_rim(exponent, hold):
    """What flows in is what stays, what flows out and what is spilt."""
    dt = 0.01
    t = np.arange(1601) * dt
    z = 0.8 - 0.7 * np.cos(np.pi * t)
    tank = replace(TANK, exponent=exponent, height=1.0, start_level=0.2, hold=hold)
    level = tank.simulate(z, z, dt)
    out = replace(tank, output="outflow").simulate(z, z, dt)
    both = replace(tank, output="outflow", caught=1.0).simulate(z, z, dt)
    spilt = both - out
    assert level.max() == 1.0
    assert (spilt >= 0).all()
    assert spilt.sum() * dt > 0.5
    assert np.count_nonzero(spilt) < len(t)
    entered = z[:-1].sum() * dt if hold == "zero-order" else np.trapezoid(z, dx=dt)
    left = np.trapezoid(out, dx=dt) + spilt.sum() * dt
    assert left + level[-1] - 0.2 == pytest.approx(entered, rel=2e-4)
    # While it overflows, all that enters beyond the outflow is spilt.
    over = np.flatnonzero((level[:-1] == 1.0) & (level[1:] == 1.0))[2:-2] + 1
    mean = z[over - 1] if hold == "zero-order" else (z[over] + z[over - 1]) / 2
    np.testing.assert_allclose(spilt[over], mean - 0.8, atol=1e-3)


@pytest.mark.parametrize("exponent", [0.5, 1.0])
def test_what_runs_over_a_weir_is_of_second_order(exponent):
    """Against a general solver: level, and what is spilt in all."""
    errors, spilt = [], []
    for count in (250, 500, 1000):
        t = np.linspace(0, 10, count + 1)

        def law(at, state):
            h, _ = state
            over = 1.5 * max(h - 0.4, 0.0) ** 1.5
            return [2 * inflow(at) - 0.8 * max(h, 0.0) ** exponent - over, over]

        about = {"t_eval": t, "rtol": 1e-10, "atol": 1e-12, "max_step": 0.05}
        true = solve_ivp(law, (0, 10), [0.3, 0.0], **about).y
        tank = replace(
            TANK, gain=2.0, exponent=exponent, start_level=0.3, height=0.4, weir=1.5
        )
        z = inflow(t)
        errors.append(np.abs(tank.simulate(z, z, t[1]) - true[0]).max())
        out, both = (
            replace(tank, output="outflow", caught=share).simulate(z, z, t[1])
            for share in (0.0, 1.0)
        )
        spilt.append(abs((both - out).sum() * t[1] - true[1, -1]))
    assert true[1, -1] > 1.0
    for error in (errors, spilt):
        assert error[-1] < 1e-3
        assert error[-1] < error[0] / 12


def test_a_long_weir_holds_the_level_as_a_sharp_rim_does():
    t = np.arange(500) * 0.01
    z = 1.0 - np.cos(np.pi * t)
    sharp = replace(TANK, height=0.5)
    long = replace(sharp, weir=1e7)
    levels = [x.simulate(z, z, 0.01) for x in (sharp, long)]
    assert levels[0].max() == 0.5
    np.testing.assert_allclose(levels[1], levels[0], atol=1e-4)


@pytest.mark.parametrize(("exponent", "first"), [(0.5, 2.0), (1.0, 0.7)])
def test_a_store_that_settles_above_a_weir_rests_there(exponent, first):
    z = np.full(200, first)
    tank = replace(TANK, exponent=exponent, height=0.4, weir=0.5, start="settled")
    level = tank.simulate(z, z, 0.01)
    assert level[0] > 0.4
    np.testing.assert_allclose(level, level[0], rtol=1e-5)


def test_half_of_what_is_spilt_is_caught():
    z = np.full(500, 3.0)
    tank = replace(TANK, height=1.0, output="outflow")
    none, half, whole = (
        replace(tank, caught=share).simulate(z, z, 0.01) for share in (0.0, 0.5, 1.0)
    )
    np.testing.assert_allclose(half, (none + whole) / 2, rtol=1e-12)
    assert whole[-1] == pytest.approx(3.0)
    assert none[-1] == pytest.approx(0.8)


def test_a_store_is_never_below_empty():
    t = np.arange(2000) * 0.01
    level = replace(TANK, start_level=0.1).simulate(np.sin(t) - 0.5, t, 0.01)
    assert level.min() == 0.0


def test_a_start_above_the_rim_is_at_the_rim():
    z = np.zeros(10)
    tank = replace(TANK, height=0.5, start_level=2.0)
    assert tank.simulate(z, z, 0.1)[0] == 0.5


@pytest.mark.parametrize("count", [0, 1, 2, 3])
@pytest.mark.parametrize("hold", ["linear", "band-limited"])
def test_a_record_may_be_short(hold, count):
    for output in ("level", "outflow"):
        tank = replace(TANK, hold=hold, output=output)
        assert tank.simulate(np.ones(count), np.ones(count), 0.01).shape == (count,)


@pytest.mark.parametrize(
    ("key", "value"), [("height", 0.0), ("caught", 1.5), ("exponent", 4.0)]
)
def test_a_parameter_out_of_bounds_is_refused(key, value):
    with pytest.raises(InputError, match=f"{key}: {value:g} is out of bounds"):
        replace(TANK, **{key: value})


@pytest.mark.parametrize("exponent", [0.5, 1.0, 2.0])
def test_a_settled_store_rests_until_its_inflow_changes(exponent):
    z = np.full(50, 0.6)
    tank = Store(gain=2.0, rate=0.8, exponent=exponent, bias=0.1, start="settled")
    np.testing.assert_allclose(tank.simulate(z, z, 0.5), (1.3 / 0.8) ** (1 / exponent))
    full = replace(tank, height=0.5)
    np.testing.assert_allclose(full.simulate(z, z, 0.5), 0.5)


def test_a_settled_store_into_which_nothing_flows_is_empty():
    z = np.full(3, -1.0)
    level = replace(TANK, start="settled").simulate(z, z, 0.5)
    np.testing.assert_array_equal(level, 0.0)

"""Linear blocks against scipy.signal and against their transfer functions."""

from dataclasses import replace

import numpy as np
import pytest
import scipy.linalg
import scipy.signal
import scipy.special
from hypothesis import given
from hypothesis import strategies as st

from hystbench.blocks import registry
from hystbench.blocks.creep import Creep
from hystbench.blocks.curve import finer
from hystbench.blocks.drive_lag import DriveLag
from hystbench.blocks.eddy_diffusion import EddyDiffusion
from hystbench.blocks.linear import (
    LinearBlock,
    _bytes,
    _curve_loop,
    respond,
    states_of,
)
from hystbench.blocks.logarithmic_creep import LogarithmicCreep
from hystbench.blocks.other_modes import OtherModes
from hystbench.blocks.resonance import Resonance
from hystbench.blocks.sensor_lag import SensorLag
from hystbench.blocks.starts import STARTS
from hystbench.blocks.state_space import StateSpace, discretise
from hystbench.blocks.transfer_function import TransferFunction
from hystbench.errors import InputError
from tests.blocks.responses import frequency_response

DT = 1e-4
WN = 2 * np.pi * 65.0
CASES = {
    "drive-lag": (DriveLag(time_constant_s=0.002), [1.0], [0.002, 1.0]),
    "sensor-lag": (SensorLag(time_constant_s=0.0007), [1.0], [0.0007, 1.0]),
    "sensor-lag of second order": (
        SensorLag(time_constant_s=0.0007, damping_ratio=0.8),
        [1.0],
        [0.0007**2, 2 * 0.8 * 0.0007, 1.0],
    ),
    # (1 - p) + p wn^2 / (...) on one denominator, by hand.
    "resonance": (
        Resonance(frequency_hz=65.0, damping_ratio=0.03, participation=-0.2),
        [1.2, 1.2 * 0.06 * WN, WN**2],
        [1.0, 0.06 * WN, WN**2],
    ),
    # 1 + 0.1 / (1 + 0.5 s) + 0.05 / (1 + 0.02 s), by hand.
    "creep": (
        Creep(magnitudes=[0.1, 0.05], time_constants_s=[0.5, 0.02]),
        [0.01, 0.547, 1.15],
        [0.01, 0.52, 1.0],
    ),
    "other-modes": (
        OtherModes(numerator=[1.0, 3.0], denominator=[1.0, 40.0, 9.0e4]),
        [1.0, 3.0],
        [1.0, 40.0, 9.0e4],
    ),
    "transfer-function": (
        TransferFunction(
            numerator=[2.0, 50.0, 3.0e5], denominator=[2.0, 900.0, 5.0e5, 9.0e7]
        ),
        [2.0, 50.0, 3.0e5],
        [2.0, 900.0, 5.0e5, 9.0e7],
    ),
}


def test_every_linear_block_has_a_case():
    linear = {k for k, block in registry().items() if issubclass(block, LinearBlock)}
    # Diffusion is no ratio of polynomials; its own test is below, and so is that of
    # creep over decades.
    assert linear == {
        *(name.split()[0] for name in CASES),
        "eddy-diffusion",
        "logarithmic-creep",
    }


@pytest.mark.parametrize("power", [0.0, 0.3])
def test_creep_over_decades_follows_a_step_as_a_power_of_time(power):
    """Between the ends it grows evenly in log time, or as that power of time."""
    block = LogarithmicCreep(
        magnitude=0.5, first_time_s=1e-4, last_time_s=1e3, power=power
    )
    system = block.continuous()
    rates, shares = -np.diag(system.a), system.b * system.c
    assert np.sum(shares / rates) == pytest.approx(0.5)
    assert system.d == 1.0
    time = 10.0 ** np.arange(-2, 2)
    settled = (shares / rates) @ -np.expm1(-np.outer(rates, time))
    each_decade = np.diff(settled)
    if power:
        ratios = each_decade[1:] / each_decade[:-1]
        assert ratios == pytest.approx(10**power, rel=0.05)
    else:
        # Seven decades share the whole.
        assert each_decade == pytest.approx(0.5 / 7, rel=0.1)


def test_creep_over_decades_needs_two_times():
    with pytest.raises(InputError, match=r"last_time_s: 1; .*more than"):
        LogarithmicCreep(magnitude=0.1, first_time_s=1.0, last_time_s=1.0)


@pytest.mark.parametrize("geometry", ["slab", "rod", "half-space"])
def test_eddy_diffusion_is_the_analytic_response(geometry):
    tau = 0.003
    frequency = np.logspace(-1, 3, 40)
    q = np.sqrt(2j * np.pi * frequency * tau)
    if geometry == "slab":
        expected = np.tanh(q) / q
    elif geometry == "half-space":
        expected = 1 / (1 + q)
    else:
        expected = 2 * scipy.special.iv(1, q) / (q * scipy.special.iv(0, q))
    block = EddyDiffusion(time_constant_s=tau, geometry=geometry)
    found = frequency_response(block, frequency)
    # 24 modes; what the last one holds too much is of the order of the bound.
    assert np.abs(found - expected).max() < 2e-3


def test_eddy_diffusion_settles_at_its_input():
    block = EddyDiffusion(time_constant_s=0.003)
    assert block.simulate(np.ones(400), np.ones(400), DT)[-1] == pytest.approx(1.0)


def rough_input(n=400):
    return np.random.default_rng(3).normal(size=n)


def with_hold(block, hold):
    return type(block).from_mapping({**block.to_mapping(), "hold": hold})


@pytest.mark.parametrize("name", CASES)
@pytest.mark.parametrize("hold", ["linear", "zero-order"])
def test_response_is_that_of_lsim(name, hold):
    block, numerator, denominator = CASES[name]
    v = rough_input()
    _, expected, _ = scipy.signal.lsim(
        (numerator, denominator), v, np.arange(len(v)) * DT, interp=hold == "linear"
    )
    simulated = with_hold(block, hold).simulate(v, v, DT)
    np.testing.assert_allclose(
        simulated, expected, rtol=0, atol=1e-9 * np.abs(expected).max()
    )


@pytest.mark.parametrize("name", CASES)
def test_frequency_response_is_that_of_the_polynomials(name):
    block, numerator, denominator = CASES[name]
    frequency = np.array([0.1, 5.0, 60.0, 65.0, 300.0])
    s = 2j * np.pi * frequency
    np.testing.assert_allclose(
        frequency_response(block, frequency),
        np.polyval(numerator, s) / np.polyval(denominator, s),
        rtol=1e-10,
    )


@pytest.mark.parametrize("name", CASES)
@pytest.mark.parametrize(("hold", "error"), [("band-limited", 1e-3), ("linear", 0.25)])
def test_steady_state_of_a_fast_sine(name, hold, error):
    # A sine at a quarter of the sampling rate: the straight-line hold loses up to
    # 1 - sinc(1/4)^2 = 19 % of what passes the dynamics, the band-limited one does not.
    block, numerator, denominator = CASES[name]
    dt = 1e-3
    n = 8000
    time = np.arange(n) * dt
    y = with_hold(block, hold).simulate(np.sin(2 * np.pi * 250 * time), time, dt)
    s = 2j * np.pi * 250
    response = np.polyval(numerator, s) / np.polyval(denominator, s)
    expected = np.imag(response * np.exp(s * time))
    middle = slice(5000, 7000)  # slow modes have settled, the far end is not near
    scale = np.abs(response)
    assert np.abs(y - expected)[middle].max() < error * scale
    if hold == "linear" and name == "drive-lag":
        assert np.abs(y - expected)[middle].max() > 0.1 * scale


@pytest.mark.parametrize("name", [*CASES, "eddy-diffusion"])
@pytest.mark.parametrize("n", [3, 10, 304])  # the first two are no longer than a curve
def test_band_limited_is_the_limit_of_straight_lines(name, n):
    # Straight lines on a finer grid converge as its step squared, start and end too.
    diffusion = EddyDiffusion(time_constant_s=0.003)
    system = (CASES[name][0] if name in CASES else diffusion).continuous()
    v = np.random.default_rng(4).normal(size=n) + 2.0
    exact = respond(system, v, DT, "band-limited")
    errors = []
    for fine in (8, 32):
        lines = respond(system, finer(v, fine), DT / fine, "linear")[::fine]
        errors.append(np.abs(lines - exact).max())
    scale = np.abs(exact).max()
    assert errors[1] < 3e-4 * scale
    assert errors[1] < errors[0] / 12 + 1e-11 * scale


def test_repeated_poles_are_no_trouble():
    # (s + 300)^4 has one eigenvector: a modal form would not exist.
    denominator = np.poly([-300.0] * 4)
    block = TransferFunction(numerator=[denominator[-1]], denominator=[*denominator])
    frequency = np.array([0.0, 10.0, 50.0, 500.0])
    expected = (300.0 / (300.0 + 2j * np.pi * frequency)) ** 4
    np.testing.assert_allclose(
        frequency_response(block, frequency), expected, rtol=1e-9
    )


@given(st.lists(st.floats(1e-6, 1e8), min_size=1, max_size=5, unique=True))
def test_modes_are_discretised_as_a_matrix_exponential_does_it(rates):
    # A time step from 1e-10 to 1e4 time constants.
    m = len(rates)
    system = StateSpace(-np.diag(rates), np.array(rates), np.ones(m), 0.0)
    for hold in ("zero-order", "linear"):
        phi, now, following = discretise(system, DT, hold)
        for i, rate in enumerate(rates):
            # One mode at a time: side by side, expm drowns the slow in the fast.
            # Its state, an input of one, and the rise of the input over the interval.
            x = rate * DT
            moves = np.array([[-x, x, 0.0], [0.0, 0.0, 1.0], [0.0, 0.0, 0.0]])
            a, step, ramp = scipy.linalg.expm(moves)[0]
            b, c = (step, 0.0) if hold == "zero-order" else (step - ramp, ramp)
            np.testing.assert_allclose(phi[i], a, rtol=1e-9, atol=1e-13)
            np.testing.assert_allclose(now[i], b, rtol=1e-9, atol=1e-13)
            np.testing.assert_allclose(following[i], c, rtol=1e-9, atol=1e-13)


@pytest.mark.parametrize(
    ("values", "message"),
    [
        ({"numerator": [1, 0, 0], "denominator": [1, 1]}, "degree 2 exceeds"),
        ({"numerator": [1], "denominator": [1, -1]}, "unstable pole"),
        ({"numerator": [1], "denominator": [1, 0, 0]}, "unstable pole"),
        ({"numerator": [1], "denominator": [1, 0], "start": "settled"}, "'rest'"),
        ({"numerator": [1], "denominator": [0, 1]}, "leading coefficient"),
        ({"numerator": [1], "denominator": [2]}, "'gain'"),
    ],
)
def test_a_transfer_function_that_cannot_be_simulated_is_refused(values, message):
    with pytest.raises(InputError, match=message):
        TransferFunction.from_mapping(values)


@pytest.mark.parametrize("hold", ["zero-order", "linear", "band-limited"])
def test_a_pole_at_the_origin_integrates(hold):
    """The same system in front of a pure integrator, and its integral by hand."""
    dt = 1e-3
    t = dt * np.arange(2000)
    u = np.sin(2 * np.pi * 3 * t) + 0.3
    lag = {"numerator": [2.0], "denominator": [0.02, 1.0], "hold": hold}
    rate = TransferFunction.from_mapping(lag).simulate(u, u, dt)
    both = lag | {"denominator": [0.02, 1.0, 0.0]}
    found = TransferFunction.from_mapping(both).simulate(u, u, dt)
    steps = 0.5 * dt * (rate[1:] + rate[:-1])
    assert found == pytest.approx(np.cumsum([0.0, *steps]), abs=2e-4)
    pure = {"numerator": [5.0], "denominator": [1.0, 0.0], "hold": hold}
    alone = TransferFunction.from_mapping(pure).simulate(np.ones(50), u, dt)
    assert alone[-1] == pytest.approx(5.0 * 49 * dt, rel=1e-2)


def test_creep_needs_a_time_constant_for_each_magnitude():
    with pytest.raises(InputError, match="expected 2 numbers, as many as time_cons"):
        Creep(magnitudes=[0.1], time_constants_s=[1.0, 2.0])


class TestStart:
    """3 / (1 + 0.05 s) from each of the starts of a transfer function."""

    dt = 0.001
    time = dt * np.arange(1000)

    def simulate(self, v, start, hold="linear"):
        block = TransferFunction(
            numerator=[3.0], denominator=[0.05, 1.0], start=start, hold=hold
        )
        return block.simulate(v, v, self.dt)

    @pytest.mark.parametrize("hold", ["zero-order", "linear", "band-limited"])
    def test_settled_a_constant_stays(self, hold):
        v = np.full(200, 4.0)
        np.testing.assert_allclose(self.simulate(v, "settled", hold), 12.0)
        assert self.simulate(v, "rest", hold)[0] == pytest.approx(0.0, abs=1e-9)

    def test_settled_only_what_follows_counts(self):
        v = 4.0 + self.time
        # The answer of a lag to a ramp from its steady state.
        decay = np.exp(-self.time / 0.05)
        wanted = 12.0 + 3 * (self.time - 0.05 * (1 - decay))
        np.testing.assert_allclose(self.simulate(v, "settled"), wanted, atol=1e-9)

    @pytest.mark.parametrize("phase", [0.0, 0.4, 3.0, 6.0])
    @pytest.mark.parametrize("hold", ["linear", "band-limited"])
    def test_moving_a_sine_shows_little_of_its_beginning(self, phase, hold):
        angle = 2 * np.pi * 2 * self.time + phase
        gain = 3 / (1 + 2j * np.pi * 2 * 0.05)
        steady = (gain * np.exp(1j * angle)).imag
        v = np.sin(angle)
        away = {
            start: np.abs(self.simulate(v, start, hold) - steady)[:200].max()
            for start in ("settled", "moving")
        }
        # Turned about a sample, a sine keeps its value and its slope.
        assert away["moving"] < 0.7 * away["settled"]
        if phase == 0.0:  # turned about its zero it is itself
            assert away["moving"] < 0.003

    def test_moving_a_ramp_has_always_been_one(self):
        v = 1.0 + 2.0 * self.time
        wanted = 3.0 * (v - 2.0 * 0.05)
        away = np.abs(self.simulate(v, "moving") - wanted)
        # It has been one for a second, twenty time constants.
        assert away.max() < 3 * 2 * 0.05 * np.exp(-19)

    @pytest.mark.parametrize("hold", ["linear", "band-limited"])
    def test_repeating_whole_periods_are_steady_from_the_first_sample(self, hold):
        angle = 2 * np.pi * 2 * np.arange(len(self.time)) / len(self.time)
        w = 2 * np.pi * 2 / (len(self.time) * (self.time[1] - self.time[0]))
        gain = 3 / (1 + 1j * w * 0.05)
        steady = (gain * np.exp(1j * (angle + 0.4))).imag
        away = np.abs(self.simulate(np.sin(angle + 0.4), "repeating", hold) - steady)
        assert away.max() < (1e-4 if hold == "linear" else 1e-5)
        at_rest = np.abs(self.simulate(np.sin(angle + 0.4), "rest", hold) - steady)
        assert at_rest.max() > 0.1


def test_a_system_that_runs_away_within_an_interval_warns_of_nothing(recwarn):
    """Exponentials of 1e9: a fit tries such values, and NaN is the answer."""
    a = np.array([[0.0, 1e9], [1e9, 1e9]])
    system = StateSpace(a, np.array([0.0, 1.0]), np.array([1.0, 0.0]), 0.0)
    phi, _, _ = discretise(system, 1.0, "linear")
    assert np.isnan(phi).all()
    assert not recwarn.list


@pytest.mark.parametrize("hold", ["zero-order", "linear", "band-limited"])
@pytest.mark.parametrize("name", ["resonance", "creep", "drive-lag"])
def test_states_make_the_response(name, hold):
    system = CASES[name][0].continuous()
    v = np.random.default_rng(3).standard_normal(200).cumsum()
    states = states_of(system, v, DT, hold)
    expected = respond(system, v, DT, hold)
    size = np.abs(expected).max()
    assert states @ system.c + system.d * v == pytest.approx(expected, abs=1e-12 * size)


EVERY = [
    *(case[0] for case in CASES.values()),
    EddyDiffusion(time_constant_s=0.01),
    LogarithmicCreep(magnitude=0.2, first_time_s=0.01, last_time_s=0.5),
]


@pytest.mark.parametrize("block", EVERY, ids=lambda block: block.name)
def test_where_the_first_value_has_stood_for_ever_nothing_moves(block):
    z = np.full(200, 3.0)
    y = replace(block, start="settled").simulate(z, z, DT)
    static = frequency_response(block, [0.0])[0].real
    np.testing.assert_allclose(y, 3.0 * static, rtol=1e-9)


@pytest.mark.parametrize("block", EVERY, ids=lambda block: block.name)
def test_what_repeats_is_the_second_of_two_passages(block):
    z = 2.0 + np.sin(2 * np.pi * np.arange(400) / 200)
    both = np.concatenate([z, z])
    twice = replace(block, start="settled").simulate(both, both, DT)
    once = replace(block, start="repeating").simulate(z, z, DT)
    np.testing.assert_allclose(once, twice[400:], rtol=1e-9, atol=1e-9)


def test_states_that_do_not_last_an_interval_are_weighed_with_the_window():
    """Beside slow ones they give what they give alone; a kernel moves the slow ones."""

    def system(rates):
        size = len(rates)
        return StateSpace(np.diag(-rates), rates, np.ones(size) / size, 0.0)

    slow, fast = np.array([3.0, 80.0]), np.array([5e5, 2e6, 9e6])
    whole = system(np.array([fast[0], slow[0], *fast[1:], slow[1]]))
    v = np.random.default_rng(4).standard_normal(60)
    parts = [respond(system(rates), v, DT, "band-limited") for rates in (slow, fast)]
    together = (2 * parts[0] + 3 * parts[1]) / 5
    assert respond(whole, v, DT, "band-limited") == pytest.approx(together, abs=1e-12)
    loop = _curve_loop(*_bytes(whole), DT)
    assert loop.states == len(slow)
    # What is as quick as that follows its input.
    assert parts[1][1:] == pytest.approx(v[1:], abs=0.2)
    assert parts[1][0] == 0.0


@pytest.mark.parametrize("hold", ["zero-order", "linear", "band-limited"])
@pytest.mark.parametrize("name", ["resonance", "eddy-diffusion"])
@pytest.mark.parametrize("start", STARTS)
def test_many_records_at_once_are_as_one_by_one(start, name, hold):
    mode = Resonance(frequency_hz=65.0, damping_ratio=0.03, participation=0.4)
    block = {"resonance": mode, "eddy-diffusion": EddyDiffusion(time_constant_s=0.01)}
    block = replace(block[name], hold=hold, start=start)
    rng = np.random.default_rng(0)
    signals = [rng.standard_normal(n) for n in (300, 1, 50, 120)]
    rates = [DT, 2 * DT, DT, 3 * DT]
    together = block.simulate_records(signals, rates)
    for z, dt, y in zip(signals, rates, together, strict=True):
        np.testing.assert_array_equal(y, block.simulate(z, z, dt))

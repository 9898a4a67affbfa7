"""Elements in parallel that slip one after the other, inside a mechanism."""

from itertools import pairwise

import numpy as np
import pytest
from scipy.integrate import quad, solve_ivp

from hystbench.blocks.iwan_force import IwanForce
from hystbench.blocks.mechanism import Mechanism
from hystbench.errors import InputError

from .bare import against, errors_of

EXPONENTS = (-0.9, -0.5, 0.0, 1.0, 20.0)


def joint(exponent=0.0, weights=()):
    return IwanForce(
        stiffness=8.0, slip_distance=0.5, exponent=exponent, weights=weights
    )


def first_loading(q, exponent):
    """Give Iwan's integral of the elements that slip and of those that hold."""

    def density(r):
        return (exponent + 1) * r**exponent

    slipped, _ = quad(lambda r: r * density(r), 0, min(q / 0.5, 1))
    held = 1 - min(q / 0.5, 1) ** (exponent + 1)
    return 8.0 * (0.5 * slipped + q * held)


@pytest.mark.parametrize("exponent", EXPONENTS)
def test_the_first_loading_is_iwans_integral(exponent):
    q = np.linspace(0, 0.8, 161)
    wanted = np.array([first_loading(x, exponent) for x in q])
    found = against(joint(exponent), q)
    assert np.abs(found - wanted).max() < 0.013 * wanted.max()
    assert found[-1] == pytest.approx(wanted[-1], rel=1e-9)
    assert found[1] > 0


@pytest.mark.parametrize("exponent", EXPONENTS)
def test_a_branch_is_the_first_loading_at_twice_the_size(exponent):
    """Masing's rule, and a small loop within a large one closes."""
    block = joint(exponent)
    up, down = np.linspace(0, 0.3, 61), np.linspace(0.3, -0.3, 61)[1:]
    found = against(block, np.concatenate([up, down]))
    np.testing.assert_allclose(found[60] - found[60:], 2 * found[:61], atol=1e-12)
    within = np.concatenate(
        [up, np.linspace(0.3, 0.1, 9)[1:], np.linspace(0.1, 0.3, 9)]
    )
    again = against(block, within)
    assert again[-1] == pytest.approx(again[60], rel=1e-12)


def test_the_loss_at_a_small_amplitude_goes_as_the_exponents_power():
    """Segalman: the work of a loop of size a goes as a to the exponent + 3."""
    turn = np.sin(np.linspace(0, 4 * np.pi, 4001))
    for exponent in (-0.5, 0.0, 1.0):
        work = []
        for size in (0.1, 0.3):
            q = size * turn
            force = against(joint(exponent), q)
            work.append(np.trapezoid(force[2000:], q[2000:]))
        power = np.log(work[1] / work[0]) / np.log(3.0)
        assert power == pytest.approx(exponent + 3.0, abs=0.12)


def test_weights_are_those_of_even_thresholds():
    """Elements of 2, 0 and 6 that slip at a third, two thirds and the whole."""
    block = IwanForce(stiffness=8.0, slip_distance=0.9, weights=(1.0, 0.0, 3.0))
    q = [0.0, 0.1, 0.3, 0.6, 0.9, 2.0, 1.8]
    wanted = [0.0, 0.8, 2.4, 4.2, 6.0, 6.0, 4.4]
    np.testing.assert_allclose(against(block, q), wanted, atol=1e-12)


@pytest.mark.parametrize("dt", [0.06, 0.01])
@pytest.mark.parametrize("exponent", EXPONENTS)
def test_a_free_motion_loses_energy_with_what_the_elements_hold(exponent, dt):
    """Each holds half its stiffness times the square of its way."""
    block = joint(exponent)
    free = Mechanism(mass=2.0, damping=0.0, stiffness=20.0, start_position=1.2)
    moved = free.motion(np.zeros(round(24 / dt)), dt, (block,))
    energy = moved.velocity**2 + 10 * moved.position**2
    shares, thresholds = block.elements()
    most = 0.5 * 8.0 * float(shares @ thresholds**2)
    least = np.minimum.accumulate(energy)
    assert (energy - least).max() <= most
    assert energy[-1] < 0.5 * energy[0]


def test_half_the_step_makes_a_quarter_of_the_error():
    weights = (1.0, 2.0, 1.0)
    shares, thresholds = joint(weights=weights).elements()

    def drive(t):
        return 9 * np.sin(3 * t) + 4 * np.sin(7 * t)

    def moves(t, state):
        q, v, *ways = state
        z = np.array(ways)
        slips = (np.abs(z) >= thresholds) & (z * v > 0)
        force = 8.0 * float(shares @ np.clip(z, -thresholds, thresholds))
        rate = (drive(t) - 0.5 * v - 20 * q - force) / 2.0
        return [v, rate, *np.where(slips, 0.0, v)]

    end = 4.0
    fine = np.linspace(0, end, 801)
    wanted = solve_ivp(
        moves, (0, end), np.zeros(5), t_eval=fine, method="RK45",
        rtol=1e-8, atol=1e-10, max_step=2e-3,
    ).y[0]  # fmt: skip
    host = Mechanism(mass=2.0, damping=0.5, stiffness=20.0, hold="linear")
    forces, counts = (joint(weights=weights),), (200, 400, 800)
    errors = errors_of(host, forces, drive, wanted, end, counts)
    assert errors[-1] < 3e-4
    for before, after in pairwise(errors):
        assert before / after > 3.0


@pytest.mark.parametrize("exponent", [-2.5, -1.0, 0.5])
def test_below_a_first_slip_it_is_a_spring(exponent):
    block = IwanForce(
        stiffness=8.0, slip_distance=0.5, exponent=exponent, first_slip=0.2
    )
    q = np.linspace(0, 0.1, 11)  # a fifth of the slip distance
    np.testing.assert_allclose(against(block, q), 8.0 * q, rtol=1e-9)


def test_with_a_first_slip_the_first_loading_is_iwans_integral():
    exponent, first = -1.7, 0.1

    def density(r):
        return r**exponent

    whole, _ = quad(density, first, 1)
    q = np.linspace(0, 0.6, 61)
    wanted = []
    for x in q / 0.5:
        slipped, _ = quad(lambda r: r * density(r), first, np.clip(x, first, 1))
        held, _ = quad(density, np.clip(x, first, 1), 1)
        wanted.append(8.0 * 0.5 * (slipped + x * held) / whole)
    block = IwanForce(
        stiffness=8.0, slip_distance=0.5, exponent=exponent, first_slip=first
    )
    assert np.abs(against(block, q) - wanted).max() < 0.01 * max(wanted)


def test_without_a_first_slip_the_density_has_an_end():
    with pytest.raises(InputError, match="expected at least"):
        IwanForce(stiffness=8.0, slip_distance=0.5, exponent=-1.2)

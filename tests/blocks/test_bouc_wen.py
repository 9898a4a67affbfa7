"""Bouc and Wen's hysteresis by Wen's numbers: its equation, its energy, its limits."""

import numpy as np
import pytest
from scipy.integrate import quad, solve_ivp

from hystbench.blocks.bouc_wen_force import BoucWenForce
from hystbench.blocks.hysteretic_force import HystereticForce
from hystbench.blocks.mechanism import Mechanism
from hystbench.errors import InputError

from .bare import against, along, errors_of

#: Stiffness, beta and gamma of loops that soften, stiffen, or lose nothing.
LOOPS = {
    "softens": (15.0, 3.0, 2.0),
    "softens, unloads less stiff": (15.0, 1.0, 4.0),
    "stiffens": (5.0, 0.8, -1.1),
    "stiffens by as much as it softens": (5.0, 0.8, -0.8),
    "elastic, stiffens": (5.0, 0.0, -1.5),
    "elastic, softens": (5.0, 0.0, 1.5),
}


def wen(name):
    stiffness, beta, gamma = LOOPS[name]
    return BoucWenForce(stiffness=stiffness, beta=beta, gamma=gamma)


@pytest.mark.parametrize("name", LOOPS)
def test_the_force_is_the_solution_of_wens_equation(name):
    stiffness, beta, gamma = LOOPS[name]
    turns = [0.0, 0.5, 0.3, 0.45, -0.6, -0.5, -0.55, 0.02]

    def slope(q, f, direction):
        return stiffness - np.abs(f) * (beta * np.sign(f * direction) + gamma)

    way, wanted = along(slope, turns)
    np.testing.assert_allclose(against(wen(name), way), wanted, atol=2e-5)


@pytest.mark.parametrize("name", LOOPS)
def test_the_step_does_not_matter(name):
    fine = np.concatenate([np.linspace(0, 0.3, 301), np.linspace(0.3, -0.2, 501)[1:]])
    many, few = against(wen(name), fine), against(wen(name), fine[[0, 300, 800]])
    np.testing.assert_allclose(few, many[[0, 300, 800]], rtol=1e-12, atol=1e-12)


@pytest.mark.parametrize("sharing", [0.0, 0.3, 0.5, 0.8, 1.0])
def test_with_a_largest_force_it_is_the_other_block(sharing):
    q = 0.8 * np.sin(np.linspace(0, 20, 999)) * np.linspace(0, 1, 999)
    other = HystereticForce(largest=3.0, yield_distance=0.2, sharing=sharing)
    # Ikhouane and Rodellar's normalized form.
    own = BoucWenForce(stiffness=15.0, beta=(1 - sharing) / 0.2, gamma=sharing / 0.2)
    np.testing.assert_allclose(against(own, q), against(other, q), atol=1e-12)


def stored(name, force):
    """Give the most work that a force can still give back: that of unloading."""
    stiffness, beta, gamma = LOOPS[name]
    work, _ = quad(
        lambda f: f / (stiffness + (beta - gamma) * f),
        0.0,
        abs(force),
        epsabs=1e-12,
    )
    return work


@pytest.mark.parametrize("dt", [0.06, 0.01])
@pytest.mark.parametrize("name", LOOPS)
def test_a_free_motion_loses_energy_with_what_the_force_stores(name, dt):
    """Few steps a turn: the discrete motion is as passive as the continuous one."""
    free = Mechanism(
        mass=2.0, damping=0.0, stiffness=20.0, start_position=1.2, start_velocity=1.0
    )
    moved = free.motion(np.zeros(round(12 / dt)), dt, (wen(name),))
    kept = np.array([stored(name, force) for force in moved.force])
    energy = moved.velocity**2 + 10 * moved.position**2 + kept
    assert np.diff(energy).max() < 1e-8 * energy[0]
    if "elastic" in name:
        np.testing.assert_allclose(energy, energy[0], rtol=1e-7)
    else:
        assert energy[-1] < 0.5 * energy[0]


@pytest.mark.parametrize("name", ["softens", "softens, unloads less stiff"])
def test_where_it_softens_on_loading_the_force_is_bounded_whatever_the_motion(name):
    stiffness, beta, gamma = LOOPS[name]
    walk = np.cumsum(np.random.default_rng(1).standard_normal(5000))
    found = against(wen(name), walk)
    most = stiffness / (beta + gamma)
    assert np.abs(found).max() == pytest.approx(most, rel=1e-9)
    assert np.abs(found).max() <= most * (1 + 1e-12)


def test_where_it_stiffens_the_reach_of_the_motion_bounds_the_force():
    stiffness, beta, gamma = LOOPS["stiffens"]
    grows = -(beta + gamma)
    rng = np.random.default_rng(2)
    walk = np.clip(np.cumsum(rng.standard_normal(50_000)), -8.0, 8.0)
    most = stiffness / grows * np.expm1(grows * np.ptp(walk))
    found = np.abs(against(wen("stiffens"), walk))
    assert 0.05 * most < found.max() < most


@pytest.mark.parametrize("size", [1e4, 1e9])
def test_a_stiffening_force_holds_whatever_drives_it(size):
    """It grows with the exponential of the way, so that no push runs away."""
    rubber = BoucWenForce(stiffness=5.0, beta=0.8, gamma=-30.0)
    held = Mechanism(mass=1.0, damping=100.0, stiffness=1.0)
    moved = held.motion(np.repeat([size, -size], 2000), 1e-3, (rubber,))
    assert np.isfinite(moved.position).all()
    # Loaded along one way from zero it is ln(1 + F (gamma + beta) / stiffness) long.
    least = np.log1p(size * 29.2 / 5.0) / 29.2
    assert moved.position[:2000].max() > 0.99 * least
    assert np.abs(moved.position).max() < 100 * least
    if size < 1e5:  # a faster one rings on in steps that are too long for it
        assert moved.force[1999] == pytest.approx(size, rel=1e-3)
        assert moved.force[-1] == pytest.approx(-size, rel=1e-3)


def test_an_impedance_that_is_moved_too_far_is_no_number_from_there_on():
    rubber = BoucWenForce(stiffness=5.0, beta=0.8, gamma=-30.0)
    with np.errstate(all="ignore"):
        force = against(rubber, [0.0, 1.0, 2.0, 40.0, 30.0, 20.0])
    assert np.isfinite(force[:3]).all()
    assert not np.isfinite(force[3:]).any()


#: Noel and Schoukens' benchmark: exponent one, alpha 5e4, beta 1e3, gamma 0.8, delta
#: -1.1 in their letters.
BENCHMARK = BoucWenForce(stiffness=5e4, beta=800.0, gamma=-1100.0)
OSCILLATOR = Mechanism(mass=2.0, damping=10.0, stiffness=5e4, hold="linear")


def drive(t):
    return 120 * np.sin(2 * np.pi * 31 * t) + 60 * np.sin(2 * np.pi * 47 * t)


def test_half_the_step_makes_a_quarter_of_the_error():
    def moves(t, state):
        q, v, f = state
        spring = 10.0 * v + 5e4 * q + f
        growth = 5e4 * v - 800 * abs(v) * f + 1100 * v * abs(f)
        return [v, (drive(t) - spring) / 2.0, growth]

    end = 0.2
    fine = np.linspace(0, end, 6401)
    wanted = solve_ivp(
        moves, (0, end), np.zeros(3), t_eval=fine, method="DOP853",
        rtol=1e-10, atol=1e-14, max_step=1e-4,
    ).y[0]  # fmt: skip
    counts = (1600, 3200, 6400)
    errors = errors_of(OSCILLATOR, (BENCHMARK,), drive, wanted, end, counts)
    assert errors[-1] < 3e-4
    ratios = errors[:-1] / errors[1:]
    assert (ratios > 3.3).all()
    assert (ratios < 4.7).all()


def test_a_negative_beta_would_give_energy_and_is_refused():
    with pytest.raises(InputError, match=r"beta: -0\.1 is out of bounds") as told:
        BoucWenForce(stiffness=1.0, beta=-0.1, gamma=0.5)
    assert "\n" not in str(told.value)

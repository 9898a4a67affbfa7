"""What inputs ``s^m`` add to a linear state in one interval, beside quadrature."""

import numpy as np
import pytest
from scipy.linalg import expm

from hystbench.blocks.state_space import StateSpace, curve_drive, moments_of

POINTS = 32
SYSTEMS = {
    "modes from slow to stiff": np.diag([-1e-6, -0.5, -3.0, -40.0, -400.0]),
    "a resonance": np.array([[0.0, 0.1], [-90.0, -0.1]]),
    "three states": np.array([[0.0, 0.3, 0.0], [0.0, 0.0, 0.3], [-300.0, -90.0, -9.0]]),
    "two equal poles": np.array([[-2.0, 1.0], [0.0, -2.0]]),
    "two integrators": np.array([[0.0, 1.0], [0.0, 0.0]]),
    "stiff and slow together": np.array([[-50.0, -3.0], [0.0, -0.01]]),
}


@pytest.mark.parametrize("name", SYSTEMS)
def test_moments_are_those_of_a_gaussian_quadrature(name):
    a = SYSTEMS[name]
    b = np.random.default_rng(0).standard_normal(len(a))
    phi, moments = moments_of(StateSpace(a, b, b, 0.0), 1.0, POINTS)
    np.testing.assert_allclose(phi, expm(a), rtol=0, atol=1e-13)
    places, weights = np.polynomial.legendre.leggauss(400)
    s, weights = (places + 1) / 2, weights / 2
    moved = np.array([expm(a * (1 - at)) @ b for at in s])
    for m in range(POINTS):
        wanted = (weights * s**m) @ moved
        np.testing.assert_allclose(
            moments[m], wanted, rtol=0, atol=1e-11 * np.abs(wanted).max()
        )


@pytest.mark.parametrize("name", SYSTEMS)
@pytest.mark.parametrize("share", [1e-4, 0.05, 0.3, 1.0, 1.9])
def test_a_curve_drives_as_its_moments_say(name, share):
    """With a series where the system is slow, and by other ways where it is not."""
    a = SYSTEMS[name]
    b = np.random.default_rng(1).standard_normal(len(a))
    system = StateSpace(a, b, b, 0.0)
    phi, drive = curve_drive(system, share, POINTS, POINTS // 2 - 1)
    np.testing.assert_allclose(phi, expm(a * share), rtol=0, atol=1e-13)
    places, weights = np.polynomial.legendre.leggauss(400)
    s, weights = (places + 1) / 2, weights / 2
    moved = np.array([expm(a * share * (1 - at)) @ b * share for at in s])
    newest = POINTS // 2  # intervals from the start of this one
    samples = newest - np.arange(POINTS)
    for k in (0, newest - 1, newest, POINTS - 1):
        others = np.delete(samples, k)
        lagrange = np.prod([(s - p) / (samples[k] - p) for p in others], axis=0)
        wanted = (weights * lagrange) @ moved
        scale = np.abs(drive).max(axis=0)
        assert (np.abs(drive[k] - wanted) <= 1e-10 * scale).all()

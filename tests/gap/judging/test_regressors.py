"""Radial basis functions about a few points: what they are to give is known."""

import numpy as np
import pytest

from hystbench.gap.judging.regressors import Landmarks


def kernel(a, b):
    apart = np.sum((a[:, None] - b[None]) ** 2, axis=2)
    return np.exp(-apart / a.shape[1])


def test_products_of_the_functions_at_the_points_are_the_kernel():
    """With all points of a cloud as landmarks nothing of the kernel is lost."""
    cloud = np.random.default_rng(1).normal(size=(30, 4))
    seen = Landmarks.among(cloud, 50).seen_from(cloud)
    assert seen @ seen.T == pytest.approx(kernel(cloud, cloud), abs=1e-9)


def test_a_few_points_of_a_cloud_are_the_same_each_time():
    cloud = np.random.default_rng(2).normal(size=(200, 3))
    one, other = (Landmarks.among(cloud, 12) for _ in range(2))
    assert one.points.shape == (12, 3)
    assert np.array_equal(one.points, other.points)
    assert all((cloud == point).all(axis=1).any() for point in one.points)
    assert one.seen_from(cloud[:5]).shape == (5, 12)

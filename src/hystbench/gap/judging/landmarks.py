"""Radial basis functions about a few points of a cloud, made independent."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from hystbench.record import FloatArray

LEAST = 1e-12
"""Singular value below which a direction of the functions is none."""


@dataclass(frozen=True)
class Landmarks:
    """Points of a cloud, each with a function that falls off around it.

    Parameters
    ----------
    points : ndarray, shape (k, m)
    whitening : ndarray, shape (k, k)
        Takes the functions to ones whose products give the kernel [1]_.

    References
    ----------
    .. [1] C. K. I. Williams, M. Seeger, "Using the Nystroem method to speed up kernel
       machines", Advances in Neural Information Processing Systems 13 (2001) 682-688.
    """

    points: FloatArray
    whitening: FloatArray

    @classmethod
    def among(cls, cloud: FloatArray, count: int) -> Landmarks:
        """Take so many points of a cloud, shape (n, m), by chance but always the same.

        Of a smaller cloud all of them.
        """
        chosen = np.random.default_rng(0).permutation(len(cloud))[:count]
        points = cloud[chosen]
        left, size, right = np.linalg.svd(_kernel(points, points))
        root = np.sqrt(np.maximum(size, LEAST))
        return cls(points, (left / root) @ right)

    def seen_from(self, places: FloatArray) -> FloatArray:
        """Give the functions at places, shape (n, m): shape (n, k)."""
        return np.asarray(_kernel(places, self.points) @ self.whitening.T)


def _kernel(a: FloatArray, b: FloatArray) -> FloatArray:
    """Give a Gaussian of the distance of each pair, of as many spreads as columns."""
    squares = np.sum(a**2, axis=1)[:, None] - 2 * a @ b.T + np.sum(b**2, axis=1)
    return np.asarray(np.exp(-np.maximum(squares, 0.0) / a.shape[1]))

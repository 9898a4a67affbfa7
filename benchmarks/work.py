"""The work that all candidates do: a record of a play model."""

from __future__ import annotations

import numpy as np

from hystbench.envelope import PUBLISHED_ENVELOPE, thresholds
from hystbench.filters import FILTERS, AdaptiveFilter
from hystbench.operators import generalized_prandtl_ishlinskii
from hystbench.record import FloatArray

ORDER = 30  # the paper's
AMPLITUDE = 0.632  # A, the paper's sines
BOUND_SAMPLES = 20_000  # of the record, on which Eq. 19's bound is computed


def record(samples: int, seed: int = 1) -> tuple[FloatArray, FloatArray]:
    """Input (A) and output of a play model with noise of 1 %, seeded.

    The input is white: Eq. 19 bounds step sizes in the mean, and under sines the power
    of the taps swings so far about its mean that half the bound may diverge.
    """
    rng = np.random.default_rng(seed)
    u = rng.uniform(-AMPLITUDE, AMPLITUDE, samples)
    envelopes = PUBLISHED_ENVELOPE.left(u), PUBLISHED_ENVELOPE.right(u)
    r = thresholds(PUBLISHED_ENVELOPE, AMPLITUDE, 10)
    y = generalized_prandtl_ishlinskii(*envelopes, r, np.linspace(2.0, 0.2, 11))
    return u, y + 0.01 * np.std(y) * rng.standard_normal(samples)


def adaptive(
    name: str, x: FloatArray, fraction: float, order: int = ORDER
) -> AdaptiveFilter:
    """Make a filter with a fraction of Eq. 19's bound as its step size.

    The Volterra filter's two parts take half of the fraction each.
    """
    options: dict[str, float] = {"order": order, "step_size": 1.0}
    if name in ("gpo", "backlash"):
        options["amplitude"] = AMPLITUDE
    sample = x[:BOUND_SAMPLES]
    if name != "volterra":
        bound = FILTERS[name](**options).bound(sample).bound
        return FILTERS[name](**options | {"step_size": float(fraction * bound)})
    power = np.convolve(sample**2, np.ones(order + 1))[: len(sample)]
    steps = {
        "step_size": float(fraction / 2 / power.mean()),
        "second_order_step": float(fraction / 2 / (power**2).mean()),
    }
    return FILTERS[name](**options | steps)

"""Kernels, plain loops and the C reference say the same; nothing here takes a time."""

import numpy as np
import pytest
from benchmarks.compiled import BUILDS, CReference, flags
from benchmarks.reference import Adapted
from benchmarks.work import AMPLITUDE, adaptive, record

from benchmarks import reference
from hystbench.envelope import PUBLISHED_ENVELOPE, thresholds
from hystbench.operators import (
    generalized_prandtl_ishlinskii,
    rate_dependent_prandtl_ishlinskii,
)

ORDER = 30
WITH_LOOPS = ("backlash", "delayed", "gpo", "volterra")
"""Filters that benchmarks/reference.py has a plain loop of: those of the paper."""


@pytest.fixture(scope="module")
def signals():
    return record(4000)


def plain(name, x, d, each):
    if name == "delayed":
        return reference.lms(x, d, each.order, each.step_size)
    if name == "volterra":
        steps = each.step_size, each.second_order_step
        return reference.volterra(x, d, each.order, *steps)
    envelope = PUBLISHED_ENVELOPE if name == "gpo" else None
    return reference.play_lms(
        x, d, each.order, each.step_size, each.thresholds, envelope
    )


def compiled(name, x, d, each, build, other):
    c = CReference(build, each.order)
    if name == "delayed":
        return c.lms(x, d, each.step_size, ahead=other)
    if name == "volterra":
        return c.volterra(x, d, each.step_size, each.second_order_step, fused=other)
    envelope = PUBLISHED_ENVELOPE if name == "gpo" else None
    return c.play_lms(x, d, each.step_size, each.thresholds, envelope, ahead=other)


@pytest.mark.parametrize("name", WITH_LOOPS)
@pytest.mark.parametrize("fraction", [0.01, 0.1, 0.5])
@pytest.mark.parametrize("order", [4, ORDER])
def test_filters_are_the_plain_loops_up_to_half_the_bound(
    name, fraction, order, signals
):
    each = adaptive(name, signals[0], fraction, order)
    result = each.run(*signals)
    assert result.diverged_at is None
    expected = plain(name, *signals, each)
    assert reference.equal(Adapted(result.output, result.weights), expected)


@pytest.mark.parametrize("name", WITH_LOOPS)
@pytest.mark.parametrize("build", BUILDS)
@pytest.mark.parametrize("other", [False, True])
def test_the_c_reference_is_the_plain_loops(name, build, other, signals):
    x, d = signals[0].copy(), signals[1]
    x[1000:1100] = x[1000]  # a hold: no envelope pushes
    each = adaptive(name, x, 0.5, ORDER)
    found = compiled(name, x, d, each, build, other)
    assert reference.equal(found, plain(name, x, d, each))


def test_simulations_are_the_plain_loops(signals):
    x, _ = signals
    r = thresholds(PUBLISHED_ENVELOPE, AMPLITUDE, ORDER)
    weights = np.linspace(2.0, 0.2, ORDER + 1)
    given = PUBLISHED_ENVELOPE.left(x), PUBLISHED_ENVELOPE.right(x), r, weights
    expected = reference.prandtl_ishlinskii(*given)
    for found in (
        generalized_prandtl_ishlinskii(*given),
        CReference("C, same flags", ORDER).prandtl_ishlinskii(*given),
    ):
        np.testing.assert_allclose(found, expected, rtol=1e-12, atol=1e-12)
    spacing = 0.02 + 0.01 * np.abs(np.sin(np.arange(len(x))))
    given = spacing, np.exp(-2 * spacing), ORDER + 1
    found, _ = rate_dependent_prandtl_ishlinskii(x, x, *given)
    expected = reference.rate_dependent(x, *given)
    np.testing.assert_allclose(found, expected, rtol=1e-12, atol=1e-12)
    found = CReference("C, same flags", ORDER).rate_dependent(x, *given[:2])
    np.testing.assert_allclose(found, expected, rtol=1e-12, atol=1e-12)


def test_unequal_results_are_told():
    one = Adapted(np.ones(3), np.ones(2))
    assert reference.equal(one, one)
    assert not reference.equal(one, Adapted(np.ones(3), np.array([1, 1 + 1e-8])))
    assert not reference.equal(one, Adapted(np.ones(2), np.ones(2)))


def test_the_reference_has_the_flags_of_the_kernels():
    found = flags()
    assert {"-O3", "-march=native", "-fno-trapping-math"} <= set(found)
    assert "-ffast-math" not in found
    assert "-ffinite-math-only" not in found

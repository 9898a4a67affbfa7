"""The benchmark of Algorithm 1: a search may be on fewer samples, its end is not."""

import numpy as np
import pytest
from benchmarks.identification import LOW, Fit

from benchmarks import reference
from hystbench.envelope import PUBLISHED_ENVELOPE, thresholds
from hystbench.record import Channel, Record

SAMPLES = 4000


@pytest.fixture
def slow():
    time = np.linspace(0, 2, SAMPLES)
    u = 2.0 * np.sin(2 * np.pi * time)
    channels = Channel("current", "A"), Channel("displacement", "um")
    return Record("a", 0.5e-3, u, u + 0.3 * np.cos(9 * time), *channels, "twin")


def point(weight):
    envelope = list(PUBLISHED_ENVELOPE.to_dict().values())
    return np.concatenate((envelope, np.full(len(LOW) - 8, weight)))


def plain_relative_error(slow, weight):
    u, y, weights = slow.u, slow.y, point(weight)[8:]
    r = thresholds(PUBLISHED_ENVELOPE, np.abs(u).max(), len(weights) - 1)
    left, right = PUBLISHED_ENVELOPE.left(u), PUBLISHED_ENVELOPE.right(u)
    model = reference.prandtl_ishlinskii(left, right, r, weights)
    return np.linalg.norm(model - y) / np.linalg.norm(y)


@pytest.mark.parametrize("samples", [None, 200])
def test_the_best_point_is_scored_on_the_whole_record(slow, samples):
    fit = Fit(slow, samples)
    lengths = {len(fit.error(point(weight))) for weight in (0.5, 0.05, 0.2)}
    assert fit.evaluations == 3
    (seen,) = lengths
    assert seen == SAMPLES if samples is None else seen <= 2 * samples
    found = {weight: plain_relative_error(slow, weight) for weight in (0.5, 0.05, 0.2)}
    assert fit.relative_error() == pytest.approx(min(found.values()), rel=1e-9)


def test_before_any_point_is_seen_there_is_no_model(slow):
    assert Fit(slow).relative_error() == pytest.approx(1.0)

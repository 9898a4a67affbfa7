"""Standard errors of what lies beside the chain, and how often they hold."""

import numpy as np
import pytest

from hystbench.gap.effects import effects
from hystbench.gap.fitting.state import Added, Free, ModelState
from hystbench.gap.fitting.uncertainty import beside_errors
from hystbench.gap.records.scored_samples import ScoredSamples
from tests.gap.made import record
from tests.gap.small import block, plain_score

COUNT, DT = 2000, 1e-3
LEVELS = (0.05, 0.1)
SLOPE, SIZE, HZ = 0.8, 0.3, 50.1


def state_of(effect, order, values, signal, seed):
    rng = np.random.default_rng(seed)
    time = np.arange(COUNT) * DT
    u = [rng.standard_normal(COUNT) for _ in LEVELS]
    records = tuple(
        record(
            each,
            3 * each + signal(time) + level * rng.standard_normal(COUNT),
            name=str(level),
            dt=DT,
        )
        for each, level in zip(u, LEVELS, strict=True)
    )
    sample = ScoredSamples(tuple(np.arange(COUNT) for _ in records))
    chain = (block("gain", value=3.0),)
    start = ModelState(chain, records, sample, free=(Free(0, "value"),)).settled()
    offered = (item.beside for item in effects()[effect].variants(start.simulation))
    beside = next(item for item in offered if item is not None and item.order == order)
    added = (Added(effect, "sensor", "", (), dict(values), 1.0),)
    return ModelState(
        chain, records, sample, start.free, added, ((beside, values),)
    ).settled()


def drifting(seed):
    return state_of("drift", 1, {}, lambda t: SLOPE * t, seed)


def humming(seed):
    values = {"frequency_hz": HZ}
    tone = lambda t: SIZE * np.sin(2 * np.pi * HZ * t + 0.4)  # noqa: E731
    return state_of("mains-pickup", 1, values, tone, seed)


def test_amplitudes_of_two_signals_are_shared_out_by_record():
    """Of a ramp one a record, of a tone two: in the order of the columns."""
    drift, tone = drifting(1), humming(1)
    both = ModelState(
        drift.chain, drift.records, drift.sample, beside=(*drift.beside, *tone.beside)
    )
    assert both.beside_columns.shape[1] == 6
    ramps, tones = both.by_signal(np.arange(6))
    assert ramps.tolist() == [[0], [1]]
    assert tones.tolist() == [[2, 3], [4, 5]]


def errors(state):
    (found,) = beside_errors(state, plain_score(state, 1e-9))
    return found


def test_the_slope_of_ramps_is_known_as_by_plain_least_squares():
    time = np.arange(COUNT) * DT
    each = [level / np.sqrt(np.sum(time**2)) for level in LEVELS]
    wanted = np.hypot(*each) / 2  # the mean of two ramps
    found = [errors(drifting(seed))["slope"] for seed in range(20)]
    assert np.mean(found) == pytest.approx(wanted, rel=0.15)


def test_a_tone_is_known_as_theory_says():
    """Of a sine in white noise: s sqrt(2/n) for the amplitude (Rife, Boorstyn 1974)."""
    each = [level * np.sqrt(2 / COUNT) for level in LEVELS]
    # The size given is the root of the mean of two squares.
    wanted = np.hypot(*each) / 2
    found = [errors(humming(seed)) for seed in range(20)]
    assert np.mean([item["amplitudes"][0] for item in found]) == pytest.approx(
        wanted, rel=0.15
    )
    # s sqrt(24 / n) / (2 pi A T), of each record; the two are weighed together.
    each = [
        level * np.sqrt(24 / COUNT) / (2 * np.pi * SIZE * COUNT * DT)
        for level in LEVELS
    ]
    wanted = 1 / np.sqrt(sum(x**-2 for x in each))
    assert np.mean([item["frequency_hz"] for item in found]) == pytest.approx(
        wanted, rel=0.15
    )
    # The phase is that at the first record's beginning: of its middle, and of the way
    # from there at a frequency that is uncertain.
    middle = LEVELS[0] * np.sqrt(2 / COUNT) / SIZE
    wanted = np.hypot(middle, 2 * np.pi * wanted * COUNT * DT / 2)
    assert np.mean([item["phases"][0] for item in found]) == pytest.approx(
        wanted, rel=0.15
    )


def test_without_anything_beside_there_is_nothing_to_say():
    state = drifting(0)
    plain = ModelState(state.chain, state.records, state.sample).settled()
    assert beside_errors(plain, plain_score(plain)) == []

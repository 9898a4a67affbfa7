"""Standard errors beside plain weighted least squares, and how often they hold."""

import statistics

import numpy as np
import pytest
import scipy.stats

from hystbench.gap.fitting.score import Score
from hystbench.gap.fitting.state import Free, ModelState
from hystbench.gap.fitting.uncertainty import (
    SAMPLES,
    Pieces,
    between_records,
    on_more_samples,
    standard_errors,
)
from hystbench.gap.records.scored_samples import ScoredSamples
from tests.gap.made import record
from tests.gap.small import block, chains, plain_score, state_of

GAIN = 3.0
LEVELS = (0.05, 0.3)
"""RMS of the white noise of each record."""
COUNT = 2000


def inputs():
    rng = np.random.default_rng(1)
    return [rng.standard_normal(COUNT) for _ in LEVELS]


def noisy(seed):
    rng = np.random.default_rng(seed)
    return tuple(
        record(u, GAIN * u + level * rng.standard_normal(COUNT), name=f"{level}")
        for u, level in zip(inputs(), LEVELS, strict=True)
    )


def one_number(records, at=GAIN):
    sample = ScoredSamples(tuple(np.arange(len(one)) for one in records))
    chain = (block("gain", value=at),)
    return ModelState(chain, records, sample, free=(Free(0, "value"),)).settled()


def plain():
    """Weighted least squares of a gain, the noise being known."""
    terms = zip(inputs(), LEVELS, strict=True)
    return 1 / np.sqrt(sum(np.sum(u**2) / level**2 for u, level in terms))


def test_errors_are_those_of_weighted_least_squares_and_hold_as_often():
    seeds = 200
    found, inside = [], 0
    weights = np.repeat([1 / level**2 for level in LEVELS], COUNT)
    for seed in range(seeds):
        records = noisy(seed)
        u, y = (np.concatenate([getattr(one, k) for one in records]) for k in "uy")
        estimate = np.sum(weights * u * y) / np.sum(weights * u**2)
        state = one_number(records, estimate)
        (error,) = standard_errors(state, plain_score(state, 1e-9))
        found.append(error)
        inside += abs(estimate - GAIN) < 2 * error
    # Each comes of 40 stretches: it scatters by a ninth, their mean by a hundredth.
    assert np.mean(found) == pytest.approx(plain(), rel=0.05)
    assert np.std(found) < 0.25 * plain()
    # Two errors hold 95 %: of 200, fewer than 178 or all are rarer than 1 in 1000.
    assert 178 <= inside <= 199


def test_what_reshaping_could_do_widens_the_errors_where_it_is_needed():
    """A direction that the residual fills counts as fitted; an empty one does not."""
    u = inputs()[0]
    noise = 0.1 * np.random.default_rng(5).standard_normal(COUNT)
    # Nine tenths of the direction are the gain's own column.
    other = np.random.default_rng(6).standard_normal(COUNT)
    other -= u * (u @ other) / (u @ u)
    share = 0.9
    direction = share * u / np.linalg.norm(u) + np.sqrt(
        1 - share**2
    ) * other / np.linalg.norm(other)
    found = {}
    for size in (0.0, 1e4):
        y = GAIN * u + noise + size * direction
        # Least squares of gain and direction, so that the gain stays where it is.
        state = one_number((record(u, y),))
        score = Score(state.sample, direction[:, None], 0.1**2)
        (found[size],) = standard_errors(state, score)
    plainly = 0.1 / np.linalg.norm(u)
    assert found[0.0] == pytest.approx(plainly, rel=0.4)
    # What is left of the column beside the direction has sqrt(1 - share^2) of its size.
    assert found[1e4] == pytest.approx(plainly / np.sqrt(1 - share**2), rel=0.4)


def test_errors_grow_where_neighbours_are_alike():
    """Noise that is the same over ten samples is a tenth of the facts."""
    seeds, found = 20, {"white": [], "held": []}
    for seed in range(seeds):
        rng = np.random.default_rng(seed)
        u = np.repeat(inputs()[0][: COUNT // 10], 10)
        noise = {
            "white": rng.standard_normal(COUNT),
            "held": np.repeat(rng.standard_normal(COUNT // 10), 10),
        }
        for kind, one in noise.items():
            state = one_number((record(u, GAIN * u + 0.1 * one),))
            found[kind] += standard_errors(state, plain_score(state, 1e-9)).tolist()
    ratio = np.mean(found["held"]) / np.mean(found["white"])
    assert ratio == pytest.approx(np.sqrt(10), rel=0.2)


def test_without_free_numbers_there_are_no_errors():
    state = state_of(chains()["gain"])
    assert standard_errors(state, plain_score(state)).shape == (0,)


def test_more_samples_change_the_sample_alone():
    state = state_of(chains()["hysteresis"], count=50, free=(Free(0, "weights", 0),))
    more = on_more_samples(state)
    assert len(more.sample) == sum(min(SAMPLES, len(one)) for one in state.records)
    assert (more.chain, more.free) == (state.chain, state.free)


def test_a_number_that_is_zero_has_an_error_like_any_other():
    """An offset at zero: of white noise, its error is that of a mean."""
    level = LEVELS[0]
    u = inputs()[0]
    made = (
        record(u, GAIN * u + level * np.random.default_rng(8).standard_normal(COUNT)),
    )
    sample = ScoredSamples((np.arange(COUNT),))
    found = []
    for offset in (0.0, 1e-6):
        chain = (block("gain", value=GAIN, offset=offset),)
        free = (Free(0, "value"), Free(0, "offset"))
        state = ModelState(chain, made, sample, free=free).settled()
        found.append(standard_errors(state, plain_score(state, 1e-9)))
    # Twenty stretches tell it to a sixth of itself.
    assert found[0][1] == pytest.approx(level / np.sqrt(COUNT), rel=0.5)
    assert found[0] == pytest.approx(found[1], rel=1e-2)


def test_a_zero_of_which_the_records_say_nothing_has_none():
    """The second of two gains in series is zero, so the first does nothing."""
    u = inputs()[0]
    made = (record(u, 0.1 * u),)
    chain = (block("gain", value=GAIN, offset=0.0), block("gain", value=0.0))
    free = (Free(0, "offset"), Free(1, "value"))
    state = ModelState(
        chain, made, ScoredSamples((np.arange(COUNT),)), free=free
    ).settled()
    nothing, something = standard_errors(state, plain_score(state, 1e-9))
    assert np.isnan(nothing)
    assert np.isfinite(something)


def pieces_of(records):
    """Each record a pair of columns and what they are fitted to, all of weight one."""
    whole = [np.concatenate(each) for each in zip(*records, strict=True)]
    sizes = np.linalg.lstsq(*whole, rcond=None)[0]
    records = [(columns, target - columns @ sizes) for columns, target in records]
    return Pieces(
        [columns.T @ columns for columns, _ in records],
        [columns * residual[:, None] for columns, residual in records],
    )


def alike_but(told, off):
    """Six records of two columns, alike in all but `told`; in `off` of another size."""
    rng = np.random.default_rng(3)
    made = []
    for number in range(6):
        one, other = rng.normal(size=(2, 200))
        other = other if number in told else one + 2e-4 * other
        residual = 0.05 * rng.normal(size=200) + off.get(number, 0.0) * one
        made.append((np.column_stack([one, other]), residual))
    return pieces_of(made)


def test_the_only_record_that_tells_two_effects_apart_does_not_disagree():
    pieces = alike_but(told={2}, off={})
    for uncounted in (0, 1):
        assert np.sqrt(between_records(pieces, uncounted)[0]) < 0.5
    # two that disagree are one more than is forgiven
    pieces = alike_but(told=set(range(6)), off={1: 4.0, 4: -4.0})
    assert np.sqrt(between_records(pieces, uncounted=1)[0]) > 0.5


def test_records_left_uncounted_are_those_that_move_a_number_most():
    rng = np.random.default_rng(5)
    records = [(rng.normal(size=(50, 2)), rng.normal(size=50)) for _ in range(7)]
    refitted = []
    for left in range(7):
        rest = [item for k, item in enumerate(records) if k != left]
        columns = np.vstack([item[0] for item in rest])
        target = np.concatenate([item[1] for item in rest])
        refitted.append(np.linalg.lstsq(columns, target, rcond=None)[0])
    for k in (0, 1):
        values = [each[k] for each in refitted]
        middle = statistics.median(values)
        kept = sorted(values, key=lambda value: abs(value - middle))[:5]
        wider = scipy.stats.t.ppf(0.975, 4) / scipy.stats.norm.ppf(0.975)
        wanted = 4 * statistics.pvariance(kept) * wider**2
        found = between_records(pieces_of(records), uncounted=2)[k]
        assert found == pytest.approx(wanted, rel=1e-6)


def test_too_few_records_that_count_tell_nothing_of_how_they_differ():
    pieces = alike_but(told=set(range(6)), off={1: 2.0})
    few = Pieces(pieces.normals[:4], pieces.pushes[:4])
    assert between_records(few).min() > 0
    assert between_records(few, uncounted=1).tolist() == [0.0, 0.0]


def test_a_record_that_tells_a_number_alone_is_none_that_others_disagree_with():
    """Of five records the last one alone shows the second number."""
    normals = [np.diag([1.0, 1e-3]) for _ in range(4)] + [np.diag([1.0, 10.0])]
    rng = np.random.default_rng(0)
    pushes = [1e-2 * rng.standard_normal((3, 2)) for _ in range(4)]
    far = np.full((3, 2), 1.0)  # it pulls both far
    first, second = np.sqrt(between_records(Pieces(normals, [*pushes, far])))
    assert first > 0.5
    alike = [np.diag([1.0, 1e-3])] * 4
    assert second == pytest.approx(0.0, abs=0.1)
    assert np.sqrt(between_records(Pieces([*alike, alike[0]], [*pushes, far]))[1]) > 100

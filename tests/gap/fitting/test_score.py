"""The score beside its formula in plain NumPy, and amplitudes beside plain minimisers.

The constants of the score are read from the module: they are tuned, the formula is not.
"""

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from scipy import optimize

from hystbench.gap.fitting import score as scores
from hystbench.gap.fitting.held import Held
from hystbench.gap.fitting.score import Score
from hystbench.gap.records.scored_samples import ScoredSamples
from tests.gap.made import record

SEEDS = st.integers(0, 2**32 - 1)


def sample_of(lengths):
    return ScoredSamples(tuple(np.arange(n) for n in lengths))


def weights_of(lengths):
    """What each record counts as: on average the same, and by its samples."""
    weight = max(scores.RECORD_WEIGHT, scores.LEAST_WEIGHT / len(lengths))
    return weight * np.array(lengths) / np.mean(lengths)


def formula(residual, lengths, directions, floor, freedom):
    """The formula of the module's docstring, loop by loop."""
    weights = weights_of(lengths)
    count = directions.shape[1]
    amplitudes = np.linalg.lstsq(directions, residual, rcond=None)[0]
    rest = residual - directions @ amplitudes
    total, first = 0.0, 0
    for n, weight in zip(lengths, weights, strict=True):
        total += weight * np.log(max(np.mean(rest[first : first + n] ** 2), floor))
        first += n
    if count:
        total += count * np.log(max(np.sum(amplitudes**2) / count, floor))
    return total + scores.PARAMETER * freedom


def problem(seed, columns=2, directions=3, noise=0.05):
    """A residual that is columns, reshaping and noise of its own size a record."""
    rng = np.random.default_rng(seed)
    lengths = rng.integers(40, 120, size=rng.integers(1, 5))
    if rng.random() < 0.5:
        lengths[:] = lengths[0]  # records alike are reckoned with together
    n = int(lengths.sum())
    basis = np.linalg.qr(rng.standard_normal((n, directions)))[0]
    terms = rng.standard_normal((n, columns)) * 10.0 ** rng.uniform(-4, 4, columns)
    size = np.sqrt(np.mean(terms**2, axis=0))
    truth = rng.uniform(0.5, 2.0, columns) * rng.choice([-1, 1], columns) / size
    level = np.repeat(noise * rng.uniform(0.3, 3.0, len(lengths)), lengths)
    residual = terms @ truth + level * rng.standard_normal(n)
    residual += basis @ rng.standard_normal(directions)
    return lengths.tolist(), basis, terms, truth, residual


@given(SEEDS, st.floats(1e-8, 10.0), st.integers(0, 4), st.floats(0, 20))
def test_the_score_is_its_formula(seed, floor, directions, freedom):
    lengths, basis, _, _, residual = problem(seed, directions=directions)
    score = Score(sample_of(lengths), basis, floor)
    plain = formula(residual, lengths, basis, floor, freedom)
    assert score.of(residual, freedom) == pytest.approx(plain, rel=1e-9, abs=1e-9)


@given(SEEDS)
def test_reshaping_is_charged_and_not_free(seed):
    lengths, basis, _, _, residual = problem(seed)
    score = Score(sample_of(lengths), basis, 1e-9)
    one = residual + 100.0 * basis[:, 0]
    assert score.of(one) > score.of(residual)
    # Outside the directions the same power costs far more: there it is a gap.
    rng = np.random.default_rng(seed)
    other, _ = score.split(rng.standard_normal(len(residual)))
    other *= 100.0 / np.linalg.norm(other)
    assert score.of(residual + other) > score.of(one)


@given(SEEDS, st.floats(0.0, 10.0))
def test_nothing_below_the_floor_counts(seed, freedom):
    lengths, basis, _, _, residual = problem(seed)
    score = Score(sample_of(lengths), basis, 1e6)
    assert score.of(residual, freedom) == score.of(0 * residual, freedom)


@given(SEEDS, st.integers(1, 3))
@settings(max_examples=25)
def test_amplitudes_minimise_the_formula(seed, columns):
    lengths, basis, terms, truth, residual = problem(seed, columns)
    floor = 1e-6
    score = Score(sample_of(lengths), basis, floor)
    found = score.amplitudes(residual, terms, 3.0)

    def value(relative):
        return formula(
            residual - terms @ (relative * truth), lengths, basis, floor, 3.0
        )

    assert found.score == pytest.approx(value(found.values / truth), abs=1e-6)
    # A sum of logarithms has several valleys; the true one is looked for from the truth
    # and from nothing.
    best = min(
        optimize.minimize(value, start, method="Nelder-Mead", options=PRECISE).fun
        for start in (np.ones(columns), np.full(columns, 0.5))
    )
    # Far below what tells two effects apart.
    assert found.score < best + 0.5


@given(SEEDS, st.booleans())
@settings(max_examples=40)
def test_on_a_fold_amplitudes_are_judged_by_what_counts(seed, whole):
    lengths, basis, terms, _, residual = problem(seed)
    rng = np.random.default_rng(seed)
    used = [rng.random(n) < 0.6 for n in lengths]
    if whole:
        used = [np.full(n, k != 1) for k, n in enumerate(lengths)]
    floor = 1e-6
    score = Score(sample_of(lengths), basis, floor, tuple(used))
    found = score.amplitudes(residual, terms, 3.0)
    left = residual - terms @ found.values
    inside = basis.T @ left
    rest = np.split(left - basis @ inside, np.cumsum(lengths)[:-1])
    squares = [np.mean(r[u] ** 2) for r, u in zip(rest, used, strict=True) if u.any()]
    weights = weights_of(lengths)[[bool(u.any()) for u in used]]
    value = np.sum(weights * np.log(np.maximum(squares, floor)))
    value += 3 * np.log(max(inside @ inside / 3, floor)) + scores.PARAMETER * 3.0
    assert found.score == pytest.approx(value, abs=1e-6)
    for change in (0.99, 1.01):
        worse = residual - terms @ (change * found.values)
        assert score.of(worse, 3.0) > found.score - 0.5


@given(SEEDS)
@settings(max_examples=40)
def test_columns_that_say_the_same_are_shared_out(seed):
    lengths, basis, terms, _, residual = problem(seed)
    score = Score(sample_of(lengths), basis, 1e-6)
    once = score.amplitudes(residual, terms)
    twice = score.amplitudes(residual, np.hstack([terms, terms[:, :1]]))
    assert twice.score == pytest.approx(once.score, abs=0.01)
    assert np.isfinite(twice.values).all()


PRECISE = {"xatol": 1e-6, "fatol": 1e-6, "maxiter": 2000}


@given(SEEDS)
@settings(max_examples=40)
def test_amplitudes_never_score_worse_than_none(seed):
    rng = np.random.default_rng(seed)
    lengths, basis, _, _, residual = problem(seed)
    score = Score(sample_of(lengths), basis, 1e-6)
    terms = rng.standard_normal((len(residual), 3))
    stiffness, moved = rng.uniform(0, 10, 3), rng.standard_normal(3)
    found = score.amplitudes(residual, terms, 1.0, Held(stiffness, moved))
    nothing = score.of(residual, 1.0) + stiffness @ moved**2
    assert found.score <= nothing + 1e-9
    assert found.score == pytest.approx(
        formula(residual - terms @ found.values, lengths, basis, 1e-6, 1.0)
        + stiffness @ (moved + found.values) ** 2
    )


@given(SEEDS)
@settings(max_examples=40)
def test_columns_that_many_calls_share_are_held_as_those_of_one(seed):
    rng = np.random.default_rng(seed)
    lengths, basis, _, _, residual = problem(seed)
    # In metres a micrometre is little: no unit may change what is told apart.
    unit = 10.0 ** rng.uniform(-8, 3)
    terms, residual = unit * rng.standard_normal((len(residual), 4)), unit * residual
    score = Score(sample_of(lengths), basis, 1e-6 * unit**2)
    held = Held(rng.uniform(0, 10, 4), rng.standard_normal(4))
    own, theirs = (Held(*(x[part] for x in held)) for part in (slice(2), slice(2, 4)))
    whole = score.amplitudes(residual, terms, 1.0, held)
    beside = score.shared(terms[:, 2:], theirs)
    found = score.amplitudes(residual, terms[:, :2], 1.0, own, beside=beside)
    assert found.score == pytest.approx(whole.score)
    assert found.values == pytest.approx(whole.values[:2], rel=1e-4, abs=1e-7)


def test_a_step_from_here_is_charged_beside_the_distance_from_a_place():
    """s (x + m)^2 + d x^2, less what it is at best."""
    s, m, d, x = 3.0, 0.7, 2.0, np.linspace(-2, 2, 9)
    both = Held(np.array([s]), np.array([m])).in_steps(np.array([d]))
    charge = both.stiffness * (both.moved + x) ** 2
    whole = s * (x + m) ** 2 + d * x**2
    np.testing.assert_allclose(charge - charge[0], whole - whole[0])


@given(SEEDS)
def test_of_one_record_amplitudes_are_least_squares(seed):
    rng = np.random.default_rng(seed)
    terms = rng.standard_normal((60, 3))
    residual = terms @ rng.standard_normal(3) + rng.standard_normal(60)
    score = Score(sample_of([60]), np.zeros((60, 0)), 1e-9)
    plain = np.linalg.lstsq(terms, residual, rcond=None)[0]
    assert score.amplitudes(residual, terms).values == pytest.approx(plain, abs=1e-8)


@given(SEEDS)
@settings(max_examples=40)
def test_amplitudes_that_may_not_be_negative(seed):
    # Orthogonal columns: then least squares without the negative ones is the optimum.
    rng = np.random.default_rng(seed)
    terms = np.linalg.qr(rng.standard_normal((60, 4)))[0]
    residual = terms @ rng.standard_normal(4) + 0.3 * rng.standard_normal(60)
    score = Score(sample_of([60]), np.zeros((60, 0)), 1e-9)
    found = score.amplitudes(residual, terms, positive=range(4)).values
    plain, _ = optimize.nnls(terms, residual)
    assert found == pytest.approx(plain, abs=1e-8)


@given(SEEDS)
@settings(max_examples=40)
def test_columns_alike_keep_their_sign(seed):
    rng = np.random.default_rng(seed)
    common = rng.standard_normal((80, 1))
    terms = common + 0.3 * rng.standard_normal((80, 4))
    residual = terms @ rng.uniform(-1, 1, 4) + rng.standard_normal(80)
    score = Score(sample_of([80]), np.zeros((80, 0)), 1e-9)
    found = score.amplitudes(residual, terms, positive=(1, 3)).values
    assert (found[[1, 3]] >= 0).all()


@given(SEEDS, st.floats(0.01, 100.0))
@settings(max_examples=40)
def test_a_tolerance_holds_an_amplitude_back(seed, stiffness):
    rng = np.random.default_rng(seed)
    column = rng.standard_normal(50)
    residual = column + 0.3 * rng.standard_normal(50)
    score = Score(sample_of([50]), np.zeros((50, 0)), 1e-9)
    found = score.amplitudes(
        residual, column[:, None], held=Held.here(np.array([stiffness]))
    )

    def value(x):
        return formula(residual - x * column, [50], np.zeros((50, 0)), 1e-9, 0.0) + (
            stiffness * x**2
        )

    # The valley of the logarithm and that of the tolerance: both are looked into.
    best = min(
        optimize.minimize_scalar(value, bounds=bounds, method="bounded").fun
        for bounds in ((-0.5, 0.5), (0.5, 1.5))
    )
    assert found.score < best + 0.5


@given(SEEDS, st.floats(0.1, 1e4))
def test_what_is_held_counts_by_how_far_samples_tell_it(seed, stiffness):
    """By the second difference of the score, at a residual that the column leaves."""
    rng = np.random.default_rng(seed)
    column, residual = rng.standard_normal((2, 60))
    column -= residual * (residual @ column) / (residual @ residual)
    score = Score(sample_of([60]), np.zeros((60, 0)), 1e-9)
    step = 1e-3
    told = (score.of(residual + step * column) - score.of(residual)) / step**2

    def counted(columns, held):
        return score.numbers_told(residual, columns, Held.here(np.array(held)))

    one = counted(column[:, None], [stiffness])
    assert one == pytest.approx(told / (told + stiffness), rel=1e-3)
    # A number that is split is told no better.
    halves = np.column_stack([column, column]) / 2
    assert counted(halves, [stiffness / 2] * 2) == pytest.approx(one)
    assert counted(column[:, None], [0.0]) == pytest.approx(1.0)
    assert counted(np.zeros((60, 1)), [stiffness]) == pytest.approx(0.0)


def test_columns_that_are_nothing_or_run_away():
    score = Score(sample_of([30]), np.zeros((30, 0)), 1e-9)
    residual = np.random.default_rng(0).standard_normal(30)
    nothing = score.amplitudes(residual, np.zeros((30, 1)))
    assert np.isfinite(nothing.values).all()
    assert nothing.score == pytest.approx(score.of(residual))
    none = score.amplitudes(residual, np.zeros((30, 0)))
    assert none.score == score.of(residual)
    gone = score.amplitudes(np.full(30, np.nan), np.zeros((30, 0)))
    assert gone.score == np.inf  # nan would be less than nothing, and not more
    with np.errstate(all="ignore"):  # the squares of what runs away overflow
        for size in (np.inf, 1e200):
            away = score.amplitudes(residual, np.full((30, 1), size))
            assert away.score == np.inf or away.score <= score.of(residual)


@given(st.lists(st.integers(1, 3000), min_size=1, max_size=4), st.integers(1, 1500))
def test_a_sample_takes_one_of_each_equal_stretch(lengths, count):
    assume(all(n > 1 for n in lengths))
    given_records = [record(np.arange(n, dtype=float)) for n in lengths]
    sample = ScoredSamples.of(given_records, count)
    assert len(sample) == sum(min(count, n) for n in lengths)
    taken = sample.take([one.u for one in given_records])
    for part, places, n in zip(sample.slices, sample.positions, lengths, strict=True):
        assert (taken[part] == places).all()
        assert (np.diff(places) > 0).all()
        stretches = places // (n / len(places) + 1e-12)
        assert abs(stretches - np.arange(len(places))).max() <= 1


def test_what_fits_a_short_record_alone_is_not_worth_what_fits_the_long_one():
    """A short step response was fitted to a thousandth, and the rest was left."""
    lengths = [197, 805]
    score = Score(sample_of(lengths), np.zeros((1002, 0)), 1e-8)
    short, both = (np.repeat(rms, lengths) for rms in ((0.003, 0.16), (0.034, 0.029)))
    assert score.of(both) < score.of(short)
    assert np.sum(score.weights) == pytest.approx(2 * score.weight)

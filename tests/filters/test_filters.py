"""Every filter against the paper's equations written out, and what all must keep."""

from dataclasses import dataclass, replace

import numpy as np
import pytest

from hystbench import published
from hystbench.envelope import PUBLISHED_ENVELOPE
from hystbench.errors import InputError
from hystbench.filters import FILTERS, AdaptiveFilter, run_many, together
from hystbench.filters.delayed import DelayedFilter
from hystbench.filters.gpo import GPOFilter
from hystbench.filters.together import CHUNK, run_together
from hystbench.record import FloatArray

OPTIONS = {
    "delayed": [{}, {"constant_tap": 0.3}],
    "backlash": [
        {"amplitude": 0.7},
        {"amplitude": 0.7, "structure": "current-input"},
        {"amplitude": 0.7, "form": "eq4", "initial_state": "settled", "x_before": 0.1},
        {"amplitude": 0.7, "constant_tap": 0.3},
    ],
    "gpo": [
        {"amplitude": 0.7},
        {"amplitude": 0.7, "form": "eq4", "x_before": -0.2},
        {"amplitude": 0.7, "initial_state": "settled", "x_before": 0.3},
        {"amplitude": 0.7, "constant_tap": 0.1},
    ],
    "volterra": [
        {"second_order_step": 1.0},
        {"second_order_step": 1.0, "x_before": 0.2},
        {"second_order_step": 1.0, "constant_tap": 0.3},
    ],
}
CASES = [(name, options) for name, several in OPTIONS.items() for options in several]


PLAYS = [case for case in CASES if case[0] in ("backlash", "gpo")]
NAMES = [f"{name}-{place}" for place, (name, _) in enumerate(CASES)]


@pytest.fixture(params=CASES, ids=NAMES)
def case(request):
    return request.param


def make(case, order, step_size=1e-3, **more):
    name, options = case
    return FILTERS[name](order=order, step_size=step_size, **options, **more)


@pytest.fixture
def signals():
    """Input of several tones and the output of a plant with memory and a bend."""
    k = np.arange(1500)
    x = 0.4 * np.sin(0.05 * k) + 0.2 * np.sin(0.31 * k + 1) + 0.1 * np.sin(1.7 * k)
    x[700:740] = x[700]  # a hold, for Eq. 12
    memory = np.convolve(x, 0.7 ** np.arange(40))[: len(x)]
    return x, memory + 0.5 * memory**2 + 0.05


def plain_regressors(case, adaptive, x):
    """Regressor of every sample, from the definitions alone, tap by tap."""
    name, options = case
    if options.get("constant_tap"):
        without = {k: v for k, v in options.items() if k != "constant_tap"}
        taps = plain_regressors((name, without), adaptive, x)
        constant = np.full((len(x), 1), options["constant_tap"])
        return np.hstack((taps, constant))
    order = adaptive.order
    before = options.get("x_before", 0.0)
    at = lambda k: x[k] if k >= 0 else before  # noqa: E731
    if name == "delayed":
        return np.array([[at(k - i) for i in range(order + 1)] for k in range(len(x))])
    if name == "volterra":
        taps = plain_regressors(("delayed", options), adaptive, x)
        return np.array([np.concatenate((h, np.outer(h, h).ravel())) for h in taps])
    if name == "gpo":
        e = PUBLISHED_ENVELOPE
        left = lambda v: e.a0 * np.tanh(e.a1 * v + e.a2) + e.a3  # noqa: E731
        right = lambda v: e.a4 * np.tanh(e.a5 * v + e.a6) + e.a7  # noqa: E731
    else:
        left = right = lambda v: v
    together = options.get("structure") == "current-input"
    h = np.zeros((len(x), order + 1))
    for i in range(order + 1):
        r = i / (order + 1) * max(left(0.7), right(0.7))
        w = 0.0
        if options.get("initial_state") == "settled":
            w = max(right(before) - r, min(left(before) + r, 0.0))
        for k in range(len(x)):
            now, last = (at(k), at(k - 1)) if together else (at(k - i), at(k - i - 1))
            low, high = right(now) - r, left(now) + r
            if options.get("form") == "eq4":
                w = max(low, min(high, w))
            elif now > last and low > w:
                w = low
            elif now < last and high < w:
                w = high
            h[k, i] = w
    return h


def plain_lms(h, d, mu):
    w, y = np.zeros(h.shape[1]), np.zeros(len(d))
    for k in range(len(d)):
        y[k] = w @ h[k]
        w = w + 2 * mu * (d[k] - y[k]) * h[k]
    return y, w


def near(actual, expected):
    scale = np.abs(expected).max()
    np.testing.assert_allclose(actual, expected, rtol=0, atol=1e-9 * scale)


def stable(case, order, x, share=None):
    """A filter at a share of Eq. 19's bound, for Volterra half of it in each part.

    The bound is on the mean. The power of products varies so much over a record
    that at half the bound single samples already overshoot: hence Volterra's tenth.
    """
    adaptive = make(case, order)
    name, options = case
    if name != "volterra":
        return make(case, order, (share or 0.5) * adaptive.bound(x).bound)
    first, second = (
        (share or 0.1) / 2 * bound for bound in adaptive.step_bounds(x).values()
    )
    return make((name, {**options, "second_order_step": second}), order, first)


# Below, at and above the width of the processor, and many of it.
@pytest.mark.parametrize("order", [0, 6, 7, 8, 53])
def test_equals_the_equations_written_out(case, order, signals):
    n = 1500
    if case[0] == "volterra" and order > 10:  # the plain loop takes its time
        n, order = 300, min(order, 34)
    x, d = signals[0][:n], signals[1][:n]
    adaptive = stable(case, order, x)
    h = plain_regressors(case, adaptive, x)
    y, w = plain_lms(h, d, adaptive.steps)
    result = adaptive.run(x, d)
    assert result.diverged_at is None
    near(result.output, y)
    near(result.weights, w)
    np.testing.assert_array_equal(result.error, d - result.output)


@pytest.mark.parametrize("order", [3, 30])
def test_regressor_equals_the_definitions(case, order, signals):
    x = signals[0][:200]
    adaptive = make(case, order)
    line = np.concatenate((np.full(adaptive.history, adaptive.x_before), x))
    h, _ = adaptive.whole_regressor(line, adaptive.start().operators)
    np.testing.assert_allclose(h, plain_regressors(case, adaptive, x), atol=1e-15)


def test_fused_loop_equals_the_general_one(case, signals):
    x, d = signals
    adaptive = stable(case, 9, x)
    whole = adaptive.run(x, d)
    general = type("General", (type(adaptive),), {"_adapt": AdaptiveFilter._adapt})
    plain = general(**vars(adaptive)).run(x, d)
    np.testing.assert_allclose(plain.output, whole.output, rtol=1e-10, atol=1e-12)
    np.testing.assert_allclose(plain.weights, whole.weights, rtol=1e-10, atol=1e-12)
    np.testing.assert_array_equal(plain.state.operators, whole.state.operators)


@pytest.mark.parametrize("order", [0, 7, 30])
def test_chunks_equal_the_whole(case, order, signals):
    x, d = signals
    adaptive = make(case, order, 1e-4)
    if case[0] == "volterra":
        name, options = case
        adaptive = make((name, {**options, "second_order_step": 1e-5}), order, 1e-4)
    whole = adaptive.run(x, d)
    state, output = adaptive.start(), []
    for part in np.split(np.arange(len(x)), [1, 2, 40, 41, 700, 1499]):
        result = adaptive.run(x[part], d[part], state)
        state = result.state
        output.append(result.output)
    # where a chunk ends a sum is cut in two, so the last bits may differ
    alike = {"rtol": 1e-12, "atol": 1e-13}
    np.testing.assert_allclose(np.concatenate(output), whole.output, **alike)
    np.testing.assert_allclose(state.weights, whole.weights, **alike)
    np.testing.assert_array_equal(state.operators, whole.state.operators)


def test_an_empty_chunk_changes_nothing(case, signals):
    x, d = signals
    adaptive = stable(case, 5, x)
    state = adaptive.run(x[:100], d[:100]).state
    result = adaptive.run([], [], state)
    assert result.diverged_at is None
    assert len(result.output) == 0
    np.testing.assert_array_equal(result.weights, state.weights)


def test_weights_given_at_the_start(signals):
    # any weights: Volterra's need not be symmetric
    x, d = signals[0][:200], signals[1][:200]
    rng = np.random.default_rng(5)
    for case in CASES:
        adaptive = stable(case, 6, x)
        start = rng.standard_normal(adaptive.size)
        result = adaptive.run(x, d, replace(adaptive.start(), weights=start))
        h = plain_regressors(case, adaptive, x)
        # the filter is linear in its weights: shift the target instead
        y, w = np.zeros(len(d)), start.copy()
        for k in range(len(d)):
            y[k] = w @ h[k]
            w = w + 2 * adaptive.steps * (d[k] - y[k]) * h[k]
        near(result.output, y)
        near(result.weights, w)


def test_a_filter_finds_the_weights_it_was_given(case):
    # the plant is the filter itself with known weights: no error is left
    rng = np.random.default_rng(3)
    x = rng.uniform(-0.6, 0.6, 60000)
    adaptive = stable(case, 2, x, 0.5)
    h = plain_regressors(case, adaptive, x[:20000])
    x = x[:20000]
    true = rng.standard_normal(adaptive.size)
    result = adaptive.run(np.tile(x, 3), np.tile(h @ true, 3))
    assert np.abs(result.error[-100:]).max() < 1e-3 * np.abs(result.error[:100]).max()


# --- how much of an error an update corrects


def test_an_update_corrects_the_share_of_the_error_that_is_told(case, signals):
    x, d = signals[0][:200], signals[1][:200]
    adaptive = stable(case, 6, x)
    rows = plain_regressors(case, adaptive, x)
    # By Eq. 18 alone: the error on the regressor that the update was made from.
    left = []
    for h, wanted in zip(rows, d, strict=True):
        w = 2 * adaptive.steps * wanted * h  # from weights of zero, e = d
        left.append(1 - (wanted - w @ h) / wanted)
    told = adaptive.correction(adaptive.largest_power(x))
    assert told == pytest.approx(max(left), rel=1e-9)


def test_a_constant_regressor_is_unstable_beyond_a_correction_of_two():
    x, d = np.full(400, 0.5), np.full(400, 2.0)
    for step_size, stays in ((1.99, True), (2.01, False)):
        adaptive = DelayedFilter(order=3, step_size=1.0, x_before=0.5)
        mu = step_size / adaptive.correction(adaptive.largest_power(x))
        error = replace(adaptive, step_size=mu).run(x, d).error
        assert (abs(error[-1]) < abs(error[0])) == stays


def test_taps_have_the_rms_of_their_definition(case, signals):
    x = signals[0][:200]
    adaptive = make(case, 6)
    taps = plain_regressors(case, adaptive, x)[:, :7]
    assert adaptive.tap_rms(x) == pytest.approx(np.sqrt(np.mean(taps**2)))


def test_a_constant_tap_finds_a_constant(signals):
    x = signals[0]
    adaptive = DelayedFilter(order=2, step_size=0.2, constant_tap=0.5)
    result = adaptive.run(x, 0.3 * x + 2.0)
    assert np.abs(result.error[-50:]).max() < 1e-3
    assert result.weights[-1] * 0.5 == pytest.approx(2.0, abs=1e-2)


# --- divergence


def test_a_step_size_beyond_the_bound_diverges_without_nan(case, signals):
    x, d = signals
    adaptive = make(case, 30, 1e3)
    result = adaptive.run(x, d)
    assert result.diverged_at is not None
    assert len(result.output) == len(result.error) == result.diverged_at
    assert (np.abs(result.error) <= 1e6 * np.abs(d).max()).all()
    assert np.isfinite(result.weights).all()


@pytest.mark.parametrize("step_size", [1e100, 1e300, 8e307])
def test_overflow_counts_as_divergence(case, step_size, signals, monkeypatch):
    # products beyond the largest double: infinities and NaN inside the loop
    monkeypatch.setattr(together, "LIMIT", 1e307)
    x, d = signals
    name, options = case
    if name == "volterra":
        case = name, {**options, "second_order_step": step_size}
    result = make(case, 30, step_size).run(x, d)
    assert result.diverged_at is not None
    assert np.isfinite(result.output).all()
    assert np.isfinite(result.error).all()
    assert np.isfinite(result.weights).all()


def test_overflow_in_the_last_update_counts_as_divergence(case):
    adaptive = make(case, 0, 8e307)
    result = adaptive.run([-0.6, 0.6], [0.0, 1e10])
    assert result.diverged_at == 2
    assert np.isfinite(result.weights).all()


def test_divergence_is_where_the_plain_loop_passes_the_limit(
    case, signals, monkeypatch
):
    x, d = signals
    monkeypatch.setattr(together, "LIMIT", 100 / np.abs(d).max())
    adaptive = stable(case, 6, x[:200], share=20.0)
    h = plain_regressors(case, adaptive, x[:200])
    w = np.zeros(adaptive.size)
    for k in range(200):
        e = d[k] - w @ h[k]
        if abs(e) > 100:
            break
        w = w + 2 * adaptive.steps * e * h[k]
    else:
        pytest.fail("the plain loop did not diverge")
    assert adaptive.run(x, d).diverged_at == k


def test_a_quiet_first_chunk_sets_no_limit_to_a_loud_second(signals):
    x, d = signals
    adaptive = make(CASES[0], 3, 1e-3)
    quiet = 1e-9 * d[:10]
    first = adaptive.run(x[:10], quiet)
    second = adaptive.run(x[10:], d[10:], first.state)
    assert np.abs(second.error).max() > 1e6 * np.abs(quiet).max()
    assert second.diverged_at is None
    assert second.state.largest == np.abs(d[10:]).max()


def test_the_limit_of_a_silent_record_is_that_of_one_in_its_unit(case):
    adaptive = make(case, 0, 1e-3)
    assert adaptive.run([1.0], [0.0]).diverged_at is None
    wild = replace(adaptive.start(), weights=np.full(adaptive.size, 1e8))
    assert adaptive.run([1.0], [0.0], wild).diverged_at == 0


def test_what_has_diverged_does_not_go_on(case, signals):
    x, d = signals
    adaptive = make(case, 30, 1e3)
    state = adaptive.run(x, d).state
    with pytest.raises(InputError, match="state: the filter has diverged"):
        adaptive.run(x, d, state)


@pytest.mark.parametrize("order", [100, 4095])
def test_high_orders_run(order, signals):
    x, d = signals
    for case in CASES:
        if case[0] == "volterra" and order > 100:
            continue  # seventeen million weights
        power = make(case, order).largest_power(x[:50])
        first = 0.1 / power
        name, options = case
        if name == "volterra":
            options = {**options, "second_order_step": first / power}
        adaptive = make((name, options), order, first)
        result = adaptive.run(x[:50], d[:50])
        # The first prediction is zero; what is learned makes later errors less.
        assert result.error[0] == d[0]
        assert np.abs(result.error[25:]).mean() < np.abs(d[25:50]).mean()


# --- Eq. 19


@pytest.mark.parametrize("order", [0, 4, 30])
def test_bound_by_plain_numpy(case, order, signals):
    x = signals[0][: 150 if order == 30 and case[0] == "volterra" else 1500]
    adaptive = make(case, order)
    h = plain_regressors(case, adaptive, x)
    correlation = h.T @ h / len(h)
    values = np.linalg.eigvalsh(correlation)
    bound = adaptive.bound(x)
    assert bound.size == len(values)
    assert bound.trace == pytest.approx(np.trace(correlation), rel=1e-12)
    assert bound.bound == pytest.approx(1 / np.trace(correlation), rel=1e-12)
    assert bound.largest == pytest.approx(values[-1], rel=1e-10)
    assert bound.bound <= 1 / bound.largest
    assert bound.rank <= np.linalg.matrix_rank(correlation, tol=1e-14 * values[-1])
    if case[0] == "volterra":
        taps = order + 1
        constant = "constant_tap" in case[1]
        ones = np.arange(h.shape[1]) < taps
        ones[-1] |= constant  # has the step size of the first-order weights
        parts = h[:, ones], h[:, ~ones]
        first, second = (np.mean(np.sum(part**2, axis=1)) for part in parts)
        bounds = adaptive.step_bounds(x)
        assert bounds["first_order"] == pytest.approx(1 / first, rel=1e-12)
        assert bounds["second_order"] == pytest.approx(1 / second, rel=1e-12)


def test_bound_of_white_input_by_hand():
    # x is -1 or 1 and white: R is near the identity, the bound near 1 / (N + 1)
    x = np.random.default_rng(2).choice([-1.0, 1.0], 200_000)
    bound = FILTERS["delayed"](order=3, step_size=1).bound(x)
    assert bound.trace == pytest.approx(4, rel=1e-4)
    assert bound.spread == pytest.approx(1, abs=0.03)
    assert bound.rank == 4


def test_spectrum_of_volterra_without_its_duplicates(signals):
    # 3 taps: 12 weights, 3 products twice, so rank 9 at most and 3 zeros at least
    x = np.random.default_rng(4).uniform(-1, 1, 5000)
    adaptive = make(("volterra", {"second_order_step": 1.0}), 2)
    h = plain_regressors(("volterra", {}), adaptive, x)
    values = np.linalg.eigvalsh(h.T @ h / len(h))
    bound = adaptive.bound(x)
    assert bound.rank == 9
    assert bound.smallest == 0
    assert bound.spread == np.inf
    assert bound.smallest_nonzero == pytest.approx(values[3], rel=1e-9)
    assert bound.spread_nonzero == pytest.approx(values[-1] / values[3], rel=1e-9)


def test_bound_of_a_constant_input():
    # all taps equal: one eigenvalue 4 * 0.25, the rest zero
    bound = FILTERS["delayed"](order=3, step_size=1, x_before=0.5).bound(
        np.full(50, 0.5)
    )
    assert bound.rank == 1
    assert bound.largest == pytest.approx(1.0)
    assert bound.spread_nonzero == pytest.approx(1.0)
    assert bound.spread == np.inf


def test_bound_of_a_zero_input():
    bound = FILTERS["delayed"](order=3, step_size=1).bound(np.zeros(50))
    assert (bound.trace, bound.rank, bound.bound) == (0, 0, np.inf)


@pytest.mark.parametrize("name", sorted(OPTIONS))
def test_mean_converges_below_the_margin_and_not_far_above(name):
    # E[v(k)] = (I - 2 M R)^k v(0): the largest eigenvalue of M R decides, not luck
    x = np.random.default_rng(6).uniform(-0.7, 0.7, 4000)
    case = (name, OPTIONS[name][0])
    adaptive = stable(case, 4, x, share=0.99)
    h = plain_regressors(case, adaptive, x)
    step = np.diag(adaptive.steps)
    values = np.linalg.eigvals(np.eye(adaptive.size) - 2 * step @ (h.T @ h / len(h)))
    assert np.abs(values).max() <= 1 + 1e-12
    # The largest eigenvalue is no less than the mean of all: there is no slack beyond.
    beyond = 1.01 * adaptive.size / 0.99 * step
    values = np.linalg.eigvals(np.eye(adaptive.size) - 2 * beyond @ (h.T @ h / len(h)))
    assert np.abs(values).max() > 1
    values = np.linalg.eigvals(step @ (h.T @ h / len(h)))
    assert values.real.sum() == pytest.approx(0.99)


# --- many at once


def test_many_at_once_are_the_same_bytes_with_any_number_of_workers(signals):
    x, d = signals
    jobs = [(stable(case, order, x, 0.1), x, d) for case in CASES for order in (3, 30)]
    one, two = run_many(jobs, workers=1), run_many(jobs, workers=2)
    again = [adaptive.run(x, d) for adaptive, _, _ in jobs]
    for a, b, c in zip(one, two, again, strict=True):
        assert a.output.tobytes() == b.output.tobytes() == c.output.tobytes()
        assert a.weights.tobytes() == b.weights.tobytes() == c.weights.tobytes()


@pytest.mark.parametrize("case", [CASES[0], *PLAYS, CASES[-1]])
@pytest.mark.parametrize("workers", [1, 2])
def test_step_sizes_together_are_the_same_bytes_as_each_alone(
    case, workers, monkeypatch
):
    # a burst late in a record longer than a chunk: some diverge there, some at once
    n = CHUNK + 3000
    rng = np.random.default_rng(8)
    x = 0.3 * np.sin(0.05 * np.arange(n)) + 0.05 * rng.standard_normal(n)
    d = x + 0.2 * x**2
    d[:50] += 1.0
    d[CHUNK + 500 :] += rng.uniform(-10, 10, n - CHUNK - 500)
    monkeypatch.setattr(together, "LIMIT", 20 / np.abs(d).max())
    first = stable(case, 6, x, 0.1)
    factors = [1e-3, 1e3, 0.1, 0.5, 30.0, 1e150, 1.0, *np.geomspace(0.01, 40, 40)]
    steps = [replace(first, step_size=first.step_size * f) for f in factors]
    others = [(replace(first, order=5), x, d), (first, d, x)]
    jobs = [*((each, x, d) for each in steps), *others, (steps[0], x.copy(), d)]
    jobs = [jobs[k] for k in rng.permutation(len(jobs))]
    ends = set()
    for (alone, u, y), found in zip(jobs, run_many(jobs, workers), strict=True):
        expected = alone.run(u, y)
        at = expected.diverged_at
        ends.add("never" if at is None else f"chunk {at // CHUNK}")
        assert found.diverged_at == expected.diverged_at
        for key in ("output", "error", "weights"):
            assert getattr(found, key).tobytes() == getattr(expected, key).tobytes()
        for key in ("weights", "past", "operators"):
            one, other = getattr(found.state, key), getattr(expected.state, key)
            assert one.tobytes() == other.tobytes()
    assert ends == {"never", "chunk 0", "chunk 1"}


def test_step_sizes_together_follow_the_equations(signals):
    x, d = signals
    for case in PLAYS:
        first = stable(case, 6, x, 0.1)
        h = plain_regressors(case, first, x)
        steps = [replace(first, step_size=first.step_size * f) for f in (1, 2, 0.3)]
        found = run_many([(each, x, d) for each in steps], workers=1)
        for each, result in zip(steps, found, strict=True):
            y, w = plain_lms(h, d, each.step_size)
            near(result.output, y)
            near(result.weights, w)


def batches_of(jobs, monkeypatch, workers=1):
    """Give the filters of each call of the loop."""
    asked = []

    def noted(filters, *rest):
        asked.append(list(filters))
        return run_together(filters, *rest)

    monkeypatch.setattr(together, "run_together", noted)
    run_many(jobs, workers)
    return asked


def test_filters_that_differ_in_more_than_the_step_size_run_apart(signals, monkeypatch):
    gpo = stable(("gpo", {"amplitude": 1.0}), 3, signals[0], 0.1)
    others = [
        replace(gpo, order=4),
        replace(gpo, amplitude=0.5),
        replace(gpo, envelope=replace(gpo.envelope, a3=gpo.envelope.a3 + 0.1)),
        replace(gpo, x_before=0.1),
        DelayedFilter(order=3, step_size=0.1),
    ]
    jobs = [(each, *signals) for each in (gpo, *others)]
    assert [len(each) for each in batches_of(jobs, monkeypatch)] == [1] * 6


@pytest.mark.parametrize("workers", [1, 2])
def test_filters_built_apart_are_run_together(signals, workers, monkeypatch):
    steps = [1e-3 * (7 * k % 16 + 1) for k in range(16)]
    built = [
        GPOFilter(
            order=3,
            step_size=step,
            amplitude=float("0.7"),  # a number of its own
            envelope=replace(PUBLISHED_ENVELOPE),
        )
        for step in steps
    ]
    found = batches_of([(each, *signals) for each in built], monkeypatch, workers)
    asked = [[item.step_size for item in batch] for batch in found]
    assert sorted(step for batch in asked for step in batch) == sorted(steps)
    assert len(asked) == (1 if workers == 1 else 8)  # several for each of two threads
    assert all(batch == sorted(batch) for batch in asked)


def test_a_setting_that_is_an_array_counts_by_identity(signals, monkeypatch):
    @dataclass(frozen=True, kw_only=True)
    class Shaped(DelayedFilter):
        shape: FloatArray

    shape = np.ones(3)
    one = Shaped(order=2, step_size=1e-3, shape=shape)
    other = replace(one, step_size=2e-3)
    copied = replace(one, shape=shape.copy())
    jobs = [(each, *signals) for each in (one, other, copied)]
    found = batches_of(jobs, monkeypatch)
    assert [len(each) for each in found] == [2, 1]


def test_those_that_go_on_stay_together(signals, play_counts):
    # those with the largest step sizes diverge at once; the others share their calls
    x = np.tile(signals[0], 1 + 3 * CHUNK // len(signals[0]))[: 3 * CHUNK]
    first = stable(("gpo", {"amplitude": 1.0}), 6, x, 0.1)
    steps = [replace(first, step_size=first.step_size * f) for f in (0.1, 1, 0.5)]
    wild = [replace(first, step_size=1e9 * k) for k in (1, 2)]
    listed = [wild[0], *steps, wild[1]]
    d = x + x**2
    found = run_many([(each, x, d) for each in listed], 1)
    told = [result.diverged_at is None for result in found]
    assert told == [False, True, True, True, False]
    assert play_counts == [5, 3, 3]


# --- the registry and what is refused


def test_every_filter_of_the_paper_is_tried_here():
    assert set(OPTIONS) == set(published.FILTERS)


def test_a_new_filter_is_one_method(signals):
    class Cubes(AdaptiveFilter):
        name = "cubes"

        def regressor(self, line, operators):
            return self.windows(line) ** 3, operators

    x, d = signals
    adaptive = Cubes(order=4, step_size=0.1)
    delayed = plain_regressors(("delayed", {}), adaptive, x)
    y, w = plain_lms(delayed**3, d, 0.1)
    result = adaptive.run(x, d)
    near(result.output, y)
    near(result.weights, w)
    trace = np.mean(np.sum(delayed**6, axis=1))
    assert adaptive.bound(x).trace == pytest.approx(trace)


def test_thirtieth_order_volterra_has_992_weights():
    assert make(("volterra", {"second_order_step": 1.0}), 30).size == 992


@pytest.mark.parametrize(
    ("kind", "more", "told"),
    [
        (("delayed", {}), {"order": -1}, "order: -1"),
        (("delayed", {}), {"order": 4096}, "order: 4096 given, 0 to 4095"),
        (("delayed", {}), {"step_size": 0.0}, "step_size: 0.0"),
        (("delayed", {}), {"step_size": np.nan}, "step_size: nan"),
        (("delayed", {}), {"x_before": np.inf}, "x_before: inf"),
        (("gpo", {"amplitude": -1.0}), {}, "amplitude: -1.0"),
        (("gpo", {"amplitude": 1.0, "form": "eq3"}), {}, "did you mean 'eq4'"),
        (("gpo", {"amplitude": 1.0, "initial_state": "zer"}), {}, "mean 'zero'"),
        (("backlash", {"amplitude": 1.0, "structure": "x"}), {}, "structure: 'x'"),
        (("volterra", {"second_order_step": -1.0}), {}, "second_order_step: -1.0"),
    ],
)
def test_parameters_out_of_range_are_refused(kind, more, told):
    settings = {"order": 3, "step_size": 1e-3, **more}
    with pytest.raises(InputError, match=told):
        make(kind, **settings)


def test_signals_that_do_not_fit_are_refused():
    adaptive = make(CASES[0], 3)
    with pytest.raises(InputError, match="x: sample 1 is nan"):
        adaptive.run([0, np.nan], [0, 0])
    with pytest.raises(InputError, match="d: sample 0 is inf"):
        adaptive.run([0, 1], [np.inf, 0])
    with pytest.raises(InputError, match="d: 3 samples given, x has 2"):
        adaptive.run([0, 1], [0, 1, 2])
    with pytest.raises(InputError, match="x: 2 dimensions"):
        adaptive.run([[0, 1]], [0, 1])
    with pytest.raises(InputError, match="x: no samples"):
        adaptive.bound([])

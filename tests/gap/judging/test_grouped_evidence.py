"""Groups of columns with variances of their own, on problems with a known answer."""

import numpy as np
import pytest
from scipy.stats import multivariate_normal

from hystbench.gap.judging.grouped_evidence import ColumnProducts, Grouped, _factored

ROWS = 2000


def made(seed, counts, sizes, noise):
    """Columns, and a sum of them with normal amplitudes and white noise."""
    rng = np.random.default_rng(seed)
    columns = rng.standard_normal((ROWS, sum(counts)))
    columns /= np.sqrt(np.mean(columns**2, axis=0))
    amplitudes = rng.standard_normal(sum(counts)) * np.repeat(sizes, counts)
    signal = columns @ amplitudes + noise * rng.standard_normal(ROWS)
    return columns, signal, in_groups(columns, counts)


def in_groups(columns, counts):
    """Columns by group, so many each."""
    parts = np.split(columns, np.cumsum(counts)[:-1], axis=1)
    return {str(k): part for k, part in enumerate(parts)}


def explained(groups, signal, sizes=None):
    return ColumnProducts.of(groups, signal, sizes).explained(groups)


def test_of_orthogonal_columns_the_variance_has_a_closed_form():
    # Their amplitudes by least squares are normal with variance v + s / n.
    rng = np.random.default_rng(1)
    columns = np.linalg.qr(rng.standard_normal((ROWS, 12)))[0] * np.sqrt(ROWS)
    signal = columns @ rng.normal(0, 0.3, 12) + rng.standard_normal(ROWS)
    found = explained({"all": columns}, signal)
    amplitudes = columns.T @ signal / ROWS
    left = signal - columns @ amplitudes
    # At a fixed point the noise is charged for what the amplitudes determine.
    assert found.variances["all"] + found.noise / ROWS == pytest.approx(
        np.mean(amplitudes**2), rel=1e-6
    )
    assert found.noise == pytest.approx(left @ left / (ROWS - 12), rel=1e-3)


@pytest.mark.parametrize("seed", range(5))
def test_noise_and_sizes_are_found_again(seed):
    counts, sizes = (30, 40, 20), (2.0, 0.0, 0.5)
    _, signal, groups = made(seed, counts, sizes, 1.0)
    found = explained(groups, signal)
    assert found.noise == pytest.approx(1.0, abs=4 * np.sqrt(2 / ROWS))
    variances = found.variances.values()
    for size, count, variance in zip(sizes, counts, variances, strict=True):
        error = 4 * np.sqrt(2 / count) * size**2 + 4 / ROWS
        assert variance == pytest.approx(size**2, abs=error)


@pytest.mark.parametrize("seed", range(5))
def test_groups_that_explain_nothing_take_no_noise_away(seed):
    # By least squares 200 columns would take a tenth of it.
    _, signal, groups = made(seed, (5, 200), (1.0, 0.0), 1.0)
    products = ColumnProducts.of(groups, signal)
    few, all_of_them = (products.explained(names) for names in (["0"], groups))
    assert all_of_them.noise == pytest.approx(few.noise, rel=0.02)
    assert all_of_them.evidence <= few.evidence + 3.0


def test_the_evidence_is_the_density_of_the_signal():
    columns, signal, _ = made(3, (4, 6), (1.0, 0.2), 0.7)
    columns, signal = columns[:300], signal[:300]
    columns = columns / np.sqrt(np.mean(columns**2, axis=0))
    found = explained(in_groups(columns, (4, 6)), signal)
    spread = np.repeat(list(found.variances.values()), (4, 6))
    covariance = (columns * spread) @ columns.T + found.noise * np.eye(300)
    density = multivariate_normal(cov=covariance).logpdf(signal)
    assert found.evidence == pytest.approx(density, rel=1e-6)


def test_a_group_offered_twice_explains_no_more():
    columns, signal, groups = made(4, (15,), (1.0,), 1.0)
    once, twice = explained(groups, signal), explained({**groups, "1": columns}, signal)
    assert twice.noise == pytest.approx(once.noise, rel=1e-3)


def test_scales_of_columns_do_not_matter():
    columns, signal, groups = made(5, (10, 10), (1.0, 0.0), 1.0)
    scales = 10.0 ** np.arange(-10, 10)
    one = explained(groups, signal)
    other = explained(in_groups(columns * scales, (10, 10)), signal)
    assert other.noise == pytest.approx(one.noise, rel=1e-9)


def test_a_column_of_zeros_and_no_group_at_all():
    _, signal, _ = made(6, (1,), (1.0,), 1.0)
    products = ColumnProducts.of({"zeros": np.zeros((ROWS, 2))}, signal)
    power = np.mean(signal**2)
    assert products.explained([]).noise == pytest.approx(power)
    assert products.explained(["zeros"]).noise == pytest.approx(power)


def test_products_over_a_tiny_noise_are_inverted_where_rounding_hides_the_one():
    # One plus v v^T / noise: along v the inverse is noise over v^T v, elsewhere one or,
    # where rounding adds to the one, less.
    v = np.random.default_rng(3).standard_normal(30)
    noise = 1e-20
    matrix = np.outer(v, v) / noise
    matrix.flat[:: len(v) + 1] += 1.0
    with pytest.raises(np.linalg.LinAlgError):
        np.linalg.cholesky(matrix)
    factor, determinant = _factored(matrix)
    sizes = np.linalg.svd(factor, compute_uv=False)
    assert sizes.max() == pytest.approx(1.0)
    assert sizes.min() == pytest.approx(np.sqrt(noise / (v @ v)), rel=1e-6)
    assert determinant == pytest.approx(-2 * np.log(sizes).sum())


def test_sizes_say_which_columns_of_a_group_are_expected_to_be_large():
    rng = np.random.default_rng(3)
    columns = rng.standard_normal((ROWS, 40))
    sizes = 1.0 / np.arange(1, 41)
    signal = columns @ (sizes * rng.standard_normal(40)) + rng.standard_normal(ROWS)
    alike, falling = (
        explained({"all": columns}, signal, each) for each in (None, {"all": sizes})
    )
    assert falling.evidence > alike.evidence
    scale = np.sqrt(np.mean(columns**2, axis=0))
    prior = np.diag(falling.variances["all"] * sizes**2)
    unit = columns / scale
    covariance = unit @ prior @ unit.T + falling.noise * np.eye(ROWS)
    expected = multivariate_normal(cov=covariance).logpdf(signal)
    assert falling.evidence == pytest.approx(expected, rel=1e-6)


def test_the_power_beyond_others_is_that_of_ridge_regression():
    rng = np.random.default_rng(4)
    columns = rng.standard_normal((ROWS, 8))
    columns[:, 5] += 3 * columns[:, 0]
    columns /= np.sqrt(np.mean(columns**2, axis=0))
    products = ColumnProducts.of(in_groups(columns, (5, 3)), np.zeros(ROWS))
    amplitudes, variances, noise = rng.standard_normal(3), np.full(5, 0.1), 2.0
    total = columns[:, 5:] @ amplitudes
    own = columns[:, :5] * np.sqrt(variances)
    ridge = np.vstack([own, np.sqrt(noise) * np.eye(5)])
    taken = np.linalg.lstsq(ridge, np.concatenate([total, np.zeros(5)]))[0]
    expected = np.mean((total - own @ taken) ** 2)
    given = Grouped(noise, {"0": 0.1}, 0.0, {"1": amplitudes})
    found = products.power_beyond(["1"], ["0"], given)
    assert found == pytest.approx(expected, rel=1e-9)

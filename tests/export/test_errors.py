"""The table of errors: what is known beforehand of its rows."""

import csv

import pytest

from hystbench.export.errors import CASES, error, noise_of_rate
from tests.conftest import run_hystbench


def case(words, samples=100):
    return next(x for x in CASES if (x.words, x.samples) == (words, samples))


def test_a_backward_difference_is_twice_as_noisy_and_a_central_one_is_itself():
    # Variances 2 and 1/2 of the noise's.
    assert noise_of_rate(2, 0) == pytest.approx(2.0)
    assert noise_of_rate(6, 1) == noise_of_rate(8, 3) == pytest.approx(1.0)


def test_a_rate_is_exact_once_the_next_sample_is_known():
    for words in ("friction", "friction, noise of 0.1 %"):
        assert error(case(words), 6, 1) < 1e-12 < error(case(words), 6, 0)


def test_more_samples_a_period_and_more_points_are_nearer():
    lags = [error(case("a lag", n), 6, 0) for n in (50, 20, 10)]
    assert lags == sorted(lags)
    points = [error(case("a lag", 20), n, 0) for n in (6, 3, 2)]
    assert points == sorted(points)


def test_the_command_writes_a_row_for_each_case(tmp_path):
    done = run_hystbench("job", "export-errors", "--out", tmp_path / "errors.csv")
    assert done.returncode == 0, done.stderr
    with (tmp_path / "errors.csv").open(newline="") as stream:
        rows = list(csv.DictReader(stream))
    assert [row["case"] for row in rows][:-1] == [x.words for x in CASES]
    assert all(float(row["--points 6"]) > 0 for row in rows)

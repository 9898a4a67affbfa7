"""Errors and convergence of a filter's run by hand, also of one that diverged."""

import json

import numpy as np
import pytest

from hystbench.record import Channel, Record
from hystbench.results import run_result, save_run

OPTIONS = {"transient_fraction": 0.5, "smoothing_fraction": 0.25}


def record(y):
    y = np.asarray(y, dtype=float)
    channels = Channel("current", "A"), Channel("displacement", "um")
    return Record("r", 0.5, np.arange(len(y)) * 1.0, y, *channels, origin="twin")


def result(y, error, diverged=None):
    return run_result(
        record(y), "gpo", np.asarray(error, float), "one-step a priori",
        diverged=diverged, **OPTIONS,
    )  # fmt: skip


def test_errors_by_hand():
    kept = result([3, 4, 0, 5, 1, 2, 0, 2], [1, -1, 2, 0, 1, 1, 0, 0])
    assert kept["mse"] == pytest.approx(8 / 8)
    assert kept["re"] == pytest.approx(np.sqrt(8 / 59))
    assert kept["mse_after_transient"] == pytest.approx(2 / 4)
    assert kept["re_after_transient"] == pytest.approx(np.sqrt(2 / 9))
    assert kept["transient_s"] == 2.0
    assert kept["units"] == {"mse": "um^2"}
    # Means of e^2 over two samples: 1, 2.5, 2, 0.5, 1, 0.5, 0.
    curve = kept["smoothed_squared_error"]
    np.testing.assert_allclose(curve["value"], [1, 2.5, 2, 0.5, 1, 0.5, 0])
    assert curve["window_s"] == 1.0


def test_convergence_is_when_the_error_has_come_down_to_stay():
    error = np.concatenate([np.full(100, 10.0), np.ones(300)])
    kept = run_result(
        record(np.ones(400)), "gpo", error, "one-step a priori",
        transient_fraction=0.25, smoothing_fraction=1 / 400,
    )  # fmt: skip
    assert kept["convergence_s"] == pytest.approx(100 * 0.5)


@pytest.mark.parametrize("samples", [0, 1, 5])
def test_a_diverged_run_has_no_errors_and_is_json(samples, tmp_path):
    told = {"sample": samples, "sentence": "diverged at sample"}
    error = np.full(samples, 1e5)
    kept = result(np.ones(8), error, told)
    assert kept["status"] == "diverged"
    assert kept["diverged"] == told
    for key in ("mse", "re", "mse_after_transient", "re_after_transient"):
        assert kept[key] is None
    save_run(tmp_path / "r.json", tmp_path / "r.npz", kept, error, error)
    assert json.loads((tmp_path / "r.json").read_text()) == kept

"""A calibration from settings to files, on two short records."""

import numpy as np

from hystbench.files import read_json
from hystbench.model import load_model
from hystbench.twins import run as running
from hystbench.twins.run import run_calibration
from hystbench.twins.search import Fit

from .test_calibrate import FILTERS, START

COMMON = {
    "amplitude": 0.632,
    "duration_s": 0.1,
    "sampling_frequency_hz": 10_000,
    "unit": "A",
}


def job(*frequencies):
    return {
        "signals": {
            f"sine-{f:03d}hz": {
                "definition": {"sine": {"frequency_hz": f}},
                "common": COMMON,
            }
            for f in frequencies
        },
        "filters": FILTERS,
        "seed": 1,
        "starts": 1,
        "search_seed": 1,
        "twins": 2,
    }


def test_it_writes_the_twin_its_like_and_a_report(tmp_path, monkeypatch):
    monkeypatch.setattr(running, "calibrate", lambda *a, **k: Fit(dict(START), 100.0))
    run_calibration(job(40, 100), tmp_path)
    twin = load_model(tmp_path / "gma.yaml")
    assert twin.value("calibration-error.offset") == START["offset"]
    others = [load_model(path) for path in sorted(tmp_path.glob("uncertainty/*.yaml"))]
    assert [other.name for other in others] == ["gma-01", "gma-02"]
    assert others[0].chain != others[1].chain
    report = read_json(tmp_path / "report.json")
    assert report["convergence_factor"]["gpo"] == {"mu": START["gpo step"]}
    assert np.isfinite(report["cells"]["rms"]["sine-040hz"])


def test_the_order_of_the_signals_does_not_matter(tmp_path, monkeypatch):
    monkeypatch.setattr(running, "calibrate", lambda *a, **k: Fit(dict(START), 100.0))
    reports = []
    for name, frequencies in (("up", (40, 100)), ("down", (100, 40))):
        run_calibration(job(*frequencies), tmp_path / name)
        reports.append((tmp_path / name / "report.json").read_bytes())
    assert reports[0] == reports[1]

"""A small twin and small settings: a second of records, short filters."""

from __future__ import annotations

from pathlib import Path

import pytest
import yaml
from click.testing import CliRunner

from hystbench.settings import read_settings
from tests.conftest import SCHEMA, own_config, shorten

SIGNALS = ["sine-100hz", "sine-150hz", "sine-120hz", "multisine-random-0-100hz"]

TWIN = {
    "name": "small",
    "input": {"name": "current", "unit": "A"},
    "output": {"name": "displacement", "unit": "um"},
    "chain": [
        {
            "gpi": {
                "envelope": [1.0, 0.0, 1.0, 0.0, 1.0, 0.0, 1.0, 0.0],
                "thresholds": [0.0, 0.2, 0.4],
                "weights": [10.0, 3.0, 2.0],
            }
        },
        {"drive-lag": {"time_constant_s": 0.001}},
        {"sensor-noise": {"rms": 0.02}},
    ],
}


def small_settings():
    """The project's settings, cut down."""
    config = own_config()
    config["signals"] = SIGNALS
    shorten(config, 0.2)
    config["excitations"]["sine-001hz"] = {"sine": {"frequency_hz": 1, "duration_s": 1}}
    config["identification"] |= {"starts": 1, "max_iterations": 5}
    config["filters"]["order"] = 6
    config["rdgpi"] |= {"fit_signals": ["sine-100hz"], "starts": 1}
    config["order_sweep"] |= {"signal": "sine-050hz", "orders": [1, 10, 12]}
    return read_settings(config, SCHEMA)


@pytest.fixture(scope="session")
def settings():
    return small_settings()


@pytest.fixture
def twin_file(tmp_path) -> Path:
    return write_twin(tmp_path / "small.yaml")


def write_twin(path: Path, gain: float = 1.0) -> Path:
    content = yaml.safe_load(yaml.safe_dump(TWIN))
    gpi = content["chain"][0]["gpi"]
    gpi["weights"] = [gain * weight for weight in gpi["weights"]]
    path.write_text(yaml.safe_dump(content))
    return path


@pytest.fixture
def two(tmp_path):
    return [write_twin(tmp_path / "one.yaml"), write_twin(tmp_path / "two.yaml", 1.5)]


def call(command, *words):
    result = CliRunner().invoke(command, list(map(str, words)), catch_exceptions=False)
    assert result.exit_code == 0, result.output

"""What tests share: the repository, small datasets and a way to run the workflow."""

from __future__ import annotations

import csv
import gc
import io
import os
import subprocess
import sys
from contextlib import redirect_stderr, redirect_stdout
from copy import deepcopy
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import yaml
from hypothesis import HealthCheck, settings

from hystbench import cli, kernels
from tests.browser.chromium import EXECUTABLE, Chromium

ROOT = Path(__file__).parents[1]
SCHEMA = ROOT / "workflow" / "schemas" / "config.schema.yaml"

# A kernel's first call or a busy machine must not fail a property. In CI the same
# examples run every time; elsewhere new ones are looked for.
settings.register_profile(
    "hystbench",
    deadline=None,
    suppress_health_check=[HealthCheck.too_slow],
    derandomize="CI" in os.environ,
    max_examples=25,
)
settings.load_profile("hystbench")


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Begin with the workflows: each takes long, and two workers end together."""
    items.sort(key=lambda item: "pipeline" not in item.path.parts)


@pytest.hookimpl(wrapper=True)
def pytest_collection():
    """Make the thousands of tests without a search for garbage: all of it is kept."""
    gc.disable()
    try:
        return (yield)
    finally:
        gc.freeze()
        gc.enable()


@pytest.fixture(scope="session", autouse=True)
def _no_cache_of_the_users(tmp_path_factory):
    """Keep outputs of functions that tests call out of the user's own cache."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("XDG_CACHE_HOME", str(tmp_path_factory.mktemp("cache")))
        yield


@cache
def _own_config() -> dict[str, Any]:
    return yaml.safe_load((ROOT / "config.yaml").read_text(encoding="utf-8"))


def own_config() -> dict[str, Any]:
    """Give the project's config, which a test may change; it is read once."""
    return deepcopy(_own_config())


def table(path: Path) -> list[dict[str, str]]:
    """Read the rows of a CSV file."""
    with path.open(encoding="utf-8", newline="") as stream:
        return list(csv.DictReader(stream))


def shorten(config: dict[str, Any], duration_s: float) -> None:
    """Make a config's records short, the random sum with the sines that they hold."""
    config["excitation"]["duration_s"] = duration_s
    random = config["excitations"]["multisine-random-0-100hz"]["random-sum-of-sines"]
    random["sines"] = min(random["sines"], round(100 * duration_s))
    config["random_sum"] |= {"draws": 2, "other_sines": [5]}
    config["step_sweep"] |= {"ratio": 2.0}
    config["pressure"] |= {"members": 1}
    config["constants"] |= {"zero_errors": [0.0], "constant_taps": [0.0, 1.0]}


@pytest.fixture(scope="session")
def root() -> Path:
    return ROOT


@pytest.fixture(scope="session")
def browser():
    """A headless Chromium, where there is one."""
    if EXECUTABLE is None:
        pytest.skip("no Chromium here (on Debian: the package chromium)")
    with Chromium() as started:
        yield started


@pytest.fixture
def write_dataset(tmp_path):
    """Write a measured dataset: a dict of CSV texts and a dataset.yaml text."""

    def write(files: dict[str, str], yaml_text: str | None = None) -> Path:
        folder = tmp_path / "dataset"
        folder.mkdir()
        for name, text in files.items():
            (folder / name).write_text(text)
        if yaml_text is None:
            records = "".join(f"  - {{file: {name}}}\n" for name in files)
            yaml_text = (
                "name: bench\n"
                "time: {column: time_s, unit: s}\n"
                "input: {column: current_A, unit: A}\n"
                "output: {column: displacement_um, unit: um}\n"
                f"records:\n{records}"
            )
        (folder / "dataset.yaml").write_text(yaml_text)
        return folder / "dataset.yaml"

    return write


def csv_text(time, u, y, header="time_s,current_A,displacement_um") -> str:
    rows = [f"{t:.9g},{a:.9g},{b:.9g}" for t, a, b in zip(time, u, y, strict=True)]
    return "\n".join([header, *rows]) + "\n"


@pytest.fixture
def play_counts(monkeypatch):
    """List how many filters each call of the play operators' LMS kernel runs."""
    counts: list[int] = []
    plain = kernels.call

    def noted(name, *arguments):
        if name == "hb_lms_play":
            counts.append(arguments[0])
        return plain(name, *arguments)

    monkeypatch.setattr(kernels, "call", noted)
    return counts


@pytest.fixture
def loop_csv():
    """Write one loop of a slow sine, 400 samples at 100 Hz, as CSV."""
    time = np.arange(400) / 100
    u = np.sin(2 * np.pi * time / 4)
    return csv_text(time, u, 10 * u + 0.1)


def run_hystbench(*arguments, cwd: Path | None = None):
    """Run the command line in this process: its start would be most of the time."""
    out, err = io.StringIO(), io.StringIO()
    with (
        pytest.MonkeyPatch.context() as patch,
        redirect_stdout(out),
        redirect_stderr(err),
    ):
        patch.setattr("sys.argv", ["hystbench", *map(str, arguments)])
        patch.chdir(cwd or Path.cwd())
        status = cli.run()
    return subprocess.CompletedProcess(
        arguments, status, out.getvalue(), err.getvalue()
    )


def refused(*arguments, cwd: Path | None = None) -> str:
    """Give the one line by which the command line refuses."""
    done = run_hystbench(*arguments, cwd=cwd)
    assert done.returncode == 2, done.stderr
    assert done.stderr.count("\n") == 1
    return done.stderr


def start_hystbench(*arguments, cwd: Path | None = None):
    """Run the command line as a program of its own."""
    return subprocess.run(
        [sys.executable, "-m", "hystbench", *map(str, arguments)],
        capture_output=True,
        text=True,
        cwd=cwd,
        check=False,
    )

"""Separate processes write the same bytes, on one processor and on several."""

import json
import os
import subprocess
import sys
from pathlib import Path

import pytest

from hystbench import kernels

SCRIPT = Path(__file__).with_name("every_kernel.py")


def ran(processors, hash_seed):
    words = [sys.executable, str(SCRIPT), str(processors)]
    environment = {**os.environ, "PYTHONHASHSEED": hash_seed}
    done = subprocess.run(
        words, capture_output=True, text=True, check=False, env=environment
    )
    assert done.returncode == 0, done.stderr
    return json.loads(done.stdout)


@pytest.fixture(scope="module")
def runs():
    return [ran(1, "1"), ran(2, "2"), ran(2, "3")]


def test_the_processes_were_confined(runs):
    allowed = len(os.sched_getaffinity(0))
    assert [run["processors"] for run in runs] == [1, min(2, allowed), min(2, allowed)]


def test_every_kernel_was_run(runs):
    for run in runs:
        assert set(run["called"]) == set(kernels.KERNELS)


def test_every_kernel_wrote_the_same_bytes(runs):
    one, *others = runs
    assert len(set(one["digests"].values())) == len(one["digests"])
    for other in others:
        assert other["digests"] == one["digests"]

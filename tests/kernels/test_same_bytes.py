"""Separate processes write the same bytes, on one processor and on several."""

import json
import os
import subprocess
import sys
from pathlib import Path

import pytest

from hystbench import kernels
from hystbench.published import FILTERS

SCRIPT = Path(__file__).with_name("every_kernel.py")


def ran(processors, hash_seed, **more):
    words = [sys.executable, str(SCRIPT), str(processors)]
    free = {k: v for k, v in os.environ.items() if not k.endswith("_NUM_THREADS")}
    environment = {**free, "PYTHONHASHSEED": hash_seed, **more}
    done = subprocess.run(
        words, capture_output=True, text=True, check=False, env=environment
    )
    assert done.returncode == 0, done.stderr
    return json.loads(done.stdout)


@pytest.fixture(scope="module")
def runs():
    """On one processor; on two; on two with BLAS set as the command sets it."""
    if len(os.sched_getaffinity(0)) < 2:
        pytest.skip("one processor: two have nothing to differ in")
    return [ran(1, "1"), ran(2, "2"), ran(2, "3", OPENBLAS_NUM_THREADS="1")]


def test_the_processes_were_confined(runs):
    assert [run["processors"] for run in runs] == [1, 2, 2]


def test_every_kernel_was_run(runs):
    for run in runs:
        assert set(run["called"]) == set(kernels.KERNELS)


def test_every_kernel_wrote_the_same_bytes(runs):
    one, *others = runs
    assert len(set(one["digests"].values())) == len(one["digests"])
    for other in others:
        assert other["digests"] == one["digests"]


def test_bounds_are_the_same_bytes_with_one_thread_of_blas(runs):
    # on one processor BLAS has one thread of itself
    one, _, other = runs
    assert set(one["bounds"]) == set(FILTERS)
    assert other["bounds"] == one["bounds"]

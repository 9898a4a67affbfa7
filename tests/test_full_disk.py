"""A disk that is full: one line, status 2, and earlier results as they were."""

from __future__ import annotations

import os
import resource
import subprocess
import sys
from contextlib import contextmanager
from pathlib import Path

import pytest

from tests.conftest import run_hystbench
from tests.test_interrupt import files
from tests.test_layouts import Layout, lay, searched


@pytest.fixture
def bench(tmp_path):
    lay(tmp_path, Layout(out="out", model="model.yaml"))
    return tmp_path


WORDS = {
    "load": ["load", "data", "a", "--out", "out/result.npz"],
    "gap": ["gap", "data", "--model", "model.yaml", "--out", "out", "--no-report"],
}


def run(name: str, folder: Path, limit: int | None = None) -> tuple[int, str]:
    """Run a command that writes to ``out``, and no file longer than the limit.

    In a process of its own that has imported all: the limit holds for a process, and
    to start one anew would be most of the time.

    Returns
    -------
    status : int
    told : str
        Standard error.
    """
    end, begin = os.pipe()
    child = os.fork()
    if child == 0:
        status = 1
        try:
            if limit is not None:
                resource.setrlimit(resource.RLIMIT_FSIZE, (limit, limit))
            os.dup2(begin, 2)
            with searched():
                done = run_hystbench(*WORDS[name], cwd=folder)
            os.write(2, done.stderr.encode())
            status = done.returncode
        finally:
            os._exit(status)
    os.close(begin)
    with os.fdopen(end) as stream:
        told = stream.read()
    return os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]), told


FIRST = {"load": "out/result.npz", "gap": "out/holdout/c.csv"}


@pytest.mark.parametrize("name", FIRST)
def test_a_file_that_does_not_fit_is_one_line(bench, name):
    """Where nothing was nothing is then, and what was there before is there still."""
    for _ in range(2):
        there = files(bench)
        status, told = run(name, bench, limit=300)
        assert status == 2, told
        *progress, last = told.splitlines()
        assert last == f"hystbench: {FIRST[name]}: File too large"
        assert progress in ([], ["base base from model.yaml"])
        assert files(bench) == there
        assert run(name, bench)[0] == 0


@contextmanager
def small_disk(folder: Path, size: str):
    """Mount a disk of a few pages, where that is allowed."""
    folder.mkdir(exist_ok=True)
    words = ["mount", "-t", "tmpfs", "-o", f"size={size}", "tmpfs", str(folder)]
    try:
        mounted = subprocess.run(words, capture_output=True, text=True, check=False)
    except FileNotFoundError:
        pytest.skip("no mount here: the limit of a file's length has to do")
    if mounted.returncode:
        pytest.skip(f"may not mount here: {mounted.stderr.strip()}")
    try:
        yield
    finally:
        subprocess.run(["umount", str(folder)], check=True)


def test_a_small_disk_that_gets_full_is_one_line(bench):
    """Until nothing fits: then the file is told, and what was there is there."""
    with small_disk(bench / "out", "256k"):
        assert run("gap", bench)[0] == 0
        filler = bench / "out" / "filler"
        with pytest.raises(OSError, match="No space"):
            filler.write_bytes(b"x" * 2**20)
        there = files(bench)
        status, told = run("gap", bench)
        assert status == 2, told
        assert told.splitlines()[-1].startswith("hystbench: out")
        assert told.endswith(": No space left on device\n")
        assert "Traceback" not in told
        assert files(bench) == there
        filler.unlink()
        assert run("gap", bench)[0] == 0


def test_printing_to_a_full_disk_is_one_line(tmp_path):
    full = Path("/dev/full")
    if not full.exists():
        pytest.skip("no /dev/full here")
    with full.open("w") as stream:
        refused = subprocess.run(
            [sys.executable, "-m", "hystbench", "--help"],
            cwd=tmp_path,
            stdout=stream,
            stderr=subprocess.PIPE,
            text=True,
            check=False,
        )
    assert refused.returncode == 2
    assert refused.stderr.startswith("hystbench: standard output")
    assert refused.stderr.endswith(": No space left on device\n")
    assert refused.stderr.count("\n") == 1

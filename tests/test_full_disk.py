"""A disk that is full: one line, status 2, and earlier results as they were."""

from __future__ import annotations

import os
import resource
import subprocess
import sys
from contextlib import contextmanager
from pathlib import Path

import pytest

from tests.conftest import ROOT
from tests.test_interrupt import files
from tests.test_layouts import Layout, lay

#: ``hystbench gap`` without its search.
SEARCHED = """
from hystbench.cli import main
from tests.test_layouts import searched
with searched():
    main()
"""


@pytest.fixture
def bench(tmp_path):
    lay(tmp_path, Layout(out="out", model="model.yaml"))
    return tmp_path


def command(name: str) -> list[str]:
    """Words of a command that writes to ``out``."""
    words = {
        "load": ["load", "data", "a", "--out", "out/result.npz"],
        "gap": ["gap", "data", "--model", "model.yaml", "--out", "out", "--no-report"],
    }[name]
    return [sys.executable, "-c", SEARCHED, *words]


def run(name: str, folder: Path, limit: int | None = None):
    """Run a command; no file of it may get longer than the limit."""

    def limited():
        if limit is not None:
            resource.setrlimit(resource.RLIMIT_FSIZE, (limit, limit))

    return subprocess.run(
        command(name),
        cwd=folder,
        # compiled modules would be cut off by the limit as well
        env=os.environ | {"PYTHONPATH": str(ROOT), "PYTHONDONTWRITEBYTECODE": "1"},
        capture_output=True,
        text=True,
        preexec_fn=limited,
        check=False,
    )


FIRST = {"load": "out/result.npz", "gap": "out/holdout/c.csv"}


@pytest.mark.parametrize("name", FIRST)
def test_a_file_that_does_not_fit_is_one_line(bench, name):
    assert run(name, bench).returncode == 0
    there = files(bench)
    refused = run(name, bench, limit=300)
    assert refused.returncode == 2
    *progress, told = refused.stderr.splitlines()
    assert told == f"hystbench: {FIRST[name]}: File too large"
    assert progress in ([], ["base base from model.yaml"])
    assert files(bench) == there


def test_where_nothing_was_nothing_is(bench):
    there = files(bench)
    assert run("gap", bench, limit=300).returncode == 2
    assert files(bench) == there
    assert run("gap", bench).returncode == 0


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
        assert run("gap", bench).returncode == 0
        filler = bench / "out" / "filler"
        with pytest.raises(OSError, match="No space"):
            filler.write_bytes(b"x" * 2**20)
        there = files(bench)
        refused = run("gap", bench)
        assert refused.returncode == 2, refused.stderr
        *_, told = refused.stderr.splitlines()
        assert told.startswith("hystbench: out")
        assert refused.stderr.endswith(": No space left on device\n")
        assert "Traceback" not in refused.stderr
        assert files(bench) == there
        filler.unlink()
        assert run("gap", bench).returncode == 0


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

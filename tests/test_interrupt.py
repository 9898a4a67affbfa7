"""Ctrl-C: one line, and what was there before is there still."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

from hystbench.files import write_text
from hystbench.written import ENTRIES, is_ours
from tests.conftest import start_hystbench
from tests.test_layouts import Layout, content, lay

#: Longer than any step here takes, on a machine that has much else to do.
PATIENCE_S = 60


@pytest.fixture
def at(tmp_path_factory):
    """A file that a started program makes when it is at the moment in question."""
    return tmp_path_factory.mktemp("moment") / "at"


@pytest.fixture
def start(at):
    """Begin programs that call the command line; none outlives its test."""
    begun = []

    def as_in_a_terminal():
        signal.signal(signal.SIGINT, signal.SIG_DFL)

    def start(code: str, cwd: Path, *arguments: object) -> subprocess.Popen[str]:
        process = subprocess.Popen(
            [sys.executable, "-c", code, *map(str, arguments)],
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            text=True,
            cwd=cwd,
            env=os.environ | {"AT": str(at)},
            preexec_fn=as_in_a_terminal,
        )
        begun.append(process)
        return process

    yield start
    for process in begun:
        process.kill()
        process.communicate()


def wait_for(path: Path) -> None:
    end = time.monotonic() + PATIENCE_S
    while not path.exists():
        assert time.monotonic() < end, path
        time.sleep(0.002)


def ended(process: subprocess.Popen[str], *signals: int) -> str:
    """Send signals; give what was said, when the process ended as it has to."""
    for number in signals:
        process.send_signal(number)
    _, said = process.communicate(timeout=PATIENCE_S)
    assert process.returncode == 128 + signals[0], said
    return said


#: The command line, in which ``at`` says that it is at the moment in question. To
#: sleep is to sleep in slices: Python sees a signal that comes between its last look
#: and the system's call only when the call ends.
BEGIN = """
import os, sys, time
from pathlib import Path
import hystbench.cli as cli
at = Path(os.environ["AT"]).touch
def sleep():
    for _ in range(6000): time.sleep(0.01)
wait = lambda: (at(), sleep())
"""
#: Each moment, as a change of the program that comes there and stays.
MOMENTS = {
    # A module of ours, whose import takes a second: the signal waits as well.
    "import": """
import importlib.abc
class Slow(importlib.abc.MetaPathFinder):
    def find_spec(self, name, path, target=None):
        if name == "click":
            at(); end = time.monotonic() + 1.0
            while time.monotonic() < end: pass
sys.meta_path.insert(0, Slow())
""",
    # A module that never ends its import, as one of the user's may.
    "endless import": """
import importlib.abc
class Slow(importlib.abc.MetaPathFinder):
    def find_spec(self, name, path, target=None):
        if name == "numpy": wait()
sys.meta_path.insert(0, Slow())
""",
    "reading": """
import hystbench.dataset as dataset
dataset.read_table = lambda *given: wait()
""",
    "compiled kernel": """
import hystbench.dataset as dataset
import ctypes
libc = ctypes.CDLL(None)
def kernel(*given):
    at(); libc.usleep(500_000); sleep()
dataset.read_table = kernel
""",
    "dropped": """
import hystbench.dataset as dataset
class Dropping:
    def __del__(self): wait()
def drop(*given):
    Dropping(); time.sleep(60)
dataset.read_table = drop
""",
    "writing": """
import numpy
numpy.savez = lambda *given, **more: wait()
""",
    "entry written": """
import hystbench.files as files
real = files.will_write
def will_write(*given):
    real(*given); wait()
files.will_write = will_write
""",
    "exit handlers": """
import atexit
atexit.register(wait)
""",
    "last threads": """
import threading
def live():
    time.sleep(0.01); threading.Thread(target=live).start()
live()
threading._register_atexit(at)
""",
}


@pytest.fixture(scope="module")
def bench(tmp_path_factory):
    """A dataset, and a record of it that an earlier command wrote."""
    root = tmp_path_factory.mktemp("bench")
    lay(root, Layout(model="model.yaml"))
    assert start_hystbench("load", "data", "a", "--out", "a.npz", cwd=root).stderr == ""
    return root


@pytest.mark.parametrize("moment", MOMENTS)
def test_ctrl_c_is_one_line_at_whatever_moment(bench, start, at, moment):
    before = files(bench)
    process = start(
        f"{BEGIN}{MOMENTS[moment]}\ncli.main()",
        bench,
        *("load", "data", "a", "--out", "a.npz"),
    )
    wait_for(at)
    said = ended(process, signal.SIGINT)
    assert said == "hystbench: interrupted\n"
    assert files(bench) == before
    assert is_ours(bench / "a.npz")
    if "writ" in moment:
        again = start_hystbench("load", "data", "a", "--out", "a.npz", cwd=bench)
        assert again.returncode == 0, again.stderr


def files(root: Path) -> dict[str, str]:
    """All that is there, but the list of what was written."""
    found = content(root)
    return {name: text for name, text in found.items() if ENTRIES not in name}


PLACES = """
from hystbench.files import whole_folder, write_text
rename = Path.rename
def slowly(self, to):
    done = rename(self, to); at(); time.sleep(0.1)
    return done
Path.rename = slowly
def run():
    with whole_folder("out", ("*.txt",)) as fresh:
        for name in ("b.txt", "c.txt", "d.txt"):
            write_text(fresh / name, "new")
    time.sleep(60)
cli.run = run
cli.main()
"""


def test_files_that_take_their_places_do_so_together(tmp_path, start, at):
    """Two signals come on the way; they are heard when all files are there."""
    for name in ("a.txt", "b.txt"):
        write_text(tmp_path / "out" / name, "old")
    process = start(BEGIN + PLACES, tmp_path)
    wait_for(at)
    assert ended(process, signal.SIGINT, signal.SIGINT) == "hystbench: interrupted\n"
    new = {f"out/{name}.txt": b"new".hex() for name in "bcd"}
    assert files(tmp_path) == new


TIDYING = """
close = os.close
def slowly(number):
    close(number); at(); time.sleep(0.1)
def run():
    with whole_folder("out", ("*.txt",)) as fresh:
        write_text(fresh / "b.txt", "new")
        os.close = slowly
    time.sleep(60)
from hystbench.files import whole_folder, write_text
cli.run = run
cli.main()
"""


def test_a_folder_is_removed_to_its_end(tmp_path, start, at):
    """Cut in two, the removal would close a number of a file that is closed already."""
    write_text(tmp_path / "out" / "b.txt", "old")
    process = start(BEGIN + TIDYING, tmp_path)
    wait_for(at)
    assert ended(process, signal.SIGINT) == "hystbench: interrupted\n"
    assert files(tmp_path) == {"out/b.txt": b"new".hex()}


NEVER = """
def run():
    try: wait()
    finally: Path("tidied").touch(); sleep()
cli.run = run
cli.main()
"""


def test_who_asks_twice_waits_for_nothing(tmp_path, start, at):
    process = start(BEGIN + NEVER, tmp_path)
    wait_for(at)
    process.send_signal(signal.SIGINT)
    wait_for(tmp_path / "tidied")
    assert ended(process, signal.SIGINT) == "hystbench: interrupted\n"


def test_a_request_to_end_is_one_line_too(tmp_path, start, at):
    process = start(BEGIN + "cli.run = wait\ncli.main()", tmp_path)
    wait_for(at)
    assert ended(process, signal.SIGTERM) == "hystbench: interrupted\n"


def test_a_signal_that_is_ignored_stays_ignored(tmp_path, start, at):
    """As that of a job in the background of a shell script."""
    code = "import signal; signal.signal(signal.SIGINT, signal.SIG_IGN)\n"
    code += BEGIN + "cli.run = lambda: (at(), time.sleep(0.5), 0)[-1]\ncli.main()"
    process = start(code, tmp_path)
    wait_for(at)
    process.send_signal(signal.SIGINT)
    _, said = process.communicate(timeout=PATIENCE_S)
    assert (process.returncode, said) == (0, "")

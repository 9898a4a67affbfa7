"""A solver's process: begun in a folder of its own, and ended when its time is up."""

import contextlib
import importlib
import os
import runpy
import signal
import sys
import time
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

#: Seconds between two looks at a running process.
POLL_S = 0.005
#: Exit status of a command that cannot be begun, as a shell has it.
NOT_FOUND = 127
OWN = "hystbench"
#: Beginnings of the names of environment variables that a solver does not get.
_TELLING = ("PWD", "OLDPWD", "SNAKEMAKE")


@dataclass(frozen=True)
class Ended:
    """How a process ended."""

    status: int | None
    """Exit status, negative for a signal; None if its time was up."""
    seconds: float
    cpu_seconds: float
    """Time on the clock, and computing time on all cores together."""


def preload(command: Sequence[str]) -> None:
    """Import once what a command of hystbench's own needs, for all cases after.

    A process that is forked has it already: a solver pays for its start-up once a
    chunk of cases, not once a case.
    """
    if command[0] != OWN or len(command) < 2:
        return
    importlib.import_module("hystbench.group")
    with contextlib.suppress(ModuleNotFoundError):
        # no such command: said by the command line itself, case by case
        importlib.import_module(f"hystbench.commands.{command[1].replace('-', '_')}")


def run(command: Sequence[str], folder: Path, log: Path, limit_s: float) -> Ended:
    """Run a command to its end, or until its time is up.

    Parameters
    ----------
    command : sequence of str
        ``hystbench`` itself is not begun anew but called in the forked process.
    folder : Path
        Where it runs.
    log : Path
        What it prints.
    limit_s : float
        Seconds on the clock. Then it is killed with all that it began.
    """
    sys.stdout.flush()
    sys.stderr.flush()
    begun = time.monotonic()
    child = os.fork()
    if child == 0:
        _become(command, folder, log)
    try:
        while True:
            ended, status, usage = os.wait4(child, os.WNOHANG)
            seconds = time.monotonic() - begun
            if ended:
                code: int | None = os.waitstatus_to_exitcode(status)
                break
            if seconds > limit_s:
                _kill(child)
                _, _, usage = os.wait4(child, 0)
                code = None
                break
            time.sleep(POLL_S)
    except BaseException:
        _kill(child)
        raise
    # what it began and left behind
    _kill(child)
    return Ended(code, seconds, usage.ru_utime + usage.ru_stime)


def _kill(group: int) -> None:
    with contextlib.suppress(ProcessLookupError, PermissionError):
        os.killpg(group, signal.SIGKILL)


def _become(command: Sequence[str], folder: Path, log: Path) -> None:
    """Turn the forked process into the command; never returns."""
    status = NOT_FOUND
    try:
        os.setsid()
        printed = os.open(log, os.O_CREAT | os.O_WRONLY | os.O_TRUNC)
        os.dup2(os.open(os.devnull, os.O_RDONLY), 0)
        os.dup2(printed, 1)
        os.dup2(printed, 2)
        os.chdir(folder)
        # a shell leaves behind where it was, and the workflow what it runs
        for name in [key for key in os.environ if key.startswith(_TELLING)]:
            del os.environ[name]
        if command[0] == OWN:
            status = _call(command)
        else:
            os.execvp(command[0], list(command))  # noqa: S606  (no shell is wanted)
    except BaseException as error:
        os.write(2, f"{type(error).__name__}: {error}\n".encode())
        status = status or 1
    finally:
        sys.stdout.flush()
        sys.stderr.flush()
        os._exit(status)


def _call(command: Sequence[str]) -> int:
    """Run hystbench in this process, as ``python -m hystbench`` would."""
    # Print to the log: the parent's streams may be anything, a test's capture too.
    sys.stdout = os.fdopen(1, "w", closefd=False)
    sys.stderr = os.fdopen(2, "w", closefd=False)
    sys.argv = list(command)
    try:
        runpy.run_module(OWN, run_name="__main__")
    except SystemExit as ended:
        if ended.code is None or isinstance(ended.code, int):
            return ended.code or 0
        print(ended.code, file=sys.stderr)
        return 1
    return 0

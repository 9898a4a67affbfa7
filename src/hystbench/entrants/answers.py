"""Answers of a solver to a chunk of cases, one file for all of them.

A solver gets a copy of a case in a temporary folder whose name tells nothing, and its
process neither stands in the contest's folder nor knows its path. A case that it
crashes on, hangs on or leaves without a readable ``gap.json`` is lost, with the reason;
the contest goes on.
"""

import contextlib
import hashlib
import importlib
import json
import multiprocessing
import os
import resource
import runpy
import shutil
import signal
import sys
import time
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, cast

import hystbench
from hystbench.errors import InputError
from hystbench.files import atomic_path, digest, read_json, write_json
from hystbench.scratch import scratch_folder
from hystbench.written import ENTRIES, remove_below

#: What may stand in a command, and what stands there when it runs.
PLACEHOLDERS = ("{dataset}", "{model}", "{out}")
#: Bytes of a gap.json that are read; more is no answer.
LARGEST_ANSWER = 20_000_000
#: What stands for the model where none is handed over: a linear one, to be identified.
NO_MODEL = "linear"
#: Seconds between two looks at a running process.
POLL_S = 0.005
#: Exit status of a command that cannot be begun, as a shell has it.
NOT_FOUND = 127
OWN = "hystbench"
#: Beginnings of the names of environment variables that a solver does not get.
_TELLING = ("PWD", "OLDPWD", "SNAKEMAKE")


@dataclass(frozen=True)
class Solver:
    """A solver that has entered.

    Raises
    ------
    InputError
        If the command lacks one of the places.
    """

    name: str
    command: tuple[str, ...]
    """Words of the command, with ``{dataset}``, ``{model}`` and ``{out}`` where the
    paths are to stand."""
    time_limit_s: float
    """Seconds on the clock for one case."""

    def __post_init__(self) -> None:
        """Refuse a command that cannot answer."""
        for holder in PLACEHOLDERS:
            if not any(holder in word for word in self.command):
                raise InputError(
                    f"blind: solvers: {self.name}: {' '.join(self.command)!r}; "
                    f"expected {holder} in it"
                )


def answer_all(
    solver: Solver, folder: Path, out: Path, keep: Sequence[str] = ()
) -> None:
    """Run a solver on all cases of a chunk and write its answers.

    What was answered before an interruption is kept beside ``out`` and used again,
    as long as solver, code and case are the same.

    Parameters
    ----------
    solver : Solver
    folder : Path
        Holds a folder a case, with ``dataset/`` and ``model.yaml``; without the latter
        the solver is told ``linear`` in its place.
    out : Path
        JSON: ``solver``, ``command``, and ``cases`` by name with ``status``
        (``answered`` or why there is no answer), ``seconds``, ``cpu_seconds``,
        ``data`` (digest of what was handed out) and ``gap``.
    keep : sequence of str
        Names of further files that the solver writes, to be kept in a folder beside
        ``out``.
    """
    unfinished = out.with_suffix(".unfinished")
    _preload(solver.command)
    about = _fingerprint(solver)
    cases: dict[str, Any] = {}
    for case in sorted(path for path in folder.iterdir() if path.is_dir()):
        key = hashlib.sha256(f"{about} {digest(case)}".encode()).hexdigest()[:20]
        done = unfinished / f"{case.name}-{key}.json"
        if not done.is_file():
            kept = out.with_suffix("") / case.name if keep else None
            write_json(done, answer(solver, case, kept, keep))
        cases[case.name] = read_json(done)
    command = list(solver.command)
    write_json(out, {"solver": solver.name, "command": command, "cases": cases})
    remove_below(unfinished)


def answer(
    solver: Solver,
    case: Path,
    kept: Path | None = None,
    keep: Sequence[str] = (),
) -> dict[str, Any]:
    """Run a solver on one case.

    Returns
    -------
    dict
        As under ``cases`` of :func:`answer_all`.
    """
    with scratch_folder("gap-") as place:
        given, out, here = (Path(place, name) for name in ("case", "out", "work"))
        shutil.copytree(case, given, ignore=shutil.ignore_patterns(ENTRIES))
        here.mkdir()
        model = given / "model.yaml"
        paths = {
            "{dataset}": str(given / "dataset"),
            "{model}": str(model) if model.is_file() else NO_MODEL,
            "{out}": str(out),
        }
        command = [_filled(word, paths) for word in solver.command]
        log = Path(place, "printed.txt")
        ended = _run(command, here, log, solver.time_limit_s)
        told: dict[str, Any] = {
            "seconds": round(ended.seconds, 4),
            "cpu_seconds": round(ended.cpu_seconds, 4),
            "data": digest(case),
            "gap": None,
        }
        if ended.status is None:
            return told | {"status": f"no answer within {solver.time_limit_s:g} s"}
        if ended.status != 0:
            return told | {"status": f"exit status {ended.status}: {_last(log)}"}
        for name in keep:
            if kept is not None and (out / name).is_file():
                with atomic_path(kept / name) as temporary:
                    shutil.copy(out / name, temporary)
        status, gap = _read(out / "gap.json")
        return told | {"status": status, "gap": gap}


def _filled(word: str, paths: dict[str, str]) -> str:
    for name, path in paths.items():
        word = word.replace(name, path)
    return word


def _read(file: Path) -> tuple[str, Any]:
    if not file.is_file():
        return "no gap.json", None
    if file.stat().st_size > LARGEST_ANSWER:
        return f"gap.json: more than {LARGEST_ANSWER} bytes", None
    try:
        gap = json.loads(file.read_bytes(), parse_constant=_refuse)
        # 1e999 is read as infinity, and half a character as text: neither can be kept.
        json.dumps(gap, allow_nan=False, ensure_ascii=False).encode()
    except (ValueError, RecursionError) as error:
        return f"gap.json: not JSON ({error})", None
    except OSError as error:
        return f"gap.json: not readable ({error.strerror})", None
    return "answered", gap


def _refuse(word: str) -> None:
    raise ValueError(f"{word} is no number")


def _last(log: Path) -> str:
    """Give the last line that was printed, which tells most of a failure."""
    lines = log.read_text(encoding="utf-8", errors="replace").split("\n")
    told = [line.strip() for line in lines if line.strip()]
    return told[-1][:300] if told else "nothing printed"


def _fingerprint(solver: Solver) -> str:
    """Tell a solver from an edited one; of foreign code the command is all we know."""
    text = json.dumps([solver.command, solver.time_limit_s])
    if solver.command[0] == OWN:
        package = Path(hystbench.__file__).parent
        text += digest(package, "*.py") + digest(package, "*.so")
    return text


@dataclass(frozen=True)
class Ended:
    """How a process ended."""

    status: int | None
    """Exit status, negative for a signal; None if its time was up."""
    seconds: float
    cpu_seconds: float
    """Time on the clock, and computing time on all cores together."""


def _preload(command: Sequence[str]) -> None:
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


def _run(command: Sequence[str], folder: Path, log: Path, limit_s: float) -> Ended:
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
    begun, before = time.monotonic(), _computed()
    forked = multiprocessing.get_context("fork")
    child = forked.Process(target=_become, args=(command, folder, log))
    child.start()
    try:
        while child.is_alive() and time.monotonic() - begun <= limit_s:
            time.sleep(POLL_S)
        seconds, status = time.monotonic() - begun, child.exitcode
    finally:
        with contextlib.suppress(ProcessLookupError, PermissionError):
            # also what it began and left behind
            os.killpg(cast(int, child.pid), signal.SIGKILL)
        child.kill()
        child.join()
    return Ended(status, seconds, _computed() - before)


def _computed() -> float:
    """Give the computing time of all processes that this one waited for."""
    usage = resource.getrusage(resource.RUSAGE_CHILDREN)
    return usage.ru_utime + usage.ru_stime


def _become(command: Sequence[str], folder: Path, log: Path) -> None:
    """Turn the forked process into the command."""
    os.setsid()
    printed = os.open(log, os.O_CREAT | os.O_WRONLY | os.O_TRUNC)
    os.dup2(os.open(os.devnull, os.O_RDONLY), 0)
    os.dup2(printed, 1)
    os.dup2(printed, 2)
    # Print to the log: the parent's streams may be anything, a test's capture too.
    sys.stdout = os.fdopen(1, "w", closefd=False)
    sys.stderr = os.fdopen(2, "w", closefd=False)
    os.chdir(folder)
    # a shell leaves behind where it was, and the workflow what it runs
    for name in [key for key in os.environ if key.startswith(_TELLING)]:
        del os.environ[name]
    if command[0] == OWN:
        sys.argv = list(command)
        runpy.run_module(OWN, run_name="__main__")
        return
    try:
        os.execvp(command[0], list(command))  # noqa: S606  (no shell is wanted)
    except OSError as error:
        print(f"{type(error).__name__}: {error}", file=sys.stderr)
        sys.exit(NOT_FOUND)

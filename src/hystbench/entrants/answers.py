"""Answers of a solver to a chunk of cases, one file for all of them.

A solver gets a copy of a case in a temporary folder whose name tells nothing, and its
process neither stands in the contest's folder nor knows its path. A case that it
crashes on, hangs on or leaves without a readable ``gap.json`` is lost, with the reason;
the contest goes on.
"""

import hashlib
import json
import shutil
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import hystbench
from hystbench.entrants.process import OWN, preload, run
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
    """With ``{dataset}``, ``{model}`` and ``{out}`` where the paths are to stand."""
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
    preload(solver.command)
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
        ended = run(command, here, log, solver.time_limit_s)
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

"""Searching again with other effects: what is kept of the first search saves.

The first case of the development set of the blind contest, with its model file
and with a linear base that is identified. Seconds of one processor, without the start
of Python, reading the records and the page. Each row is a process of its own; the first
of a case begins with an empty cache.
"""

from __future__ import annotations

import json
import os
import subprocess
import sys
import tempfile
from pathlib import Path
from time import process_time

from benchmarks.gap import make_cases
from benchmarks.timing import write_table
from hystbench.gap.evidence import load_evidence
from hystbench.interface.gap import find_gap

CASES = 1
COLUMNS = ("case", "base", "search", "cpu_seconds", "times_quicker", "answer")


def main() -> None:
    """Write rerun.csv."""
    rows = []
    with tempfile.TemporaryDirectory() as name:
        make_cases(Path(name, "cases"))
        for case in sorted(Path(name, "cases").iterdir())[:CASES]:
            for word in ("model.yaml", "linear"):
                model = str(case / word) if word == "model.yaml" else word
                rows += searched(case, model, word, Path(name, f"{case.name}-{word}"))
    write_table("rerun.csv", COLUMNS, rows)


def searched(
    case: Path, model: str, base: str, cache: Path
) -> list[tuple[object, ...]]:
    """Search once, the same again, and without the first name: rows of the table."""
    rows: list[tuple[object, ...]] = []
    first = 0.0
    rejected: list[str] = []
    for search in ("first", "the same again", "without its name"):
        without = rejected if search == "without its name" else []
        if search == "without its name" and not rejected:
            continue
        found = once(case, model, without, cache)
        first = first or float(found["cpu_seconds"])
        rejected = rejected or found["names"][:1]
        answer = "+".join(found["names"]) or found["verdict"]
        seconds = float(found["cpu_seconds"])
        rows.append((case.name, base, search, seconds, first / seconds, answer))
    return rows


def once(case: Path, model: str, without: list[str], cache: Path) -> dict[str, object]:
    """Search in a process of its own."""
    words = [sys.executable, "-m", "benchmarks.rerun", str(case), model, *without]
    alone = {
        **os.environ,
        "OPENBLAS_NUM_THREADS": "1",
        "XDG_CACHE_HOME": str(cache),
    }
    done = subprocess.run(words, check=True, capture_output=True, text=True, env=alone)
    found: dict[str, object] = json.loads(done.stdout)
    return found


def work(case: str, model: str, without: list[str]) -> dict[str, object]:
    """Search and tell what it took."""
    data = Path(case, "dataset")
    evidence = load_evidence(data)
    start = process_time()
    gap = find_gap(data, model, without=without, evidence=evidence)
    return {
        "cpu_seconds": process_time() - start,
        "names": [effect.name for effect in gap.effects],
        "verdict": gap.verdict,
    }


if __name__ == "__main__":
    case, model, *without = sys.argv[1:]
    print(json.dumps(work(case, model, without)))

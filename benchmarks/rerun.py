"""Searching again with other effects: what is kept of an earlier search saves.

The first case of the development set of the blind contest, with its model file and with
a linear base that is identified. Seconds of one processor, without the start of Python,
reading the records and the page: of a search that keeps nothing, and of the same search
after the first one of the case was kept. Each search is a process of its own.
"""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path
from time import process_time
from typing import Any

from benchmarks.gap import make_cases
from benchmarks.timing import write_table
from hystbench.gap.records.evidence import load_evidence
from hystbench.interface.gap import find_gap

CASES = 1
COLUMNS = (
    *("case", "base", "search", "from_nothing_s", "after_the_first_s"),
    *("times_quicker", "answer"),
)


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
    """Search once and keep it; then the same, and without its name."""
    kept = once(case, model, [], cache)
    rows = []
    for search, without in (("the same", []), ("without its name", kept["names"][:1])):
        if search != "the same" and not without:
            continue
        cold = once(case, model, without, None)
        warm = once(case, model, without, cache)
        seconds = float(cold["cpu_seconds"]), float(warm["cpu_seconds"])
        answer = "+".join(warm["names"]) or warm["verdict"]
        rows.append(
            (case.name, base, search, *seconds, seconds[0] / seconds[1], answer)
        )
    return rows


def once(
    case: Path, model: str, without: list[str], cache: Path | None
) -> dict[str, Any]:
    """Search in a process of its own, in a copy of what was kept."""
    with tempfile.TemporaryDirectory() as name:
        place = Path(name, "cache")
        if cache is not None and cache.is_dir():
            shutil.copytree(cache, place)
        words = [sys.executable, "-m", "benchmarks.rerun", str(case), model]
        words += ["keep" if cache is not None else "nothing", *without]
        alone = {
            **os.environ,
            "OPENBLAS_NUM_THREADS": "1",
            "XDG_CACHE_HOME": str(place),
        }
        done = subprocess.run(
            words, check=True, capture_output=True, text=True, env=alone
        )
        if cache is not None and not cache.is_dir():
            shutil.copytree(place, cache)
    found: dict[str, Any] = json.loads(done.stdout)
    return found


def work(case: str, model: str, keep: bool, without: list[str]) -> dict[str, Any]:
    """Search and tell what it took."""
    data = Path(case, "dataset")
    evidence = load_evidence(data)
    start = process_time()
    gap = find_gap(data, model, without=without, evidence=evidence, cache=keep)
    return {
        "cpu_seconds": process_time() - start,
        "names": [effect.name for effect in gap.effects],
        "verdict": gap.verdict,
    }


if __name__ == "__main__":
    case, model, keep, *without = sys.argv[1:]
    print(json.dumps(work(case, model, keep == "keep", without)))

"""The gap workflow: what a case costs, and how that grows with samples and candidates.

The cases are the first of the development set of the blind contest: twelve records and
70,000 samples each. Each measurement runs in a process of its own, so that its peak
memory is its own; its seconds leave out the start of Python, the imports and reading
the records.

How the cost grows is told by one round of naming
(:func:`hystbench.gap.naming.rank.rank`), since more data may take more rounds. Fewer
samples are the first part of each record, fewer candidates the first of the effects in
alphabetical order.
"""

from __future__ import annotations

import gc
import importlib
import json
import os
import subprocess
import sys
import tempfile
from dataclasses import replace
from pathlib import Path
from time import perf_counter, process_time

from benchmarks.timing import peak_mib, write_table
from hystbench.gap.asked import Asked
from hystbench.gap.bases.load import load_base
from hystbench.gap.effects import effects
from hystbench.gap.fitting.model_score import make_score
from hystbench.gap.fitting.on_records import start_state
from hystbench.gap.naming.rank import rank
from hystbench.gap.records.evidence import Evidence, load_evidence
from hystbench.gap.run import closed_gap
from hystbench.record import Record

CASES = 15
SHARES = (0.25, 0.5, 0.75, 1.0)  # of each record
CANDIDATES = (5, 10, 15, len(effects()))
COLUMNS = (
    *("what", "case", "records", "samples", "candidates", "seconds", "cpu_seconds"),
    *("us_per_sample", "seconds_per_candidate", "peak_mib", "answer"),
)


def main() -> None:
    """Write gap.csv."""
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name, "cases")
        make_cases(folder)
        cases = sorted(folder.iterdir())
        rows = [measured("a case", case) for case in cases]
        rows += [measured("a round", cases[0], len(effects()), s) for s in SHARES]
        rows += [measured("a round", cases[0], count) for count in CANDIDATES]
    write_table("gap.csv", COLUMNS, rows)


def make_cases(folder: Path) -> None:
    """Write the cases as a solver gets them."""
    plan = {"name": "development", "scale": 1.0}
    settings = {"plan": plan, "size": CASES, "chunk": "0000"}
    command = str(Path(sys.executable).with_name("hystbench"))
    words = [
        "job",
        "blind-make",
        "--settings",
        json.dumps(settings),
        "--out",
        str(folder),
    ]
    subprocess.run([command, *words], check=True)


def measured(
    what: str, case: Path, candidates: int = len(effects()), share: float = 1.0
) -> tuple[object, ...]:
    """Measure in a process of its own: a row of the table."""
    words = [sys.executable, "-m", "benchmarks.gap"]
    words += [what, str(case), str(candidates), str(share)]
    alone = {**os.environ, "OPENBLAS_NUM_THREADS": "1"}  # as hystbench itself
    done = subprocess.run(words, check=True, capture_output=True, text=True, env=alone)
    found = json.loads(done.stdout)
    return (
        *(what, case.name, found["records"], found["samples"], candidates),
        *(found["seconds"], found["cpu_seconds"]),
        found["seconds"] * 1e6 / found["samples"],
        found["seconds"] / candidates,
        *(found["peak_mib"], found["answer"]),
    )


def cut(record: Record, share: float) -> Record:
    """Give the first part of a record, as one without a period."""
    end = round(share * len(record.u))
    return replace(record, u=record.u[:end], y=record.y[:end], period_samples=None)


def close(evidence: Evidence, model: str) -> str:
    """Find what the model lacks, without the page; give its names."""
    base, _ = load_base(model, evidence)
    with tempfile.TemporaryDirectory() as out:
        found = closed_gap(evidence, base, Asked())
        found.write(Path(out, "gap"), report=False)
    content = found.outcome.content
    named = "+".join(item["name"] for item in content["effects"])
    return named or str(content["verdict"])


def one_round(evidence: Evidence, model: str, candidates: int, share: float) -> str:
    """Rank some of the effects beside the model on the fit records; give the best."""
    base, _ = load_base(model, evidence)
    fit = tuple(cut(record, share) for record in evidence.fit)
    state, floor = start_state(fit, base, evidence.input_hold, evidence.noise_rms)
    known = list(effects().values())[:candidates]
    score = make_score(state, floor)
    return rank(state, score, known)[0].effect


def work(what: str, case: str, candidates: int, share: float) -> dict[str, object]:
    """Do one piece of work and tell what it took."""
    evidence, model = load_evidence(Path(case, "dataset")), f"{case}/model.yaml"
    whole = what == "a case"
    records = (*evidence.fit, *evidence.hold_out) if whole else evidence.fit
    importlib.import_module("scipy.optimize")  # what a case imports on its way
    gc.freeze()  # as the command does
    wall, cpu = perf_counter(), process_time()
    answer = (
        close(evidence, model)
        if whole
        else one_round(evidence, model, candidates, share)
    )
    return {
        "seconds": perf_counter() - wall,
        "cpu_seconds": process_time() - cpu,
        "records": len(records),
        "samples": sum(round(share * len(record.u)) for record in records),
        "peak_mib": peak_mib(),
        "answer": answer,
    }


if __name__ == "__main__":
    what, case, candidates, share = sys.argv[1:]
    print(json.dumps(work(what, case, int(candidates), float(share))))

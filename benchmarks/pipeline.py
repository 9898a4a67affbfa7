"""The whole pipeline on two cores, beside one script that does the same arithmetic.

All runs are in a folder of their own, with the project's config. Where their time goes
is in jobs.csv, from the benchmark files that Snakemake writes of each job.
"""

from __future__ import annotations

import csv
import json
import os
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Callable, Iterator
from pathlib import Path
from time import perf_counter

from benchmarks.timing import least_and_median, write_table
from hystbench.yaml_files import load_yaml

ROOT = Path(__file__).parents[1]
CORES = 2
SEEN = 1.0  # seconds that a job lasts whose memory Snakemake has seen
COLUMNS = ("what", "jobs", "seconds", "median_seconds", "needed_seconds", "repeats")
JOB_COLUMNS = ("rule", "jobs", "seconds", "mean_seconds", "peak_mib")
GROWTH_COLUMNS = ("signals", "filters", "orders", "jobs", "seconds", "seconds_per_job")
FULL, NOTHING = "full reproduction, figures and report", "nothing to do"
CHANGED, HELP = "one changed step size to tables", "hystbench --help"
ALONE = "the tables alone, from nothing"
#: Seconds that each may take.
NEEDED = {FULL: 60.0, NOTHING: 2.0, CHANGED: 8.0, HELP: 0.15}
TABLES = "results/compare/tables.txt"


def main() -> None:
    """Write pipeline.csv, jobs.csv and growth.csv."""
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        config = load_yaml(ROOT / "config.yaml")
        configure(folder, config)
        rows = [(FULL, *full(folder), NEEDED[FULL])]
        jobs = list(jobs_of(folder))  # before other runs write theirs
        rows += [
            (NOTHING, *repeated(3, lambda: snakemake(folder)), NEEDED[NOTHING]),
            *(
                (f"{CHANGED}, {name}", *timed, NEEDED[CHANGED])
                for name, timed in changed(folder, config)
            ),
            (HELP, *repeated(9, lambda: hystbench("--help")), NEEDED[HELP]),
            (ALONE, *alone(folder), None),
            ("rival: one script, no figures", *rival(folder), None),
        ]
        over = [ours - its for ours, its in zip(rows[-2][2], rows[-1][2], strict=True)]
        told: list[tuple[object, ...]] = [
            *((what, jobs, *s[0:2], limit, s[2]) for what, jobs, s, limit in rows),
            (f"{ALONE}: over the rival", None, *over[:2], None, None),
        ]
        write_table("pipeline.csv", COLUMNS, told)
        write_table("jobs.csv", JOB_COLUMNS, jobs)
    write_table("growth.csv", GROWTH_COLUMNS, list(growth()))


Timed = tuple[int, tuple[float, float, int]]
"""Jobs run; least and median time and the number of repeats."""


def full(folder: Path) -> Timed:
    """From nothing to the page."""
    return repeated(1, lambda: snakemake(folder))


def changed(folder: Path, config: dict[str, object]) -> Iterator[tuple[str, Timed]]:
    """One step size is changed and the tables asked for, each filter in turn."""
    for name, steps in config["filters"]["convergence_factor"].items():  # type: ignore[index]

        def once(steps: dict[str, float] = steps) -> int:
            steps[next(iter(steps))] *= 0.99
            configure(folder, config)
            return snakemake(folder, TABLES)

        yield name, repeated(3, once)


def alone(folder: Path) -> Timed:
    """The tables from nothing, with the project's config: what the rival computes."""
    configure(folder, load_yaml(ROOT / "config.yaml"))

    def once() -> int:
        shutil.rmtree(folder / "results")
        shutil.rmtree(folder / ".snakemake")
        return snakemake(folder, TABLES)

    return repeated(3, once)


def rival(folder: Path) -> Timed:
    """One script; its errors must be those of the pipeline."""
    done: list[str] = []

    def script() -> int:
        words = [sys.executable, "-m", "benchmarks.rival", str(folder)]
        done.append(run(words, ROOT).stdout)
        return 1

    shutil.copytree(ROOT / "workflow", folder / "workflow", dirs_exist_ok=True)
    timed = repeated(3, script)
    for cell, mse in json.loads(done[0]).items():
        kept = json.loads((folder / f"results/filters/{cell}.json").read_text())["mse"]
        if kept is None or abs(kept - mse) > 1e-9 * kept:
            raise SystemExit(f"{cell}: the rival has {mse}, the pipeline {kept}")
    return timed


def growth() -> Iterator[tuple[object, ...]]:
    """Time of the tables from nothing, over signals, filters and orders."""
    config = load_yaml(ROOT / "config.yaml")
    filters = [name for name in config["models"] if name != "rdgpi"]
    every, orders = config["signals"], config["order_sweep"]["orders"]
    cases = [(s, 4, len(orders)) for s in (1, len(every) // 2, len(every))]
    cases += [(len(every), 1, len(orders)), (len(every), 4, 5)]
    for signals, models, points in cases:
        given = load_yaml(ROOT / "config.yaml")
        given["signals"], given["models"] = every[:signals], filters[:models]
        given["order_sweep"]["orders"] = orders[:points]
        with tempfile.TemporaryDirectory() as name:
            configure(Path(name), given)
            start = perf_counter()
            jobs = snakemake(Path(name), TABLES)
            seconds = perf_counter() - start
        yield signals, models, points, jobs, seconds, seconds / max(jobs, 1)


def repeated(times: int, work: Callable[[], int]) -> Timed:
    """Time a piece of work; keep what it says last of the number of jobs."""
    seconds, jobs = [], 0
    for _ in range(times):
        start = perf_counter()
        jobs = work()
        seconds.append(perf_counter() - start)
    return jobs, (*least_and_median(seconds), times)


def snakemake(folder: Path, *words: str) -> int:
    """Run the workflow in a folder; give the number of jobs that it ran."""
    snakefile = ["--snakefile", str(ROOT / "Snakefile"), "--cores", str(CORES)]
    done = run([sys.executable, "-m", "snakemake", *snakefile, *words], folder)
    told = [line.split() for line in (done.stderr + done.stdout).splitlines()]
    return next((int(w[1]) for w in told if len(w) == 2 and w[0] == "total"), 0)


def hystbench(*words: str) -> int:
    """Run the command."""
    run([str(Path(sys.executable).with_name("hystbench")), *words], ROOT)
    return 1


def run(words: list[str], folder: Path) -> subprocess.CompletedProcess[str]:
    """Run a program to its end, or end with what it said."""
    done = subprocess.run(
        words, cwd=folder, env=os.environ, capture_output=True, text=True, check=False
    )
    if done.returncode:
        raise SystemExit(f"{' '.join(words)}\n{done.stdout}{done.stderr}")
    return done


def configure(folder: Path, config: dict[str, object]) -> None:
    """Write config.yaml (JSON is YAML)."""
    (folder / "config.yaml").write_text(json.dumps(config), encoding="utf-8")


def jobs_of(folder: Path) -> Iterator[tuple[object, ...]]:
    """Sum Snakemake's benchmark files up by rule, the dearest first."""
    rules: dict[str, list[tuple[float, float | None]]] = {}
    for file in (folder / "results" / "logs" / "benchmarks").rglob("*.tsv"):
        with file.open(encoding="utf-8") as stream:
            row = next(csv.DictReader(stream, delimiter="\t"))
        place = file.relative_to(folder / "results" / "logs" / "benchmarks")
        # Snakemake looks at a job now and then: a short one is over, or has not begun.
        seen = float(row["s"]) >= SEEN and row["max_rss"] not in ("NA", "-")
        memory = float(row["max_rss"]) if seen else None
        rules.setdefault(place.parts[0].removesuffix(".tsv"), []).append(
            (float(row["s"]), memory)
        )
    for rule, found in sorted(
        rules.items(), key=lambda item: -sum(s for s, _ in item[1])
    ):
        total = sum(seconds for seconds, _ in found)
        peak = max((memory for _, memory in found if memory is not None), default=None)
        yield rule, len(found), total, total / len(found), peak


if __name__ == "__main__":
    main()

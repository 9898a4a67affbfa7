"""What the job graph itself costs Snakemake: a dry run of independent jobs."""

from __future__ import annotations

import os
import subprocess
import sys
import tempfile
from pathlib import Path

from benchmarks.timing import write_table

SIZES = (100, 1_000, 10_000)
COLUMNS = ("jobs", "cpu_seconds", "peak_mib")
SNAKEFILE = """
rule all:
    input:
        expand("cases/{case}.json", case=range(config["cases"])),


rule case:
    output:
        "cases/{case}.json",
    shell:
        "touch {output}"
"""


def main() -> None:
    """Write graph.csv."""
    with tempfile.TemporaryDirectory() as folder:
        Path(folder, "Snakefile").write_text(SNAKEFILE, encoding="utf-8")
        rows = [(size, *dry_run(folder, size)) for size in SIZES]
    write_table("graph.csv", COLUMNS, rows)


def dry_run(folder: str, cases: int) -> tuple[float, float]:
    """CPU time and peak memory of a dry run over so many jobs."""
    words = ["-n", "--quiet", "all", "--config", f"cases={cases}"]
    log = Path(folder, "log")
    with log.open("wb") as stream:
        started = subprocess.Popen(
            [sys.executable, "-m", "snakemake", *words],
            cwd=folder,
            stdout=stream,
            stderr=stream,
        )
        _, status, used = os.wait4(started.pid, 0)
    started.returncode = os.waitstatus_to_exitcode(status)
    if started.returncode:
        raise SystemExit(log.read_text(encoding="utf-8"))
    return used.ru_utime + used.ru_stime, used.ru_maxrss / 1024


if __name__ == "__main__":
    main()

"""What each kind of job imports, and what that costs at its start."""

from __future__ import annotations

import subprocess
import sys

from benchmarks.timing import interleaved, least_and_median, write_table
from hystbench.cli import COMMANDS
from hystbench.group import job_lines

COLUMNS = (
    *("command", "seconds", "median_seconds", "modules"),
    *("scipy", "pandas", "matplotlib", "costliest"),
)
HEAVY = ("scipy", "pandas", "matplotlib")
REPEATS = 3
DEAREST = 3  # packages named in the last column


def main() -> None:
    """Write imports.csv: a row a command or job, and what they are weighed against."""
    commands = {
        "(python alone)": "pass",
        "(numpy)": "import numpy",
        "(numpy, our kernels)": "import hystbench.kernels",
        "(numpy, numba)": "import numba",
        "--help": "import hystbench.cli",
        **imported(),
    }
    seconds = interleaved(
        {name: lambda code=code: start(code) for name, code in commands.items()},  # type: ignore[misc]
        REPEATS,
    )
    rows = []
    for name, code in commands.items():
        modules, packages = profile(code)
        heavy = ("yes" if each in packages else "no" for each in HEAVY)
        dearest = sorted(packages, key=lambda each: -packages[each])[:DEAREST]
        told = " ".join(f"{each}:{packages[each] / 1000:.0f}ms" for each in dearest)
        rows.append((name, *least_and_median(seconds[name]), modules, *heavy, told))
    write_table("imports.csv", COLUMNS, rows)


def imported() -> dict[str, str]:
    """Give the line that imports each command, and each job of the workflow."""
    commands = {name: f"hystbench.commands.{name}" for name in COMMANDS}
    jobs = {f"job {name}": f"hystbench.commands.jobs.{name}" for name in job_lines()}
    return {
        name: f"import {module.replace('-', '_')}"
        for name, module in (commands | jobs).items()
    }


def start(code: str) -> None:
    """Start an interpreter and run a line in it."""
    subprocess.run([sys.executable, "-c", code], check=True)


def profile(code: str) -> tuple[int, dict[str, int]]:
    """Count imported modules and sum their own times (us) by top package."""
    words = [sys.executable, "-X", "importtime", "-c", code]
    told = subprocess.run(words, check=True, capture_output=True, text=True).stderr
    packages: dict[str, int] = {}
    modules = 0
    for line in told.splitlines()[1:]:
        own, _, name = line.removeprefix("import time:").split("|")
        package = name.strip().partition(".")[0]
        packages[package] = packages.get(package, 0) + int(own)
        modules += 1
    return modules, packages

"""``hystbench job blind-solve``: one solver on the cases of a chunk."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import click

from hystbench import options
from hystbench.entrants.answers import Solver, answer_all


@click.command()
@click.argument(
    "cases", type=click.Path(exists=True, file_okay=False, path_type=Path), nargs=1
)
@options.settings
@options.out
def blind_solve(cases: Path, settings: dict[str, Any], out: Path) -> None:
    """Run a solver on each folder in CASES and write all its answers."""
    solver = Solver(
        settings["name"], tuple(settings["command"]), settings["time_limit_s"]
    )
    answer_all(solver, cases, out, settings["keep"])

"""``hystbench gap-summary``: the verdicts on several datasets as tables."""

from __future__ import annotations

from pathlib import Path

import click

from hystbench import options
from hystbench.files import read_json
from hystbench.gap.summary import write_effects, write_summary


@click.command()
@click.argument("gaps", nargs=-1, type=options.FILE)
@click.option(
    "--effects", type=options.NEW_FILE, required=True, help="Table of what was named."
)
@options.out
def gap_summary(gaps: tuple[Path, ...], effects: Path, out: Path) -> None:
    """Write one row a dataset from GAPS, its gap.json files, and one a parameter."""
    contents = [read_json(path) for path in gaps]
    write_effects(contents, effects)
    write_summary(contents, out)

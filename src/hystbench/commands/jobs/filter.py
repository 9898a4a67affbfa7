"""``hystbench job filter``: run one LMS filter on one record."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import click

from hystbench import options
from hystbench.adaptive import make_filter, run_filter
from hystbench.record import load_record
from hystbench.results import save_run


@click.command()
@click.argument("record", type=options.FILE)
@click.option("--model", required=True, help="Name of the filter.")
@options.identified
@options.settings
@options.out
@options.arrays
def filter(  # noqa: A001  (the command's name)
    record: Path,
    model: str,
    identified: dict[str, Any] | None,
    settings: dict[str, Any],
    out: Path,
    arrays: Path,
) -> None:
    """Run the filter on RECORD: errors as JSON, output and error as arrays."""
    evidence = load_record(record)
    adaptive = make_filter(model, settings, evidence, identified)
    kept, result = run_filter(adaptive, evidence, settings)
    save_run(out, arrays, kept, result.output, result.error)

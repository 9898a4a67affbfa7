"""``hystbench job gap-summary``: the verdicts on several datasets as tables."""

from __future__ import annotations

from pathlib import Path

import click

from hystbench import options
from hystbench.files import read_json
from hystbench.gap.report.tables import (
    write_adds,
    write_effects,
    write_records,
    write_sentences,
    write_summary,
)
from hystbench.model import load_model


@click.command()
@click.argument("gaps", nargs=-1, type=options.FILE)
@click.option(
    "--effects", type=options.NEW_FILE, required=True, help="Table of what was named."
)
@click.option(
    "--records",
    type=options.NEW_FILE,
    required=True,
    help="Table of the hold-out records.",
)
@click.option(
    "--sentences",
    type=options.NEW_FILE,
    required=True,
    help="Table of the verdicts in a sentence.",
)
@click.option("--twin", type=options.FILE, help="Model file of the twin.")
@click.option("--adds", type=options.NEW_FILE, help="Table of what it adds.")
@options.out
def gap_summary(
    gaps: tuple[Path, ...],
    effects: Path,
    records: Path,
    sentences: Path,
    twin: Path | None,
    adds: Path | None,
    out: Path,
) -> None:
    """Write tables of GAPS, gap.json files: datasets, parameters, records, words."""
    contents = [read_json(path) for path in gaps]
    write_effects(contents, effects)
    write_records(contents, records)
    write_sentences(contents, sentences)
    write_summary(contents, out)
    if twin is not None and adds is not None:
        write_adds(load_model(twin), adds)

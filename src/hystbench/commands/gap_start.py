"""``hystbench gap-start``: the base on the fit records, before the first round."""

from __future__ import annotations

from pathlib import Path

import click

from hystbench import options
from hystbench.files import write_json
from hystbench.gap.bases import load_base
from hystbench.gap.evidence import check_units, load_evidence
from hystbench.gap.stages import begin


@click.command()
@click.argument("dataset", type=options.DATASET)
@click.option("--model", required=True, help="As for hystbench gap.")
@click.option("--base", type=options.NEW_FILE, required=True, help="Model to write.")
@options.out
@options.kept_calls
def gap_start(dataset: Path, model: str, base: Path, out: Path) -> None:
    """Read or identify the base MODEL, and measure the noise floor.

    Opens the fit records of DATASET alone. Writes the base as a model file, and the
    progress that the first round starts from.
    """
    evidence = load_evidence(dataset, "fit")
    found, note = load_base(model, evidence)
    if note:
        click.echo(note, err=True)
    check_units(evidence, found, model)
    start = begin(evidence, found)
    found.save(base)
    write_json(out, start)

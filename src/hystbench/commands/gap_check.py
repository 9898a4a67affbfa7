"""``hystbench gap-check``: whether all records can be used, before a search is paid."""

from __future__ import annotations

from pathlib import Path

import click

from hystbench import options
from hystbench.gap.asked import IDENTIFIED, check_base
from hystbench.gap.bases import given_base
from hystbench.gap.evidence import load_evidence
from hystbench.gap.start import run_base


@click.command()
@click.argument("dataset", type=click.Path(path_type=Path))
@click.option("--model", required=True, help="As for hystbench gap.")
def gap_check(dataset: Path, model: str) -> None:
    """Check all records of DATASET, those held out too, and the base MODEL on them.

    A base that is to be identified is not checked. Writes nothing.
    """
    check_base(model)
    evidence = load_evidence(dataset)
    options.warn(evidence.warnings)
    if model not in IDENTIFIED:
        base, _ = given_base(model, evidence)
        run_base(base, evidence.hold_out, evidence.hold)
    click.echo(
        f"{evidence.name}: {len(evidence.fit)} records to fit and "
        f"{len(evidence.hold_out)} held out can be used",
        err=True,
    )

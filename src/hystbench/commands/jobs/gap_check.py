"""``hystbench job gap-check``: whether all records can be used, before a search."""

import click

from hystbench import options
from hystbench.files import write_text
from hystbench.gap.bases.kinds import IDENTIFIED, check_base
from hystbench.gap.bases.load import given_base
from hystbench.gap.fitting.on_records import run_base
from hystbench.gap.records.evidence import load_evidence
from hystbench.options import DatasetFile, Out, command


@command
@options.kept_calls
def gap_check(dataset: DatasetFile, *, model: str, out: Out | None = None) -> None:
    """Check all records of DATASET, those held out too, and the base MODEL on them.

    A base that is to be identified is not checked. OUT is an empty file.
    """
    check_base(model)
    evidence = load_evidence(dataset)
    options.warn(evidence.warnings)
    if model not in IDENTIFIED:
        base, _ = given_base(model, evidence)
        run_base(base, evidence.hold_out, evidence.input_hold)
    told = (
        f"{evidence.name}: {len(evidence.fit)} records to fit and "
        f"{len(evidence.hold_out)} held out can be used"
    )
    click.echo(told, err=True)
    if out is not None:
        write_text(out, "")  # nothing of the hold-out records is told to later jobs

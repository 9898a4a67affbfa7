"""``hystbench job gap-decide``: what to name, from the fit records alone."""

from pathlib import Path

import click

from hystbench import options
from hystbench.gap.bases.load import load_base
from hystbench.gap.records.evidence import check_units, load_evidence
from hystbench.gap.run import decide_in, write_next_experiment
from hystbench.gap.vocabulary import Vocabulary
from hystbench.job import DatasetFile, OutFolder, job


@job
@options.write_experiment
@options.vocabulary
@options.limits
@options.unnamed_share
@options.kept_calls
def gap_decide(
    dataset: DatasetFile,
    *,
    model: str,
    without: tuple[str, ...],
    with_: tuple[str, ...],
    write_experiment: Path | None,
    limit_low: float | None,
    limit_high: float | None,
    limit_rate: float | None,
    unnamed_share: float,
    out: OutFolder,
) -> None:
    """Decide what MODEL lacks beside the fit records of DATASET; opens no other.

    Writes curves.json, and the base, what was named and the decision to OUT/stages.
    """
    asked = Vocabulary.of(without, with_)  # refuses, before a file is read
    evidence = load_evidence(dataset, "fit")
    base, note = load_base(model, evidence)
    if note:
        click.echo(note, err=True)
    check_units(evidence, base, model)
    decision = decide_in(
        out,
        evidence,
        base,
        unnamed_share=unnamed_share,
        vocabulary=asked,
        limits=options.asked_limits(limit_low, limit_high, limit_rate),
        say=lambda line: click.echo(line, err=True),
    )
    if write_experiment is not None:
        # The folder is a job's output, with the signal or without.
        write_experiment.parent.mkdir(parents=True, exist_ok=True)
        told = write_next_experiment(decision, evidence.input, write_experiment)
        click.echo(told, err=True)

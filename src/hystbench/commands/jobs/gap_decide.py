"""``hystbench job gap-decide``: what to name, from the fit records alone."""

import click

from hystbench import options
from hystbench.gap.bases.load import load_base
from hystbench.gap.records.evidence import check_units, load_evidence
from hystbench.gap.run import decide_in, write_next_experiment
from hystbench.gap.vocabulary import Vocabulary
from hystbench.signature import (
    DatasetFile,
    Experiment,
    NextHigh,
    NextLow,
    NextRate,
    OutFolder,
    UnnamedShare,
    With,
    Without,
    command,
)


@command
@options.kept_calls
def gap_decide(
    dataset: DatasetFile,
    *,
    model: str,
    without: tuple[Without, ...] = (),
    with_: tuple[With, ...] = (),
    write_experiment: Experiment | None = None,
    limit_low: NextLow | None = None,
    limit_high: NextHigh | None = None,
    limit_rate: NextRate | None = None,
    unnamed_share: UnnamedShare = 0.01,
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

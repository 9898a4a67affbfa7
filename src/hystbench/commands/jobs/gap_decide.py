"""``hystbench job gap-decide``: what to name, from the fit records alone."""

from functools import partial
from typing import Any

import click

from hystbench import options
from hystbench.cores import on_cores
from hystbench.gap.asked import Asked
from hystbench.gap.bases.load import load_base
from hystbench.gap.computing_time import write_took
from hystbench.gap.records.evidence import check_units, load_evidence
from hystbench.gap.run import write_next_experiment
from hystbench.gap.stages import decide_in
from hystbench.gap.vocabulary import Vocabulary
from hystbench.options import (
    DatasetFile,
    Out,
    OutFolder,
    SearchOptions,
    command,
    of_class,
)


@partial(command, also=of_class(SearchOptions))
@options.kept_calls
def gap_decide(
    dataset: DatasetFile,
    *,
    model: str,
    out: OutFolder,
    took: Out | None = None,
    **search: Any,
) -> None:
    """Decide what MODEL lacks beside the fit records of DATASET; opens no other.

    Writes curves.json, and the base, what was named and the decision to OUT/stages.
    Writes to TOOK, if given, how long that computed.
    """
    given = SearchOptions(**search)
    asked = Asked(
        limits=given.limits,
        unnamed_share=given.unnamed_share,
        # Refuses, before a file is read.
        vocabulary=Vocabulary.of(given.without, given.with_),
        say=lambda line: click.echo(line, err=True),
    )
    evidence = load_evidence(dataset, "fit")
    with on_cores(given.most_cores):
        base, note = load_base(model, evidence)
        if note:
            click.echo(note, err=True)
        check_units(evidence, base, model)
        decision = decide_in(out, evidence, base, asked)
    if given.write_experiment is not None:
        # The folder is a job's output, with the signal or without.
        place = given.write_experiment
        place.parent.mkdir(parents=True, exist_ok=True)
        told = write_next_experiment(decision, evidence.input, place)
        click.echo(told, err=True)
    if took is not None:
        write_took(evidence.name, took)

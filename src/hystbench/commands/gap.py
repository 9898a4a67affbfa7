"""``hystbench gap``: find what a simulator lacks, add it, show the gap shrink."""

from __future__ import annotations

from typing import Annotated

import click

from hystbench import options
from hystbench.gap.bases.kinds import check_base
from hystbench.gap.experiment.excitations import Limits
from hystbench.gap.records.evidence import load_evidence
from hystbench.gap.run import will_write, write_next_experiment
from hystbench.gap.vocabulary import Vocabulary, in_words
from hystbench.interface.gap import find_gap
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
def gap(
    dataset: DatasetFile,
    *,
    model: Annotated[
        str, "Model file, gpi, linear, column, or package.module:function."
    ],
    out: OutFolder,
    without: tuple[Without, ...] = (),
    with_: tuple[With, ...] = (),
    write_experiment: Experiment | None = None,
    limit_low: NextLow | None = None,
    limit_high: NextHigh | None = None,
    limit_rate: NextRate | None = None,
    unnamed_share: UnnamedShare = 0.01,
    calls: Annotated[
        int | None,
        click.IntRange(min=1),
        "Calls of a function that are made at most; the search then ends.",
    ] = None,
    keep_calls: Annotated[
        bool,
        "Whether outputs of a slow function are kept in the user's cache folder, so "
        "that another run need not call it again.",
    ] = True,
    cache: Annotated[
        bool,
        "Whether what the search computes is kept in the user's cache folder, so that "
        "another one on the same records is quicker.",
    ] = True,
    report: Annotated[bool, "Whether to write the page."] = True,
) -> None:
    """Find what MODEL lacks beside the measurements in DATASET.

    Writes OUT/gap.json, model.yaml, holdout/ and report.html. To reject a name, run the
    same again with --without NAME; to hold your own against it, with --with NAME.
    """

    def say(line: str) -> None:
        click.echo(line, err=True)

    asked = options.asked_limits(limit_low, limit_high, limit_rate)
    check_base(model)
    Vocabulary.of(without, with_)  # refuses, before a file is read
    evidence = load_evidence(dataset)
    options.warn(evidence.warnings)
    Limits.of(evidence.fit, asked)  # refuses, before work is paid
    will_write(out, evidence)
    found = find_gap(
        dataset,
        model,
        without=without,
        with_=with_,
        limits=asked,
        unnamed_share=unnamed_share,
        calls=calls,
        keep_calls=keep_calls,
        cache=cache,
        say=say,
        evidence=evidence,
    )
    found.save(out, report)
    say(f"{found.verdict}: {found.content['reason']}")  # once all is written
    if write_experiment is not None:
        decision = found.closed.decision
        click.echo(write_next_experiment(decision, evidence.input, write_experiment))
    effects = [in_words(effect.name) for effect in found.effects]
    named = f": {', '.join(effects)}" if effects else ""
    put_in = f" (you put in {', '.join(with_)})" if with_ else ""
    click.echo(f"{out / 'gap.json'}: {found.verdict}{named}{put_in}")

"""``hystbench gap``: find what a simulator lacks, add it, show the gap shrink."""

from functools import partial
from typing import Annotated, Any

import click

from hystbench import options
from hystbench.cores import on_cores
from hystbench.gap.bases.kinds import check_base
from hystbench.gap.experiment.candidates import Limits
from hystbench.gap.records.evidence import load_evidence
from hystbench.gap.run import will_write, write_next_experiment
from hystbench.gap.vocabulary import Vocabulary, in_words
from hystbench.interface.gap import find_gap
from hystbench.options import DatasetFile, OutFolder, SearchOptions, command, of_class


@partial(command, also=of_class(SearchOptions))
def gap(
    dataset: DatasetFile,
    *,
    model: Annotated[
        str, "Model file, gpi, linear, column, or package.module:function."
    ],
    out: OutFolder,
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
    **search: Any,
) -> None:
    """Find what MODEL lacks beside the measurements in DATASET.

    Writes OUT/gap.json, model.yaml, holdout/ and report.html. To reject a name, run the
    same again with --without NAME; to hold your own against it, with --with NAME.
    """

    def say(line: str) -> None:
        click.echo(line, err=True)

    asked = SearchOptions(**search)
    limits = asked.limits
    check_base(model)
    Vocabulary.of(asked.without, asked.with_)  # refuses, before a file is read
    evidence = load_evidence(dataset)
    options.warn(evidence.warnings)
    Limits.of(evidence.fit, limits)  # refuses, before work is paid
    will_write(out, evidence)
    found = find_gap(
        dataset,
        model,
        without=asked.without,
        with_=asked.with_,
        limits=limits,
        unnamed_share=asked.unnamed_share,
        calls=calls,
        keep_calls=keep_calls,
        cache=cache,
        cores=asked.most_cores,
        say=say,
        evidence=evidence,
    )
    with on_cores(asked.most_cores):
        found.save(out, report)
    known = evidence.warnings
    options.warn(line for line in found.content["warnings"] if line not in known)
    say(f"{found.verdict}: {found.content['reason']}")  # once all is written
    if asked.write_experiment is not None:
        given = found.closed.decision, evidence.input, asked.write_experiment
        click.echo(write_next_experiment(*given))
    effects = [in_words(effect.name) for effect in found.effects]
    like = "nearest " if found.verdict == "unnamed" else ""
    named = f": {like}{', '.join(effects)}" if effects else ""
    taken = found.content["withdrawn"]
    if taken is not None and taken["names"]:
        gone = ", ".join(map(in_words, taken["names"]))
        named += f" (the hold-out records took {gone} back)"
    put_in = f" (you put in {', '.join(asked.with_)})" if asked.with_ else ""
    click.echo(f"{out / 'gap.json'}: {found.verdict}{named}{put_in}")

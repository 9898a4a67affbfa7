"""``hystbench gap-choose``: take the best effect of one round, if it pays."""

from __future__ import annotations

from pathlib import Path

import click

from hystbench import options
from hystbench.files import read_json, write_json
from hystbench.gap.bases import written_base
from hystbench.gap.evidence import load_evidence
from hystbench.gap.stages import choose


@click.command()
@click.argument("candidates", nargs=-1, required=True, type=options.FILE)
@click.option("--dataset", type=options.DATASET, required=True)
@click.option("--base", type=options.FILE, required=True, help="Model file.")
@click.option(
    "--before", type=options.FILE, required=True, help="Progress before the round."
)
@options.out
@options.kept_calls
def gap_choose(
    candidates: tuple[Path, ...], dataset: Path, base: Path, before: Path, out: Path
) -> None:
    """Rank the CANDIDATES of a round and write the progress after it."""
    evidence = load_evidence(dataset, "fit")
    model = written_base(base, evidence)
    tried = {content["effect"]: content for content in map(read_json, candidates)}
    write_json(
        out,
        choose(
            evidence,
            model,
            read_json(before),
            tried,
            say=lambda line: click.echo(line, err=True),
        ),
    )

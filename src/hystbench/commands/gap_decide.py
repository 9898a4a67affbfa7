"""``hystbench gap-decide``: verdict and model, from the fit records alone."""

from __future__ import annotations

from pathlib import Path

import click

from hystbench import options
from hystbench.gap.bases import written_base
from hystbench.gap.evidence import load_evidence
from hystbench.gap.jobs import decide_in


@click.command()
@click.argument("dataset", type=click.Path(path_type=Path))
@click.option("--base", type=options.FILE, required=True, help="Model file.")
@click.option(
    "--named",
    type=options.FILE,
    help="Progress after the last round; without it effects are named here.",
)
@click.option("--out", type=click.Path(path_type=Path), required=True)
def gap_decide(dataset: Path, base: Path, named: Path | None, out: Path) -> None:
    """Decide what BASE lacks beside the fit records of DATASET; opens no other.

    Writes model.yaml, curves.json, stages/decision.json and stages/named.json to OUT.
    """
    evidence = load_evidence(dataset, "fit")
    model = written_base(base, evidence)
    decide_in(
        out,
        evidence,
        model,
        named,
        say=lambda line: click.echo(line, err=True),
    )

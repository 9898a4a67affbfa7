"""``hystbench gap-candidate``: one effect beside the model of one round."""

from __future__ import annotations

from pathlib import Path

import click

from hystbench import options
from hystbench.errors import InputError, nearest
from hystbench.files import read_json, write_json
from hystbench.gap.bases import written_base
from hystbench.gap.effects import effects
from hystbench.gap.evidence import load_evidence
from hystbench.gap.stages import try_one


@click.command()
@click.argument("effect")
@click.option("--dataset", type=options.DATASET, required=True)
@click.option("--base", type=options.FILE, required=True, help="Model file.")
@click.option(
    "--before", type=options.FILE, required=True, help="Progress before the round."
)
@options.out
@options.kept_calls
def gap_candidate(
    effect: str, dataset: Path, base: Path, before: Path, out: Path
) -> None:
    """Try EFFECT at every place where it makes sense; opens fit records alone."""
    if effect not in effects():
        raise InputError(f"no effect {effect!r}; {nearest(effect, effects())}")
    evidence = load_evidence(dataset, "fit")
    model = written_base(base, evidence)
    write_json(out, try_one(evidence, model, read_json(before), effect))

"""``hystbench hide``: make records in which a plant hides effects."""

from __future__ import annotations

from pathlib import Path

import click

from hystbench import options
from hystbench.challenge.make import make
from hystbench.challenge.spec import CaseSpec, draw_spec, kind_of
from hystbench.challenge.writing import check_places, write_case
from hystbench.errors import InputError


@click.command()
@click.option(
    "--effect", "effects", multiple=True, help="Name of an effect; may be repeated."
)
@click.option(
    "--kind",
    help="single, pair, triple, none or unlisted: draw the effects, or say none.",
)
@click.option(
    "--family",
    default="gpi",
    help="gpi, preisach, jiles-atherton, mass-spring, free-mass, ...",
)
@click.option("--ratio-db", type=float, default=20.0, help="Gap over noise, in dB.")
@click.option("--seed", type=int, required=True)
@click.option("--spread", type=float, default=1.0, help="Factor on the ranges.")
@click.option("--campaign", default="standard", help="standard or other records.")
@options.out_folder
@click.option("--truth", type=options.NEW_FILE, required=True)
def hide(
    effects: tuple[str, ...],
    kind: str | None,
    family: str,
    ratio_db: float,
    seed: int,
    spread: float,
    campaign: str,
    out: Path,
    truth: Path,
) -> None:
    """Write DIR/dataset and DIR/model.yaml for a solver, and the truth elsewhere."""
    if effects or kind == "none":
        asked = kind_of(effects)
        if kind not in (None, asked):
            raise InputError(
                f"--kind: {kind!r} with {len(effects)} effects; expected {asked!r}"
            )
        spec = CaseSpec(seed, asked, effects, family, ratio_db, spread, campaign)
    elif kind is None:
        raise InputError("--effect: none given; expected one, or --kind")
    else:
        spec = draw_spec(seed, kind, family, ratio_db, spread=spread, campaign=campaign)
    check_places(out, truth)
    write_case(make(spec), out, truth)

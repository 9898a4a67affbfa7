"""``hystbench job twins``: errors and claims on several twins."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import click

from hystbench import options
from hystbench.files import read_json
from hystbench.twins.judge import write_twins
from hystbench.twins.parts import join
from hystbench.twins.read import read_twins


@click.command()
@click.argument("twins", type=options.FILE, nargs=-1, required=True)
@click.option("--fits", type=options.FILE, required=True, help="Of twin-fits.")
@click.option("--runs", type=options.FILE, multiple=True, help="Of twin-runs.")
@options.settings
@click.option("--errors", type=options.NEW_FILE, required=True, help="Errors to write.")
@click.option("--claims", type=options.NEW_FILE, required=True, help="Claims to write.")
def twins(
    twins: tuple[Path, ...],
    fits: Path,
    runs: tuple[Path, ...],
    settings: dict[str, Any],
    errors: Path,
    claims: Path,
) -> None:
    """Put what was run on TWINS together: errors, and where claims hold."""
    parts = [read_json(path) for path in (fits, *runs)]
    outcomes = (
        outcome
        for place, twin in enumerate(read_twins(twins))
        for outcome in join(twin, place, settings, parts)
    )
    write_twins(outcomes, errors, claims)

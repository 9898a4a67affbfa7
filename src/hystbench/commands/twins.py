"""``hystbench twins``: errors and claims on several twins."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import click

from hystbench import options
from hystbench.pressure.ensemble import fit_rdgpi, run_ensemble
from hystbench.pressure.report import write_twins
from hystbench.pressure.twins import read_twins


@click.command()
@click.argument("twins", type=options.FILE, nargs=-1, required=True)
@options.settings
@click.option("--errors", type=options.NEW_FILE, required=True, help="Errors to write.")
@click.option("--claims", type=options.NEW_FILE, required=True, help="Claims to write.")
def twins(
    twins: tuple[Path, ...], settings: dict[str, Any], errors: Path, claims: Path
) -> None:
    """Run all models on TWINS as configured: errors, and where claims hold."""
    found = []
    for twin in read_twins(twins):
        click.echo(f"twin {twin.name} ({twin.family})", err=True)
        rdgpi = fit_rdgpi(twin, settings)
        found.append(run_ensemble(twin, settings, rdgpi, seed=0, factors=[1.0]))
    write_twins(found, errors, claims)

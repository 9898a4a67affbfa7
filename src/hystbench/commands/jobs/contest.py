"""``hystbench job contest``: each filter with its own best step size."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import click

from hystbench import options
from hystbench.files import whole_folder
from hystbench.pressure.contest import Entry, hold_contest, rank
from hystbench.pressure.contest_report import WRITTEN, write_contest
from hystbench.pressure.twins import read_twins
from hystbench.published import load


@click.command()
@click.argument("twins", type=options.FILE, nargs=-1, required=True)
@options.settings
@options.out_folder
def contest(twins: tuple[Path, ...], settings: dict[str, Any], out: Path) -> None:
    """Run all filters on TWINS with a grid of step sizes, LMS and normalized LMS."""
    with whole_folder(out, WRITTEN) as fresh:
        entries: list[Entry] = []
        for twin in read_twins(twins):
            click.echo(f"twin {twin.name} ({twin.family})", err=True)
            entries += hold_contest(twin, settings)
        published = {(p.signal, p.model): p.mse.value for p in load()}
        write_contest(entries, rank(entries, published), fresh)

"""``hystbench job constants``: the ranking with other constants."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import click

from hystbench import options
from hystbench.compare.constants import write_constants
from hystbench.published import load
from hystbench.twins.constants import vary_constants
from hystbench.twins.read import read_twins


@click.command()
@click.argument("twins", type=options.FILE, nargs=-1, required=True)
@options.identified
@options.settings
@options.out
def constants(
    twins: tuple[Path, ...],
    identified: dict[str, Any] | None,
    settings: dict[str, Any],
    out: Path,
) -> None:
    """Rank the filters on TWINS with other zero errors and with a constant tap."""
    published = {(p.signal, p.model): p.mse.value for p in load()}
    rows = [
        row
        for twin in read_twins(twins)
        for row in vary_constants(twin, settings, identified, published)
    ]
    write_constants(rows, out)

"""``hystbench job twin-fits``: Algorithm 1 and the RDGPI model on several twins."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import click

from hystbench import options
from hystbench.files import write_json
from hystbench.twins.fits import fit
from hystbench.twins.read import read_twins


@click.command()
@click.argument("twins", type=options.FILE, nargs=-1, required=True)
@options.settings
@options.out
def twin_fits(twins: tuple[Path, ...], settings: dict[str, Any], out: Path) -> None:
    """Fit on TWINS what no step size changes."""
    write_json(out, fit(read_twins(twins), settings))

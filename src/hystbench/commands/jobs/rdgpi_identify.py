"""``hystbench job rdgpi-identify``: fit the RDGPI model to records."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import click

from hystbench import options
from hystbench.files import write_json
from hystbench.rdgpi import identify_rdgpi
from hystbench.record import load_record


@click.command()
@click.argument("records", type=options.FILE, nargs=-1, required=True)
@options.settings
@options.out
def rdgpi_identify(
    records: tuple[Path, ...], settings: dict[str, Any], out: Path
) -> None:
    """Fit the RDGPI model to all RECORDS at once, in free run."""
    fit = identify_rdgpi([load_record(path) for path in records], **settings)
    write_json(
        out,
        {
            "parameters": fit.model.to_dict(),
            "relative_error": fit.relative_error,
            "starts": fit.starts,
        },
    )

"""``hystbench job blind-make``: the cases of a chunk, as solvers get them."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import click

from hystbench import options
from hystbench.challenge.contest.chunk import WRITTEN, make_chunk
from hystbench.challenge.contest.plan import chunks, plan
from hystbench.files import whole_folder


@click.command()
@options.settings
@options.out_folder
def blind_make(settings: dict[str, Any], out: Path) -> None:
    """Write a folder a case; no truth is written anywhere."""
    entries = chunks(plan(**settings["plan"]), settings["size"])
    with whole_folder(out, WRITTEN) as fresh:
        make_chunk(entries[settings["chunk"]], fresh)

"""``hystbench job report``: the front page of the results."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import click

from hystbench import options
from hystbench.files import write_text
from hystbench.report.reproduction.page import page
from hystbench.report.reproduction.read import read_content

FOLDER = click.Path(exists=True, file_okay=False, path_type=Path)


@click.command()
@click.argument("compare", type=FOLDER)
@click.option("--figure", "figures", multiple=True, type=options.FILE, help="SVG.")
@click.option("--table", "tables", multiple=True, type=options.FILE, help="CSV.")
@click.option("--captions", type=FOLDER, required=True, help="Folder of captions.")
@options.settings
@options.out
def report(
    compare: Path,
    figures: tuple[Path, ...],
    tables: tuple[Path, ...],
    captions: Path,
    settings: dict[str, Any],
    out: Path,
) -> None:
    """Write one page on what a comparison left in the folder COMPARE."""
    content = read_content(out.parent, compare, figures, tables, captions, settings)
    write_text(out, page(content))

"""``hystbench show``: print the tables of a comparison."""

from __future__ import annotations

from pathlib import Path

import click

from hystbench import options


@click.command()
@click.argument("text", type=options.FILE)
def show(text: Path) -> None:
    """Print TEXT, the tables that a comparison wrote for the terminal."""
    click.echo(text.read_text(encoding="utf-8"), nl=False)

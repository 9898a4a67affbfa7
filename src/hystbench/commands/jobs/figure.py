"""``hystbench job figure``: draw one figure from files of results."""

from __future__ import annotations

import inspect
from pathlib import Path
from typing import Any

import click

from hystbench import options
from hystbench.errors import InputError
from hystbench.figures import drawer


@click.command()
@click.argument("name")
@click.option("--record", "records", multiple=True, type=options.FILE, help="Record.")
@click.option(
    "--run", "runs", multiple=True, type=options.FILE, help="Run, its arrays beside it."
)
@click.option("--table", type=options.FILE, help="Table (CSV).")
@options.identified_file
@click.option(
    "--out",
    "outs",
    multiple=True,
    required=True,
    type=options.NEW_FILE,
    help="PNG or SVG file to write; once for each.",
)
def figure(name: str, outs: tuple[Path, ...], **given: Any) -> None:
    """Draw the figure NAME and write it to every --out."""
    draw = drawer(name)
    from hystbench.figures import style

    with style.in_style():
        drawn = draw(**_inputs(name, inspect.signature(draw), given))
        for out in outs:
            style.save(drawn, out)


def _inputs(
    name: str, signature: inspect.Signature, given: dict[str, Any]
) -> dict[str, Any]:
    """Take what a figure is drawn from, and refuse what it does not use."""
    for key, value in given.items():
        option = f"--{key.removesuffix('s')}"
        if value and key not in signature.parameters:
            raise InputError(f"figure {name}: does not use {option}; leave it out")
        if not value and key in signature.parameters:
            raise InputError(f"figure {name}: expected {option}")
    return {key: given[key] for key in signature.parameters}

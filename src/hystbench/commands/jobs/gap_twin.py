"""``hystbench job gap-twin``: the worked example's records and base."""

from __future__ import annotations

from pathlib import Path

import click

from hystbench import options
from hystbench.files import read_json, whole_folder
from hystbench.gap.example import WRITTEN, write_example
from hystbench.record import load_record


@click.command()
@click.option("--fit", multiple=True, required=True, type=options.FILE, help="Record.")
@click.option(
    "--hold-out", multiple=True, required=True, type=options.FILE, help="Record."
)
@click.option(
    "--identified",
    type=options.FILE,
    required=True,
    help="What Algorithm 1 found (JSON).",
)
@options.out_folder
def gap_twin(
    fit: tuple[Path, ...], hold_out: tuple[Path, ...], identified: Path, out: Path
) -> None:
    """Write records as a dataset and the identified model as the base beside them.

    Writes OUT/dataset/ and OUT/base.yaml.
    """
    with whole_folder(out, WRITTEN) as fresh:
        write_example(
            [load_record(path) for path in fit],
            [load_record(path) for path in hold_out],
            read_json(identified),
            fresh,
        )

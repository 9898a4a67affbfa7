"""``hystbench init``: propose a dataset.yaml for files of measurements."""

import sys
from collections.abc import Sequence
from functools import partial
from pathlib import Path
from typing import Annotated, Any

import click

from hystbench import options
from hystbench.command_files import writes
from hystbench.errors import InputError
from hystbench.files import write_text
from hystbench.inspection.draft import draft
from hystbench.inspection.entries import dataset_text
from hystbench.inspection.input_summary import summary_of
from hystbench.inspection.user import Flags
from hystbench.options import In, command, of_class
from hystbench.templates import templates

PLACE = "dataset.yaml"


@partial(command, also=of_class(Flags))
def init(
    files: tuple[In, ...],
    *,
    out: Annotated[
        Path | None,
        options.NEW_FILE,
        "The dataset.yaml to write; by default beside the first file.",
    ] = None,
    **given: Any,
) -> None:
    """Propose a dataset.yaml for FILES: CSV, MATLAB, HDF5, Parquet, TDMS, .npz, WAV.

    Columns, units, periods and roles are found; what cannot be found is asked, or has
    to be said by an option where nobody is there to be asked.
    """
    place = out or files[0].parent / PLACE
    if out is None:
        writes(place)  # refuses, before work is paid
    there = sys.stdin.isatty() and sys.stdout.isatty()
    found = draft(files, place, Flags(**given), _asked if there else _refused)
    write_text(place, dataset_text(found.dataset.about))
    kinds = [summary_of(record.u, record.dt).kind for record in found.records]
    given = {"place": place, "found": found, "kinds": kinds}
    click.echo(templates(__package__).get_template("init.txt.j2").render(given))
    options.warn(found.warnings)


def _refused(
    question: str, choices: Sequence[str], flag: str, likely: str | None
) -> str:
    """Refuse what nobody is there to be asked, unless something is likely."""
    if likely is not None:
        return likely
    told = f"; expected one of {', '.join(choices)}" if choices else ""
    raise InputError(f"{question}: not told; say {flag}{told}")


def _asked(
    question: str, choices: Sequence[str], _flag: str, likely: str | None
) -> str:
    """Ask on the terminal."""
    kind = click.Choice(list(choices)) if choices else None
    answer: str = click.prompt(question, type=kind, default=likely, err=True)
    return answer

"""``hystbench init``: propose a dataset.yaml for files of measurements."""

from __future__ import annotations

import sys
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import click

from hystbench import options
from hystbench.device_kinds import DEVICE_KINDS
from hystbench.errors import InputError
from hystbench.files import write_text
from hystbench.inspection.columns import Flags
from hystbench.inspection.draft import Draft, draft
from hystbench.inspection.writing import yaml_text
from hystbench.written import writes

PLACE = "dataset.yaml"


@click.command()
@click.argument("files", type=options.FILE, nargs=-1, required=True)
@click.option("--input", help="Column of the input.")
@click.option("--output", help="Column of the output.")
@click.option("--time", help="Column of time.")
@click.option("--input-unit", help="Its unit, such as A; '-' for none.")
@click.option("--output-unit", help="Its unit, such as um; '-' for none.")
@click.option("--time-unit", help="Its unit; seconds where the file tells none.")
@click.option(
    "--sampling-frequency",
    "sampling_frequency_hz",
    type=float,
    help="In Hz, where no column is time.",
)
@click.option("--hold-out", multiple=True, help="Name of a record to hold out.")
@click.option(
    "--missing",
    type=click.Choice(["interpolate", "split"]),
    help="What to do where samples are missing.",
)
@click.option("--device", type=click.Choice(DEVICE_KINDS), help="Kind of the device.")
@click.option("--name", help="Name of the dataset; by default that of its folder.")
@click.option(
    "--out",
    type=options.NEW_FILE,
    help="The dataset.yaml to write; by default beside the first file.",
)
def init(files: Sequence[Path], out: Path | None, **given: Any) -> None:
    """Propose a dataset.yaml for FILES: CSV, MATLAB, HDF5, Parquet, TDMS, .npz, WAV.

    Columns, units, periods and roles are found; what cannot be found is asked, or has
    to be said by an option where nobody is there to be asked.
    """
    place = out or files[0].parent / PLACE
    if out is None:
        writes(place)  # refuses, before work is paid
    there = sys.stdin.isatty() and sys.stdout.isatty()
    found = draft(files, place, Flags(**given), _asked if there else _refused)
    write_text(place, yaml_text(found.dataset.about))
    for line in _said(place, found):
        click.echo(line)
    options.warn(found.warnings)


def _refused(question: str, choices: Sequence[str], flag: str) -> str:
    """Refuse what nobody is there to be asked; units alone have a word for unknown."""
    if flag.endswith("-unit"):
        return "-"
    told = f"; expected one of {', '.join(choices)}" if choices else ""
    raise InputError(f"{question}: not told; say {flag}{told}")


def _asked(question: str, choices: Sequence[str], flag: str) -> str:
    """Ask on the terminal."""
    kind = click.Choice(list(choices)) if choices else None
    default = "-" if flag.endswith("-unit") else None
    answer: str = click.prompt(question, type=kind, default=default, err=True)
    return answer


def _said(place: Path, found: Draft) -> list[str]:
    """Tell what was written, and what to do next."""
    about = found.dataset.about
    lines = [
        f"{place}: {len(found.records)} records of {found.dataset.name}",
        *(
            f"  {key}: {about[key]['column']} ({about[key]['unit']})"
            for key in ("time", "input", "output", "simulated")
            if key in about
        ),
    ]
    width = max(len(record.name) for record in found.records)
    for record in found.records:
        item = found.inputs[record.name]
        period = record.period_samples
        lines.append(
            f"  {record.name:{width}}  {record.use:8}  {len(record)} samples at "
            f"{1 / record.dt:.6g} Hz, {item.kind}, "
            + (f"period_samples: {period}" if period else "no period")
        )
    lines += [f"  note: {note}" for note in found.notes]
    base = "column" if "simulated" in about else "linear"
    folder = place.parent
    lines += [
        "Next:",
        f"  hystbench check {place} --out {folder / 'check.html'}",
    ]
    if any(record.use == "hold-out" for record in found.records):  # gap wants one
        lines.append(f"  hystbench gap {place} --model {base} --out {folder / 'gap'}")
    return lines

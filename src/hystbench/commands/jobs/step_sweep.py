"""``hystbench job step-sweep``: how far each step size can go."""

from __future__ import annotations

import math
from dataclasses import astuple, fields
from pathlib import Path
from typing import Any

import click

from hystbench import options
from hystbench.compare.edges import write_edges
from hystbench.files import write_csv
from hystbench.record import load_record
from hystbench.twins.edges import Point, sweep


@click.command()
@click.argument("records", type=options.FILE, nargs=-1, required=True)
@options.identified
@options.settings
@click.option("--edges", type=options.NEW_FILE, required=True, help="CSV to write.")
@click.option("--points", type=options.NEW_FILE, required=True, help="CSV to write.")
def step_sweep(
    records: tuple[Path, ...],
    identified: dict[str, Any] | None,
    settings: dict[str, Any],
    edges: Path,
    points: Path,
) -> None:
    """Raise each filter's step sizes on RECORDS up to their edge."""
    read = {record.name: record for record in map(load_record, records)}
    found, run = sweep(read, settings, identified)
    write_edges(found, edges)
    rows = (
        [
            ("" if v is None or math.isinf(v) else f"{v:.4g}")
            if not isinstance(v, str)
            else v
            for v in astuple(point)
        ]
        for point in run
    )
    write_csv(points, [field.name for field in fields(Point)], rows)

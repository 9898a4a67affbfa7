"""``hystbench job tracking``: follow references with and without the inverse."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import click
import numpy as np

from hystbench import options
from hystbench.files import whole_folder, write_csv, write_text
from hystbench.inverse.told import table, verdict
from hystbench.inverse.tracking import (
    OWN,
    WITH,
    WITHOUT,
    Line,
    Reference,
    Tracked,
    references,
    track,
)
from hystbench.model import load_model
from hystbench.record import FloatArray
from hystbench.signals import load_signal

SHOWN_S = 0.15
"""Time of the last reference that is kept, for the figure."""
WRITTEN = ("tracking.csv", "raster.csv", "tracking.md", "verdict.md")


@click.command()
@click.argument("signals", type=options.FILE, nargs=-1, required=True)
@click.option("--plant", type=options.FILE, required=True, help="The twin (YAML).")
@click.option("--base", type=options.FILE, required=True, help="Its slow loop's model.")
@click.option(
    "--slow", type=options.FILE, required=True, help="Signal of the linear gain."
)
@click.option(
    "--augmented", type=options.FILE, required=True, help="The model with the effects."
)
@options.settings
@options.out_folder
def tracking(
    signals: tuple[Path, ...],
    plant: Path,
    base: Path,
    slow: Path,
    augmented: Path,
    settings: dict[str, Any],
    out: Path,
) -> None:
    """Drive the twin open loop with inputs for references of the SIGNALS' forms.

    Each reference is followed with a linear gain, with the inverse of the slow loop's
    model, with that of the augmented model, and with that of the twin itself.
    """
    given = [load_signal(path) for path in signals]
    twin, of_loop = load_model(plant), load_model(base)
    models = {WITHOUT: of_loop, WITH: load_model(augmented), OWN: twin}
    line = Line.of(of_loop, load_signal(slow))
    rest = float(twin.simulate(np.zeros(64), given[0].dt)[-1])
    wanted = references(given, settings["highest_hz"], line, rest)
    rows = track(twin, settings["input_zero_error"], models, line, wanted)
    with whole_folder(out, WRITTEN) as fresh:
        cells = [_cells(row, twin.output.unit) for row in rows]
        values = (list(each.values()) for each in cells)
        write_csv(fresh / "tracking.csv", list(cells[0]), values)
        scan = _part(rows, wanted[-1])
        write_csv(fresh / "raster.csv", list(scan), _lines(scan))
        write_text(fresh / "tracking.md", table(rows, twin.output.unit))
        write_text(fresh / "verdict.md", verdict(rows))


def _cells(row: Tracked, unit: str) -> dict[str, str]:
    return {
        "reference": row.reference.name,
        "highest_hz": f"{row.reference.highest_hz:g}",
        "drive": row.drive,
        "stroke": f"{row.stroke:.4g}",
        "unit": unit,
        "rms_percent": f"{100 * row.rms:.3g}",
        "largest_percent": f"{100 * row.largest:.3g}",
        "largest_input": f"{np.abs(row.u).max():.4g}",
    }


def _lines(columns: dict[str, FloatArray]) -> list[list[str]]:
    together = zip(*columns.values(), strict=True)
    return [[f"{value:.9g}" for value in line] for line in together]


def _part(rows: list[Tracked], reference: Reference) -> dict[str, FloatArray]:
    """Give a part of a reference in time, and what the plant does with each drive."""
    middle = len(reference.y) // 2
    part = slice(middle, middle + round(SHOWN_S / reference.dt))
    time = np.arange(len(reference.y[part]), dtype=np.float64) * reference.dt
    own = {row.drive: row.y[part] for row in rows if row.reference is reference}
    return {"time_s": time, "reference": reference.y[part], **own}

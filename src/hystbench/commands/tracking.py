"""``hystbench tracking``: follow references with and without the inverse."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import click
import numpy as np

from hystbench import options
from hystbench.figures import style, tracking_errors
from hystbench.files import whole_folder, write_csv, write_text
from hystbench.inverse.told import table, verdict
from hystbench.inverse.tracking import (
    OWN,
    WITH,
    WITHOUT,
    Line,
    Tracked,
    references,
    track,
)
from hystbench.model import load_model
from hystbench.signals import load_signal

WRITTEN = ("tracking.csv", "tracking.md", "verdict.md", "tracking.png", "tracking.svg")


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
        write_csv(fresh / "tracking.csv", list(_cells(rows[0])), map(_values, rows))
        write_text(fresh / "tracking.md", table(rows, twin.output.unit))
        write_text(fresh / "verdict.md", verdict(rows))
        with style.in_style():
            figure = tracking_errors.draw(rows, twin.output)
            for suffix in (".png", ".svg"):
                style.save(figure, fresh / f"tracking{suffix}")


def _cells(row: Tracked) -> dict[str, str]:
    return {
        "reference": row.reference.name,
        "highest_hz": f"{row.reference.highest_hz:g}",
        "drive": row.drive,
        "stroke": f"{row.stroke:.4g}",
        "rms_percent": f"{100 * row.rms:.3g}",
        "largest_percent": f"{100 * row.largest:.3g}",
        "largest_input": f"{np.abs(row.u).max():.4g}",
    }


def _values(row: Tracked) -> list[str]:
    return list(_cells(row).values())

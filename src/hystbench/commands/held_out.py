"""``hystbench held-out``: the structures that were tried on the held-out signals."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import click
import numpy as np

from hystbench import options
from hystbench.calibration.structures import find_structure, make_objective
from hystbench.errors import InputError, nearest
from hystbench.files import read_json, write_csv
from hystbench.published import FILTERS, load
from hystbench.schema import load_yaml

COLUMNS = (
    "structure",
    "chosen",
    "left_out_score",
    *(f"held_out_median_{model}" for model in FILTERS),
    "held_out_within_factor_2",
    "held_out_worst_factor",
)


@click.command()
@click.argument("tried", type=options.FILE, nargs=-1, required=True)
@click.option("--choice", type=options.FILE, required=True, help="Committed choice.")
@options.settings
@click.option("--out", type=options.NEW_FILE, required=True)
def held_out(
    tried: tuple[Path, ...], choice: Path, settings: dict[str, Any], out: Path
) -> None:
    """Judge every structure in TRIED on the held-out signals, after the choice.

    All by one rule, as fitted to the calibration signals; none is refitted.
    """
    found = sorted((read_json(path) for path in tried), key=lambda one: one["score"])
    names = [one["name"] for one in found]
    chosen = load_yaml(choice)["chosen"]["name"]
    if chosen not in names:
        raise InputError(
            f"{choice}: chosen: name: {chosen!r} was not tried; "
            f"{nearest(chosen, names)}"
        )
    published = {(pair.signal, pair.model): pair.mse.value for pair in load()}
    rows = []
    for one in found:
        objective = make_objective(find_structure(one["name"]), settings)
        cells = objective.cells(one["values"], settings["signals"])
        sizes = np.abs(
            [
                [np.log10(mse[model] / published[signal, model]) for model in FILTERS]
                for signal, mse in cells.mse.items()
            ]
        )
        rows.append(
            [
                one["name"],
                "yes" if one["name"] == chosen else "",
                f"{one['score']:.2f}",
                *(f"{value:.3f}" for value in np.median(sizes, axis=0)),
                f"{np.mean(sizes <= np.log10(2)):.3f}",
                f"{10 ** sizes.max():.2f}",
            ]
        )
    write_csv(out, COLUMNS, rows)

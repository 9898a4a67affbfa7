"""``hystbench job held-out``: judge what was tried on the held-out signals."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import click
import numpy as np

from hystbench import options
from hystbench.calibration.choice import check_committed
from hystbench.calibration.structures import find_structure, make_objective
from hystbench.errors import InputError, nearest
from hystbench.files import read_json, write_csv
from hystbench.published import FILTERS, load
from hystbench.published.consistency import check
from hystbench.yaml_files import load_yaml

COLUMNS = (
    "structure",
    "chosen",
    "left_out_score",
    *(f"held_out_median_{model}" for model in FILTERS),
    "held_out_within_factor_2",
    "held_out_worst_factor",
    "held_out_rms_percent",
)


@click.command()
@click.argument("tried", type=options.FILE, nargs=-1, required=True)
@click.option("--choice", type=options.FILE, required=True, help="Committed choice.")
@options.settings
@options.out
def held_out(
    tried: tuple[Path, ...], choice: Path, settings: dict[str, Any], out: Path
) -> None:
    """Judge every structure in TRIED on the held-out signals, after the choice.

    All by one rule, as fitted to the calibration signals; none is refitted. Refused
    unless the choice is committed and names one of them. The last columns have the
    error of the RMS displacement (percent): its largest magnitude, and that of each
    signal.
    """
    found = sorted((read_json(path) for path in tried), key=lambda one: one["score"])
    names = [one["name"] for one in found]
    chosen = load_yaml(choice)["chosen"]["name"]
    if chosen not in names:
        raise InputError(
            f"{choice}: chosen: name: {chosen!r} was not tried; "
            f"{nearest(chosen, names)}"
        )
    check_committed(choice, tell=lambda line: click.echo(line, err=True))
    signals = list(settings["signals"])
    rows = [
        [
            one["name"],
            "yes" if one["name"] == chosen else "",
            f"{one['score']:.2f}",
            *_figures(one, settings),
        ]
        for one in found
    ]
    write_csv(out, (*COLUMNS, *(f"rms_percent_{name}" for name in signals)), rows)


def _figures(one: Mapping[str, Any], settings: Mapping[str, Any]) -> list[str]:
    """Errors of a fitted structure on the signals of the settings, as in the table."""
    published = {(pair.signal, pair.model): pair.mse.value for pair in load()}
    checked = check(load())
    values = one["values"]
    objective = make_objective(find_structure(one["name"]), settings).at(values)
    cells = objective.cells(values, settings["signals"])
    sizes = np.abs(
        [
            [np.log10(mse[model] / published[signal, model]) for model in FILTERS]
            for signal, mse in cells.mse.items()
        ]
    )
    percent = [
        100 * (rms / checked[signal].implied_rms - 1)
        for signal, rms in cells.rms.items()
    ]
    return [
        *(f"{value:.3f}" for value in np.median(sizes, axis=0)),
        f"{np.mean(sizes <= np.log10(2)):.3f}",
        f"{10 ** sizes.max():.2f}",
        f"{np.abs(percent).max():.1f}",
        *(f"{value:+.1f}" for value in percent),
    ]

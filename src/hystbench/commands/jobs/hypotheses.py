"""``hystbench job hypotheses``: what could explain the errors that stay far off."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import click

from hystbench import options
from hystbench.files import write_csv
from hystbench.pressure.hypotheses import Row, chirp_rows, volterra_rows
from hystbench.pressure.twins import read_twins
from hystbench.published import FILTERS, load


@click.command()
@click.argument("twin", type=options.FILE)
@options.settings
@click.option("--chirp", type=options.NEW_FILE, required=True, help="CSV to write.")
@click.option("--volterra", type=options.NEW_FILE, required=True, help="CSV to write.")
def hypotheses(
    twin: Path, settings: dict[str, Any], chirp: Path, volterra: Path
) -> None:
    """Run the filters on TWIN with one thing changed at a time; nothing is fitted."""
    (read,) = read_twins([twin])
    printed = {(p.signal, p.model): p.mse.text for p in load()}
    rows = list(chirp_rows(read, settings))
    told = [printed[rows[0].signal, model] for model in FILTERS]
    lines = [["the paper's table", *told]]
    lines += [
        [row.changed, *(_number(row.mse[model]) for model in FILTERS)] for row in rows
    ]
    write_csv(chirp, ["changed", *FILTERS], lines)
    write_csv(volterra, *_volterra(list(volterra_rows(read, settings)), printed))


def _volterra(
    rows: list[Row], printed: dict[tuple[str, str], str]
) -> tuple[list[str], list[list[str]]]:
    """A line for each step size and part of the record, a column for each signal."""
    signals = list(dict.fromkeys(row.signal for row in rows))
    found = {(row.changed, row.part, row.signal): row.mse["volterra"] for row in rows}
    lines = [["the paper's table", "", *(printed[s, "volterra"] for s in signals)]]
    for changed, part in dict.fromkeys((row.changed, row.part) for row in rows):
        values = [found.get((changed, part, s), math.inf) for s in signals]
        lines.append([changed, part, *map(_number, values)])
    return ["changed", "part", *signals], lines


def _number(value: float) -> str:
    return "diverged" if math.isinf(value) else f"{value:.3g}"

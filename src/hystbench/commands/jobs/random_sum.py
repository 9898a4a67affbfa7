"""``hystbench job random-sum``: the random sum drawn many times."""

from __future__ import annotations

from pathlib import Path
from statistics import fmean
from typing import Any

import click

from hystbench import options
from hystbench.compare.draws import write_draws
from hystbench.files import read_json, write_csv
from hystbench.published import load
from hystbench.published.consistency import check
from hystbench.rdgpi import RateDependentGPI
from hystbench.twins.draws import READING_COLUMNS, readings, run_draws
from hystbench.twins.read import read_twins


@click.command()
@click.argument("twin", type=options.FILE)
@options.identified
@click.option("--rdgpi", type=options.FILE, help="Identified RDGPI model (JSON).")
@options.settings
@click.option("--draws", type=options.NEW_FILE, required=True, help="CSV to write.")
@click.option("--readings", "told", type=options.NEW_FILE, required=True, help="CSV.")
def random_sum(
    twin: Path,
    identified: dict[str, Any] | None,
    rdgpi: Path | None,
    settings: dict[str, Any],
    draws: Path,
    told: Path,
) -> None:
    """Run all models on draws of the random sum: each draw, and what they say."""
    fitted = None
    if rdgpi is not None:
        fitted = RateDependentGPI.from_dict(read_json(rdgpi)["parameters"])
    found = run_draws(read_twins([twin])[0], settings, identified, fitted)
    signal = settings["signal"]
    write_draws(signal, found, draws)
    published = {p.model: p.mse.value for p in load() if p.signal == signal}
    implied = check(load())[signal].rms
    rms = fmean((each.low + each.high) / 2 for each in implied)
    write_csv(told, READING_COLUMNS, readings(found, published, rms))

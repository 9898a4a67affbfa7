"""``hystbench job random-sum``: the random sum drawn many times."""

from __future__ import annotations

from dataclasses import fields
from pathlib import Path
from statistics import fmean
from typing import Any

import click

from hystbench import options
from hystbench.compare.draws import write_draws
from hystbench.files import read_json, write_csv
from hystbench.pressure.draws import Reading, readings, run_draws
from hystbench.pressure.twins import read_twins
from hystbench.published import load
from hystbench.published.consistency import check
from hystbench.rdgpi import RateDependentGPI


@click.command()
@click.argument("twin", type=options.FILE)
@options.identified
@click.option("--rdgpi", type=options.FILE, help="Identified RDGPI model (JSON).")
@options.settings
@click.option("--draws", type=options.NEW_FILE, required=True, help="CSV to write.")
@click.option("--readings", "told", type=options.NEW_FILE, required=True, help="CSV.")
def random_sum(
    twin: Path,
    identified: Path | None,
    rdgpi: Path | None,
    settings: dict[str, Any],
    draws: Path,
    told: Path,
) -> None:
    """Run all models on draws of the random sum: each draw, and what they say."""
    fitted = None
    if rdgpi is not None:
        fitted = RateDependentGPI.from_dict(read_json(rdgpi)["parameters"])
    envelopes = {} if identified is None else read_json(identified)
    found = run_draws(read_twins([twin])[0], settings, envelopes, fitted)
    signal = settings["signal"]
    write_draws(signal, found, draws)
    published = [pair for pair in load() if pair.signal == signal]
    implied = check(load())[signal].rms
    rms = fmean((each.low + each.high) / 2 for each in implied)
    rows = [
        [
            each.sines,
            each.quantity,
            *(f"{getattr(each, key):.4g}" for key in _NUMBERS),
            f"{each.ratio:.2f}",
        ]
        for each in readings(found, published, rms)
    ]
    names = [field.name for field in fields(Reading)]
    write_csv(told, [*names, "median_over_published"], rows)


_NUMBERS = ("published", "median", "low", "high")

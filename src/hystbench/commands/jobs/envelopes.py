"""``hystbench job envelopes``: the GPO filter with either envelope functions."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import click

from hystbench import options
from hystbench.adaptive import make_filter, run_filter
from hystbench.files import write_csv
from hystbench.record import load_record

COLUMNS = ["signal", "envelopes", "mse", "re", "status"]


@click.command()
@click.argument("records", type=options.FILE, nargs=-1, required=True)
@options.identified
@options.settings
@options.out
def envelopes(
    records: tuple[Path, ...],
    identified: dict[str, Any] | None,
    settings: dict[str, Any],
    out: Path,
) -> None:
    """Run the GPO filter on RECORDS with identified and published envelopes."""
    rows = []
    for path in records:
        record = load_record(path)
        # The published envelopes are those of one actuator, in amperes.
        twin = record.origin == "twin"
        for source in ("identified", "published") if twin else ("identified",):
            chosen = settings | {"envelopes": source}
            adaptive = make_filter("gpo", chosen, record, identified)
            kept, _ = run_filter(adaptive, record, chosen)
            told = kept["diverged"]
            status = told["sentence"] if told else "finite"
            rows.append([record.name, source, kept["mse"], kept["re"], status])
    write_csv(out, COLUMNS, rows)

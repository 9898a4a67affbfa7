"""``hystbench job rdgpi``: simulate the RDGPI model on one record."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import click

from hystbench import options
from hystbench.files import read_json
from hystbench.rdgpi import RateDependentGPI
from hystbench.record import load_record
from hystbench.results import run_result, save_run


@click.command()
@click.argument("record", type=options.FILE)
@click.option("--identified", type=options.FILE, required=True, help="Fit (JSON).")
@options.settings
@options.out
@options.arrays
def rdgpi(
    record: Path, identified: Path, settings: dict[str, Any], out: Path, arrays: Path
) -> None:
    """Simulate the identified RDGPI model freely on RECORD."""
    evidence = load_record(record)
    model = RateDependentGPI.from_dict(read_json(identified)["parameters"])
    output = model.simulate(evidence.u, evidence.dt)
    error = evidence.y - output
    result = run_result(evidence, "rdgpi", error, "free-run simulation", **settings)
    result |= {
        "order": model.order,
        "taps": None,
        "step_size": {},
        "bound": {},
        "eigenvalues": None,
        "weights": [],
    }
    save_run(out, arrays, result, output, error)

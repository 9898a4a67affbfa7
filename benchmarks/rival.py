"""The plainest rival of the pipeline: one script, one process, no files between.

It does the arithmetic of all tables with the same functions, in order, and
prints the errors of all runs as JSON. It draws no figures, judges no claims and keeps
nothing for a second run.
"""

from __future__ import annotations

import json
import sys
from pathlib import Path

from hystbench.adaptive import make_filter, run_filter
from hystbench.identification.algorithm import identify_slow_loop
from hystbench.metrics import mean_square_error
from hystbench.model import load_model
from hystbench.order_errors import filters_by_order, order_errors
from hystbench.rdgpi import identify_rdgpi
from hystbench.settings import read_settings
from hystbench.signals import make_signal
from hystbench.twin_record import record_of_twin
from hystbench.twins.fits import fit
from hystbench.twins.parts import run
from hystbench.twins.runs import read_twins
from hystbench.yaml_files import load_yaml


def main(root: Path) -> dict[str, float | None]:
    """Reproduce the tables' numbers; give the MSE by ``signal/model``."""
    config = load_yaml(root / "config.yaml")
    schema = root / "workflow" / "schemas" / "config.schema.yaml"
    settings = read_settings(config, schema)
    plant, records = load_model(settings.model_file), {}
    for name in settings.all_records:
        signal = make_signal(name, config["excitations"][name], config["excitation"])
        records[name] = record_of_twin(signal, plant, settings.measure_job, "twin")
    slow = records[settings.identification_signal]
    identified = identify_slow_loop(slow, settings.identification_job).to_dict()
    fitted = [records[name] for name in settings.rdgpi_fit_signals]
    rdgpi = identify_rdgpi(fitted, **settings.rdgpi_job).model
    errors: dict[str, float | None] = {}
    for name in settings.signals:
        record = records[name]
        for model in settings.filters:
            job = settings.filter_job(model)
            adaptive = make_filter(model, job, record, identified)
            errors[f"{name}/{model}"] = run_filter(adaptive, record, job)[0]["mse"]
        error = record.y - rdgpi.simulate(record.u, record.dt)
        errors[f"{name}/rdgpi"] = mean_square_error(error)
        for source in ("identified", "published"):
            job = settings.filter_job("gpo") | {"envelopes": source}
            run_filter(make_filter("gpo", job, record, identified), record, job)
    swept = records[settings.order_sweep_signal]
    order_errors(swept, filters_by_order(swept, settings.order_sweep_job, identified))
    twins = list(read_twins(map(Path, settings.twin_files)))
    found = fit(twins, settings.twin_fits_job)
    for model in settings.filters:
        run(twins, settings.twin_runs_job(model), found)
    return errors


if __name__ == "__main__":
    json.dump(main(Path(sys.argv[1])), sys.stdout)

"""Errors on a measured dataset, for which the paper has no numbers."""

from collections.abc import Iterable, Sequence
from pathlib import Path

import pandas as pd

from hystbench.compare.rows import write_fields
from hystbench.compare.runs import Run, read_run
from hystbench.compare.tables import PrintedTable, error_kind
from hystbench.files import write_text
from hystbench.published import in_order

#: Columns of errors.csv: one row a record and model.
ERROR_COLUMNS = (
    *("signal", "model", "error_kind", "mse", "re"),
    *("mse_after_transient", "re_after_transient", "unit", "status"),
)
WRITTEN = ("errors.csv", "tables.txt", "verdict.rst", "tables/errors.*")
"""Files of a comparison, as names or patterns."""


def compare_measured(
    out_dir: str | Path, dataset: str, runs: Iterable[str | Path]
) -> None:
    """Write the errors of all models on a measured dataset.

    Parameters
    ----------
    out_dir : path
        Folder for ``errors.csv`` (a row a record and model), ``tables/errors``
        (a row a record), ``tables.txt`` and ``verdict.rst``.
    dataset : str
    runs : iterable of paths
        One JSON file for each record and model.
    """
    out = Path(out_dir)
    found = [read_run(path) for path in runs]
    table = errors_table(
        "errors",
        f"Errors on the measured records of {dataset}.",
        "The paper has no numbers for them.",
        found,
    )
    write_fields(out / "errors.csv", ERROR_COLUMNS, found)
    table.write(out / "tables")
    parts = filter(None, (*table.text("rst"), finite_sentence(found)))
    text = "\n\n".join(parts) + "\n"
    write_text(out / "tables.txt", text)
    write_text(out / "verdict.rst", text)


def errors_table(name: str, of: str, why: str, runs: Sequence[Run]) -> PrintedTable:
    """Set the errors of all models side by side, a row a record and metric.

    Parameters
    ----------
    name : str
        Stem of the table's files.
    of, why : str
        First and last sentence of its caption; between them stands the kind of error.
    runs : sequence of Run
    """
    by_cell = {(run.signal, run.model): run for run in runs}
    signals = dict.fromkeys(run.signal for run in runs)
    models = in_order(run.model for run in runs)
    units = {run.signal: run.unit for run in runs}
    content = []
    for signal in signals:
        for metric, told in (("mse", f"MSE ({units[signal]})"), ("re", "RE")):
            line = {"record": signal, "error": told}
            for model in models:
                run = by_cell.get((signal, model))
                line[model] = _cell(run, metric)
            content.append(line)
    return PrintedTable(
        name=name,
        caption=f"{of} {error_kind(models)}. {why}",
        legend="; ".join(
            f"{run.signal}, {run.model}: {run.diverged}"
            for run in runs
            if run.diverged is not None
        ),
        frame=pd.DataFrame(content, dtype=str),
    )


def finite_sentence(runs: Sequence[Run]) -> str:
    """Say how many models stay finite on every record."""
    models = dict.fromkeys(run.model for run in runs)
    lost = dict.fromkeys(run.model for run in runs if run.diverged is not None)
    finite = len(models) - len(lost)
    text = f"{finite} of {len(models)} models stay finite on every record"
    return f"{text}; not {', '.join(lost)}." if lost else f"{text}."


def _cell(run: Run | None, metric: str) -> str:
    if run is None:
        return "not run"
    if run.diverged is not None:
        return "diverged"
    return f"{run.error(metric):.4g}"

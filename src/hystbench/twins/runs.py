"""Twins, records of them and runs of the filters on these, all in memory.

A twin's thirteen records and the four filters on them take a tenth of a second. What
takes longer, and imports more, is in :mod:`hystbench.twins.fits`.
"""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from hystbench.adaptive import make_filter, steps_of
from hystbench.compare.runs import Cell, Run
from hystbench.errors import InputError
from hystbench.filters import AdaptiveFilter, Result, run_many
from hystbench.metrics import mean_square_error, relative_error
from hystbench.model import Model, load_model
from hystbench.published import in_order
from hystbench.record import Record
from hystbench.signals import Signal, make_signal
from hystbench.twin_record import record_of_twin

Settings = Mapping[str, Any]
#: Blocks that make hysteresis; the first one in a twin's chain names its family.
HYSTERESIS = ("gpi", "preisach", "jiles-atherton", "rdgpi")


@dataclass(frozen=True)
class Twin:
    """A twin."""

    name: str
    place: str
    """Stem of its file, and the file."""
    model: Model
    family: str
    """Name of the block that makes its hysteresis."""


def read_twins(paths: Iterable[Path]) -> tuple[Twin, ...]:
    """Read twins; the first is the one that the claims are judged on.

    Raises
    ------
    InputError
        If a file is not what it should be, no block makes hysteresis or two twins
        have one name.
    """
    twins: dict[str, Twin] = {}
    for path in paths:
        if path.stem in twins:
            raise InputError(f"{path}: a second twin of the name {path.stem!r}")
        model = load_model(path)
        makers = [block.name for block in model.chain if block.name in HYSTERESIS]
        if not makers:
            raise InputError(
                f"{path}: no block makes hysteresis; expected one of "
                f"{', '.join(HYSTERESIS)}"
            )
        twins[path.stem] = Twin(path.stem, str(path), model, makers[0])
    return tuple(twins.values())


def draw_signals(definitions: Mapping[str, Settings], seed: int) -> dict[str, Signal]:
    """Make the signals; those with a seed of their own take another draw."""
    signals = {}
    for name, job in definitions.items():
        ((kind, given),) = job["definition"].items()
        if "seed" in given:
            given = given | {"seed": given["seed"] + seed}
        signals[name] = make_signal(name, {kind: given}, job["common"])
    return signals


def measure_twin(
    twin: Twin, signals: Iterable[Signal], settings: Settings, seed: int
) -> dict[str, Record]:
    """Simulate a twin on signals; another seed draws another noise."""
    job = dict(settings) | {"seed": settings["seed"] + seed}
    return {
        each.name: record_of_twin(each, twin.model, job, twin.place) for each in signals
    }


def filter_jobs(settings: Settings) -> dict[str, Settings]:
    """Give the settings of each filter, in the order of the paper's tables."""
    jobs = settings["filters"]
    return {model: jobs[model] for model in in_order(jobs)}


def run_records(
    model: str,
    job: Settings,
    records: Mapping[str, Record],
    identified: Settings | None,
) -> dict[Cell, Run]:
    """Run a filter on records; ``identified`` is the result of Algorithm 1."""
    jobs = [(make_filter(model, job, r, identified), r) for r in records.values()]
    # On one core: the workflow runs other jobs beside.
    results = run_many(((each, r.u, r.y) for each, r in jobs), workers=1)
    return {
        (record.name, model): filter_run(adaptive, record, result)
        for (adaptive, record), result in zip(jobs, results, strict=True)
    }


def filter_run(adaptive: AdaptiveFilter, record: Record, result: Result) -> Run:
    """Make the run of a filter."""
    at = result.diverged_at
    return bare_run(
        record,
        adaptive.name,
        None if at is not None else result.error,
        error_kind="one-step a priori",
        order=adaptive.order,
        weight_count=adaptive.size,
        step_size=steps_of(adaptive),
        diverged=None if at is None else f"diverged at sample {at}",
    )


def bare_run(record: Record, model: str, error: Any, **about: Any) -> Run:
    """Make a run of its errors alone; what costs more, such as bounds, is left out.

    Parameters
    ----------
    record : Record
    model : str
    error : ndarray, shape (n,), or None
        Error at each sample; None where it diverged.
    **about
        ``error_kind``, and what else is known.
    """
    return Run(
        signal=record.name,
        model=model,
        origin=record.origin,
        unit=f"{record.output.unit}^2",
        mse=None if error is None else mean_square_error(error),
        re=None if error is None else relative_error(error, record.y),
        **about,
    )


def compare_envelopes(
    job: Settings, records: Mapping[str, Record], identified: Settings
) -> dict[Cell, float]:
    """Give the MSE of the GPO filter with either envelopes, by signal and envelopes."""
    errors = {}
    for source in ("identified", "published"):
        runs = run_records(
            "gpo", dict(job) | {"envelopes": source}, records, identified
        )
        for (signal, _), run in runs.items():
            errors[signal, source] = run.error("mse")
    return errors

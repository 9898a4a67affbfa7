"""``hystbench job constants``: the ranking with other constants.

None of the paper's filters has a weight for a constant. So the constants of operators,
input and displacement must be made of the other taps, and the filter that can do that
best leads. Here the constant of the recorded input is varied, and each filter is given
a constant tap.
"""

import math
from collections.abc import Iterable, Iterator, Mapping
from statistics import geometric_mean
from typing import Any

from hystbench.compare.beside import Ranking
from hystbench.compare.rows import four_digits, names_of, write_fields
from hystbench.compare.runs import Cell
from hystbench.compare.summary import pairs_in_order
from hystbench.options import In, Json, Out, Settings, command
from hystbench.published import FILTERS, load_errors
from hystbench.twins.runs import (
    Twin,
    draw_signals,
    filter_jobs,
    measure_twin,
    read_twins,
    run_records,
)

Errors = Mapping[Cell, float]
"""MSE by signal and filter; infinite where it diverged."""


@command
def constants(
    twins: tuple[In, ...],
    *,
    identified: Json | None = None,
    settings: Settings,
    out: Out,
) -> None:
    """Rank the filters on TWINS with other zero errors and with a constant tap."""
    published = {(p.signal, p.model): p.mse.value for p in load_errors()}
    rows = [
        row
        for twin in read_twins(twins)
        for row in _vary_constants(twin, settings, identified, published)
    ]
    write_fields(out, names_of(Ranking), rows, four_digits)


def _vary_constants(
    twin: Twin,
    settings: Settings,
    identified: Mapping[str, Any] | None,
    published: Errors,
) -> Iterator[Ranking]:
    """Run the filters with each zero error, and with each constant tap.

    Parameters
    ----------
    twin : Twin
    settings : mapping
        ``signals`` (definitions), ``measure``, ``filters``, ``zero_errors``,
        ``constant_taps`` and ``calibrated``, the signals of one half of the pairs.
    identified : mapping or None
        Result of Algorithm 1, for identified envelopes.
    published : mapping
        The paper's MSE (um^2) by signal and filter.
    """
    signals = draw_signals(settings["signals"], 0).values()
    usual = settings["measure"]["input_zero_error"]
    jobs = filter_jobs(settings)
    if not jobs:
        return
    tap = next(iter(jobs.values()))["constant_tap"]
    cases = [(zero, tap) for zero in sorted({*settings["zero_errors"], usual})]
    cases += [(usual, each) for each in settings["constant_taps"] if each != tap]
    for zero, size in cases:
        measured = {**settings["measure"], "input_zero_error": zero}
        records = measure_twin(twin, signals, measured, 0)
        mse: dict[Cell, float] = {}
        for model, job in jobs.items():
            changed = {**job, "constant_tap": size}
            runs = run_records(model, changed, records, identified)
            mse |= {cell: run.error("mse") for cell, run in runs.items()}
        first = {s: min(jobs, key=lambda model: mse[s, model]) for s in records}
        others = {s: model for s, model in first.items() if model != "gpo"}
        fitted, held_out = (
            {c: e for c, e in mse.items() if (c[0] in settings["calibrated"]) is inside}
            for inside in (True, False)
        )
        yield Ranking(
            twin=twin.name,
            family=twin.family,
            zero_error_mA=1e3 * zero,
            constant_tap=size,
            configured="yes" if (zero, size) == (usual, tap) else "",
            gpo_first=len(records) - len(others),
            signals=len(records),
            first_elsewhere="; ".join(f"{s}: {model}" for s, model in others.items()),
            pairs_calibrated="{} of {}".format(*pairs_in_order(fitted, published)),
            pairs_held_out="{} of {}".format(*pairs_in_order(held_out, published)),
            diverged=sum(map(math.isinf, mse.values())),
            **{
                f"mean_mse_{model}_um2": _mean(
                    mse.get((s, model), math.inf) for s in records
                )
                for model in FILTERS
            },
        )


def _mean(values: Iterable[float]) -> float:
    """Give the geometric mean to three digits; infinite where one is."""
    return float(f"{geometric_mean(values):.3g}")

"""All models on a twin, with step sizes around the configured ones."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import product

import numpy as np

from hystbench.compare.evidence import Evidence, identification_of
from hystbench.order_errors import filters_by_order
from hystbench.pressure.fits import identify_records, run_rdgpi
from hystbench.pressure.runs import (
    Ensemble,
    Settings,
    compare_envelopes,
    draw_signals,
    filter_jobs,
    measure_twin,
    run_records,
    scaled,
    sweep_orders,
)
from hystbench.pressure.twins import Twin
from hystbench.rdgpi import RateDependentGPI


def run_ensemble(
    twin: Twin,
    settings: Settings,
    rdgpi: RateDependentGPI | None,
    seed: int,
    factors: Sequence[float],
) -> Ensemble:
    """Run all models on a twin.

    Parameters
    ----------
    twin : Twin
    settings : mapping
        ``signals`` (definitions by name), ``asked`` (names of those to run),
        ``measure``, ``filters`` (settings by filter), ``identification`` (settings,
        ``signal`` among them) and ``order_sweep`` (the same).
    rdgpi : RateDependentGPI or None
        As :func:`hystbench.pressure.fits.fit_rdgpi` fits it: once a twin, for noise
        far below its error.
    seed : int
        Which draw of the noise and of the random sum; zero is the configured one.
    factors : sequence of float
        On the configured step sizes.
    """
    signals = draw_signals(settings["signals"], seed)
    records = measure_twin(twin, signals.values(), settings["measure"], seed)
    asked = {name: records[name] for name in settings["asked"]}
    jobs = filter_jobs(settings)
    found = identify_records(records, settings)
    runs = {
        (model, factor): run_records(model, scaled(job, factor), asked, found)
        for model, job in jobs.items()
        for factor in factors
    }
    sweep = settings["order_sweep"]
    swept = records[sweep["signal"]]
    by_order = {
        model: filters_by_order(swept, dict(sweep) | {"filters": {model: job}}, found)
        for model, job in jobs.items()
    }
    return Ensemble(
        twin=twin,
        seed=seed,
        common=Evidence(
            records=asked,
            identification=identification_of(found, twin.place),
            runs=run_rdgpi(rdgpi, asked),
        ),
        runs=runs,
        order_sweeps={
            (model, factor): sweep_orders(swept, filters, factor)
            for model, filters in by_order.items()
            for factor in factors
        },
        envelope_errors={
            factor: compare_envelopes(scaled(jobs["gpo"], factor), asked, found)
            for factor in factors
            if "gpo" in jobs
        },
    )


def step_choices(
    filters: Sequence[str], factors: Sequence[float], count: int, rng: Sequence[int]
) -> list[dict[str, float]]:
    """Draw choices of a factor for each filter; all of them where they are few.

    Parameters
    ----------
    filters : sequence of str
    factors : sequence of float
    count : int
        How many to draw, without repetition.
    rng : sequence of int
        Seed of the draw.
    """
    every = list(product(factors, repeat=len(filters)))
    if count < len(every):
        drawn = np.random.default_rng(rng).choice(len(every), count, replace=False)
        every = [every[index] for index in sorted(drawn)]
    return [dict(zip(filters, choice, strict=True)) for choice in every]

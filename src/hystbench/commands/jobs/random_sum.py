"""``hystbench job random-sum``: the random sum drawn many times.

One draw of its phases is a lottery: each has its own phases and its own noise. Beside
the reading of config.yaml other numbers of sines are run, so that what a reading
changes can be seen.
"""

from collections.abc import Iterator, Mapping, Sequence
from statistics import median
from typing import Any

from hystbench.compare.beside import Draw
from hystbench.compare.rows import names_of, or_empty, write_fields
from hystbench.files import write_csv
from hystbench.metrics import rms
from hystbench.options import In, Json, Out, Settings, command
from hystbench.published import load_errors
from hystbench.published.consistency import check
from hystbench.rdgpi import RateDependentGPI
from hystbench.twins.fits import run_rdgpi
from hystbench.twins.runs import (
    Twin,
    draw_signals,
    filter_jobs,
    measure_twin,
    read_twins,
    run_records,
)

READING_COLUMNS = (
    "sines",
    "quantity",
    "published",
    "median",
    "low",
    "high",
    "median_over_published",
)


@command
def random_sum(
    twin: In,
    *,
    identified: Json | None = None,
    rdgpi: Json | None = None,
    settings: Settings,
    draws: Out,
    readings: Out,
) -> None:
    """Run all models on draws of the random sum: each draw, and what they say."""
    fitted = RateDependentGPI(**rdgpi["parameters"]) if rdgpi else None
    found = _run_draws(read_twins([twin])[0], settings, identified, fitted)
    signal = settings["signal"]
    write_fields(draws, names_of(Draw), found, or_empty)
    published = {p.model: p.mse.value for p in load_errors() if p.signal == signal}
    rms = check(load_errors())[signal].implied_rms
    told = _readings(found, published, rms)
    write_csv(readings, READING_COLUMNS, told)


def _run_draws(
    twin: Twin,
    settings: Settings,
    identified: Mapping[str, Any] | None,
    rdgpi: RateDependentGPI | None,
) -> list[Draw]:
    """Run all models on each draw of the random sum, for each number of sines.

    Parameters
    ----------
    twin : Twin
    settings : mapping
        ``signal`` (its name), ``definition`` and ``common`` as of ``hystbench
        signal``, ``measure``, ``filters``, ``draws`` (how many) and ``other_sines``.
    identified : mapping or None
        Result of Algorithm 1, for identified envelopes.
    rdgpi : RateDependentGPI or None
        The identified RDGPI model.
    """
    name = settings["signal"]
    ((kind, given),) = settings["definition"].items()
    found = []
    for sines in (given["sines"], *settings["other_sines"]):
        definition = {kind: {**given, "sines": sines}}
        job = {name: {"definition": definition, "common": settings["common"]}}
        for draw in range(settings["draws"]):
            signals = draw_signals(job, draw).values()
            records = measure_twin(twin, signals, settings["measure"], draw)
            size = rms(records[name].y)
            runs = dict(run_rdgpi(rdgpi, records))
            for model, own in filter_jobs(settings).items():
                runs |= run_records(model, own, records, identified)
            found += [
                Draw(name, sines, draw, model, run.error("mse"), run.error("re"), size)
                for (_, model), run in runs.items()
            ]
    return found


def _readings(
    draws: Sequence[Draw], published: Mapping[str, float], implied_rms: float
) -> Iterator[list[Any]]:
    """Sum the draws up by number of sines: RMS displacement, then each model's MSE.

    Parameters
    ----------
    draws : sequence of Draw
    published : mapping
        The paper's MSE (um^2) on the signal by model.
    implied_rms : float
        RMS displacement (um) that its errors imply.

    Yields
    ------
    list
        A row of :data:`READING_COLUMNS`: the published value, and the median and the
        range over the draws.
    """
    for sines in dict.fromkeys(each.sines for each in draws):
        mine = [each for each in draws if each.sines == sines]
        rms = {each.draw: each.rms for each in mine}
        parts = [("RMS displacement (um)", implied_rms, list(rms.values()))]
        for model in dict.fromkeys(each.model for each in mine):
            own = [each.mse for each in mine if each.model == model]
            parts.append((f"MSE of {model} (um^2)", published[model], own))
        for quantity, wanted, values in parts:
            middle = median(values)
            numbers = (wanted, middle, min(values), max(values))
            told = [f"{number:.4g}" for number in numbers]
            yield [sines, quantity, *told, f"{middle / wanted:.2f}"]

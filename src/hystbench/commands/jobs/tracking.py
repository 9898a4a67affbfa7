"""``hystbench job tracking``: follow references with and without the inverse."""

from typing import Any

import numpy as np

from hystbench.blocks.rdgpi import RateDependentPrandtlIshlinskii
from hystbench.blocks.step import Sampling
from hystbench.export import python
from hystbench.export.inverse import describe_inverse
from hystbench.files import whole_folder, write_columns, write_csv, write_text
from hystbench.inverse.told import left, table, verdict
from hystbench.inverse.tracking import (
    CODE,
    FIELD,
    LINEAR,
    OWN,
    WITH,
    WITHOUT,
    Line,
    Reference,
    Tracked,
    Way,
    by_inverse,
    by_line,
    references,
    track,
)
from hystbench.job import In, Json, OutFolder, Settings, job
from hystbench.model import Model, load_model
from hystbench.record import FloatArray
from hystbench.signals import load_signal

SHOWN_S = 0.15
"""Time of the last reference that is kept, for the figure."""
ROOM = 2.0
"""Limits of the exported inverse, as a share of the signals' largest input."""
WRITTEN = ("tracking.csv", "raster.csv", "tracking.md", "verdict.md")


@job
def tracking(
    signals: tuple[In, ...],
    *,
    plant: In,
    base: In,
    slow: In,
    augmented: In,
    rate_dependent: Json,
    settings: Settings,
    out: OutFolder,
) -> None:
    """Drive the twin open loop with inputs for references of the SIGNALS' forms.

    Each reference is followed with a linear gain, with the inverse of the slow loop's
    model, with that of the rate-dependent Prandtl-Ishlinskii model, with that of the
    augmented model, also as code that is fed sample by sample, and with that of the
    twin itself, the PLANT. BASE is the model of the slow loop, RATE-DEPENDENT what was
    identified from the twin's records; the linear gain is that of the SLOW signal.
    """
    given = [load_signal(path) for path in signals]
    twin, of_loop = load_model(plant), load_model(base)
    with_effects = load_model(augmented)
    of_field = _rdgpi(rate_dependent, twin)
    line = Line.of(of_loop, load_signal(slow))
    rest = float(twin.simulate(np.zeros(64), given[0].dt)[-1])
    wanted = references(given, settings["highest_hz"], line, rest)
    largest = max(float(np.abs(signal.u).max()) for signal in given)
    ways = {
        LINEAR: by_line(line),
        WITHOUT: by_inverse(of_loop),
        FIELD: by_inverse(of_field),
        WITH: by_inverse(with_effects),
        CODE: _by_code(with_effects, ROOM * largest),
        OWN: by_inverse(twin),
    }
    rows = track(twin, settings["input_zero_error"], ways, wanted)
    with whole_folder(out, WRITTEN) as fresh:
        cells = [_cells(row, twin.output.unit) for row in rows]
        values = (list(each.values()) for each in cells)
        write_csv(fresh / "tracking.csv", list(cells[0]), values)
        write_columns(fresh / "raster.csv", _part(rows, wanted[-1]), 9)
        write_text(fresh / "tracking.md", table(rows, twin.output.unit))
        write_text(fresh / "verdict.md", verdict(rows) + left(rows, of_field))


def _rdgpi(identified: dict[str, Any], twin: Model) -> Model:
    """Give the identified RDGPI model: what the field inverts for such actuators."""
    numbers = identified["parameters"]
    chain = (RateDependentPrandtlIshlinskii.from_mapping(numbers),)
    return Model("rdgpi", twin.input, twin.output, chain)


def _by_code(model: Model, limit: float) -> Way:
    """Feed what ``hystbench export --inverse`` writes, sample by sample."""

    def way(reference: Reference) -> FloatArray:
        code = describe_inverse(model, Sampling(reference.dt), (-limit, limit))
        u: FloatArray = python.loaded(code).simulate(reference.y)
        return u

    return way


def _cells(row: Tracked, unit: str) -> dict[str, str]:
    return {
        "reference": row.reference.name,
        "highest_hz": f"{row.reference.highest_hz:g}",
        "drive": row.drive,
        "stroke": f"{row.stroke:.4g}",
        "unit": unit,
        "rms_percent": f"{100 * row.rms:.3g}",
        "largest_percent": f"{100 * row.largest:.3g}",
        "largest_input": f"{np.abs(row.u).max():.4g}",
    }


def _part(rows: list[Tracked], reference: Reference) -> dict[str, FloatArray]:
    """Give a part of a reference in time, and what the plant does with each drive."""
    middle = len(reference.y) // 2
    part = slice(middle, middle + round(SHOWN_S / reference.dt))
    time = np.arange(len(reference.y[part]), dtype=np.float64) * reference.dt
    own = {row.drive: row.y[part] for row in rows if row.reference is reference}
    return {"time_s": time, "reference": reference.y[part], **own}

"""``hystbench invert``: the input that makes a model follow a reference."""

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated

import click
import numpy as np

from hystbench import options
from hystbench.blocks.step import Sampling
from hystbench.errors import InputError
from hystbench.export.code import loaded
from hystbench.export.inverse import describe_inverse
from hystbench.files import write_columns, write_csv
from hystbench.inverse.feedforward import BAND_SHARE, InputRange, feedforward
from hystbench.metrics import rms
from hystbench.model import Model, load_model
from hystbench.options import In, InputHigh, InputLow, Out, command
from hystbench.record import FloatArray, column_name
from hystbench.samples import read_input

PERIODS = 4
"""Periods of each sine; the first two may still show how it began."""
PER_DECADE = 6
"""Frequencies of the table."""
HOLDS = 0.01
"""RMS error, as a share of the stroke, up to which the inverse is said to hold."""


@dataclass(frozen=True)
class FollowedSine:
    """A sine: its frequency, and what is left of it, as a share of the stroke."""

    frequency_hz: float
    error: float | None
    largest_input: float | None
    said: str = ""


Invert = Callable[[FloatArray], FloatArray]
"""Gives the input for a reference."""


@command
def invert(
    model: In,
    *,
    reference: Annotated[
        Path | None,
        options.FILE,
        "CSV file with time_s and the output that is wanted, such as displacement_um.",
    ] = None,
    dt: Annotated[float | None, "Sampling interval in seconds; no reference."] = None,
    stroke: Annotated[float | None, "Peak-to-peak of sines; no reference."] = None,
    band: Annotated[
        float | None,
        "Correct errors up to this frequency in Hz; by default a tenth of the "
        "sampling rate.",
    ] = None,
    limit_low: InputLow | None = None,
    limit_high: InputHigh | None = None,
    sampled: Annotated[
        bool,
        "Invert sample by sample, as exported code does, which knows no reference to "
        "come; give both limits.",
    ] = False,
    out: Out,
) -> None:
    """Find the input that makes the output of MODEL follow a reference.

    Writes the input beside the reference and the model's output. Without a reference it
    writes how well sines of one --stroke are followed, from slow to the band's edge.
    """
    for name, value in (("--dt", dt), ("--stroke", stroke), ("--band", band)):
        if value is not None and not 0 < value < np.inf:
            raise InputError(f"{name}: {value:g}; expected a number above 0")
    system = load_model(model)
    asked = options.asked_limits(limit_low, limit_high, None)
    limits = InputRange(**asked)
    if sampled:
        if band is not None and reference is not None:
            raise InputError("--band: expected none beside --sampled and --reference")
        options.both_limits(limit_low, limit_high, "--sampled")
    if reference is not None:
        if dt is not None or stroke is not None:
            raise InputError("--dt and --stroke: expected none beside --reference")
        _follow(system, model, reference, band, limits, sampled, out)
        return
    if dt is None or stroke is None:
        missing = "--dt" if dt is None else "--stroke"
        raise InputError(f"{missing}: expected it, or a --reference")
    top = _band(band, dt)

    def iterated(wanted: FloatArray) -> FloatArray:
        return feedforward(system, wanted, dt, top, limits).u

    way = _by_code(system, model, dt, limits) if sampled else iterated
    _table(system, dt, stroke, top, way, out)


def _band(asked: float | None, dt: float) -> float:
    return BAND_SHARE / dt if asked is None else asked


def _follow(
    system: Model,
    model: Path,
    file: Path,
    band: float | None,
    limits: InputRange,
    sampled: bool,
    out: Path,
) -> None:
    """Write the input for a reference, from the whole of it or sample by sample."""
    names = [column_name(x.name, x.unit) for x in (system.input, system.output)]
    dt, reference = read_input(file, names[1])
    clipped = 0
    if sampled:
        u = _by_code(system, model, dt, limits)(reference)
        y = system.simulate(u, dt)
        stroke = float(np.ptp(reference)) or 1.0
        left = rms(y - reference) / stroke
        how = "inverted sample by sample, as exported code does"
    else:
        with options.refused_of(model, file):
            found = feedforward(system, reference, dt, band, limits)
        u, y, left, clipped = found.u, found.y, found.left, found.clipped
        exact = f"'{found.exact}' inverted exactly, " if found.exact else ""
        corrections = f"{len(found.error) - 1} corrections"
        how = f"{exact}{corrections} up to {_band(band, dt):g} Hz"
    time = np.arange(len(reference)) * dt
    simulated = column_name("simulated", system.output.unit)
    titles = ("time_s", *names, simulated)
    write_columns(out, dict(zip(titles, (time, u, reference, y), strict=True)))
    click.echo(
        f"{out}: {len(reference)} samples, input from {u.min():.4g} to {u.max():.4g} "
        f"{system.input.unit}; {how}; the model's output is off by "
        f"{100 * left:.3g} % of the stroke (RMS)"
    )
    if clipped:
        click.echo(f"{clipped} samples stand at a limit of the input")


def _by_code(system: Model, model: Path, dt: float, limits: InputRange) -> Invert:
    """Feed the exported inverse."""
    with options.refused_of(model):
        described = describe_inverse(system, Sampling(dt), limits)

    def invert(reference: FloatArray) -> FloatArray:
        u: FloatArray = loaded(described).simulate(reference)
        return u

    return invert


def _table(
    system: Model, dt: float, stroke: float, band: float, way: Invert, out: Path
) -> None:
    rows = bandwidth(system, stroke, dt, band, way)
    header = ["frequency_hz", "rms_error_percent", "largest_input", "said"]
    cells = [
        [
            f"{row.frequency_hz:.4g}",
            "" if row.error is None else f"{100 * row.error:.3g}",
            "" if row.largest_input is None else f"{row.largest_input:.4g}",
            row.said,
        ]
        for row in rows
    ]
    write_csv(out, header, cells)
    for row in cells:
        click.echo(
            f"{row[0]:>8} Hz  {row[1] or '-':>8} %  {row[2]:>8}  {row[3]}".rstrip()
        )
    highest = holds_to(rows)
    share = f"{100 * HOLDS:g} % of the stroke (RMS)"
    click.echo(
        f"{out}: the inverse of the model holds to {highest:.4g} Hz within {share}"
        if highest is not None
        else f"{out}: the inverse of the model holds at none of these within {share}"
    )


def bandwidth(
    model: Model, stroke: float, dt: float, band_hz: float, invert: Invert
) -> list[FollowedSine]:
    """Invert a model for sines of one stroke, from slow to the edge of the band.

    Parameters
    ----------
    model : Model
    stroke : float
        Peak-to-peak of each sine, in the unit of the model's output.
    dt : float
        Sampling interval in seconds.
    band_hz : float
    invert : callable

    Returns
    -------
    list of FollowedSine
        The error is that of the model itself, over the second half of the record.
    """
    decades = 2
    count = PER_DECADE * decades + 1
    frequencies = band_hz * np.logspace(-decades, 0, count)
    rest = float(model.simulate(np.zeros(64), dt)[-1])
    rows = []
    for frequency in frequencies:
        samples = max(round(PERIODS / frequency / dt), 64)
        time = np.arange(samples) * dt
        reference = rest + stroke / 2 * np.sin(2 * np.pi * frequency * time)
        try:
            u = invert(reference)
        except InputError as error:
            rows.append(FollowedSine(float(frequency), None, None, str(error)))
            continue
        off = (reference - model.simulate(u, dt))[samples // 2 :]
        left = float(np.sqrt(np.mean(off**2))) / stroke
        rows.append(FollowedSine(float(frequency), left, float(np.abs(u).max())))
    return rows


def holds_to(rows: list[FollowedSine]) -> float | None:
    """Give the highest frequency to which each error is at most :data:`HOLDS`."""
    highest = None
    for row in rows:
        if row.error is None or row.error > HOLDS:
            break
        highest = row.frequency_hz
    return highest

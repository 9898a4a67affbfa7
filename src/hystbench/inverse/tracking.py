"""Open-loop tracking on a plant: inputs from several models for the same references."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from hystbench.inverse.feedforward import feedforward
from hystbench.model import Model
from hystbench.record import FloatArray
from hystbench.signals import Signal

STROKE_SHARE = 0.7
"""Stroke of the references, as a share of the one that the signals' own size makes:
what is lost to the dynamics needs more input than a slow motion of the same stroke."""
RASTER_HZ = (5.0, 20.0)
"""Lines a second of the raster scans."""

LINEAR, WITHOUT, FIELD = "linear", "without", "rate-dependent"
WITH, CODE, OWN = "with", "code", "own"
DRIVES = {
    LINEAR: "no inverse: a linear gain",
    WITHOUT: "inverse without the gap's effects",
    FIELD: "inverse of the RDGPI model",
    WITH: "inverse with the gap's effects",
    CODE: "the same sample by sample, as exported",
    OWN: "inverse of the plant itself",
}


@dataclass(frozen=True)
class Reference:
    """What the plant is to do: a signal in the unit of its output."""

    name: str
    highest_hz: float
    dt: float
    y: FloatArray


@dataclass(frozen=True)
class Tracked:
    """A reference and what the plant does with the input from one model.

    Errors are shares of the reference's peak-to-peak.
    """

    reference: Reference
    drive: str
    u: FloatArray
    y: FloatArray

    @property
    def stroke(self) -> float:
        """Peak-to-peak of the reference."""
        return float(np.ptp(self.reference.y))

    @property
    def rms(self) -> float:
        """RMS of the error."""
        return float(np.sqrt(np.mean((self.reference.y - self.y) ** 2))) / self.stroke

    @property
    def largest(self) -> float:
        """Largest error."""
        return float(np.abs(self.reference.y - self.y).max()) / self.stroke


@dataclass(frozen=True)
class Line:
    """A straight line from input to output."""

    gain: float
    offset: float

    @classmethod
    def of(cls, model: Model, signal: Signal) -> Line:
        """Fit the line to a model's loop by least squares."""
        y = model.simulate(signal.u, signal.dt)
        gain, offset = np.polyfit(signal.u, y, 1)
        return cls(float(gain), float(offset))


Way = Callable[[Reference], FloatArray]
"""Gives the input for a reference."""


def by_inverse(model: Model) -> Way:
    """Take the whole reference for the inverse of a model."""
    return lambda reference: feedforward(model, reference.y, reference.dt).u


def by_line(line: Line) -> Way:
    """Take a straight line for the inverse."""
    return lambda reference: (reference.y - line.offset) / line.gain


def follows(model: Model, row: Tracked) -> Tracked:
    """Give what a model does with the input of a row, instead of the plant."""
    return replace(row, y=model.simulate(row.u, row.reference.dt))


def references(
    signals: Sequence[Signal], highest_hz: Mapping[str, float], line: Line, rest: float
) -> list[Reference]:
    """Make references of the signals' forms, and raster scans: triangles.

    They begin at the output at rest.

    Parameters
    ----------
    signals : sequence of Signal
        Inputs; the line makes outputs of them, :data:`STROKE_SHARE` of their size.
    highest_hz : mapping of str to float
        The highest frequency of each signal.
    line : Line
    rest : float
        Output at rest.
    """
    made = [
        Reference(
            signal.name,
            highest_hz[signal.name],
            signal.dt,
            rest + STROKE_SHARE * line.gain * (signal.u - signal.u[0]),
        )
        for signal in signals
    ]
    like = signals[0]
    time = np.arange(len(like.u)) * like.dt
    size = STROKE_SHARE * line.gain * float(np.abs(like.u).max())
    for lines in RASTER_HZ:
        phase = (time * lines + 0.25) % 1.0
        triangle = 1 - 4 * np.abs(phase - 0.5)
        name = f"raster-{lines:g}-lines-a-second"
        made.append(Reference(name, lines, like.dt, rest + size * triangle))
    return made


def track(
    plant: Model,
    input_zero_error: float,
    ways: Mapping[str, Way],
    wanted: Sequence[Reference],
) -> list[Tracked]:
    """Drive the plant with the input that each way gives for each reference.

    Parameters
    ----------
    plant : Model
        Simulated without its sensor's noise.
    input_zero_error : float
        The models are identified on inputs that were recorded with this error; inputs
        that they ask for are therefore this much larger than the plant's own.
    ways : mapping of str to callable
        By drive; that by the plant itself knows of no such error.
    wanted : sequence of Reference
    """
    rows = []
    for reference in wanted:
        for drive, way in ways.items():
            u = way(reference)
            error = 0.0 if drive == OWN else input_zero_error
            y = plant.simulate(u - error, reference.dt)
            rows.append(Tracked(reference, drive, u, y))
    return rows

"""What the gap workflow reads: fit records, hold-out records, how the input moves."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from hystbench.blocks.held import Hold
from hystbench.dataset import load_dataset
from hystbench.device_kinds import DeviceKind
from hystbench.doubts import doubts
from hystbench.errors import InputError
from hystbench.gap.records import folds, nuisance
from hystbench.gap.records.usable import check_usable
from hystbench.model import Model
from hystbench.quantities import NONE_KNOWN, Quantities
from hystbench.record import Channel, FloatArray, Record, Use
from hystbench.units import check_same_unit


@dataclass(frozen=True)
class Evidence:
    """Records of one device.

    Parameters
    ----------
    name : str
    fit : tuple of Record
        What models are fitted to; folds of these decide what pays.
    hold_out : tuple of Record
        Checked with the others; compared with a model only after all is decided.
    hold : {"zero-order", "linear", "band-limited"}
        How the input moves between samples.
    noise_rms : float, optional
        As declared, in the output's unit.
    identification : str, optional
        Name of the fit record that a hysteretic base is identified from; by default
        the slowest.
    simulated_column : str, optional
        Column of the output that a simulator gave elsewhere, if the records have one.
    warnings : tuple of str
        What of the records is hardly meant, one line each.
    quantities : Quantities
        What the device takes and gives.
    device_kind : str, optional
        Kind of the device, where dataset.yaml tells it.
    """

    name: str
    fit: tuple[Record, ...]
    hold_out: tuple[Record, ...]
    hold: Hold = "band-limited"
    noise_rms: float | None = None
    identification: str | None = None
    simulated_column: str | None = None
    warnings: tuple[str, ...] = ()
    quantities: Quantities = NONE_KNOWN
    device_kind: DeviceKind | None = None

    @property
    def input(self) -> Channel:
        """Name and unit of the input."""
        return (*self.fit, *self.hold_out)[0].input

    @property
    def output(self) -> Channel:
        """Name and unit of the output."""
        return (*self.fit, *self.hold_out)[0].output

    @property
    def own_offsets(self) -> bool:
        """Whether each fit record may have an offset of its own."""
        return own_offsets(self.fit, self.quantities)

    @property
    def slowest(self) -> Record:
        """The record for identification: the one named, or the slowest to fit."""
        if self.identification is None:
            return min(self.fit, key=lambda record: record.rate)
        return next(item for item in self.fit if item.name == self.identification)


def load_evidence(path: str | Path, use: Use | None = None) -> Evidence:
    """Read a dataset for the gap workflow.

    Parameters
    ----------
    path : str or Path
    use : {"fit", "hold-out"}, optional
        Read only these records; the files of the others are not opened.

    Raises
    ------
    InputError
        If a record cannot be used, there is none to fit or none held out, or one held
        out is a copy of one to fit.
    """
    dataset = load_dataset(path)
    if not any(dataset.use(name) == "hold-out" for name in dataset.record_files):
        raise InputError(
            f"{dataset.path}: records: none has 'use: hold-out'; expected at least "
            "one, to show by how much the gap shrinks"
        )
    records = [
        dataset.read(name)
        for name in dataset.record_files
        if use in (None, dataset.use(name))
    ]
    for record in records:
        file = dataset.record_files[record.name]
        _check_length(file, record)
        check_usable(file, record, dataset.stands_still(record.name))
    about = dataset.about
    hold: Hold = about["input"].get("hold", "band-limited")
    named = about.get("identification")
    if named is not None and dataset.use(named) != "fit":
        raise InputError(
            f"{dataset.path}: identification: {named!r} is held out; expected a record "
            "with 'use: fit'"
        )
    notes = doubts(dataset, records)
    decay = decay_of_free_mass(records, dataset.quantities)
    if decay is not None:
        notes, named = (*notes, CUT), None
        records = [window for record in records for window in windows(record, decay)]
    fit = tuple(record for record in records if record.use == "fit")
    hold_out = tuple(record for record in records if record.use == "hold-out")
    return Evidence(
        dataset.name,
        fit,
        hold_out,
        hold,
        about.get("noise_rms"),
        named,
        dataset.simulated_column,
        notes,
        dataset.quantities,
        dataset.device_kind,
    )


def own_offsets(records: Sequence[Record], quantities: Quantities) -> bool:
    """Tell whether the zero of the output may be another one in each record.

    Not where it is physical: a store is empty at zero, and a window of a free mass
    begins there.
    """
    windows = any(record.decay_s is not None for record in records)
    return len(records) > 1 and quantities.causality != "storage" and not windows


CUT = (
    "a force moves a mass that no spring holds: every record is cut where the motion "
    "turns; each window starts at zero, and what its velocity there does is left out"
)


def _check_length(file: Path, record: Record) -> None:
    """Refuse a record that is too short for its role, whatever will be named."""
    least, why = {
        "fit": (folds.LEAST, "blocks of it judge what was fitted to the others"),
        "hold-out": (nuisance.LEAST, "its first 30 % give what is new in it"),
    }[record.use]
    if len(record) < least:
        raise InputError(
            f"{file}: {len(record)} samples; expected at least {least}, as {why}"
        )


def check_units(evidence: Evidence, model: Model, place: str) -> None:
    """Refuse a model whose units are not those of the records, in some spelling.

    Raises
    ------
    InputError
        Which unit, and what was expected.
    """
    for key, model_has, data_have in (
        ("input", model.input, evidence.input),
        ("output", model.output, evidence.output),
    ):
        whose = f"the {data_have.name} of {evidence.name}"
        where = f"{place}: {key}: unit"
        check_same_unit(where, model_has.unit, whose, data_have.unit)


SPRING = 0.1
"""Share of the input's rms below which a spring's force is none."""
LEFT = 0.5
"""Share of the input's power that a law of motion may leave."""
LASTS = 1e6
"""Time constant, in seconds, of a mass that nothing brakes."""
LEAST = 100
"""Samples of a window, at least."""
NEIGHBOURS = 5
"""Samples on either side through which a parabola gives velocity and acceleration."""


def decay_of_free_mass(
    records: Iterable[Record], quantities: Quantities
) -> float | None:
    """Give the time constant of a mass that a force moves and no spring holds.

    The input of the fit records is put down to acceleration, velocity, position, dry
    friction and a constant, by least squares. The time constant is that with which the
    velocity dies out: mass over damping, in seconds.

    Parameters
    ----------
    records : iterable of Record
        Only those with ``use: fit`` are looked at.
    quantities : Quantities

    Returns
    -------
    float or None
        None where it is another device.
    """
    if quantities.causality != "force to motion" or quantities.output != "position":
        return None
    columns, wanted = [], []
    for record in records:
        if record.use != "fit" or len(record) < 2 * LEAST:
            continue
        velocity, acceleration = _derivatives(record)
        position = record.y - np.mean(record.y)
        columns.append(
            np.column_stack(
                [
                    acceleration,
                    velocity,
                    position,
                    np.sign(velocity),
                    np.ones(len(record)),
                ]
            )
        )
        wanted.append(record.u)
    if not columns:
        return None
    stacked, u = np.vstack(columns), np.concatenate(wanted)
    sizes = np.maximum(np.sqrt(np.mean(stacked**2, axis=0)), 1e-300)
    found = np.linalg.lstsq(stacked / sizes, u, rcond=1e-10)[0]
    left = float(np.mean((u - (stacked / sizes) @ found) ** 2))
    total = float(np.var(u))
    if left >= LEFT * total or abs(found[2]) > SPRING * np.sqrt(total):
        return None
    mass, damping = found[:2] / sizes[:2]
    return float(mass / damping) if mass > 0 and damping > 0 else LASTS


def windows(record: Record, decay_s: float | None = None) -> tuple[Record, ...]:
    """Cut a record where its motion turns; each window starts at zero.

    Parameters
    ----------
    record : Record
    decay_s : float, optional
        Time constant with which an unknown velocity at its first sample dies out.

    Returns
    -------
    tuple of Record
        One, of the whole record, where it does not turn.
    """
    starts = _starts(record)
    ends, mask = [*starts[1:], len(record)], record.interpolated
    return tuple(
        replace(
            record,
            name=f"{record.name}-{k + 1}",
            u=record.u[a:b].copy(),
            y=record.y[a:b] - record.y[a],
            period_samples=None,
            simulated=None,
            interpolated=None if mask is None else mask[a:b].copy(),
            decay_s=decay_s,
        )
        for k, (a, b) in enumerate(zip(starts, ends, strict=True))
        if b - a >= LEAST or len(starts) == 1
    )


def runs(records: Sequence[Record]) -> tuple[tuple[int, ...], ...]:
    """Give which records were measured in one run: windows of one record, or it alone.

    Parameters
    ----------
    records : sequence of Record
        As they were measured, or cut by :func:`windows`.

    Returns
    -------
    tuple of tuple of int
        Numbers of the records, by run.
    """
    found: dict[str, list[int]] = {}
    for number, record in enumerate(records):
        window = record.decay_s is not None
        run = record.name.rpartition("-")[0] if window else f"{number} {record.name}"
        found.setdefault(run, []).append(number)
    return tuple(tuple(own) for own in found.values())


def _starts(record: Record) -> list[int]:
    """Give the samples where a window begins: the first, and those of no velocity."""
    if len(record) < 2 * LEAST:
        return [0]
    velocity, _ = _derivatives(record)
    turns: NDArray[np.intp] = np.flatnonzero(np.diff(np.sign(velocity)) != 0)
    starts = [0]
    for turn in turns.tolist():
        nearer = turn + int(abs(velocity[turn + 1]) < abs(velocity[turn]))
        if nearer - starts[-1] >= LEAST and len(record) - nearer >= LEAST:
            starts.append(nearer)
    return starts


def _derivatives(record: Record) -> tuple[FloatArray, FloatArray]:
    """Velocity and acceleration of the output, by parabolas through its neighbours.

    Towards the ends the first and the last parabola go on.
    """
    place = np.arange(-NEIGHBOURS, NEIGHBOURS + 1)
    parabolas = np.linalg.pinv(np.vander(place, 3, increasing=True))
    slope = np.correlate(record.y, parabolas[1], "valid")
    bend = 2 * np.correlate(record.y, parabolas[2], "valid")
    before, after = place[:NEIGHBOURS], place[NEIGHBOURS + 1 :]
    velocity = [slope[0] + bend[0] * before, slope, slope[-1] + bend[-1] * after]
    acceleration = np.pad(bend, NEIGHBOURS, mode="edge")
    return np.concatenate(velocity) / record.dt, acceleration / record.dt**2

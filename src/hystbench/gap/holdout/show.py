"""What hold-out records show of a base and of the model that was found."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from hystbench.errors import InputError
from hystbench.gap.fitting.own_values import NONE, OwnValues
from hystbench.gap.fitting.start import run_base
from hystbench.gap.fitting.state import ModelState
from hystbench.gap.holdout.black_box import black_box_mapping
from hystbench.gap.holdout.runs_away import RunsAway, bounded, reach
from hystbench.gap.holdout.shrink import (
    RecordShrink,
    Shrink,
    ladder,
    mapping,
    records_mapping,
    shrink,
)
from hystbench.gap.judging.black_box import BlackBox
from hystbench.gap.naming.ladder import Rung
from hystbench.gap.records.floor import Floor
from hystbench.gap.records.nuisance import (
    Nuisance,
    degree_that_carries_on,
    path_and_mains,
)
from hystbench.gap.simulation.simulation import Simulation
from hystbench.model import Model
from hystbench.record import FloatArray, Record


@dataclass(frozen=True)
class FitResult:
    """What the fit records fix; hold-out records are compared with it.

    Parameters
    ----------
    base : Model
    state : ModelState
        The model with all effects that were added, on the fit records.
    floor : Floor
    black_box : BlackBox
        Fitted to what the base leaves on the fit records.
    rungs : tuple of Rung
        The models on the way from the base to the last effect.
    own : OwnValues
        What some records have of their own: a hold-out record may have the same.
    """

    base: Model
    state: ModelState
    floor: Floor
    black_box: BlackBox
    rungs: tuple[Rung, ...]
    own: OwnValues = NONE


@dataclass(frozen=True)
class Shown:
    """What the hold-out records show.

    Parameters
    ----------
    content : dict
        ``gap``, ``records``, ``ladder``, ``runs_away`` and ``black_box`` of gap.json.
    outputs : list of (ndarray, ndarray)
        Outputs before and after, of each record; NaN where the model runs away on it.
    """

    content: dict[str, Any]
    outputs: list[tuple[FloatArray, FloatArray]]


def show(fitted: FitResult, records: tuple[Record, ...]) -> Shown:
    """Compare base and model on hold-out records.

    Parameters
    ----------
    fitted : FitResult
    records : tuple of Record

    Returns
    -------
    Shown

    Raises
    ------
    InputError
        If the base's output is not finite on a record. Where a model's is not, the
        decision stays: the record is told, and counts as nothing closed.
    """
    base, state, floor, own = fitted.base, fitted.state, fitted.floor, fitted.own
    nuisance = nuisance_of(state, own)
    plain = run_base(base, records, state.hold)
    usual = reach(plain, floor.rms)
    mine = as_recorded(own, records, plain, floor)
    before = [output for output in mine if output is not None]
    found_after, lost = _run(_name(base, state), state, records, usual)
    after = as_recorded(own, records, found_after, floor)
    found: Shrink = shrink(records, before, after, floor.rms, floor.method, nuisance)
    stages = [
        (
            rung.name,
            as_recorded(
                own,
                records,
                _run(_name(base, rung.state), rung.state, records, usual)[0],
                floor,
            ),
        )
        for rung in fitted.rungs
    ]
    content = {
        "gap": mapping(found),
        "records": records_mapping(found),
        "ladder": [
            {"name": name, "rms": value}
            for name, value in ladder(records, stages, nuisance)
        ],
        "runs_away": [item.mapping() for item in lost],
        "black_box": black_box_mapping(
            fitted.black_box, records, before, found, nuisance
        ),
    }
    outputs = [
        (record.y - item.residual_before, _after(record, item))
        for record, item in zip(records, found.records, strict=True)
    ]
    return Shown(content, outputs)


def _after(record: Record, item: RecordShrink) -> FloatArray:
    if item.residual_after is None:
        return np.full(len(record), np.nan)
    return record.y - item.residual_after


def nuisance_of(state: ModelState, own: OwnValues) -> Nuisance | None:
    """Give regressors of what is new in every record, of the device or its own."""
    nuisance = what_is_new(state)
    if own.kinds and nuisance is None:
        nuisance = path_and_mains(None)  # nothing more, but the first part estimates
    return nuisance


def as_recorded(
    own: OwnValues,
    records: Sequence[Record],
    outputs: Sequence[FloatArray | None],
    floor: Floor,
) -> list[FloatArray | None]:
    """Give simulated outputs with what each record has of its own."""
    return [
        output
        if output is None or not own.kinds
        else own.fitted_first(record, output, floor.rms**2).of(output, record.dt)
        for record, output in zip(records, outputs, strict=True)
    ]


def what_is_new(state: ModelState) -> Nuisance | None:
    """Give regressors of what is new in every record, if an effect says so."""
    if not state.beside:
        return None
    tones = [
        order * values["frequency_hz"]
        for beside, values in state.beside
        if "frequency_hz" in values
        for order in range(1, beside.order + 1)
    ]
    if all("frequency_hz" in values for _, values in state.beside):
        return path_and_mains(None, tones)
    outputs = Simulation(state.chain, state.records, state.hold).output
    degree = degree_that_carries_on(state.records, outputs, tones)
    return path_and_mains(degree, tones)


def _run(
    name: str, state: ModelState, records: tuple[Record, ...], usual: float
) -> tuple[list[FloatArray | None], list[RunsAway]]:
    outputs: list[FloatArray] = []
    refused: dict[str, str] = {}
    for record in records:
        try:
            with np.errstate(over="ignore", invalid="ignore"):
                outputs += Simulation(state.chain, (record,), state.hold).output
        except InputError as error:  # a simulator may not take what an effect sends it
            refused[record.name] = str(error)
            outputs.append(np.full(len(record), np.nan))
    return bounded(name, records, outputs, usual, refused)


def _name(base: Model, state: ModelState) -> str:
    effects = " and ".join(item.effect for item in state.added)
    return f"{base.name} with {effects}" if effects else base.name

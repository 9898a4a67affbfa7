"""What hold-out records show of a base and of the model that was found."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from hystbench.errors import InputError
from hystbench.gap.fitting.augmented_model import augmented
from hystbench.gap.fitting.on_records import run_base
from hystbench.gap.fitting.own_values import OwnValues
from hystbench.gap.fitting.state import ModelState
from hystbench.gap.holdout.shrink import shrink
from hystbench.gap.naming.ladder import FitResult
from hystbench.gap.records.black_box import BlackBox
from hystbench.gap.records.floor import Floor
from hystbench.gap.records.nuisance import (
    Nuisance,
    degree_that_carries_on,
    left_rms,
    path_and_mains,
)
from hystbench.gap.simulation.simulation import Simulation
from hystbench.metrics import rms
from hystbench.model import Model
from hystbench.record import FloatArray, Record


@dataclass(frozen=True)
class Outcome:
    """What the hold-out records show."""

    model: Model
    """The base with its effects; the base, where the records took the names back."""
    content: dict[str, Any]
    """Keys of gap.json: ``gap``, ``records``, ``ladder``, ``runs_away`` and
    ``black_box``, then all of it."""
    outputs: list[tuple[FloatArray, FloatArray]]
    """Outputs before and after, of each record as it was measured; NaN where the model
    runs away on it."""


def score_hold_out(fitted: FitResult, records: tuple[Record, ...]) -> Outcome:
    """Compare base and model on hold-out records.

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
    before = [y for y in as_recorded(own, records, plain, floor) if y is not None]

    def run(state: ModelState) -> tuple[list[FloatArray | None], list[dict[str, Any]]]:
        outputs, lost = _run(base, state, records, usual)
        return as_recorded(own, records, outputs, floor), lost

    after, lost = run(state)
    found = shrink(records, before, after, floor, nuisance)
    content = {
        "gap": found.gap,
        "records": found.records,
        "ladder": [
            {"name": rung.name, "rms": left_rms(records, run(rung.state)[0], nuisance)}
            for rung in fitted.rungs
        ],
        "runs_away": lost,
        "black_box": black_box_mapping(
            fitted.black_box, records, before, found.records, floor, nuisance
        ),
    }
    outputs = [
        (record.y - old, record.y - (np.nan if new is None else new))
        for record, (old, new) in zip(records, found.residuals, strict=True)
    ]
    shown = [
        (before[record.past :], after[record.past :])
        for record, (before, after) in zip(records, outputs, strict=True)
    ]
    model = augmented(base, state).with_hold(state.hold)
    return Outcome(model, content, shown)


def nuisance_of(state: ModelState, own: OwnValues) -> Nuisance | None:
    """Give regressors of what is new in every record, of the device or its own."""
    if not state.beside:
        # There is nothing more, but the first part of a record estimates its own.
        return path_and_mains(None) if own.kinds else None
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
        else own.fitted_first(record, output, floor.square).of(output, record.dt)
        for record, output in zip(records, outputs, strict=True)
    ]


def _run(
    base: Model, state: ModelState, records: tuple[Record, ...], usual: float
) -> tuple[list[FloatArray | None], list[dict[str, Any]]]:
    outputs: list[FloatArray] = []
    refused: dict[str, str] = {}
    for record in records:
        try:
            with np.errstate(over="ignore", invalid="ignore"):
                outputs += Simulation(state.chain, (record,), state.hold).output
        except InputError as error:  # a simulator may not take what an effect sends it
            refused[record.name] = str(error)
            outputs.append(np.full(len(record), np.nan))
    effects = " and ".join(item.effect for item in state.added)
    name = f"{base.name} with {effects}" if effects else base.name
    return bounded(name, records, outputs, usual, refused)


RUNS_AWAY_RATIO = 1e6
"""Times as far as the base ever goes: an output beyond it runs away, finite or not."""


def reach(outputs: Sequence[FloatArray], floor_rms: float) -> float:
    """Give how far a base's outputs go on all records, and the noise."""
    return max(float(np.abs(output).max()) for output in outputs) + floor_rms


def bounded(
    model: str,
    records: Sequence[Record],
    outputs: Sequence[FloatArray],
    usual: float,
    refused: Mapping[str, str] | None = None,
) -> tuple[list[FloatArray | None], list[dict[str, Any]]]:
    """Tell on which records a model runs away.

    Parameters
    ----------
    model : str
        What it is called.
    records : sequence of Record
    outputs : sequence of ndarray, shape (n,) each
    usual : float
        How far the base goes.
    refused : mapping of str to str, optional
        By record, why there is no output, which is NaN there.

    Returns
    -------
    outputs : list of ndarray or None
        None where the model runs away.
    found : list of dict
        What gap.json holds under ``runs_away``.
    """
    kept: list[FloatArray | None] = []
    found = []
    for record, output in zip(records, outputs, strict=True):
        # What is no number is not within either.
        beyond = np.flatnonzero(~(np.abs(output) <= RUNS_AWAY_RATIO * usual))
        kept.append(None if len(beyond) else output)
        if len(beyond):
            why = (refused or {}).get(record.name)
            start = float(record.time[beyond[0]])
            what = f"cannot be run on {record.name}: {why}"
            if why is None:
                what = (
                    f"diverges on {record.name} from {start:g} s on: there its output "
                    "is not bounded"
                )
            told = f"{model} {what}, and nothing of the gap counts as closed."
            about = {"record": record.name, "from_s": start, "refused": why}
            found.append(about | {"sentence": told})
    return kept, found


def black_box_mapping(
    box: BlackBox,
    records: Sequence[Record],
    simulated: Sequence[FloatArray],
    named: Sequence[Mapping[str, Any]],
    floor: Floor,
    nuisance: Nuisance | None = None,
) -> dict[str, Any]:
    """Give what gap.json holds under ``black_box``.

    Parameters
    ----------
    box : BlackBox
    records : sequence of Record
        The hold-out records.
    simulated : sequence of ndarray, shape (n,) each
        Output of the base, which the black box corrects.
    named : sequence of mapping
        What the named effects reach on the same records: ``records`` of gap.json.
    floor : Floor
    nuisance : callable, optional
        The same as for ``named``.

    Returns
    -------
    dict
        ``explained_on_folds``, and on hold-out records ``after`` (RMS), ``explained``,
        both with an interval, and ``records``; each of these has ``named`` (RMS after
        the named effects) and ``outside`` (in what the record lies outside the training
        range). ``outside`` has RMS over those that lie outside, None where none does.
        ``after`` and ``named`` are None where a model runs away.
    """
    with np.errstate(over="ignore", invalid="ignore"):
        corrected = [
            output + box.predict(record, output)
            for record, output in zip(records, simulated, strict=True)
        ]
    kept, _ = bounded("the black box", records, corrected, reach(simulated, floor.rms))
    about, rows, _ = shrink(records, simulated, kept, floor, nuisance)
    for row, record, other in zip(rows, records, named, strict=True):
        row["named"] = other["after"]
        row["outside"] = list(box.outside(record))
    keys = ("after", "explained", "after_interval", "interval")
    return {
        "explained_on_folds": box.explained_on_folds,
        **{key: about[key] for key in keys if key in about},
        "records": rows,
        "outside": _together([row for row in rows if row["outside"]]),
    }


def _together(rows: Sequence[dict[str, Any]]) -> dict[str, float | None] | None:
    """RMS over records alike, of the base, the black box and the named effects."""
    if not rows:
        return None
    found: dict[str, float | None] = {}
    for key in ("before", "after", "named"):
        sizes = [row[key] for row in rows]
        found[key] = None if None in sizes else rms(np.array(sizes))
    return found

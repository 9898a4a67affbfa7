"""A decision after the hold-out records were read."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

from hystbench.gap.fitting.augmented_model import augmented
from hystbench.gap.fitting.own_values import NONE, OwnValues
from hystbench.gap.fitting.start import run_base
from hystbench.gap.fitting.state import ModelState
from hystbench.gap.holdout.shortfall import shortfall
from hystbench.gap.holdout.show import as_recorded, nuisance_of, show
from hystbench.gap.holdout.shrink import (
    ladder,
)
from hystbench.gap.holdout.withdrawal import (
    first_figure,
    with_built_in,
    with_what_was_asked,
    withdrawal,
    without_names,
)
from hystbench.gap.judging.black_box import BlackBox
from hystbench.gap.naming.built_in import BuiltIn
from hystbench.gap.naming.ladder import BASE, Rung
from hystbench.gap.records.evidence import Evidence
from hystbench.gap.records.floor import Floor
from hystbench.gap.vocabulary import Vocabulary
from hystbench.model import Model
from hystbench.record import FloatArray, Record


@dataclass(frozen=True)
class Outcome:
    """A decision after the hold-out records were read.

    Parameters
    ----------
    model : Model
        The base, where they took the names back.
    content : dict
        What gap.json holds.
    outputs : list of (ndarray, ndarray)
        Outputs before and after, of each record; NaN where the model runs away on it.
    """

    model: Model
    content: dict[str, Any]
    outputs: list[tuple[FloatArray, FloatArray]]


def outcome(
    base: Model,
    decided: Mapping[str, Any],
    state: ModelState,
    floor: Floor,
    box: BlackBox,
    records: tuple[Record, ...],
    rungs: Sequence[Rung],
    own: OwnValues = NONE,
    warnings: Sequence[str] = (),
) -> Outcome:
    """Show a decision on the hold-out records; take back what is worse there.

    Parameters
    ----------
    base : Model
    decided : mapping
        What gap.json holds, but for what the hold-out records show.
    state, floor, box, records, rungs, own
        As for :func:`show`.
    warnings : sequence of str
        What of the dataset is hardly meant.
    """
    shown = show(base, state, floor, box, records, rungs, own)
    content = {
        **decided,
        "withdrawn": None,
        **shown.content,
        "warnings": list(warnings),
    }
    model = augmented(base, state).with_hold(state.hold)
    taken = withdrawal(content)
    if taken is not None:
        # The ladder and what runs away stay: they tell why.
        alone = show(base, rungs[0].state, floor, box, records, rungs[:1], own)
        kept = {key: alone.content[key] for key in ("gap", "records", "black_box")}
        content = without_names({**content, **kept}, taken)
        model = base.with_hold(state.hold)
        shown = alone
    elif content["effects"] or content["verdict"] == "parameters":
        content["reason"] = f"{first_figure(content)}; {content['reason']}"
    content["shortfall"] = shortfall(content)
    return Outcome(model, content, shown.outputs)


def as_asked(
    shown: Outcome,
    vocabulary: Vocabulary,
    built_in: BuiltIn | None,
    evidence: Evidence,
    state: ModelState,
    floor: Floor,
    own: OwnValues,
) -> Outcome:
    """Tell which effects the user put in or left out, and what those put in do.

    Parameters
    ----------
    shown : Outcome
    vocabulary : Vocabulary
    built_in : BuiltIn or None
        None where no effect was put in.
    evidence : Evidence
    state, floor, own
        As for :func:`show`.
    """
    content = with_what_was_asked(shown.content, vocabulary)
    if built_in is not None:
        records = evidence.hold_out
        outputs = run_base(built_in.alone, records, evidence.hold)
        mine = as_recorded(own, records, outputs, floor)
        ((_, alone),) = ladder(records, [(BASE, mine)], nuisance_of(state, own))
        assert alone is not None  # noqa: S101  (run_base refuses what has no bound)
        content = with_built_in(content, built_in, alone)
    return replace(shown, content=content)

"""A decision after the hold-out records were read."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any

from hystbench.gap.behaviour import with_device
from hystbench.gap.fitting.augmented_model import augmented
from hystbench.gap.fitting.start import run_base
from hystbench.gap.holdout.shortfall import shortfall
from hystbench.gap.holdout.show import FitResult, as_recorded, nuisance_of, show
from hystbench.gap.holdout.shrink import ladder
from hystbench.gap.holdout.withdrawal import (
    first_figure,
    with_built_in,
    with_what_was_asked,
    withdrawal,
    without_names,
)
from hystbench.gap.naming.built_in import BuiltIn
from hystbench.gap.naming.ladder import BASE
from hystbench.gap.records.evidence import Evidence
from hystbench.gap.vocabulary import Vocabulary
from hystbench.model import Model
from hystbench.record import FloatArray


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
    fitted: FitResult, decided: Mapping[str, Any], evidence: Evidence
) -> Outcome:
    """Show a decision on the hold-out records; take back what is worse there.

    Parameters
    ----------
    fitted : FitResult
    decided : mapping
        What gap.json holds, but for what the hold-out records show.
    evidence : Evidence
    """
    shown = show(fitted, evidence.hold_out)
    content = {
        **decided,
        "withdrawn": None,
        **shown.content,
        "warnings": list(evidence.warnings),
    }
    base, state = fitted.base, fitted.state
    model = augmented(base, state).with_hold(state.hold)
    taken = withdrawal(content)
    if taken is not None:
        # The ladder and what runs away stay: they tell why.
        first = fitted.rungs[0]
        unchanged = replace(fitted, state=first.state, rungs=(first,))
        alone = show(unchanged, evidence.hold_out)
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
    fitted: FitResult,
    evidence: Evidence,
    vocabulary: Vocabulary,
    built_in: BuiltIn | None,
) -> Outcome:
    """Tell which effects the user put in or left out, and what the device makes of all.

    Parameters
    ----------
    shown : Outcome
    fitted : FitResult
    evidence : Evidence
    vocabulary : Vocabulary
    built_in : BuiltIn or None
        None where no effect was put in.
    """
    content = with_what_was_asked(shown.content, vocabulary)
    if built_in is not None:
        records = evidence.hold_out
        outputs = run_base(built_in.alone, records, evidence.hold)
        mine = as_recorded(fitted.own, records, outputs, fitted.floor)
        nuisance = nuisance_of(fitted.state, fitted.own)
        ((_, alone),) = ladder(records, [(BASE, mine)], nuisance)
        assert alone is not None  # noqa: S101  (run_base refuses what has no bound)
        content = with_built_in(content, built_in, alone)
    content = with_device(content, evidence.device_kind, evidence.quantities)
    return replace(shown, content=content)

"""The decision after the hold-out records: they open its reason, or take names back.

They choose nothing. A model that is worse on them than the base goes as a whole: to
keep those of its effects that do better there would be to choose by hold-out records.
A name whose step widens the gap there is no surer than even. ``content`` is what
gap.json holds, in every function.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from hystbench.gap.bases.gpi import is_another
from hystbench.gap.bases.lead import lead_warnings
from hystbench.gap.bases.linear import is_identified_linear
from hystbench.gap.bases.roughly_known import as_it_was
from hystbench.gap.fitting.on_records import run_base
from hystbench.gap.fitting.parameters import base_parameters
from hystbench.gap.holdout.confidence_cap import no_surer_than_even
from hystbench.gap.holdout.scored import (
    Outcome,
    as_recorded,
    nuisance_of,
    score_hold_out,
)
from hystbench.gap.holdout.shortfall import shortfall
from hystbench.gap.naming.ladder import FitResult, Rung
from hystbench.gap.naming.put_in import PutIn
from hystbench.gap.records.evidence import Evidence
from hystbench.gap.records.lone_samples import (
    lone_share,
    lone_words,
    much_stands_alone,
)
from hystbench.gap.records.nuisance import left_rms
from hystbench.gap.records.scored_samples import Compared
from hystbench.gap.thresholds import ABOVE_NOISE, AS_GOOD, LOOSE
from hystbench.gap.vocabulary import Vocabulary, with_device
from hystbench.metrics import rms
from hystbench.model import Model
from hystbench.units import sized


@dataclass(frozen=True, kw_only=True)
class ToShow:
    """What goes from the fit records to those that are held out."""

    first: Model
    """The base as it was given, or first identified. It is kept to find the leads of
    hold-out records: it forgets its start, while a host in its place, as a store, may
    not."""
    fitted: FitResult
    content: Mapping[str, Any]
    """What gap.json holds, but for what the hold-out records show."""
    vocabulary: Vocabulary
    """What the user put in or left out, which is told."""
    put_in: PutIn | None
    """None where no effect was put in."""
    damper: float = 0.0
    """Of the observer that it was decided with; zero without one."""
    plain: ToShow | None = None
    """What stands where hold-out records take that back: decided without an observer,
    and with nothing named."""


def show_on_hold_out(decided: ToShow, evidence: Evidence) -> Outcome:
    """Show a decision on the hold-out records; take back what is worse there.

    It is worse where it leaves more than the base, or than what was identified before
    any effect was known: a hysteresis, or a linear base in whose place a host stands.
    """
    first, fitted, put_in = decided.first, decided.fitted, decided.put_in
    shown = score_hold_out(fitted, evidence.hold_out)
    content = {**decided.content, "withdrawn": None, **shown.content}
    other, least = None, np.inf
    if put_in is None and _was_replaced(first, fitted):
        other, least = first, _left_by(first, fitted, evidence)
        linear = is_identified_linear(first)
        who = "the linear base" if linear else "as it was first identified it"
        content["reason"] += (
            f"; {who} leaves {sized(least, content['unit'])} rms of the hold-out "
            "records"
        )
    taken = withdrawal(content, least)
    if taken is not None:
        shown = _base_alone(fitted, other, evidence)
        # The ladder and what runs away stay: they tell why.
        alone = {key: shown.content[key] for key in ("gap", "records", "black_box")}
        content = without_names({**content, **alone}, taken)
        if other is not None:
            numbers = base_parameters(other, _rung_of(other, fitted).state)
            content["base_parameters"] = numbers
    elif content["effects"] or content["verdict"] == "parameters":
        content = _as_borne_out(content)
    content = _with_warnings(content, shown, decided, evidence)
    content["shortfall"] = shortfall(content)
    content = with_what_was_asked(content, decided.vocabulary)
    if put_in is not None:
        alone_rms = _left_by(put_in.alone, fitted, evidence)
        content = _with_put_in(content, put_in, alone_rms)
    content = with_device(content, evidence.device_kind, evidence.quantities)
    return replace(shown, content=content)


def _was_replaced(first: Model, fitted: FitResult) -> bool:
    """Tell whether effects were found beside another base than was first identified."""
    base, hold = fitted.base, fitted.state.hold
    if not is_identified_linear(first):
        return is_another(first, base)
    return first.with_hold(hold).chain != base.with_hold(hold).chain


def _rung_of(base: Model, fitted: FitResult) -> Rung:
    """Give another base on the fit records, as the first rung."""
    rung = fitted.rungs[0]
    chain = base.with_hold(fitted.state.hold).chain
    return rung._replace(state=replace(rung.state, chain=chain, free=()).settled())


def _base_alone(fitted: FitResult, other: Model | None, evidence: Evidence) -> Outcome:
    """Compare the base with the hold-out records, or another in its place, if any."""
    rung, base, hold = fitted.rungs[0], fitted.base, fitted.state.hold
    if other is not None:
        base, rung = other, _rung_of(other, fitted)
    unchanged = replace(fitted, base=base, state=rung.state, rungs=(rung,))
    alone = score_hold_out(unchanged, evidence.hold_out)
    return replace(alone, model=as_it_was(base).with_hold(hold))


def _as_borne_out(content: Mapping[str, Any]) -> dict[str, Any]:
    """Give names that stay the confidence that hold-out records allow, and a figure."""
    reason = f"{first_figure(content)}; {content['reason']}"
    return {**content, "effects": no_surer_than_even(content), "reason": reason}


def _with_warnings(
    content: Mapping[str, Any], shown: Outcome, decided: ToShow, evidence: Evidence
) -> dict[str, Any]:
    """Warn of what hold-out records show; a base that predicts nothing has a gap."""
    fitted = decided.fitted
    still = rms_of_a_constant(evidence, fitted.floor.rms)
    worse = worse_than_a_constant(_left_of(content["gap"]), still, content["unit"])
    lone = _lone_samples(shown, evidence, fitted.floor.rms)
    warned = {
        **content,
        "warnings": [
            *evidence.warnings,
            *decided.content.get("warnings", ()),
            *lead_warnings((*fitted.state.records, *evidence.hold_out)),
            *([*worse, *lone] or more_than_on_fit_records(content)),
        ],
    }
    if content["verdict"] == "no-gap" and worse:
        # The fit records show none, but nothing of the device is known by that.
        reason = f"{worse[0]}; of the fit records: {content['reason']}"
        warned |= {"verdict": "unnamed", "reason": reason}
    return warned


def _lone_samples(shown: Outcome, evidence: Evidence, floor: float) -> list[str]:
    """Say that much of what is left of the hold-out records stands in lone samples."""
    gap = shown.content["gap"]
    if gap["after"] is None:
        return []
    pairs = zip(evidence.hold_out, shown.outputs, strict=True)
    compared = [Compared(record.as_measured, after) for record, (_, after) in pairs]
    lone = lone_share(compared)
    before = max(gap["before"] ** 2, floor**2)
    if not much_stands_alone(lone, gap["after"] ** 2, before):
        return []
    return [lone_words("hold-out", compared, lone)]


def more_than_on_fit_records(content: Mapping[str, Any]) -> list[str]:
    """Say that much more is left of hold-out records than of fit records, if so.

    Where the fit records show no gap, that is what is more than noise; else twice the
    rms that the model leaves of them.
    """
    gap, unit = content["gap"], content["unit"]
    before, floor = gap["before"], gap["noise_floor"]
    if content["verdict"] != "no-gap":
        return _twice_as_much(content)
    if before is None:
        return []
    if before**2 <= (1 + ABOVE_NOISE) * max(floor, content["fit"]["after"] or 0.0) ** 2:
        return []
    return [
        f"on the hold-out records the base leaves {sized(before, unit)} "
        f"rms, and the noise floor is {sized(floor, unit)}: no fit record "
        "shows that. The zero of a hold-out record may have moved"
    ]


def _twice_as_much(content: Mapping[str, Any]) -> list[str]:
    """Say that hold-out records leave twice the rms of fit records, or more."""
    gap, unit = content["gap"], content["unit"]
    of_fit = content["fit"]["before" if content.get("withdrawn") else "after"]
    left = _left_of(gap)
    if left is None or of_fit is None:
        return []
    if LOOSE * left**2 <= max(gap["noise_floor"], of_fit) ** 2:
        return []
    return [
        f"of the hold-out records the model leaves {sized(left, unit)} rms, of the fit "
        f"records {sized(of_fit, unit)}. What fits these does not hold there: another "
        "range or another state of the device, a second cause that the input does not "
        "tell, or too few fit records for what was fitted"
    ]


def _left_of(gap: Mapping[str, Any]) -> Any:
    """Give the RMS that the model leaves; where it cannot be run, the base's.

    None where there is neither.
    """
    return gap["before"] if gap["after"] is None else gap["after"]


def rms_of_a_constant(evidence: Evidence, floor: float) -> float:
    """Give what the mean output of the fit records leaves of the hold-out records.

    Infinite where that is no more than noise: a record at rest shows nothing of a base.
    """
    mean = np.mean(np.concatenate([x.y[x.counted] for x in evidence.fit]))
    measured = [record.as_measured for record in evidence.hold_out]
    still = rms(np.concatenate([x.y[x.counted] for x in measured]) - mean)
    return np.inf if still**2 <= (1 + AS_GOOD) * floor**2 else still


def worse_than_a_constant(left: float, still: float, unit: str) -> list[str]:
    """Say that the mean output of the fit records does better than the model.

    Parameters
    ----------
    left : float
        RMS residual of the model with its effects, if any, on the hold-out records.
    still : float
        That of a constant.
    unit : str

    Returns
    -------
    list of str
        One warning, or none.
    """
    if left**2 <= (1 + AS_GOOD) * still**2:
        return []
    return [
        f"on the hold-out records the model leaves {sized(left, unit)} rms, and a "
        f"constant, the mean output of the fit records, {sized(still, unit)}: as it "
        "is, the model predicts nothing. Check its columns, its units, its start and "
        "its numbers; if they are right, what it lacks has no name here"
    ]


def _left_by(base: Model, fitted: FitResult, evidence: Evidence) -> float:
    """RMS residual of another base on the hold-out records."""
    records = evidence.hold_out
    outputs = run_base(base, records, evidence.input_hold)
    mine = as_recorded(fitted.own, records, outputs, fitted.floor)
    size = left_rms(records, mine, nuisance_of(fitted.state, fitted.own))
    assert size is not None  # noqa: S101  (run_base refuses what has no bound)
    return size


LEAST_TOLD = 5e-4
"""Share that is told as none: it would read 0.0 %."""


def first_figure(content: Mapping[str, Any]) -> str:
    """Say what is gone on the hold-out records, and of what it is a share."""
    gap, unit = content["gap"], content["unit"]
    sizes = f"{gap['before']:.3g} to {sized(gap['after'], unit)} rms"
    share, floor = gap["explained"], gap["noise_floor"]
    if share is None or gap["before"] ** 2 <= (1 + AS_GOOD) * floor**2:
        return f"on the hold-out records the base leaves no more than noise: {sizes}"
    ends = share if isinstance(share, list | tuple) else [share]
    told = " to ".join(dict.fromkeys(f"{100 * end:.1f} %" for end in ends))
    if max(ends) < LEAST_TOLD:
        told = "none"
    return (
        f"on the hold-out records {told} of the gap's power above the noise floor is "
        f"gone, {sizes}"
    )


def withdrawal(
    content: Mapping[str, Any], least: float = np.inf
) -> dict[str, Any] | None:
    """Tell what the hold-out records take back, if the model is worse on them.

    Parameters
    ----------
    content : mapping
        What gap.json would hold if nothing were taken back.
    least : float
        RMS residual of another base that it must not be worse than either.

    Returns
    -------
    dict or None
        ``withdrawn`` of gap.json: ``names``, empty where only the base was re-tuned;
        ``verdict`` and ``effects`` as the fit records decided; ``before`` and
        ``after``, RMS on the hold-out records together, and of each in ``records``;
        ``why``.
    """
    gap, unit = content["gap"], content["unit"]
    before, after = min(gap["before"], least), gap["after"]
    names = [item["name"] for item in content["effects"]]
    if after is not None and after**2 <= (1 + AS_GOOD) * before**2:
        return None
    what = " and ".join(names) or "the re-tuning of the base"
    if after is None:
        lost = " and ".join(item["record"] for item in content["runs_away"])
        shown = f"with it the model cannot be run to the end of {lost}"
    else:
        grown = f"{before:.3g} to {sized(after, unit)} rms"
        shown = f"with it the gap grows there, from {grown}"
    return {
        "names": names,
        "verdict": content["verdict"],
        "effects": content["effects"],
        "before": before,
        "after": after,
        "records": [
            {key: item[key] for key in ("name", "before", "after")}
            for item in content["records"]
        ],
        "why": f"the hold-out records take {what} back: {shown}, so that the model "
        "stays the base",
    }


def without_names(
    content: Mapping[str, Any], taken: Mapping[str, Any]
) -> dict[str, Any]:
    """Give what gap.json holds once names are withdrawn."""
    numbers = {
        name: item | {"after": item["before"]}
        for name, item in content["base_parameters"].items()
    }
    no_gap = taken["verdict"] == "no-gap"  # of the base re-tuned: there was no name
    reason = content["reason"]
    if taken["names"]:
        reason = taken["why"]
    elif not no_gap:
        reason = f"{reason}; {taken['why']}"
    return {
        **content,
        "verdict": "no-gap" if no_gap else "unnamed",
        "reason": reason,
        "effects": [],
        "withdrawn": dict(taken),
        "base_parameters": numbers,
    }


def with_what_was_asked(
    content: Mapping[str, Any], vocabulary: Vocabulary
) -> dict[str, Any]:
    """Tell in the reason which effects the user put in or left out."""
    words = vocabulary.words()
    if not words:
        return dict(content)
    reason = "; ".join([content["reason"], *words])
    return {**content, "reason": reason, "asked": vocabulary.mapping()}


def _with_put_in(
    content: Mapping[str, Any], put_in: PutIn, alone: float
) -> dict[str, Any]:
    """Tell what the effects that the user put in do, apart from what was found.

    The ``gap`` of the content begins with them; ``alone`` is the RMS residual of the
    simulator without them on the hold-out records.
    """
    names = " and ".join(put_in.names)
    first, *rest = content["ladder"]
    after, unit = content["gap"]["before"], content["unit"]
    told = {
        "effects": list(put_in.effects),
        "before": alone,
        "after": after,
        "sentence": (
            f"You put {names} into the simulator; on the hold-out records the residual "
            f"of the simulator alone is {sized(alone, unit)} rms, with {names} "
            f"{sized(after, unit)}. Nothing of that counts as found."
        ),
    }
    ladder = [
        {"name": first["name"], "rms": alone},
        {"name": f"{names} (you put it in)", "rms": after},
        *rest,
    ]
    return {**content, "built_in": told, "ladder": ladder}

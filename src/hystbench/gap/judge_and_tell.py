"""The verdict on what fit records named, and all that gap.json says of it."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any, NamedTuple

import numpy as np

from hystbench.blocks.calls import USED_UP, current
from hystbench.gap.asked import Asked
from hystbench.gap.beside_base import BesideBase
from hystbench.gap.effects.hysteresis import Hysteresis
from hystbench.gap.experiment.candidates import Limits
from hystbench.gap.experiment.tell_apart import Experiment, tell_apart
from hystbench.gap.fitting.augmented_model import augmented, blocks_of
from hystbench.gap.fitting.model_score import (
    floor_with_steps,
    leaves_more,
    make_score,
    step_error,
)
from hystbench.gap.fitting.on_records import compared_records
from hystbench.gap.fitting.own_values import OwnValues
from hystbench.gap.fitting.parameters import at_ends, base_parameters
from hystbench.gap.fitting.state import ModelState
from hystbench.gap.fitting.uncertainty import (
    beside_errors,
    on_more_samples,
    size_error,
    standard_errors,
)
from hystbench.gap.judging.effect_rows import (
    effect_mapping,
    not_tried,
    paths_no_surer,
    ranking_rows,
    simulator_mapping,
)
from hystbench.gap.judging.leftover import Leftover, size_follows, what_is_left
from hystbench.gap.judging.measure_unowned import measure_unowned
from hystbench.gap.judging.unowned import Unowned
from hystbench.gap.judging.verdict import (
    Verdict,
    judge_names,
    judge_none,
    likelier_wrong,
    what_mends,
)
from hystbench.gap.locate import curves, locate
from hystbench.gap.locate.forms import LEAST_SHARE, View
from hystbench.gap.locate.level_classes import beside_level
from hystbench.gap.naming.add_effects import LITTLE, Named
from hystbench.gap.naming.ladder import FitResult, contributions, rungs
from hystbench.gap.naming.loops import is_a_curve
from hystbench.gap.progress import Say
from hystbench.gap.records.black_box import BlackBox, black_box
from hystbench.gap.records.floor import Floor, unrepeated
from hystbench.gap.records.lone_samples import lone_share, lone_words
from hystbench.model import Model

NO_LOOP = (
    "what would be a hysteresis has no loop: it is a curve of what enters it, of "
    "another form than those that were tried"
)


@dataclass(frozen=True, kw_only=True)
class Decision(FitResult):
    """What the fit records decide; nothing was compared with hold-out records yet."""

    model: Model
    """The base with the effects that were added."""
    content: Mapping[str, Any]
    """What gap.json holds, but for what the hold-out records show."""
    curves: Mapping[str, Any]
    """What the pictures of where the gap is are drawn from."""
    experiment: Experiment | None
    """What would tell likely effects apart best."""


def judge_and_tell(
    dataset: str, found: BesideBase, asked: Asked, limits: Limits | None
) -> Decision:
    """Locate the gap, and give the verdict on what was named.

    Parameters
    ----------
    dataset : str
        Its name.
    found : BesideBase
    asked : Asked
    limits : Limits or None
        Of the next experiment; those of the records where none are given.
    """
    say, allowed = asked.say, asked.unnamed_share
    around = found.inside or found  # what the effects are in
    base, start, floor = around.base, around.start, found.floor
    named = _unless_worse(found.named, start, floor, say)
    named, left = _unless_little(named, start, floor, say)
    state, model = named.state, augmented(base, named.state)
    before, after = compared_records(start), compared_records(state)
    left = replace(
        left,
        lone=lone_share(after),
        unrepeated=unrepeated(after, floor.rms),
    )
    box = black_box(before, floor.rms)
    judged = _judged(start, named, left, floor, box, found.own, allowed)
    effects = _effects(named, model, left, floor, judged.trust)
    if judged.verdict == "named" and (doubt := likelier_wrong(effects)):
        judged = judged._replace(verdict="unnamed", reason=f"{doubt}; {judged.reason}")
    ladder = rungs(start, named)
    contributed = contributions(ladder) if judged.verdict == "named" else ()
    where = locate(before, floor, contributed)
    if where[0].share_of_gap_power >= LEAST_SHARE:
        say(where[0].sentence)
    if judged.verdict != "no-gap":
        places = [(item.effect, item.place) for item in state.added]
        moved = beside_level(where, places, little_left=left.share_left <= allowed)
        reason = "; ".join(part for part in (judged.reason, moved) if part)
        judged = judged._replace(reason=reason)
    experiment, why_none = tell_apart(base, named, start.records, floor, limits)
    lone = [lone_words("fit", after, left.lone)] if left.lone_matters else []
    content = _content(
        dataset,
        found,
        named,
        judged,
        effects,
        left,
        model=model,
        where=where,
        experiment=experiment,
        no_experiment=why_none,
        box=box,
        warnings=lone,
    )
    return Decision(
        base,
        state,
        floor,
        box,
        ladder,
        found.own,
        model=model,
        content=content,
        curves=curves(where),
        experiment=experiment,
    )


def _unless_worse(named: Named, start: ModelState, floor: Floor, say: Say) -> Named:
    """Leave the base as it is where what was found leaves more of the fit records.

    Hold-out records would be told to take that back.
    """
    if not leaves_more(named.state, start, floor.square):
        return named
    say("what was found leaves more of the fit records than the base: that stays")
    none = named.with_none_named() if named.rounds else named
    return replace(none, state=start)


def _unless_little(
    named: Named, start: ModelState, floor: Floor, say: Say
) -> tuple[Named, Leftover]:
    """Drop names that leave most of what may be a slightly wrong shape alone.

    Returns
    -------
    Named
        As it was, or with no effect.
    Leftover
        What that leaves.
    """
    left = what_is_left(start, named.state, floor)
    if not (named.state.added and left.little_named):
        return named, left
    say(f"{LITTLE}: none named")
    named = named.with_none_named()
    return named, what_is_left(start, named.state, floor)


class _Judged(NamedTuple):
    """A verdict, and what it is made of."""

    verdict: Verdict
    reason: str
    trust: float
    unowned: Unowned


def _judged(
    start: ModelState,
    named: Named,
    left: Leftover,
    floor: Floor,
    box: BlackBox,
    own: OwnValues,
    allowed: float,
) -> _Judged:
    """Give the verdict on what was named, and say why."""
    state = named.state
    unowned = measure_unowned(start, state, floor, allowed)
    if state.added:
        verdict, why = judge_names(left, unowned)
        if verdict == "named" and is_a_curve(state, Hysteresis.name):
            verdict, why = "unnamed", NO_LOOP
    else:
        bound = floor.method == "upper-bound"
        size_tells = bound or left.is_new or unowned.follows_nothing
        verdict, why = judge_none(
            left,
            unowned,
            explained_by_box=box.explained_on_folds,
            retuned=bool(start.free),
            floor_is_upper_bound=bound,
            size_follows=size_tells and size_follows(state),
            mends=what_mends(start.records),
        )
    beside = f"beside {own.words} of some records' own" if own.records else ""
    if verdict == "no-gap" and own.scales and own.share > allowed:
        verdict, why, beside = "unnamed", f"{own.reason}; beside that {why}", ""
    parts = (
        why,
        _untried(not_tried(named)) if state.added else "",
        at_ends(state),
        beside,
        _predicts_nothing(state),
        _used_up(),
    )
    trust = unowned.trust(left.may_be_of_base)
    reason = "; ".join(part for part in parts if part)
    return _Judged(verdict, reason, trust, unowned)


def _content(
    dataset: str,
    found: BesideBase,
    named: Named,
    judged: _Judged,
    effects: list[dict[str, Any]],
    left: Leftover,
    *,
    model: Model,
    where: Sequence[View],
    experiment: Experiment | None,
    no_experiment: str,
    box: BlackBox,
    warnings: Sequence[str],
) -> dict[str, Any]:
    """Give what gap.json holds, but for what the hold-out records show."""
    around = found.inside or found
    base, start, state = around.base, around.start, named.state
    unit = start.records[0].output.unit
    content: dict[str, Any] = {
        "dataset": dataset,
        "model": base.name,
        "unit": unit,
        "verdict": judged.verdict,
        "reason": judged.reason,
        "effects": effects,
        "fit": _fit(start, state, found.floor, left),
        "unnamed": judged.unowned.mapping(),
        "where": [view.to_mapping() for view in where],
        "ranking": ranking_rows(named),
        "record_values": found.own.mapping(unit),
        "not_tried": not_tried(named),
        "taken_out": [item._asdict() for item in named.taken_out],
        "next_experiment": None if experiment is None else experiment.mapping(),
        "base_parameters": base_parameters(base, state),
        "simulator": simulator_mapping(model, start.records),
        "black_box": {"explained_on_folds": box.explained_on_folds},
        "warnings": list(warnings),
    }
    if no_experiment:
        content["no_experiment"] = no_experiment
    if used_up := _used_up():
        content["calls_used_up"] = {"bound": current().bound, "sentence": used_up}
    return content


def _effects(
    named: Named, model: Model, left: Leftover, floor: Floor, trust: float
) -> list[dict[str, Any]]:
    """Tell the effects with their numbers and errors."""
    state, by_effect = named.state, named.reasons
    finer = on_more_samples(state)
    score = make_score(finer, floor, forms=False)
    errors, of_beside = standard_errors(finer, score), beside_errors(finer, score)
    rows = [
        effect_mapping(
            item,
            state,
            errors,
            of_beside,
            by_effect.get(item.effect, ()),
            left,
            size_error(finer, floor.square, number),
            trust,
        )
        | {"blocks": blocks_of(item, state, model)}
        for number, item in enumerate(state.added)
    ]
    return paths_no_surer(rows, state.paths)


def _predicts_nothing(state: ModelState) -> str:
    """Say which effects have no number in common to the records: a path of drift.

    A tone has one, its frequency.
    """
    names = sorted(state.paths)
    if not names:
        return ""
    return f"{' and '.join(names)} of each record's own predicts no other record"


def _untried(names: Sequence[str]) -> str:
    """Tell which effects a name was not held against."""
    if not names:
        return ""
    why = USED_UP if current().refused() else "the simulator cannot be run again"
    return f"not tried, as {why}: {', '.join(names)}"


def _used_up() -> str:
    """Tell that a bound on calls has ended the search, if so."""
    calls = current()
    if not calls.refused():
        return ""
    return (
        f"the search ended early, as the {calls.bound} calls of the simulator that "
        "--calls allows were used up"
    )


def _fit(
    start: ModelState, state: ModelState, floor: Floor, left: Leftover
) -> dict[str, Any]:
    """Tell what is gone on the fit records, and how much no other record knows."""
    square = floor.square
    before, after = (each.power(square) for each in (start, state))
    alone = replace(state, beside=()).power(square)
    there = before > 0
    error = step_error(state)
    return {
        "before": float(np.sqrt(before + square)),
        "after": float(np.sqrt(after + square)),
        "explained": (before - after) / before if there else None,
        "new_in_every_record": (alone - after) / before if there else 0.0,
        "noise": floor.rms,
        "step_error": error,
        "floor": floor_with_steps(floor.rms, error),
        "left": left.share_left,
        "lone_share": left.lone,
        "unrepeated": left.unrepeated,
    }

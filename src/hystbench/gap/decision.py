"""From a dataset and a base to a decision: what is decided on the fit records alone."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from hystbench.blocks.calls import USED_UP, Calls, current
from hystbench.blocks.held import Hold
from hystbench.gap.bases.lead import leads_left_out
from hystbench.gap.bases.linear import is_identified
from hystbench.gap.effects import among
from hystbench.gap.experiment.excitations import Limits
from hystbench.gap.experiment.tell_apart import Experiment, tell_apart
from hystbench.gap.fitting.augmented_model import augmented, blocks_of
from hystbench.gap.fitting.compare import compare
from hystbench.gap.fitting.model_score import make_score
from hystbench.gap.fitting.own_values import NONE, OwnValues
from hystbench.gap.fitting.parameters import at_ends, base_parameters
from hystbench.gap.fitting.start import start_state
from hystbench.gap.fitting.state import ModelState
from hystbench.gap.fitting.step_error import floor_with_steps, step_error
from hystbench.gap.fitting.uncertainty import (
    on_more_samples,
    size_error,
    standard_errors,
)
from hystbench.gap.fitting.uncertainty_beside import beside_errors
from hystbench.gap.holdout.show import FitResult
from hystbench.gap.inside.apart import apart_inside
from hystbench.gap.inside.named_inside import Inside, beats, named_inside
from hystbench.gap.judging.black_box import black_box
from hystbench.gap.judging.gap_json import (
    effect_mapping,
    not_tried,
    ranking_rows,
    simulator_mapping,
)
from hystbench.gap.judging.unnamed import what_is_unnamed
from hystbench.gap.judging.verdict import (
    Left,
    judge,
    may_be_of_base,
    what_is_left,
    what_mends,
)
from hystbench.gap.locate import curves, locate
from hystbench.gap.naming.add_effects import LITTLE, Named, add_effects
from hystbench.gap.naming.ladder import contributions, rungs
from hystbench.gap.naming.with_own_values import named_apart
from hystbench.gap.progress import Say, silent
from hystbench.gap.records.evidence import own_offsets
from hystbench.gap.records.floor import Floor, lone_share, unrepeated
from hystbench.gap.thresholds import LOOSE, UNNAMED_SHARE
from hystbench.model import Model
from hystbench.quantities import Quantities
from hystbench.record import Record

NOT_IN_WINDOWS = ("drift", "sensor-nonlinearity", "saturation")
"""Effects that windows of a free mass cannot tell. An integrator makes a path of its
own in every window of any error; and each begins at zero wherever the mass is, so that
no curve over its place has a meaning."""
OF_THE_PLACE = "asymmetry"
"""The same behind a base that may hold a hysteresis. Before a linear one it bends what
drives the mass, as a valve does that opens more one way."""


@dataclass(frozen=True, kw_only=True)
class Decision(FitResult):
    """What the fit records decide; hold-out records have not been read.

    Parameters
    ----------
    model : Model
        The base with the effects that were added.
    left : Left
    content : mapping
        What gap.json holds, but for what the hold-out records show.
    curves : mapping
        What the pictures of where the gap is are drawn from.
    experiment : Experiment, optional
        What would tell likely effects apart best.
    """

    model: Model
    left: Left
    content: Mapping[str, Any]
    curves: Mapping[str, Any]
    experiment: Experiment | None


def search(
    dataset: str,
    records: tuple[Record, ...],
    base: Model,
    hold: Hold = "band-limited",
    declared: float | None = None,
    asked: Mapping[str, float] | None = None,
    say: Say = silent,
    unnamed_share: float = UNNAMED_SHARE,
    offered: tuple[str, ...] | None = None,
    quantities: Quantities | None = None,
) -> Decision:
    """Locate the gap, name what is missing and add it.

    Parameters
    ----------
    dataset : str
        Its name.
    records : tuple of Record
        The fit records; no other are read.
    base : Model
    hold : {"zero-order", "linear", "band-limited"}
        How the input moves between samples.
    declared : float, optional
        RMS noise, where it is known.
    asked : mapping of str to float, optional
        Limits of the next experiment; the others are those of the records.
    say : callable
        Told a line of progress at a time.
    unnamed_share : float
        Share of the power of the gap that may stay unnamed beside a name.
    offered : tuple of str, optional
        Effects that may be named; all by default.
    quantities : Quantities, optional
        What the device takes and gives, where forces are to be tried inside the
        dynamics too.

    Raises
    ------
    InputError
        If the base does not run on the records, or no excitation fits the limits.
    """
    limits = Limits.of(records, asked) if asked else None
    if any(record.decay_s is not None for record in records):
        closed = (*NOT_IN_WINDOWS, *(() if quantities else (OF_THE_PLACE,)))
        offered = tuple(name for name in among(offered) if name not in closed)
    start, floor = start_state(records, base, hold, declared, offered)
    inside, own = None, NONE
    if quantities is not None:
        identified = is_identified(base)

        def look(start: ModelState) -> Inside | None:
            return named_inside(base, start, floor.rms, quantities, identified, say)

        inside = look(start)
        shorter = _without_leads(inside, base, records, hold, quantities, say)
        if shorter is not records:
            start, floor = start_state(shorter, base, hold, declared, offered)
            inside = look(start)
        if not _leaves_little(inside, floor) and own_offsets(records, quantities):
            start, inside, own = apart_inside(start, inside, floor.rms, look, say)
    enough = inside is not None and _why_enough(inside, floor, unnamed_share)
    if enough:
        say(f"inside: {enough}, so no chain of effects is tried")
    else:
        named, theirs = add_effects(start, floor.rms, say, unnamed_share), own
        if inside is not None and not beats(inside, named, floor.rms, say):
            inside = None
        if not (own.records or _leaves_little(inside, floor)):
            start, named, theirs = named_apart(
                start, floor.rms, named, say, unnamed_share
            )
            if inside is not None and theirs.records:
                inside = inside if beats(inside, named, floor.rms, say) else None
        own = theirs if inside is None else own
    if inside is not None:
        base, start, named = inside.base, inside.start, inside.named
    found = judge_and_tell(
        dataset, base, start, floor, named, say, limits, own, unnamed_share
    )
    if inside is None:
        return found
    reason = f"{found.content['reason']}; {inside.sentence}"
    return replace(found, content={**found.content, "reason": reason})


def _without_leads(
    inside: Inside | None,
    base: Model,
    records: tuple[Record, ...],
    hold: Hold,
    quantities: Quantities,
    say: Say,
) -> tuple[Record, ...]:
    """Leave out the leads of records of which forces show that they begin in motion.

    A base without the forces is too far off to show it.
    """
    if inside is None or quantities.causality == "storage":
        return records
    found = augmented(inside.base, inside.named.state)
    return leads_left_out(records, base, hold, "fit", say, found)


def _leaves_little(inside: Inside | None, floor: Floor) -> bool:
    """Tell whether forces leave so little that no record needs numbers of its own."""
    if inside is None:
        return False
    before, after = _powers(inside, floor)
    return after <= LOOSE * before


def _why_enough(inside: Inside, floor: Floor, unnamed_share: float) -> str:
    """Say why no effect in a chain could gain what matters beside forces; or nothing.

    It is what ends a search in a chain as well: an effect has to take more than may
    stay unnamed, and more than noise.
    """
    before, after = _powers(inside, floor)
    if after < floor.rms**2:
        return "less than the noise's own power is left above it"
    if after <= unnamed_share * before:
        return "no more is left than may stay unnamed"
    return ""


def _powers(inside: Inside, floor: Floor) -> tuple[float, float]:
    """Give the power of the gap above the floor, without forces inside and with."""
    square = floor.rms**2
    return inside.start.power(square), inside.named.state.power(square)


def judge_and_tell(
    dataset: str,
    base: Model,
    start: ModelState,
    floor: Floor,
    named: Named,
    say: Say = silent,
    limits: Limits | None = None,
    own: OwnValues = NONE,
    unnamed_share: float = UNNAMED_SHARE,
) -> Decision:
    """Locate the gap, and give the verdict on what was named.

    Parameters
    ----------
    dataset : str
        Its name.
    base : Model
    start : ModelState
        The base on the fit records.
    floor : Floor
    named : Named
    say : callable
        Told a line of progress at a time.
    limits : Limits, optional
        Of the next experiment; those of the records where none are given.
    own : OwnValues
        What was taken off the records of ``start``, as it is their own.
    unnamed_share : float
        Share of the power of the gap that may stay unnamed beside a name.
    """
    left = what_is_left(start, named.state, floor.rms)
    if named.state.added and left.little_named:
        say(f"{LITTLE}: none named")
        named = named.taken_back()
        left = what_is_left(start, named.state, floor.rms)
    records, state = start.records, named.state
    compared = compare(start)
    box = black_box(compared, floor.rms)
    after = compared if state is start else compare(state)
    lone = lone_share([item.residual for item in after])
    differs = unrepeated(after, floor.rms)
    unnamed = what_is_unnamed(start, state, floor.rms, unnamed_share)
    verdict, reason = judge(
        left,
        bool(state.added),
        box.explained_on_folds,
        bool(start.free),
        floor.method == "upper-bound",
        lone,
        differs,
        unnamed,
        unnamed_share,
        what_mends(start.records),
    )
    trust = unnamed.trust(unnamed_share, may_be_of_base(left, lone, differs))
    untried = not_tried(named)
    reason += _untried(untried) if state.added else ""
    ends = at_ends(state)
    reason += f"; {ends}" if ends else ""
    used_up = _used_up(current())
    reason += f"; beside {own.words} of some records' own" if own.records else ""
    reason += _predicts_nothing(state)
    reason += f"; {used_up}" if used_up else ""
    ladder = rungs(start, named)
    simulated = {start: compared, state: after}
    contributed = contributions(ladder, simulated) if verdict == "named" else ()
    where = locate(compared, floor, contributed)
    say(where[0].sentence)
    say(f"{verdict}: {reason}")
    finer = on_more_samples(state)
    score = make_score(finer, floor.rms, forms=False)
    errors = standard_errors(finer, score)
    of_beside = beside_errors(finer, score)
    by_effect = named.reasons
    model = augmented(base, state)
    experiment, why_none = tell_apart(base, named, records, floor.rms, limits)
    content: dict[str, Any] = {
        "dataset": dataset,
        "model": base.name,
        "unit": records[0].output.unit,
        "verdict": verdict,
        "reason": reason,
        "effects": [
            effect_mapping(
                item,
                state,
                errors,
                of_beside,
                by_effect.get(item.effect, ()),
                left,
                size_error(finer, floor.rms, number),
                trust,
            )
            | {"blocks": blocks_of(item, state, model)}
            for number, item in enumerate(state.added)
        ],
        "fit": _fit(start, state, floor)
        | {"left": left.loose, "lone_share": lone, "unrepeated": differs},
        "unnamed": unnamed.mapping(unnamed_share),
        "where": [view.to_mapping() for view in where],
        "ranking": ranking_rows(named),
        "record_values": own.mapping(records[0].output.unit),
        "not_tried": untried,
        "taken_out": [item._asdict() for item in named.gone],
        "next_experiment": None if experiment is None else experiment.mapping(),
        "base_parameters": base_parameters(base, state),
        "simulator": simulator_mapping(model, records),
        "black_box": {"explained_on_folds": box.explained_on_folds},
    }
    if why_none:
        content["no_experiment"] = why_none
    if used_up:
        content["calls_used_up"] = {"bound": current().bound, "sentence": used_up}
    return Decision(
        base,
        state,
        floor,
        box,
        ladder,
        own,
        model=model,
        left=left,
        content=content,
        curves=curves(where),
        experiment=experiment,
    )


def _predicts_nothing(state: ModelState) -> str:
    """Say which effects have no number in common to the records: a path of drift.

    A tone has one, its frequency.
    """
    names = sorted({beside.effect for beside, values in state.beside if not values})
    if not names:
        return ""
    return f"; {' and '.join(names)} of each record's own predicts no other record"


def _untried(names: Sequence[str]) -> str:
    """Tell which effects a name was not held against."""
    if not names:
        return ""
    why = USED_UP if current().refused() else "the simulator cannot be run again"
    return f"; not tried, as {why}: {', '.join(names)}"


def _used_up(calls: Calls) -> str:
    """Tell that a bound on calls has ended the search, if so."""
    if not calls.refused():
        return ""
    return (
        f"the search ended early, as the {calls.bound} calls of the simulator that "
        "--calls allows were used up"
    )


def _fit(start: ModelState, state: ModelState, floor: Floor) -> dict[str, Any]:
    """Tell what is gone on the fit records, and how much no other record knows."""
    square = floor.rms**2
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
    }

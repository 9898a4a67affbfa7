"""Naming beside what records have of their own: a late trigger, another range."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace

import numpy as np

from hystbench.gap.asked import Asked
from hystbench.gap.cache import records_digest
from hystbench.gap.effects.sensor import Drift
from hystbench.gap.effects.variant import Beside, Values
from hystbench.gap.fitting.edit_chain import without
from hystbench.gap.fitting.model_score import make_score, score_of
from hystbench.gap.fitting.on_records import on_records
from hystbench.gap.fitting.own_values import KINDS, NONE, OwnValues, own_values
from hystbench.gap.fitting.refit import ENOUGH, finished
from hystbench.gap.fitting.score import Score
from hystbench.gap.fitting.serialize import remembered_of
from hystbench.gap.fitting.state import ModelState
from hystbench.gap.naming.add_effects import Named, add_effects
from hystbench.gap.progress import Say
from hystbench.gap.records.floor import Floor
from hystbench.gap.thresholds import ABOVE_NOISE, PARAMETER, PAYS


def named_apart(
    start: ModelState,
    floor: Floor,
    named: Named,
    asked: Asked,
) -> tuple[ModelState, Named, OwnValues]:
    """Name anew beside what records have of their own, where that explains them better.

    Effects go first: they are laws of few numbers that hold for every record. What
    records have of their own is looked for beside three models: the effects that were
    named, those of them that do not act alike on all records, and the base alone. It is
    taken off the records, and naming begins again. This is repeated while the score
    falls and the names change.

    An answer is accepted if

    1. its score, with all numbers charged, is lower than that of the first names by
       `PAYS`. If these hold a path of each record's own, any lower score is enough.
       Offsets alone are then charged half a number less for each record, as a path is;
    2. no more is left than noise, or than may stay unnamed. Numbers of single records
       can imitate any law that depends on the rate or the amplitude of a record.

    Parameters
    ----------
    start : ModelState
        The base on the fit records.
    floor : Floor
    named : Named
        What was named on the records as they are.
    asked : Asked
        Where laws leave no more than may stay unnamed, records have nothing of their
        own that matters.

    Returns
    -------
    start : ModelState
        The base, on records without what is their own.
    named : Named
    own : OwnValues
    """
    found = (start, named, NONE)
    square, share, say = floor.square, asked.unnamed_share, asked.say
    paths = bool(named.state.paths)
    if not paths and named.state.power(square) <= share * start.power(square):
        return found
    score = make_score(start, floor, forms=False)
    least = score_of(named.state, score) - (0.0 if paths else PAYS)
    if least <= score.least(start.freedom + 1):
        return found  # noise alone, and what is their own charged, scores no less
    # A path is charged half a number in each record or more, an offset a whole one.
    half = PARAMETER * len(start.records) / 2 if paths else 0.0

    def charge(own: OwnValues) -> float:
        return own.charge - (half if own.kinds == ("offset",) else 0.0)

    models = _models_beside_which(named.state, start, score)
    likely = _likely(start, models, score, least, charge)
    # Beside more than that they cannot be told from what the simulator does wrong.
    most = max(ABOVE_NOISE * square, share * start.power(square))
    for _ in range(ROUNDS):
        value, own = next((item for item in likely if item[0] < least), (least, NONE))
        if not own.records:
            break
        say(f"records have {own.words} of their own: naming beside that")
        apart = on_records(start, own.taken_off(start.records, start.hold))
        again = add_effects(apart, floor, asked)
        value = score_of(again.state, score) + charge(own)
        if value >= least:
            likely = []
            if own.kinds == ("offset",):
                told = beside_offsets(again.state, start, score)
                likely = _likely(start, [(told, own.kinds)], score, least, charge)
            if any(item[0] < least for item in likely):
                continue
            say("that scores no better: they have none of their own")
            break
        if again.state.power(square) > most:
            say("too much is left beside that, so that is not shown")
            break
        taken = apart.share(start, square, start.power(square))
        same = _names(again) == _names(found[1])
        found, least = (apart, again, replace(own, share=taken)), value
        if same:
            break  # naming has told all that it can
        told = on_records(again.state, start.records)
        likely = _likely(start, [(told, kinds_of(start))], score, least, charge)
    return found


def _models_beside_which(
    state: ModelState, start: ModelState, score: Score
) -> list[tuple[ModelState, tuple[str, ...]]]:
    """Give models beside which a record's own may show, with the kinds looked for.

    Beside a delay, a gain or an offset that all records share it would not be seen that
    each has its own. A path follows an offset, so that it may stand for each one's.
    """
    models = dict.fromkeys((state, without(state, SHARED), start), kinds_of(start))
    if state.paths:
        models[beside_offsets(state, start, score)] = ("offset",)
    return list(models.items())


def _names(named: Named) -> set[tuple[str, str]]:
    return {(item.effect, item.form) for item in named.state.added}


SHARED = frozenset({"input-delay", "calibration-error"})
"""Effects that do to all records what each may have of its own."""


def beside_offsets(state: ModelState, start: ModelState, score: Score) -> ModelState:
    """Fit a model's laws together with a constant in each record; leave that out again.

    A slow law and an offset look alike: one after the other, each takes what is the
    other's. Paths stand for the offsets, so they go.
    """
    laws = on_records(without(state, state.paths), start.records)
    level: tuple[Beside, Values] = Drift.levels(), {}
    fitted, _ = finished(replace(laws, beside=(*laws.beside, level)).settled(), score)
    return replace(fitted, beside=fitted.beside[:-1])


def offsets_for_paths(
    start: ModelState, named: Named, floor: Floor, say: Say
) -> tuple[ModelState, Named, OwnValues]:
    """Give records offsets of their own in place of a path named beside forces.

    A path follows an offset too. Offsets stand where they score no worse, each charged
    as a number of a path is: they say less of the device.

    Parameters
    ----------
    start : ModelState
        The base on the fit records.
    named : Named
        Forces, and what the input does not explain.
    floor : Floor
    say : callable

    Returns
    -------
    start : ModelState
        The base on records without their offsets.
    named : Named
        Without the path.
    own : OwnValues
    """
    state, square = named.state, floor.square
    score = make_score(state, floor, forms=False)
    laws = beside_offsets(state, start, score)
    own = own_values(start.records, laws.exact, square, ("offset",))
    if not own.records:
        return start, named, NONE
    bare = own.taken_off(start.records, start.hold)
    found, value = finished(on_records(laws, bare), score)
    if value + own.charge / 2 > score_of(state, score):
        return start, named, NONE
    say("inside: offsets of the records explain as much: no path is named")
    apart = on_records(start, bare)
    share = apart.share(start, square, start.power(square))
    rounds = tuple(
        replace(one, before=on_records(one.before, bare))
        for one in named.rounds
        if one.ranking[0].effect not in state.paths
    )
    own = replace(own, share=share)
    return apart, replace(named, state=found, rounds=rounds), own


ROUNDS = 3
"""Rounds of naming; after each of them what records have of their own is known
better."""


def _likely(
    start: ModelState,
    models: Sequence[tuple[ModelState, Sequence[str]]],
    score: Score,
    least: float,
    charge: Callable[[OwnValues], float],
) -> list[tuple[float, OwnValues]]:
    """Find what records have of their own beside models, and the scores with it.

    Only the kinds that are listed with each model are looked for. The model is refitted
    without what was found, and the search is repeated while that helps.
    """
    found = []
    for state, kinds in models:
        best: tuple[float, OwnValues] = (np.inf, NONE)
        for _ in range(ROUNDS):
            own = _own_values(state, start, score.floor, kinds)
            if not own.records:
                break
            bare = own.taken_off(start.records, start.hold)
            apart, value = finished(on_records(state, bare), score)
            if value + charge(own) >= best[0] - ENOUGH:
                break
            best = value + charge(own), own
            if best[0] > least + PAYS:
                break  # found again beside it they gain less than that
            state = on_records(apart, start.records)
        if best[1].records:
            found.append(best)
    return sorted(found, key=lambda item: item[0])


def _own_values(
    state: ModelState, start: ModelState, square: float, kinds: Sequence[str]
) -> OwnValues:
    """Find what records have of their own beside a model, or look it up."""
    unit = start.records[0].output.unit
    found = remembered_of(
        state,
        lambda: ["own values", records_digest(start.records), square, kinds],
        lambda: own_values(start.records, state.exact, square, kinds).mapping(unit),
    )
    return OwnValues.of_mapping(found)


def kinds_of(state: ModelState) -> tuple[str, ...]:
    """Give what may be a record's own: no delay where the base cannot be run again."""
    reruns = all(block.reruns for block in state.chain)
    return KINDS if reruns else tuple(kind for kind in KINDS if kind != "delay")

"""Naming effects inside the dynamics, also of records with a zero of their own.

Whether they do better than those in the chain is asked afterwards
(:func:`beats_chain`).
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable
from dataclasses import dataclass, replace
from functools import partial

import numpy as np

from hystbench.blocks.attached import AttachedBlock
from hystbench.gap.asked import USUAL, Asked
from hystbench.gap.bases.linear import is_identified_linear
from hystbench.gap.fitting.augmented_model import augmented
from hystbench.gap.fitting.cross_validation import (
    gain_on_folds,
    shows_in_one_record,
)
from hystbench.gap.fitting.model_score import leaves_more, score_of
from hystbench.gap.fitting.on_records import on_records
from hystbench.gap.fitting.own_values import NONE, OwnValues, own_values
from hystbench.gap.fitting.score import Score
from hystbench.gap.fitting.state import ModelState
from hystbench.gap.inside.as_late import with_others_as_late
from hystbench.gap.inside.choose import (
    as_rounds,
    bends,
    may_gain,
    not_taken,
)
from hystbench.gap.inside.combine_forces import ForceSearch
from hystbench.gap.inside.fewer import on_all_samples, on_fewer
from hystbench.gap.inside.fitted_numbers import re_tuning
from hystbench.gap.inside.host import Kind
from hystbench.gap.inside.host_places import host_places
from hystbench.gap.inside.insert_law import Times, laws_for
from hystbench.gap.inside.lags_of_base import LAGS, with_lags_of_base
from hystbench.gap.inside.other_names import with_other_names
from hystbench.gap.inside.possible_hosts import hosts
from hystbench.gap.inside.short_steps import in_short_steps
from hystbench.gap.inside.try_hosts import (
    HostTrial,
    Tried,
    best_with_several,
    in_each_host,
)
from hystbench.gap.naming.add_effects import Named
from hystbench.gap.naming.with_own_values import ROUNDS
from hystbench.gap.progress import Say, silent
from hystbench.gap.records.evidence import Evidence
from hystbench.gap.records.floor import Floor
from hystbench.gap.simulation.memory import may_have_hysteresis
from hystbench.gap.thresholds import AS_GOOD, FURTHER, PAYS, pay_of_further
from hystbench.model import Model
from hystbench.quantities import Quantities, angle_in
from hystbench.sentences import finely
from hystbench.units import sized


@dataclass(frozen=True)
class Inside:
    """Effects inside the dynamics, and the linear base that they were found beside."""

    base: Model
    start: ModelState
    """The base on the fit records, before anything is named."""
    named: Named
    sentence: str
    """What it stands in place of."""
    counts: int = 0
    """How many effects more it counts as: one if known numbers were fitted."""
    host: Kind = "coordinate"
    """What the effects act in."""


def named_inside(
    base: Model,
    start: ModelState,
    floor: Floor,
    quantities: Quantities,
    asked: Asked = USUAL,
    most: Callable[[], float] = lambda: np.inf,
    again: Callable[[Model], bool] = lambda found: False,
    *,
    kinds: Collection[Kind] = (),
) -> Inside | None:
    """Find effects inside the dynamics; None where no force pays.

    In place of the base stands a linear model of one coordinate, or the base itself
    as a structure of its modes (:func:`hosts`), and forces are put inside.

    Parameters
    ----------
    base : Model
    start : ModelState
        The base on the fit records, before anything is named.
    floor : Floor
    quantities : Quantities
        What the device takes and gives: they tell which hosts there are.
    asked : Asked
        A further effect that takes less than may stay unnamed does not matter.
    most : callable
        Computes the chain once, which is slow, and gives how many effects inside could
        still pay against it. Re-tuning known numbers counts as one effect. The first
        host of an identified base is tried without asking: it takes less time than a
        chain, and is often enough.
    again : callable
        Told of a host with its best force, where that takes most of the gap. If it says
        that the search is to begin again, on other records, this one ends: None.
    kinds : collection of str
        Hosts that are tried; all by default.
    """
    say, identified = asked.say, is_identified_linear(base)
    fewer = on_fewer(start, quantities)
    score, score_of_all = (Score.plain(x.sample, floor.square) for x in (fewer, start))
    turns = angle_in(start.records[0].output.unit)
    times = Times.of(start.records, identified)
    offer = partial(laws_for, turns=turns, offered=start.offered, times=times)
    forces = ForceSearch(offer, score, say)
    trial = HostTrial(fewer, forces, asked.unnamed_share, identified)

    def begins_again(tried: Tried) -> bool:
        in_place = of_free_numbers(base, tried.found[0].state)
        return again(augmented(in_place, tried.best.state))

    wanted = hosts(fewer, quantities, identified, score, base.exact, kinds=kinds)
    ones = in_each_host(trial, wanted, most, begins_again)
    if ones is None:
        return None
    tried = with_likenesses(trial, best_with_several(trial, *ones))
    tried = trial.of_better(tried)
    if not tried.best.effects:
        say("inside: no force pays")
        if identified and fewer is start and not may_gain(tried.best, score):
            return without_forces(base, start, tried, score.floor)
        return None
    if fewer is not start:
        tried = on_all_samples(tried, start, score_of_all, identified)
    return with_effects_inside(base, start, tried, score_of_all)


def with_likenesses(trial: HostTrial, tried: Tried) -> Tried:
    """Add what may stand in the place of the effects that do best in a host.

    That is what is as late, the same curve by another name, and the host with a lag.
    """
    host, offer, score = tried.host, trial.forces.offer, trial.score
    tried = trial.of(host, with_others_as_late(tried.best, tried.found, offer, score))
    tried = replace(tried, found=with_other_names(tried.best, tried.found, offer))
    if trial.identified and not LAGS.isdisjoint(tried.best.effects):
        found = with_lags_of_base(tried.best, tried.found, score)
        host = replace(host, alone=found[0].state, words=f"{host.words}, with a lag")
        tried = trial.of(host, found)
    return tried


def with_effects_inside(
    base: Model, start: ModelState, tried: Tried, score: Score
) -> Inside:
    """Give a host with effects inside in place of a base, and tell what it does."""
    host, found, floor = tried.host, tried.found, score.floor
    state, alone, re_tuned = (
        replace(x, offered=start.offered)
        for x in (tried.best.state, host.alone, found[0].state)
    )
    state, alone = in_short_steps(state, score), alone.settled()
    before, after = lefts((start, alone), floor, base.output.unit)
    sentence = (
        f"{host.words}, and effects act inside it (without them it leaves {after} rms "
        f"of the fit records above the noise floor, the base {before})"
    )
    if host.counts:
        taken = re_tuned.share(start, floor, start.gap(floor))
        sentence += f"; its numbers fitted without them take {finely(taken)} of the gap"
    if not is_identified_linear(base):
        sentence += re_tuning(alone, state)
    # The first rung is the host re-tuned, so that no effect has the credit of that.
    rounds = as_rounds(re_tuned.settled(), tried.best, found)
    model = of_free_numbers(base, alone)
    named = Named(state, tuple(rounds))
    return Inside(model, alone, named, sentence, host.counts, host.kind)


def without_forces(
    base: Model, start: ModelState, tried: Tried, square: float
) -> Inside:
    """Give a host that leaves nothing but noise in place of an identified base.

    It may begin as the base cannot: a store has a level of its own at the first sample,
    where a transfer function is at rest or settled.
    """
    host, found = tried.host, tried.found
    alone = found[0].state.settled()
    before, after = lefts((start, alone), square, base.output.unit)
    sentence = (
        f"{host.words}; then {after} rms of the fit records is left above the noise "
        f"floor, with the base {before}"
    )
    rounds = (not_taken(alone, found),) if len(found) > 1 else ()
    model = of_free_numbers(base, alone)
    return Inside(model, alone, Named(alone, rounds), sentence, host.counts, host.kind)


def lefts(states: Iterable[ModelState], square: float, unit: str) -> list[str]:
    """Give in words what models leave above the noise floor."""
    powers = (state.power(square) for state in states)
    return [sized(float(np.sqrt(max(power, 0.0))), unit) for power in powers]


def of_free_numbers(base: Model, alone: ModelState) -> Model:
    """Write what stands for a base as a model, its fitted numbers free."""
    model = Model(base.name, base.input, base.output, alone.chain)
    labels = [label for label, _ in model.labelled()]
    free = [f"{labels[item.block]}.{item.parameter}" for item in alone.free]
    return replace(model, free=tuple(dict.fromkeys(free)))


def apart_inside(
    start: ModelState,
    inside: Inside | None,
    floor: Floor,
    look: Callable[..., Inside | None],
    kinds: Collection[Kind],
    say: Say,
) -> tuple[ModelState, Inside | None, OwnValues]:
    """Look for forces again without the offsets that records have of their own.

    Offsets are found beside what was named, then beside what is named without them, and
    so on while the score falls. The first time it has to fall by what an effect has to
    gain, all offsets charged.

    Parameters
    ----------
    start : ModelState
        The base on the fit records.
    inside : Inside or None
        What was found on them as they are.
    floor : Floor
    look : callable
        Finds forces beside a base, as :func:`named_inside` of start, floor and kinds.
    kinds : collection of str
        Hosts that are tried, till forces are found in one; all if it is empty.
    say : callable

    Returns
    -------
    start : ModelState
        The base on records without their offsets, or as it was.
    inside : Inside or None
    own : OwnValues
    """
    square = floor.square
    score = Score.plain(start.sample, square)
    state = start if inside is None else inside.named.state
    found, least = (start, inside, NONE), score_of(state, score) - PAYS
    for _ in range(ROUNDS):
        own = own_values(start.records, state.exact, square, ("offset",))
        if not own.records:
            break
        say("inside: records have an offset of their own: looking beside that")
        apart = on_records(start, own.taken_off(start.records, start.hold))
        again = look(apart, floor, kinds=kinds)
        before = [item.effect for item in state.added]
        state = apart if again is None else again.named.state
        value = score_of(state, score) + own.charge
        if again is None or value >= least:
            break
        share = apart.share(start, square, start.power(square))
        found, least = (apart, again, replace(own, share=share)), value
        if [item.effect for item in state.added] == before:
            break  # looking has told all that it can
        kinds = (again.host,)
    return found


def beats_base(inside: Inside, start: ModelState, floor: Floor) -> bool:
    """Tell whether effects inside lower the base's score by what one has to gain.

    A model of one coordinate may lack what a base of higher order has: an effect that
    makes up for that is not missing in the base. Nor may they leave more than the base.
    """
    score, state = Score.plain(start.sample, floor.square), inside.named.state
    gain = score_of(start, score) - score_of(state, score)
    return gain >= PAYS and not leaves_more(state, start, floor.square)


def beats_chain(inside: Inside, named: Named, floor: Floor, say: Say = silent) -> bool:
    """Tell whether effects inside do better than those in a chain.

    They must beat the chain on folds by `PAYS`, and by `FURTHER` more for each effect
    that they have beyond the chain's; for each that they have fewer, by `FURTHER` less.
    Beside a chain of no effects the first is not counted. For a fold both models are
    refitted without it. Of two that leave as little no folds are asked: fewer effects
    of few numbers stand, and beside a law of many numbers as many.
    """
    state, chain = inside.named.state, named.state
    if _inside_is_simpler(inside, named, floor.square):
        say("inside: laws of few numbers leave as little as a chain of many")
        return True
    if _chain_is_simpler(inside, named, floor.square):
        say("inside: a chain of fewer effects leaves as little")
        return False
    score = Score.plain(state.sample, floor.square)
    # What the chain changes elsewhere says nothing of where forces show.
    in_blocks = shows_in_one_record(inside.start, state, score)
    gain = gain_on_folds(chain, state, score, in_blocks)
    gain -= gain_on_folds(chain, chain, score, in_blocks)
    better = "better" if gain > 0 else "worse"
    say(f"inside: on folds {abs(gain):.1f} {better} than what a chain has found")
    gain -= state.moved_charge - chain.moved_charge
    ours, theirs = len(state.added) + inside.counts, len(chain.added)
    # Beside no chain the first effect pays by the gain itself, as it does in a chain.
    more = FURTHER * (ours - theirs) if theirs else pay_of_further(ours)
    return gain - more >= PAYS


def _inside_is_simpler(inside: Inside, named: Named, square: float) -> bool:
    """Tell whether as few effects, none of many numbers, leave as little of the gap.

    One of many numbers counts as two: it has the numbers of several.
    """
    state, chain = inside.named.state, named.state
    many = sum(x.is_of_many_numbers for x in chain.added)
    few = len(state.added) + inside.counts <= len(chain.added) + many
    return (
        bool(many)
        and few
        and not bends(state)
        and _no_better(chain, state, named, square)
    )


def _chain_is_simpler(inside: Inside, named: Named, square: float) -> bool:
    """Tell whether a chain of fewer effects of few numbers leaves as little."""
    state, chain = inside.named.state, named.state
    fewer = 0 < len(chain.added) < len(state.added) + inside.counts
    return fewer and not bends(chain) and _no_better(state, chain, named, square)


def _no_better(
    state: ModelState, other: ModelState, named: Named, square: float
) -> bool:
    """Tell whether a model takes no more of the gap than another one does as well."""
    return state.share(other, square, named.rounds[0].before.gap(square)) < AS_GOOD


def quantities_if_linear(base: Model, evidence: Evidence) -> Quantities | None:
    """Give what the device takes and gives, where forces may be tried inside the base.

    That is where the base may be linear, as nothing in it remembers a way, and where it
    holds one mechanism, with its own forces or without. None elsewhere.
    """
    holds = len(host_places(base.chain)) == 1
    for block in base.chain:
        if holds and isinstance(block, AttachedBlock):
            continue
        if isinstance(block, AttachedBlock) or block.hysteretic:
            return None
        if may_have_hysteresis(block, evidence.fit):
            return None
    return evidence.quantities

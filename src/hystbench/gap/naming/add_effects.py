"""Naming: the base alone, then every effect, added while something pays."""

from __future__ import annotations

from collections.abc import Collection, Sequence
from dataclasses import dataclass, replace
from operator import itemgetter

from hystbench.blocks.calls import USED_UP, CallsUsedUp, current
from hystbench.blocks.forced import ForcedDynamics
from hystbench.gap.asked import Asked
from hystbench.gap.effects import among
from hystbench.gap.fitting.edit_chain import at_end
from hystbench.gap.fitting.in_stages import fitted_far
from hystbench.gap.fitting.least_squares import fitted_to_the_end
from hystbench.gap.fitting.model_score import (
    above_floor,
    make_score,
    score_of,
    score_of_numbers,
)
from hystbench.gap.fitting.refit import finished, finished_to_the_end, scanned
from hystbench.gap.fitting.score import Score
from hystbench.gap.fitting.state import ModelState
from hystbench.gap.naming.forecast_calls import foretell, foretell_rest
from hystbench.gap.naming.rank import rank
from hystbench.gap.naming.removal import (
    TakenOut,
    is_shape_that_matters,
    without_what_goes,
)
from hystbench.gap.naming.rounds import MOST_EFFECTS, Candidate, Round
from hystbench.gap.naming.second_looks import reconsidered
from hystbench.gap.progress import Say
from hystbench.gap.records.floor import Floor
from hystbench.gap.thresholds import (
    FURTHER,
    MOST,
    PAYS,
    SCALE,
    SHAPE,
    UNNAMED_SHARE,
    pay_of_further,
)

LITTLE = "what the effects leave of a slightly wrong shape is most of it"
NO_MORE_LEFT = "no more is left than may stay unnamed"
SAID = 4
"""Lines of a ranking that are said: the page has all of it."""


@dataclass(frozen=True)
class Named:
    """What naming found."""

    state: ModelState
    """The model with all effects that were added."""
    rounds: tuple[Round, ...] = ()
    taken_out: tuple[TakenOut, ...] = ()
    """Effects that were added and went out again."""

    @property
    def reasons(self) -> dict[str, tuple[Candidate, ...]]:
        """The last ranking by which each effect was taken, or kept.

        A wrong shape may be taken first though effects score better. They are left out
        of its ranking: they are no rivals, as they need the shape beside them.
        """
        found: dict[str, tuple[Candidate, ...]] = {}
        for one in self.rounds:
            first = one.ranking[0]
            if one.taken and first.effect == SHAPE:
                found[SHAPE] = tuple(x for x in one.ranking if x.score >= first.score)
            elif one.taken:
                found[first.effect] = one.ranking
            found |= {x.taken: x.ranking for x in one.looks if x.taken is not None}
        return found

    def with_none_named(self) -> Named:
        """Give the same with no effect named: the base as it was before the first."""
        out = [TakenOut(item.effect, LITTLE) for item in self.state.added]
        return replace(
            self, state=self.rounds[0].before, taken_out=(*self.taken_out, *out)
        )


def add_effects(state: ModelState, floor: Floor, asked: Asked) -> Named:
    """Add effects to a model for as long as one pays, or until little is left."""
    say = asked.say
    foretell(state, say)
    found = _one_by_one(state, floor, say, asked.unnamed_share)
    try:
        return looked_over(found, state, floor, say)
    except CallsUsedUp:
        return Named(found.state, found.rounds)
    finally:
        current().reserve = 0


def looked_over(found: SoFar, start: ModelState, floor: Floor, say: Say) -> Named:
    """Look over what was added one by one; where a wrong shape is to go first, anew.

    Where a wrong shape of the hysteresis takes more of the gap away than the effect
    that scores best, that effect may still be one of several that do without it. So
    they are tried first; if the shape is needed after all, it goes first.
    """
    cut_short = current().refused()
    if not cut_short and found.deferred and found.state.has_shape:
        say(f"{SHAPE} is needed and takes most of the gap away: it goes first")
        found = _one_by_one(start, floor, say, found.share, shape_first=True)
    if not cut_short:
        found = _instead_of_many_numbers(found, start, floor, say)
    state, gone = without_what_goes(found.state, floor, found.gap, say)
    rounds = found.rounds
    while not cut_short and len(state.added) > 1:
        rivals = _rivals_of_all(state, rounds) | set(found.in_place_of)
        if not rivals:
            break
        before = names(state)
        state, again = reconsidered(state, rounds, floor, say, rivals)
        last = replace(rounds[-1], looks=(*rounds[-1].looks, *again))
        rounds = (*rounds[:-1], last)
        if names(state) == before:
            break
    if state.added:
        # Its own numbers are found without what other forms of it could do.
        state = finished_to_the_end(state, score_of_numbers(state, floor))
    return Named(state, rounds, gone)


def _instead_of_many_numbers(
    found: SoFar, start: ModelState, floor: Floor, say: Say
) -> SoFar:
    """Add others one by one where one effect of many numbers leaves more than noise.

    So many numbers do much of what several laws of few do together. These are named if
    they score better, each charged as a further effect is.
    """
    if len(found.state.added) != 1 or found.state.has_shape:
        return found
    (effect,) = found.state.added
    name, score = effect.effect, make_score(start, floor, forms=False)
    if not effect.is_of_many_numbers or above_floor(found.state, score) < FURTHER:
        return found
    say(f"{name} has many numbers and leaves more than noise: naming without it")
    others = tuple(x for x in among(start.offered) if x != name)
    other = _one_by_one(replace(start, offered=others), floor, say, found.share)
    other = replace(other, state=replace(other.state, offered=start.offered))
    # They end with numbers that were fitted while other forms were allowed.
    state, value = finished(other.state, score)
    value += pay_of_further(len(state.added))
    if value < finished(found.state, score)[1] - SCALE:
        say(f"they score better: {name} goes")
        rounds = tuple(
            replace(one, before=replace(one.before, offered=start.offered))
            for one in other.rounds
        )
        return replace(other, state=state, rounds=rounds, in_place_of={name})
    say(f"that scores no better: {name} stays")
    return found


def names(state: ModelState) -> set[str]:
    """Give the names of the effects that were added."""
    return {item.effect for item in state.added}


def _rivals_of_all(state: ModelState, rounds: Sequence[Round]) -> set[str]:
    """Give effects that are to be tried in the place of each that was added.

    All offered effects, if any added effect was replaced or removed: no round has
    ranked beside exactly this set. Else those that would pay beside them, though they
    take too little to be added: an effect that has the place of another leaves what
    that one would take.
    """
    taken = {one.ranking[0].effect for one in rounds if one.taken}
    if names(state) != taken:
        return set(among(state.offered))
    last = rounds[-1]
    pay = {x.effect for x in last.ranking if x.state and x.gain > PAYS}
    return set() if last.taken else pay - taken


@dataclass(frozen=True)
class SoFar:
    """How far adding effects one by one has come."""

    state: ModelState
    gap: float
    """Mean square of the base's gap above the floor."""
    share: float = UNNAMED_SHARE
    """Share of it that may stay unnamed."""
    rounds: tuple[Round, ...] = ()
    deferred: bool = False
    """Whether a shape that takes more of the gap was put off."""
    nothing_to_gain: bool = False
    """Whether nothing is left that an effect could gain."""
    in_place_of: Collection[str] = ()
    """Effects whose place these took together; each may still do better than one."""

    @classmethod
    def begun(
        cls, state: ModelState, floor: Floor, share: float = UNNAMED_SHARE
    ) -> SoFar:
        """Start from the base, re-tuned where it has free numbers.

        Those of a base in motion that is known roughly may have far to go.
        """
        if state.free:
            score = make_score(state, floor)
            starts = [state]
            moves = any(isinstance(block, ForcedDynamics) for block in state.chain)
            if moves and any(free.tolerance is not None for free in state.free):
                plain = Score.plain(state.sample, floor.square)
                starts.append(fitted_far(state, plain).state)
            ends = (finished(each, score) for each in starts)
            state, _ = min(ends, key=itemgetter(1))
        square = floor.square
        # A gap of nothing has no shares; where there is noise a millionth is nothing.
        return cls(state, max(state.power(square), square * 1e-6), share)

    @property
    def done(self) -> bool:
        """Whether nothing more is to be added."""
        stopped = bool(self.rounds) and not self.rounds[-1].taken
        return stopped or self.nothing_to_gain or len(self.state.added) >= MOST_EFFECTS

    def little_left(self, square: float) -> bool:
        """Tell whether no more is left than may stay unnamed, of whatever sort it is.

        Then no effect could take what matters.
        """
        return bool(self.state.added) and (
            self.state.power(square) <= self.share * self.gap
        )


def _one_by_one(
    state: ModelState,
    floor: Floor,
    say: Say,
    share: float,
    shape_first: bool = False,
) -> SoFar:
    """Add effects one by one."""
    progress = SoFar.begun(state, floor, share)
    calls = current()
    while not (progress.done or calls.refused()):
        try:
            further = advance(progress, floor, say, shape_first)
        except CallsUsedUp:
            break
        # A round that was cut short counts only where nothing in it needed a call.
        if not calls.refused() or not progress.state.added:
            progress = further
        foretell_rest(progress.state, len(progress.rounds))
    if calls.refused():
        say(f"{USED_UP}: the search ends here")
    return progress


def advance(
    progress: SoFar,
    floor: Floor,
    say: Say,
    shape_first: bool = False,
) -> SoFar:
    """Try every effect beside the model and add the one that pays, if any does."""
    square = floor.square
    little = progress.little_left(square)
    found = None if little else _before_a_round(progress.state, floor)
    if found is None:
        say(NO_MORE_LEFT if little else "nothing is left that an effect could gain")
        return replace(progress, nothing_to_gain=True)
    state, score = found
    ranking = rank(state, score, needs=FURTHER if state.added else PAYS)
    deferred = progress.deferred
    if _shape_takes_more(ranking, state, square):
        deferred = True
        if shape_first:
            ranking = tuple(sorted(ranking, key=lambda x: x.effect != SHAPE))
    first = ranking[0]
    for item in ranking[:SAID]:
        say(f"{item.effect} {item.form}: gain {item.gain:.1f}")
    taken = pays(first, state, square, progress.gap, progress.share)
    one = Round(state, first.score + first.gain, ranking, taken)
    state = progress.state
    if taken:
        assert first.state is not None  # noqa: S101  (for the type checker)
        state = with_all_numbers(scanned(first.state, floor), square)
        if len(state.added) > 1:
            rounds = (*progress.rounds, one)
            state, looks = reconsidered(state, rounds, floor, say)
            one = replace(one, looks=looks)
    return replace(
        progress, state=state, rounds=(*progress.rounds, one), deferred=deferred
    )


def with_all_numbers(state: ModelState, square: float) -> ModelState:
    """Fit all numbers of a model without hysteresis together, the base's own as well.

    A linear base was fitted with the gap in it: what an effect bends much may take its
    numbers far, farther than steps from a linear fit lead.
    """
    own = state.places_added
    re_tuned = [free for free in state.free if free.block not in own]
    bound = any(free.tolerance is not None for free in re_tuned)
    if bound or not re_tuned or state.beside or state.simulation.loop is not None:
        return state
    score = Score.plain(state.sample, square)
    best = fitted_to_the_end(state, score)
    better = best.score < score_of(state, score) and not at_end(best.state)
    return best.state if better else state


def _before_a_round(state: ModelState, floor: Floor) -> tuple[ModelState, Score] | None:
    """Refit a model under the score that a further effect is to lower.

    The score allows for other forms of the effects that the model has, which it was
    fitted without: what a refit gains no further effect may count as its own. None
    where the effects leave nothing to gain.
    """
    score = make_score(state, floor)
    if not state.added:
        return state, score
    if above_floor(state, score) < FURTHER:
        return None
    state, _ = finished(state, score)
    return None if above_floor(state, score) < FURTHER else (state, score)


def _shape_takes_more(
    ranking: tuple[Candidate, ...], before: ModelState, square: float
) -> bool:
    """Tell whether a wrong shape pays and takes twice as much as the best effect."""
    shape = next((x for x in ranking if x.effect == SHAPE and x.state), None)
    first = ranking[0]
    if shape is None or shape.state is None or first.state is None:
        return False
    if shape is first or shape.gain < PAYS:
        return False
    gap = before.power(square)
    most = shape.state.share(before, square, gap)
    return first.state.share(before, square, gap) < MOST * most


def pays(
    item: Candidate, state: ModelState, square: float, gap: float, needed: float
) -> bool:
    """Tell whether an effect is to be added.

    The first has only to pay. A further one must take more than may stay unnamed as
    well: what is left after the right effect is also what its form, or the simulation,
    misses.
    """
    if item.state is None or item.gain < PAYS:
        return False
    if not state.added:
        return True
    share = item.state.share(state, square, gap)
    if is_shape_that_matters(item.effect, item.gain, share):
        return True
    return item.gain > FURTHER and share > needed

"""What was named beside a base, and what that is worth beside other answers."""

from __future__ import annotations

from dataclasses import dataclass

from hystbench.gap.fitting.edit_chain import removable, without_effect
from hystbench.gap.fitting.model_score import make_score, score_of
from hystbench.gap.fitting.own_values import NONE, OwnValues
from hystbench.gap.fitting.re_tuning_gain import (
    charge_of_base,
    re_tuned_score,
    repeats_the_base,
)
from hystbench.gap.fitting.score import Score
from hystbench.gap.fitting.state import ModelState
from hystbench.gap.inside.host import Kind
from hystbench.gap.inside.named_inside import Inside
from hystbench.gap.naming.add_effects import Named
from hystbench.gap.records.floor import Floor
from hystbench.gap.thresholds import FURTHER, LOOSE, PAYS, pay_of_further
from hystbench.model import Model


@dataclass(frozen=True)
class BesideBase:
    """What was named beside a base."""

    base: Model
    start: ModelState
    """The base on the fit records, before anything is named."""
    floor: Floor
    chain: Named | None = None
    """Effects in a chain; none where forces were enough, or before it is tried."""
    inside: Inside | None = None
    """Forces inside the dynamics, where they do better than a chain."""
    own: OwnValues = NONE
    tried: Inside | None = None
    """Forces inside that were found, whether they do better or not."""

    @property
    def named(self) -> Named:
        """The forces inside where they stand, else the chain."""
        found = self.chain if self.inside is None else self.inside.named
        assert found is not None  # noqa: S101  (one of them was looked for)
        return found

    @property
    def hosts(self) -> tuple[Kind, ...]:
        """What forces were found in: a further look is at that alone."""
        return () if self.tried is None else (self.tried.host,)

    @property
    def laws_of_many_numbers(self) -> int:
        """How many of its effects are by a law of many numbers; no force is."""
        if self.inside is not None:
            return 0
        return sum(item.is_of_many_numbers for item in self.named.state.added)

    @property
    def counts(self) -> int:
        """Effects named; numbers of a host that nobody set free count as one."""
        host = self.inside is not None and self.inside.counts > 0
        return len(self.named.state.added) + host

    def score_beside(self, other: BesideBase) -> Score:
        """Give the score that this answer and another one are compared by.

        Neither is better for what a wrong shape of the base's hysteresis leaves, unless
        one of them names it.
        """
        if self.named.state.has_shape or other.named.state.has_shape:
            return Score.plain(self.start.sample, self.floor.square)
        return make_score(self.start, self.floor, forms=False)

    @property
    def margin(self) -> float:
        """By how much a re-tuned base has to do better: the base is believed as given.

        If a named effect repeats a part of the base, the re-tuned base wins even if it
        scores worse by less than `PAYS`. The effect is then the base's own mode or
        spring with other numbers.
        """
        return -PAYS if repeats_the_base(self.named.state) else PAYS

    def value(self, score: Score, re_tuned: bool = False) -> float:
        """Score it, with what its effects and its numbers have to pay.

        A re-tuned base is to pay as an effect does.
        """
        state = self.named.state
        cost = self.own.charge + _pay(self.counts + re_tuned)
        return cost + charge_of_base(state, score) + score_of(state, score)

    def may_be_simpler(self) -> bool:
        """Tell whether there may be a better answer beside a re-tuned base.

        Re-tuning may replace an effect, or let one of few numbers stand where one of
        many does. And where it pays beside the effects, as one more, these may stand
        for a base that is off.
        """
        state, score = self.named.state, self.score_beside(self)
        now = score_of(state, score)
        if self.laws_of_many_numbers and len(self.named.rounds) == 1:
            return self._simple_law_might_suffice(score, now)
        # What is asked below is of one or two effects of few numbers.
        if self.counts > 2 or self.laws_of_many_numbers:
            return True
        count, margin = len(state.added), self.margin
        shorter = [
            (without_effect(state, number), now - margin)
            for number in range(count)
            if removable(state, number)
        ]
        if count > 1:  # it may stand for both, and pays as one effect
            alone = now + _pay(count) - _pay(1) - margin
            shorter.append((self.start, alone))
        # Beside all of them it pays as one more, as it has to where it is to stand.
        beside = now + _pay(count) - _pay(count + 1) - margin
        # What moves a mode far is told by a fit, as slopes tell little of that.
        far = repeats_the_base(state)
        return re_tuned_score(state, score, beside) < beside or any(
            re_tuned_score(short, score, most, far) < most for short, most in shorter
        )

    def _simple_law_might_suffice(self, score: Score, now: float) -> bool:
        """Tell whether a re-tuned base may do with a law of few numbers, or with none.

        The laws are those that stood beside the one that was taken; one has to come as
        near to it as a further effect, or another form, could make up for.
        """
        ranking = self.named.rounds[0].ranking
        others = [item.state for item in ranking if item.state is not None]
        few = [x for x in others if not any(y.is_of_many_numbers for y in x.added)]
        most = now + FURTHER
        return any(
            re_tuned_score(state, score, most, far=True) < most
            for state in (self.start, *few)
        )


def stays(found: BesideBase, again: BesideBase, re_tuned: bool = False) -> bool:
    """Tell whether a base stays as it was, and not with other numbers or timing.

    What was given is believed unless as much speaks against it as makes a gap
    (:attr:`BesideBase.margin`). Numbers that were re-tuned are charged as an effect;
    timing is a matter of the records. Laws of many numbers bend to what such numbers
    do, so they are no rivals of laws of few that leave as little.

    It stays too where the two were scored on more or fewer samples, as where leads were
    left out of short records beside one of them: such scores do not compare.
    """
    if len(again.start.sample) != len(found.start.sample):
        return True
    if re_tuned and _needs_fewer_laws_of_many_numbers(found, again):
        return False
    score = found.score_beside(again)
    margin = found.margin if re_tuned else PAYS
    return again.value(score, re_tuned) >= found.value(score) - margin


def leaves_much(state: ModelState, start: ModelState, floor: Floor) -> bool:
    """Tell whether effects leave more of the base's gap than a name may."""
    square = floor.square
    return state.power(square) > LOOSE * start.power(square)


def _needs_fewer_laws_of_many_numbers(found: BesideBase, again: BesideBase) -> bool:
    """Tell whether a re-tuned base needs no laws of many numbers for as little left."""
    square = found.floor.square
    return (
        again.laws_of_many_numbers < found.laws_of_many_numbers
        and again.counts <= found.counts
        and again.named.state.power(square) <= found.named.state.power(square)
    )


def _pay(effects: int) -> float:
    """Give by how much so many effects are to lower a score."""
    return PAYS + pay_of_further(effects) if effects > 0 else 0.0

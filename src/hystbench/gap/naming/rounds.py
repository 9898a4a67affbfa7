"""What a round of the search says: every effect as it did, and what was taken."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, replace
from typing import Any, NamedTuple, TypeVar

import numpy as np

from hystbench.cores import each
from hystbench.gap.fitting.serialize import read_like, written
from hystbench.gap.fitting.state import ModelState
from hystbench.gap.thresholds import SCALE

Item = TypeVar("Item")

MOST_EFFECTS = 4
"""Effects that are looked for, at most: a bound on time, as each costs a round."""

WIDER = "makes the gap wider"
"""Why a finalist was declined whose refit went to where a wrong shape hides it."""


class TriedVariant(NamedTuple):
    """A variant of an effect: where and how it was tried, and its score."""

    place: str
    form: str
    position: int | None
    """Position of its first block in the chain; None for a signal beside it."""
    score: float


@dataclass(frozen=True)
class Candidate:
    """An effect as it did in one round."""

    effect: str
    place: str
    form: str = ""
    score: float = np.inf
    """Score of the model with it; raised by what folds take off its gain."""
    gain: float = 0.0
    """How far it lowers the score. For a finalist that pays it is the less of what all
    records tell and what folds do."""
    state: ModelState | None = None
    """Model with the effect, jointly refitted; finalists have it."""
    declined: str = ""
    """Why it could not be judged, if so."""
    refused: bool = False
    """Whether that is a block that refuses the numbers of this law."""
    gain_on_folds: float | None = None
    """What a finalist that pays gains on folds."""
    variants: tuple[TriedVariant, ...] = ()
    """Every place and form of it that could be scored, best first."""

    def dearer(self, by: float) -> Candidate:
        """Give the same with a score that is so much worse."""
        return replace(self, score=self.score + by, gain=self.gain - by)

    def but(self, why: str) -> Candidate:
        """Give the same as one that declined."""
        return Candidate(self.effect, self.place, declined=why)


def each_candidate(
    judge: Callable[[Item], Candidate],
    items: Sequence[Item],
    like: ModelState,
    kind: str,
) -> list[Candidate]:
    """Judge items that know nothing of each other, on several cores.

    Parameters
    ----------
    judge : callable
    items : sequence
    like : ModelState
        A model on the same records.
    kind : str
        Words for the work, as of :func:`hystbench.cores.each`.
    """

    def write(found: Candidate) -> tuple[Candidate, Any]:
        return replace(found, state=None), written(found.state)

    def read(content: tuple[Candidate, Any], item: Item) -> Candidate:
        found, state = content
        return replace(found, state=read_like(state, like))

    return each(judge, items, kind, write=write, read=read)


@dataclass(frozen=True)
class SecondLook:
    """An effect and its rivals in its place, now that others are there."""

    instead_of: str
    """The effect in whose place they were tried."""
    beside: tuple[str, ...]
    """The other effects, which stayed."""
    ranking: tuple[Candidate, ...]
    """Best first."""
    taken: str | None
    """The effect that has the place by this ranking. None where the one that was there
    could not be judged again: it stays by the ranking that took it before."""


@dataclass(frozen=True)
class Round:
    """One round: the model before, every effect beside it, what was added."""

    before: ModelState
    score: float
    """Score of the model before."""
    ranking: tuple[Candidate, ...]
    """Best first."""
    taken: bool
    """Whether the first of the ranking was added."""
    looks: tuple[SecondLook, ...] = ()
    """Second looks at the effects that were there when it was added, in their order."""


def near(first: Candidate, ranking: Sequence[Candidate]) -> tuple[str, ...]:
    """Give the effects that score too near one that was added to be told apart."""
    return tuple(
        item.effect
        for item in ranking
        if item.effect != first.effect
        and item.state is not None
        and item.score < first.score + SCALE
    )


def best_forms(
    candidates: Iterable[Candidate], value: Callable[[Candidate], float]
) -> list[Candidate]:
    """Keep the form of each effect whose value is least, if it has several.

    One that declined stays only where all did.
    """
    forms: dict[str, list[Candidate]] = {}
    for item in candidates:
        forms.setdefault(item.effect, []).append(item)
    standing = [[x for x in each if not x.declined] or each for each in forms.values()]
    return [min(each, key=value) if len(each) > 1 else each[0] for each in standing]


def in_order(candidates: Iterable[Candidate]) -> list[Candidate]:
    """Put finalists first, what scores least first among them; what declined, last."""
    return sorted(candidates, key=lambda item: (item.state is None, item.score))

"""Forces tried in each host: one at a time, then several; and which host does best."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, replace

import numpy as np

from hystbench.gap.fitting.in_stages import gentlest
from hystbench.gap.fitting.least_squares import Fitted
from hystbench.gap.fitting.model_score import leaves_more
from hystbench.gap.fitting.score import Score
from hystbench.gap.fitting.state import ModelState
from hystbench.gap.inside.choose import best_of_each, charged, chosen, may_gain
from hystbench.gap.inside.combine_forces import ForceSearch
from hystbench.gap.inside.fitted_numbers import more_for_numbers
from hystbench.gap.inside.host import Host
from hystbench.gap.inside.known_host import with_best_beside_free
from hystbench.gap.inside.lags_of_base import LAGS
from hystbench.gap.inside.likeliest import to_the_end
from hystbench.gap.thresholds import MOST


@dataclass(frozen=True)
class Tried:
    """A host with hypotheses of forces in it: the host alone is the first."""

    host: Host
    found: Sequence[Fitted]
    best: Fitted
    """The one that is chosen."""
    before: Tried | None = None
    """The same in the host without a timing, where they were fitted on from there."""


@dataclass(frozen=True)
class HostTrial:
    """What forces are tried on, and by what they are judged."""

    start: ModelState
    """The base, on the samples that the search takes."""
    forces: ForceSearch
    share: float
    """Share of the gap that may stay unnamed."""
    identified: bool
    """Whether the base was identified from the records."""

    @property
    def score(self) -> Score:
        """What hypotheses are judged by."""
        return self.forces.score

    def of(self, host: Host, found: Sequence[Fitted]) -> Tried:
        """Choose among the hypotheses in a host."""
        return Tried(host, found, chosen(found, self.score.floor, self.share))

    def of_better(self, tried: Tried) -> Tried:
        """Choose among those that improve on the base, or the host alone.

        What leaves more of the records than the base could not stand in its place. On
        the way there it may: a further effect takes more.
        """
        if self._improves(tried.best.state):
            return tried
        found, floor = tried.found, self.score.floor
        best = chosen(found, floor, self.share, lambda x: self._improves(x.state))
        return replace(tried, best=best)

    def _improves(self, state: ModelState) -> bool:
        """Tell whether a model leaves no more of the records than the base."""
        return not leaves_more(state, self.start, self.score.floor)

    def with_one(self, host: Host, before: Tried | None = None) -> Tried:
        """Try each force alone in a host, or what did best in the one before."""
        if before is not None and before.best.effects and host.carry is not None:
            self.forces.say(f"inside: {host.words}; forces are fitted on in it")
            found = self._carried(host, host.carry, before)
            return replace(self.of(host, found), before=before)
        self.forces.say(f"inside: {host.words}; forces are tried in it")
        found = self.forces.singles(host.fitted, host.unfitted_start)
        return self.of(host, found)

    def _carried(
        self,
        host: Host,
        carry: Callable[[ModelState], ModelState],
        before: Tried,
    ) -> list[Fitted]:
        """Fit forces on in another host: the best by all its laws, the others as found.

        They are fitted to the end in any case, and no others are tried.
        """
        best, *others = sorted(before.found[1:], key=lambda item: item.score)
        of_best = self.forces.of(best.effects)
        found = of_best.singles(host.fitted, host.unfitted_start)
        begun = [Fitted(carry(item.state), item.score) for item in others]
        gentle = gentlest(host.fitted.state)
        return best_of_each([*found, *to_the_end(begun, self.score, gentle)])

    def with_several(self, tried: Tried, most: float, lags: bool = False) -> Tried:
        """Go on to several forces in a host, so many at most; or to lags alone."""
        forces = self.forces.of(LAGS) if lags else self.forces
        most -= tried.host.counts
        return self.of(tried.host, forces.together(tried.found, most))

    def with_best_beside_free(self, tried: Tried, free: Sequence[Fitted]) -> Tried:
        """Add what does best where the host's known numbers are free."""
        found = with_best_beside_free(tried.found, self.forces, free)
        return self.of(tried.host, found)

    def leaves_more(self, item: Fitted, share: float) -> bool:
        """Tell whether more than a share of the gap is left."""
        floor = self.score.floor
        return item.state.power(floor) > share * self.start.power(floor)

    def wants_more(self, tried: Tried) -> bool:
        """Tell whether a further effect could gain what it must, and would matter.

        Beside known numbers effects may leave little that stand for others.
        """
        best = tried.best
        matters = not self.identified or self.leaves_more(best, self.share)
        return matters and may_gain(best, self.score)

    def cost(self, tried: Tried) -> float:
        """Give the score of the best, with what effects and the host have to pay."""
        own = charged(tried.best, tried.found, self.score.floor, self.share)
        return tried.host.charge + own


def in_each_host(
    trial: HostTrial,
    hosts: Iterable[Host],
    most: Callable[[], float],
    begins_again: Callable[[Tried], bool],
) -> tuple[list[Tried], float] | None:
    """Try each force alone in one host after the other, till one leaves nothing.

    Where one leaves no more than may stay unnamed, none of many modes is tried.

    Parameters
    ----------
    trial : HostTrial
    hosts : iterable of Host
    most : callable
        Tells how many effects are looked for at most. It is asked before each host,
        but not before the first of an identified base, and no longer once a host leaves
        less than may stay unnamed.
    begins_again : callable
        Told of a host whose best force takes most of the gap. If it says so, this ends.

    Returns
    -------
    tried : list of Tried
    limit : float
        How many effects are looked for at most.
    None
        If it begins again, or no host could do better than what is known.
    """
    every: list[Tried] = []
    limit, little, enough = np.inf, False, False
    for host in hosts:
        if (every or not trial.identified) and not little:
            limit = most()
        if limit - host.counts < 1 or (little and host.kind == "structure"):
            continue
        tried = trial.with_one(host, every[-1] if every else None)
        every.append(tried)
        best = tried.best
        if best.effects and not trial.leaves_more(best, MOST) and begins_again(tried):
            return None
        little = little or not trial.leaves_more(best, trial.share)
        enough = not may_gain(best, trial.score)
        if enough:
            break  # no other host could do better
    if not every:
        return None
    if not (enough or little):
        limit = most()
    return every, limit


def best_with_several(trial: HostTrial, every: Sequence[Tried], limit: float) -> Tried:
    """Try several forces together, and give the host that does best with its forces.

    That is done in the host that does best with one. But first in the one of the fewest
    numbers, and in those whose numbers are not re-tuned: several forces may do as much.
    What a timing does, a lag may do too: no other force is tried without that timing.
    """
    best = min(every, key=trial.cost)
    if trial.identified and not trial.wants_more(best):
        return best
    tried = [
        trial.with_several(one, limit, lags=one is best.before)
        for one in _plainer(every, best.host)
    ]
    if all(map(trial.wants_more, tried)):
        tried.append(trial.with_several(best, limit))
        if not trial.identified and limit - best.host.counts > 1:
            tried = _beside_known_numbers(trial, tried, every, best.host, limit)
    else:
        tried.append(best)
    fewest = min(
        (len(one.best.effects) for one in tried if not one.host.charge), default=np.inf
    )

    def cost(one: Tried) -> float:
        more = more_for_numbers(one.host, one.best.state, fewest)
        return trial.cost(one) + more

    return min(tried, key=cost)


def _plainer(every: Sequence[Tried], than: Host) -> list[Tried]:
    """Choose hosts of the fewest numbers, fewer than another's, or with less charge."""
    numbers = [len(one.host.fitted.state.free) for one in every]
    return [
        one
        for one, count in zip(every, numbers, strict=True)
        if one.host.charge < than.charge
        or count == min(numbers) < len(than.fitted.state.free)
    ]


def _beside_known_numbers(
    trial: HostTrial,
    tried: Sequence[Tried],
    every: Sequence[Tried],
    best: Host,
    limit: float,
) -> list[Tried]:
    """Add to hosts of known numbers what does best where these numbers are re-tuned.

    If the best host is a given base as it is, that is looked for first.
    """
    if best.kind == "given" and not best.charge:
        more = (trial.with_several(one, limit) for one in every if _is_re_tuned(one))
        tried = [*tried, *more]
    free = next((one.found for one in tried if _is_re_tuned(one)), ())
    return [
        one if one.host.charge else trial.with_best_beside_free(one, free)
        for one in tried
    ]


def _is_re_tuned(tried: Tried) -> bool:
    """Tell whether a host is a given base whose known numbers were fitted."""
    return tried.host.charge > 0.0 and tried.host.kind == "given"

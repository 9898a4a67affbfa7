"""Forces in a linear host: singles, then pairs, then three, all numbers refitted."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from hystbench.blocks.base import Block
from hystbench.blocks.impedance import Impedance
from hystbench.blocks.mechanism import Mechanism
from hystbench.blocks.parameter import HUGE
from hystbench.gap.effects import among
from hystbench.gap.effects.base import Law, Moved
from hystbench.gap.inside.least_squares import QUICK, Fitted, fitted
from hystbench.gap.say import Say, silent
from hystbench.gap.score import Score
from hystbench.gap.state import Added, Free, State

SINGLES, PAIRS = 4, 2
"""Of them, so many are carried into pairs and into threes: forces that gain little
alone may gain much together."""


@dataclass(frozen=True)
class Hypothesis:
    """A host with forces inside, fitted.

    Parameters
    ----------
    effects : tuple of str
        In the order in which they were put in.
    forms : tuple of str
        Law of each.
    fitted : Fitted
    """

    effects: tuple[str, ...]
    forms: tuple[str, ...]
    fitted: Fitted

    @property
    def score(self) -> float:
        """Score with all numbers charged."""
        return self.fitted.score


def search(
    host: Fitted,
    score: Score,
    turns: bool = False,
    offered: Iterable[str] | None = None,
    say: Say = silent,
) -> list[Hypothesis]:
    """Try forces inside a host, alone and together.

    Parameters
    ----------
    host : Fitted
        Linear, without a force.
    score : Score
    turns : bool
        Whether its coordinate is an angle.
    offered : iterable of str, optional
        Effects that may be named; all by default.
    say : callable
        Told a line of progress at a time.

    Returns
    -------
    list of Hypothesis
        The host alone first; every other with the score that was reached.
    """
    moved = how_it_moves(host.state, turns)
    laws = {
        name: tuple(effect.inside(moved)) for name, effect in among(offered).items()
    }
    laws = {name: own for name, own in laws.items() if own}
    alone = Hypothesis((), (), host)
    found = [alone]
    carried = [alone]
    for keep in (SINGLES, PAIRS, 1):
        further: dict[frozenset[str], Hypothesis] = {}
        for before in carried:
            for name, own in laws.items():
                key = frozenset((*before.effects, name))
                if name in before.effects or key in further:
                    continue
                best = put_in(before, name, own, score)
                if best is not None:
                    further[key] = best
        best_first = sorted(further.values(), key=lambda item: item.score)
        for item in best_first[:3]:
            say(
                f"inside: {' + '.join(item.effects)}: "
                f"gain {host.score - item.score:.1f}"
            )
        found += best_first
        carried = [item for item in best_first[:keep] if item.score < host.score]
        if not carried:
            break
    return found


def put_in(
    before: Hypothesis, effect: str, laws: Sequence[Law], score: Score
) -> Hypothesis | None:
    """Put a further force inside, by the law and the start that score least.

    Every law is fitted to the end from the better of its starts.
    """
    quick: dict[str, Fitted] = {}
    for law in laws:
        state = with_law(before.fitted.state, effect, law)
        if not np.all(np.isfinite(state.residual)):
            continue
        own = fitted(state, score, QUICK)
        if law.form not in quick or own.score < quick[law.form].score:
            quick[law.form] = own
    if not quick:
        return None
    done = {form: fitted(own.state, score) for form, own in quick.items()}
    form = min(done, key=lambda key: done[key].score)
    if not np.isfinite(done[form].score):
        return None
    effects, forms = (*before.effects, effect), (*before.forms, form)
    return Hypothesis(effects, forms, done[form])


def with_law(state: State, effect: str, law: Law) -> State:
    """Put a law into a chain, with its numbers free.

    A force goes behind the host, a filter before all or behind all.
    """
    host = next(k for k, block in enumerate(state.chain) if is_host(block))
    place = {"before": 0, "inside": host + 1, "behind": len(state.chain)}[law.place]
    chain = (*state.chain[:place], law.block, *state.chain[place:])

    def moved(block: int) -> int:
        return block + 1 if block >= place else block

    values: dict[str, Any] = {name: getattr(law.block, name) for name in law.free}
    item = Added(effect, law.place, law.form, (place,), values, float(len(law.free)))
    return replace(
        state,
        chain=chain,
        free=(
            *(free._replace(block=moved(free.block)) for free in state.free),
            *(Free(place, name) for name in law.free),
        ),
        added=(
            *(
                old._replace(blocks=tuple(moved(block) for block in old.blocks))
                for old in state.added
            ),
            item,
        ),
    )


def is_host(block: Block) -> bool:
    """Tell whether forces can act inside a block."""
    return isinstance(block, Mechanism | Impedance)


def how_it_moves(state: State, turns: bool) -> Moved:
    """Look how far, how fast and by what force a host moves on its records."""
    host: Any = next(block for block in state.chain if is_host(block))
    reach = speed = force = 0.0
    for record in state.records:
        motion = host.motion(record.u, record.dt, ())
        q = motion.position
        reach = max(reach, float(np.ptp(q)) / 2)
        speed = max(speed, float(np.max(np.abs(motion.velocity))))
        driving = record.y if host.name == "impedance" else record.u
        force = max(force, float(np.max(np.abs(driving - np.mean(driving)))))
    tiny = 1.0 / HUGE
    step = min(record.dt for record in state.records)
    anywhere = isinstance(host, Mechanism) and host.stiffness == 0.0
    return Moved(
        max(reach, tiny), max(speed, tiny), max(force, tiny), step, turns, anywhere
    )

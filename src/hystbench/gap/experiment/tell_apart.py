"""Effects that the records cannot tell apart, and the experiment that can."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from hystbench.errors import InputError
from hystbench.gap.experiment.limits import Limits
from hystbench.gap.experiment.next_experiment import (
    Experiment,
    new_in_every_record,
    next_experiment,
)
from hystbench.gap.experiment.separation import Rival, pairs_of, parameter_tangents
from hystbench.gap.fitting.augmented_model import augmented
from hystbench.gap.fitting.state import ModelState
from hystbench.gap.naming.name import Named
from hystbench.gap.naming.rounds import Candidate, near
from hystbench.model import Model
from hystbench.record import Record

ELSEWHERE = (
    "the base holds the output of a simulator that ran elsewhere, which answers to no "
    "other input"
)
"""Why no experiment is computed."""


def tell_apart(
    base: Model,
    named: Named,
    records: Sequence[Record],
    floor_rms: float,
    limits: Limits | None,
) -> tuple[Experiment | None, str]:
    """Look for the one excitation that tells all sets of likely effects apart.

    A set is a named effect and those that it cannot be told from, each as it was fitted
    beside the same other effects.

    Parameters
    ----------
    base : Model
    named : Named
    records : sequence of Record
        The fit records.
    floor_rms : float
    limits : Limits or None
        Those of the records where none are given.

    Returns
    -------
    experiment : Experiment or None
    str
        Why there is none though effects cannot be told apart; else empty.
    """
    alike = {
        item.effect: members
        for item in named.state.added
        if (members := _alike(item.effect, named.reasons.get(item.effect, ())))
    }
    if not alike:
        return None, ""
    if not all(block.reruns for block in base.chain):
        return None, ELSEWHERE
    left_out = tuple(
        (of, name)
        for of, members in alike.items()
        for name, state in members.items()
        if _is_beside(name, state)
    )
    rivals = _Rivals(base)
    sets = {
        of: {
            name: rivals.of(state)
            for name, state in members.items()
            if (of, name) not in left_out
        }
        for of, members in alike.items()
    }
    unseen = new_in_every_record(left_out) if left_out else ""
    if not pairs_of(sets):
        return None, unseen
    try:
        found = next_experiment(sets, records, floor_rms, limits)
    except InputError as error:
        return None, "; ".join(filter(None, [str(error), unseen]))
    return replace(found, left_out=left_out), ""


def _alike(effect: str, ranking: Sequence[Candidate]) -> dict[str, ModelState]:
    """Give an effect and those that cannot be told from it, if there are any."""
    own = next((x for x in ranking if x.effect == effect), None)
    names = () if own is None else near(own, ranking)
    if not names:
        return {}
    return {
        x.effect: x.state
        for x in ranking
        if x.effect in (effect, *names) and x.state is not None
    }


def _is_beside(effect: str, state: ModelState) -> bool:
    """Tell whether an effect is a signal of each record, which no input brings out."""
    return any(beside.effect == effect for beside, _ in state.beside)


class _Rivals:
    """Gives states as rivals, the same one for the same model: it runs once then.

    What other effects put beside the chain is left out, as it is new in every record.
    """

    def __init__(self, base: Model) -> None:
        self._base = base
        self._known: list[tuple[Model, Rival]] = []

    def of(self, state: ModelState) -> Rival:
        model = augmented(self._base, replace(state, beside=()))
        for known, rival in self._known:
            if known == model:
                return rival
        rival = Rival(model, parameter_tangents(model, model.free))
        self._known.append((model, rival))
        return rival

"""Effects that the records cannot tell apart, and the experiment that can."""

from __future__ import annotations

from collections.abc import Sequence

from hystbench.errors import InputError
from hystbench.gap.augmented import augmented
from hystbench.gap.experiment import Experiment, next_experiment, parameter_tangents
from hystbench.gap.limits import Limits
from hystbench.gap.name import Named
from hystbench.gap.rank import Candidate, near
from hystbench.model import Model
from hystbench.record import Record

ELSEWHERE = (
    "the base holds the output of a simulator that ran elsewhere, which answers to no "
    "other input"
)
NEW_IN_EVERY_RECORD = (
    "one of those that cannot be told apart is new in every record, and no input "
    "brings it out"
)
"""Why no experiment is computed."""


def tell_apart(
    base: Model,
    named: Named,
    records: Sequence[Record],
    floor_rms: float,
    limits: Limits | None,
) -> tuple[Experiment | None, str]:
    """Look for the excitation that tells a set of likely effects apart.

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
    why = ""
    for effect in (item.effect for item in named.state.added):
        ranking = named.reasons.get(effect, ())
        rivals = _rivals(effect, ranking)
        if not rivals:
            continue
        if not all(block.reruns for block in base.chain):
            return None, ELSEWHERE
        usable = [x for x in rivals if x.state is not None and not x.state.beside]
        if len(usable) < 2:
            why = NEW_IN_EVERY_RECORD
            continue
        models = [(x.effect, augmented(base, x.state)) for x in usable[:3] if x.state]
        tangents = parameter_tangents([(model, model.free) for _, model in models])
        try:
            found = next_experiment(models, records, floor_rms, limits, tangents)
        except InputError as error:
            return None, str(error)
        return found, ""
    return None, why


def _rivals(effect: str, ranking: Sequence[Candidate]) -> list[Candidate]:
    """Give an effect and those that cannot be told from it, if there are any."""
    own = next((x for x in ranking if x.effect == effect), None)
    names = () if own is None else near(own, ranking)
    return [x for x in ranking if names and x.effect in (effect, *names) and x.state]

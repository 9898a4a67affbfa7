"""How far naming has come, as JSON: so that one job goes on where another stopped."""

from __future__ import annotations

from hystbench.gap.kept_state import (
    Mapped,
    StateRestorer,
    limit,
    number,
    state_mapping,
)
from hystbench.gap.name import Progress
from hystbench.gap.rounds import Candidate, Look, Round, Tested
from hystbench.model import Model
from hystbench.record import Record


class Restorer(StateRestorer):
    """Makes progress of JSON on the same records.

    Parameters
    ----------
    records : tuple of Record
        The fit records.
    base : Model
        Gives its own blocks back: one may hold more than a file does, such as the
        output of a simulator that ran elsewhere.
    """

    def __init__(self, records: tuple[Record, ...], base: Model) -> None:
        super().__init__(records, base.chain)

    def progress(self, content: Mapped) -> Progress:
        """Give the progress that :func:`progress_mapping` wrote."""
        return Progress(
            self.state(content["state"]),
            content["gap"],
            tuple(self._round(item) for item in content["rounds"]),
            content["deferred"],
            content["closed"],
        )

    def _round(self, content: Mapped) -> Round:
        return Round(
            self.state(content["before"]),
            content["score"],
            self._ranking(content),
            content["taken"],
            tuple(self._look(item) for item in content["looks"]),
        )

    def _look(self, content: Mapped) -> Look:
        return Look(
            content["instead_of"],
            tuple(content["beside"]),
            self._ranking(content),
            content["taken"],
        )

    def _ranking(self, content: Mapped) -> tuple[Candidate, ...]:
        return tuple(self._candidate(item) for item in content["ranking"])

    def _candidate(self, content: Mapped) -> Candidate:
        state = content["state"]
        own: Mapped = {
            "score": limit(content["score"]),
            "state": None if state is None else self.state(state),
            "variants": tuple(
                Tested(place, form, position, limit(score))
                for place, form, position, score in content["variants"]
            ),
        }
        return Candidate(**content | own)


def progress_mapping(progress: Progress) -> Mapped:
    """Give how far naming has come, as JSON holds it."""
    return {
        "done": progress.done,
        "gap": progress.gap,
        "deferred": progress.deferred,
        "closed": progress.closed,
        "state": state_mapping(progress.state),
        "rounds": [
            {
                "before": state_mapping(one.before),
                "score": one.score,
                "ranking": [_candidate_mapping(item) for item in one.ranking],
                "taken": one.taken,
                "looks": [_look_mapping(item) for item in one.looks],
            }
            for one in progress.rounds
        ],
    }


def _look_mapping(look: Look) -> Mapped:
    return {
        "instead_of": look.instead_of,
        "beside": list(look.beside),
        "ranking": [_candidate_mapping(item) for item in look.ranking],
        "taken": look.taken,
    }


def _candidate_mapping(item: Candidate) -> Mapped:
    return {
        "effect": item.effect,
        "place": item.place,
        "form": item.form,
        "score": number(item.score),
        "gain": item.gain,
        "state": None if item.state is None else state_mapping(item.state),
        "declined": item.declined,
        "held_back": item.held_back,
        "variants": [[*x[:3], number(x.score)] for x in item.variants],
    }

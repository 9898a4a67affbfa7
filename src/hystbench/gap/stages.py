"""Naming cut into jobs: a start, one job an effect and round, and a choice a round.

The jobs compute; the choice decides, by the code that decides in one process too. One
process searches around the likely variants alone and refits the finalists alone; an
effect's job cannot know how well the others do, so it searches around all its variants
and refits the best. The choice then looks up what one process would have computed,
simulates the likeliest exactly and judges them on folds. So both ways name the same,
and the jobs together do more work.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from hystbench.errors import InputError
from hystbench.gap.effects import effects
from hystbench.gap.effects.base import Effect, Variant
from hystbench.gap.evidence import Evidence
from hystbench.gap.fit import ready, score_of
from hystbench.gap.floor import Floor
from hystbench.gap.kept import Restorer, progress_mapping
from hystbench.gap.kept_state import Mapped, limit, number, state_mapping
from hystbench.gap.name import Named, Progress, advance, settled
from hystbench.gap.rank import make_score
from hystbench.gap.say import Say, silent
from hystbench.gap.score import Score
from hystbench.gap.search import Attempt, Trial
from hystbench.gap.start import start_state
from hystbench.gap.state import State
from hystbench.gap.work import IN_PROCESS, Tried, Work
from hystbench.model import Model


def begin(evidence: Evidence, base: Model) -> Mapped:
    """Measure the floor and give the progress before the first round.

    Parameters
    ----------
    evidence : Evidence
        Only its fit records are read.
    base : Model

    Returns
    -------
    dict
        ``floor`` and, as after every round, ``state``, ``gap``, ``rounds``,
        ``deferred`` and ``done``.
    """
    state, floor = start_state(evidence.fit, base, evidence.hold, evidence.noise_rms)
    begun = progress_mapping(Progress.begun(state, floor.rms))
    return {"floor": floor_mapping(floor), **begun}


def floor_mapping(floor: Floor) -> Mapped:
    """Give the noise floor, as JSON holds it."""
    return {
        "rms": floor.rms,
        "method": floor.method,
        "per_record": dict(floor.per_record),
    }


def try_one(evidence: Evidence, base: Model, before: Mapped, name: str) -> Mapped:
    """Try one effect beside the model of a round.

    Parameters
    ----------
    evidence : Evidence
        Only its fit records are read.
    base : Model
    before : dict
        The progress before the round.
    name : str
        Of the effect.

    Returns
    -------
    dict
        ``effect``; ``declined``: why, or empty; ``variants``, each with its best point
        of the grid (``coarse``) and the best around it (``fine``); ``added``: the best
        variant refitted with the whole model, or why a block refuses it.
    """
    state = Restorer(evidence.fit, base).state(before["state"])
    found: Mapped = {"effect": name, "declined": "", "variants": [], "added": None}
    if name in {item.effect for item in state.added}:
        return found | {"declined": "added already"}
    score = make_score(state, before["floor"]["rms"])
    state = ready(state, score)
    tried, declined = IN_PROCESS.tried(effects()[name], state, score)
    if declined:
        return found | {"declined": declined}
    best: tuple[int, Trial] | None = None
    for place, (attempt, trial) in enumerate(tried):
        finer = IN_PROCESS.fine(attempt, trial)
        found["variants"].append(
            {
                "number": attempt.number,
                "form": trial.variant.form,
                "coarse": _trial_mapping(trial),
                "fine": _trial_mapping(finer),
            }
        )
        if best is None or finer.score < best[1].score:
            best = place, finer
    if best is not None and best[1].score < score_of(state, score):
        found["added"] = _added(state, best, score)
    return found


def choose(
    evidence: Evidence,
    base: Model,
    before: Mapped,
    tried: Mapping[str, Mapped],
    say: Say = silent,
) -> Mapped:
    """Rank the effects of a round and add the one that pays, if any does.

    Parameters
    ----------
    evidence : Evidence
        Only its fit records are read.
    base : Model
    before : dict
        The progress before the round.
    tried : mapping
        What :func:`try_one` gave, by effect. An effect that is not there is tried here.
    say : callable
        Told a line of progress at a time.

    Returns
    -------
    dict
        The progress after the round.
    """
    restorer = Restorer(evidence.fit, base)
    progress = restorer.progress(before)
    work = Recorded(tried, restorer)
    after = advance(progress, before["floor"]["rms"], say, work=work)
    return {"floor": before["floor"], **progress_mapping(after)}


def named_by(
    evidence: Evidence,
    base: Model,
    content: Mapped,
    start: State,
    say: Say = silent,
) -> tuple[Named, Floor]:
    """Give what the rounds named, and the floor that they were judged by.

    Where a wrong shape of the hysteresis has to go first, the second way of adding
    effects is gone here, in one process.

    Raises
    ------
    InputError
        If the last round was not the last.
    """
    progress = Restorer(evidence.fit, base).progress(content)
    if not progress.done:
        raise InputError(
            f"round {len(progress.rounds)}: an effect was added; expected the progress "
            "after the round that adds none"
        )
    floor = Floor(**content["floor"])
    return settled(progress, start, floor.rms, say), floor


class Recorded(Work):
    """Looks up what jobs computed beside one model, and computes what they did not.

    Parameters
    ----------
    tried : mapping
        What the jobs wrote, by effect.
    restorer : Restorer
    """

    def __init__(self, tried: Mapping[str, Mapped], restorer: Restorer) -> None:
        self._tried, self._restorer = tried, restorer
        self._variants: list[Variant] = []
        self._entries: list[Mapped] = []

    def tried(
        self, effect: Effect, state: State, score: Score
    ) -> tuple[list[Tried], str]:
        """Look up every variant of an effect over its grid."""
        if effect.name not in self._tried:
            return super().tried(effect, state, score)
        content = self._tried[effect.name]
        if content["declined"]:
            return [], str(content["declined"])
        found = []
        variants = list(effect.variants(state.scene))
        for entry in content["variants"]:
            number = entry["number"]
            variant = variants[number]
            self._variants.append(variant)
            self._entries.append(entry)
            attempt = Attempt(state, variant, score, number)
            found.append((attempt, _trial(variant, entry["coarse"])))
        return found, ""

    def fine(self, attempt: Attempt, trial: Trial) -> Trial:
        """Look up the best around the best point of a variant's grid."""
        entry = self._entry(trial.variant)
        if entry is None:
            return super().fine(attempt, trial)
        return _trial(trial.variant, entry["fine"])

    def added(self, state: State, trial: Trial, score: Score) -> tuple[State, float]:
        """Look up the effect added and all refitted, if it is what its job added."""
        entry = self._entry(trial.variant)
        if entry is None:
            return super().added(state, trial, score)
        content = self._tried[trial.variant.effect]
        added = content["added"]
        if (
            added is None
            or content["variants"][added["variant"]] is not entry
            or added["values"] != trial.values
        ):
            return super().added(state, trial, score)
        if added["refused"]:
            raise InputError(added["refused"])
        return self._restorer.state(added["state"]), added["score"]

    def _entry(self, variant: Variant) -> Mapped | None:
        """Give what a job wrote of a variant, if it was a job's."""
        for known, entry in zip(self._variants, self._entries, strict=True):
            if known is variant:
                return entry
        return None


def _added(state: State, best: tuple[int, Trial], score: Score) -> Mapped:
    place, trial = best
    found: Mapped = {"variant": place, "values": dict(trial.values)}
    try:
        after, value = IN_PROCESS.added(state, trial, score)
    except InputError as error:
        return found | {"refused": str(error), "state": None, "score": None}
    return found | {"refused": "", "state": state_mapping(after), "score": value}


def _trial_mapping(trial: Trial) -> Mapped:
    return {"values": dict(trial.values), "score": number(trial.score)}


def _trial(variant: Variant, content: Mapping[str, Any]) -> Trial:
    return Trial(variant, dict(content["values"]), limit(content["score"]))

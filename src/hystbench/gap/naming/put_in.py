"""Effects that a user puts into the simulator before the search.

They are fitted and become part of the simulator: the search begins with them, so that
``before`` has them and ``after`` tells what the search found. What they close of the
gap is told beside that, and is never added to it.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

from hystbench.errors import InputError
from hystbench.gap.effects import effects
from hystbench.gap.fitting.augmented_model import augmented
from hystbench.gap.fitting.edit_chain import with_effect
from hystbench.gap.fitting.model_score import make_score
from hystbench.gap.fitting.on_records import start_state
from hystbench.gap.fitting.parameters import parameters_of
from hystbench.gap.fitting.refit import added, finished
from hystbench.gap.fitting.score import Score
from hystbench.gap.fitting.state import ModelState
from hystbench.gap.fitting.tried import trials_of
from hystbench.gap.fitting.uncertainty import on_more_samples, standard_errors
from hystbench.gap.fitting.variant_search import Trial, fine
from hystbench.gap.progress import Say, silent
from hystbench.gap.records.evidence import Evidence
from hystbench.model import Model


@dataclass(frozen=True)
class PutIn:
    """A simulator with effects that its user put in."""

    alone: Model
    """The simulator without them."""
    effects: tuple[dict[str, Any], ...]
    """Each with its ``name``, ``place``, ``form`` and ``parameters``, as fitted before
    the search."""

    @property
    def names(self) -> tuple[str, ...]:
        """Names of the effects, in the order in which they were put in."""
        return tuple(str(item["name"]) for item in self.effects)

    def mapping(self) -> dict[str, Any]:
        """Give the same as JSON holds it."""
        return {"alone": self.alone.to_mapping(), "effects": list(self.effects)}

    @classmethod
    def of_mapping(cls, content: Mapping[str, Any]) -> PutIn:
        """Give back what :meth:`mapping` gave."""
        alone = Model.from_mapping(content["alone"], "the simulator alone")
        return cls(alone, tuple(content["effects"]))


def with_put_in(
    base: Model, evidence: Evidence, names: Sequence[str], say: Say = silent
) -> tuple[Model, PutIn | None]:
    """Put effects into a simulator and fit them to the fit records, one by one.

    Whether an effect pays is not asked. Each takes the place and the form that score
    best, as the search would choose them; its numbers stay free, so that the search
    refits them beside what it adds.

    Parameters
    ----------
    base : Model
    evidence : Evidence
        Only its fit records are looked at.
    names : sequence of str
    say : callable
        Told a line of progress at a time.

    Returns
    -------
    Model
        The simulator with the effects.
    PutIn or None
        None where no effect is named.

    Raises
    ------
    InputError
        If an effect cannot be judged on these records or in this simulator, or has no
        block of its own, as it is new in every record.
    """
    if not names:
        return base, None
    state, floor = start_state(
        evidence.fit, base, evidence.input_hold, evidence.noise_rms
    )
    # Without directions: a wrong shape of the hysteresis is no excuse here. Numbers are
    # those with which the simulator fits the records best.
    score = Score.plain(state.sample, floor.square)
    if state.free:
        state, _ = finished(state, score)
    for name in names:
        state, _ = finished(_with(state, score, name), score)
        say(f"{name} is in, as you asked")
    finer = on_more_samples(state)
    errors = standard_errors(finer, make_score(finer, floor, forms=False))
    told = tuple(
        {
            "name": item.effect,
            "place": item.place,
            "form": item.form,
            "parameters": parameters_of(item, state, errors),
        }
        for item in state.added
    )
    model = augmented(base, state)
    # What the search of an effect does not free, such as the gain of an offset, stays.
    labels = [label for label, _ in model.labelled()]
    own = {f"{labels[item.block]}.{item.parameter}" for item in state.free}
    free = tuple(name for name in model.free if name in own)
    title = f"{base.name} with {' and '.join(names)}"
    return replace(model, name=title, free=free), PutIn(base, told)


def _with(state: ModelState, score: Score, name: str) -> ModelState:
    """Add an effect where and as it scores best, whether it pays or not."""
    found, declined = trials_of(effects()[name], state, score)
    blocks = [trial for trial in found if not trial.variant.beside]
    if not blocks:
        why = declined or (
            "it is new in every record, so that no model can hold it; the search may "
            "name it"
        )
        raise InputError(f"--with {name}: {why}")
    refused = None
    for trial in sorted(map(fine, blocks), key=lambda trial: trial.score):
        try:
            return _added(state, trial, score)
        except InputError as error:
            refused = refused or error  # of the form that scores best
    raise InputError(f"--with {name}: {refused}")


def _added(state: ModelState, trial: Trial, score: Score) -> ModelState:
    """Add an effect as a trial found it, refitted where the block accepts that."""
    as_tried = with_effect(state, trial.variant, trial.values)
    try:
        return added(state, trial, score)[0]
    except InputError:
        return as_tried

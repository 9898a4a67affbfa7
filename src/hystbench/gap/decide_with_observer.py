"""Deciding beside an observer, where a free run of a model may go astray."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from hystbench.blocks.base import Block
from hystbench.blocks.mechanism import Mechanism
from hystbench.errors import InputError
from hystbench.gap.asked import Asked
from hystbench.gap.bases.linear import IdentifiedModel, with_its_numbers_free
from hystbench.gap.effects import effects
from hystbench.gap.effects.effect import Effect
from hystbench.gap.fitting.model_score import make_score
from hystbench.gap.fitting.on_records import on_records
from hystbench.gap.fitting.score import Score
from hystbench.gap.fitting.state import ModelState
from hystbench.gap.fitting.uncertainty import on_more_samples, standard_errors
from hystbench.gap.holdout.withdraw import ToShow
from hystbench.gap.inside.one_coordinate import best_host, one_coordinate
from hystbench.gap.judge_and_tell import Decision
from hystbench.gap.naming.ladder import FitResult
from hystbench.gap.records.evidence import Evidence
from hystbench.gap.records.floor import Floor
from hystbench.gap.records.observer import observer_for, with_observer_signal
from hystbench.gap.records.scored_samples import ScoredSamples
from hystbench.gap.vocabulary import Vocabulary
from hystbench.model import Model
from hystbench.units import sized


def with_observer(
    evidence: Evidence,
    decide: Callable[[Evidence, Model, Asked], tuple[Decision, ToShow]],
    asked: Asked,
    plain: ToShow | None,
) -> tuple[Decision, ToShow] | None:
    """Decide anew beside an observer, where a free run may go astray.

    That stands if forces are named then, inside the mass alone, if they take more of
    their gap than what was found without it, and if a free run does not speak against
    them: it leaves no more than grown noise may.

    Parameters
    ----------
    evidence : Evidence
        Without its hold-out records. Nothing was named on them as they are.
    decide : callable
        Decides on records beside a base.
    asked : Asked
    plain : ToShow, optional
        What was decided on them, which stands where hold-out records take names back.

    Returns
    -------
    tuple of Decision and ToShow, or None
        None where it does not stand, or no force moves the device.
    """
    damper, say = observer_for(evidence), asked.say
    if damper is None:
        return None
    own = with_observer_signal(evidence, damper)
    mass = mass_on_a_spring(own)
    if mass is None:
        return None
    say("a free run may go astray: naming forces beside an observer")
    forces = replace(asked, vocabulary=of_forces(asked.vocabulary))
    decision, to_show = decide(own, mass, forces)
    elsewhere = any(item.place != "inside" for item in decision.state.added)
    if decision.content["verdict"] != "named" or elsewhere:
        say("beside an observer none is named")
        return None
    if not takes_more(decision.content, plain.content if plain else None):
        say("without an observer as much of the gap is taken")
        return None
    free = FreeRun.of(decision, damper, evidence.fit[0].decay_s)
    if not free.may_be_grown_noise:
        say("a free run speaks against what is named beside an observer")
        return None
    content = told(to_show.content, evidence, damper, free)
    decision = replace(decision, content=content, experiment=None)
    return decision, replace(
        to_show,
        fitted=decision,
        content=content,
        vocabulary=asked.vocabulary,
        damper=damper,
        plain=plain,
    )


def takes_more(content: Mapping[str, Any], plain: Mapping[str, Any] | None) -> bool:
    """Tell whether a decision takes more of its gap than a plain one of a free run.

    Errors did not grow where a free run takes as much.
    """
    mine, other = (
        (x or {}).get("fit", {}).get("explained") or 0.0 for x in (content, plain)
    )
    return bool(mine > other)


def mass_on_a_spring(evidence: Evidence) -> Model | None:
    """Give the mass that moves nearest to what fit records show; None where none does.

    It stands for the base. The order of the identified one is not used, as friction or
    a stop may have raised it.
    """
    floor = np.finfo(float).tiny
    score = Score.plain(ScoredSamples.of(evidence.fit), floor)
    begun = one_coordinate(evidence.fit, evidence.quantities, evidence.input_hold)
    best = best_host(begun, score)
    if best is None:
        return None
    name, channels = "linear", (evidence.input, evidence.output)
    model = IdentifiedModel(name, *channels, best.state.chain)
    return with_its_numbers_free(model)


def of_forces(vocabulary: Vocabulary) -> Vocabulary:
    """Leave out what does not act inside a mechanism.

    An observer acts on the mass. What lies before the mass or behind it would change
    the observer's force, which was measured.
    """
    barred = {*vocabulary.without, *vocabulary.put_in}
    elsewhere = tuple(
        name
        for name, effect in effects().items()
        if type(effect).in_mechanism is Effect.in_mechanism and name not in barred
    )
    return replace(vocabulary, without=(*vocabulary.without, *elsewhere))


@dataclass(frozen=True)
class FreeRun:
    """What a model that was found beside an observer does without one, on fit records.

    All are mean squares.
    """

    noise: float
    left: float
    """What it leaves above the noise."""
    growth: float
    """What the errors of its numbers do, over what they do beside the observer."""

    @classmethod
    def of(
        cls, found: FitResult, damper: float, decay_s: float | None = None
    ) -> FreeRun:
        """Run a model, and run it with each of its numbers off by its standard error.

        Parameters
        ----------
        found : FitResult
        damper : float
            Of the observer.
        decay_s : float, optional
            With which an unknown velocity dies out without it, in windows of a free
            mass.
        """
        state, noise = found.state, found.floor.square
        alone = tuple(
            replace(record, injected=None, decay_s=decay_s) for record in state.records
        )
        chain, sample = without_damper(state.chain, damper), ScoredSamples.of(alone)
        free = on_records(replace(state, chain=chain, sample=sample), alone)
        errors = _errors(state, found.floor)
        beside = _moved(state, errors)
        growth = _moved(free, errors) / beside if beside > 0.0 else 1.0
        return cls(noise, max(free.power(noise), 0.0), growth)

    @property
    def may_be_grown_noise(self) -> bool:
        """Whether an error as large as the noise, grown, may be all it leaves."""
        return self.left <= self.growth * self.noise


def _errors(state: ModelState, floor: Floor) -> dict[int, float]:
    """Give standard errors of the free numbers that the records tell of."""
    finer = on_more_samples(state)
    errors = standard_errors(finer, make_score(finer, floor, forms=False))
    return {k: float(x) for k, x in enumerate(errors) if np.isfinite(x)}


def _moved(state: ModelState, errors: dict[int, float]) -> float:
    """Sum the mean squares by which small changes move a model, one at a time."""
    total = 0.0
    for k, error in errors.items():
        try:
            moved = state.moved({k: error})
        except InputError:
            continue  # beyond what the block accepts
        with np.errstate(over="ignore", invalid="ignore"):  # it may run away
            total += float(np.mean((moved.left - state.left) ** 2))
    return total


def without_damper(chain: tuple[Block, ...], damper: float) -> tuple[Block, ...]:
    """Take the damper of an observer out of the mass that a chain holds."""
    return tuple(
        replace(block, damping=_alone(block.damping, damper))
        if isinstance(block, Mechanism)
        else block
        for block in chain
    )


def _alone(damping: float, damper: float) -> float:
    """Give a mass's own damping; it is none where a fit came below the damper."""
    return max(damping - damper, 0.0)


def model_without_damper(model: Model, damper: float) -> Model:
    """Take the damper of an observer out of a model."""
    if damper == 0.0:
        return model
    return replace(model, chain=without_damper(model.chain, damper))


def told(
    content: Mapping[str, Any], evidence: Evidence, damper: float, free: FreeRun
) -> dict[str, Any]:
    """Say in gap.json's content that an observer was at work."""
    unit = evidence.output.unit
    moved = f"/({unit})" if evidence.quantities.output == "velocity" else f" s/{unit}"
    left = sized(float(np.sqrt(free.left)), unit)
    words = (
        f"by an observer: a damper of {damper:.3g} {evidence.input.unit}{moved} "
        "draws every simulated motion to the measured one. Without it errors grow to "
        f"{np.sqrt(free.growth):.2g} times the size: a free run of the model leaves "
        f"{left} rms of the fit records above the noise floor"
    )
    numbers = {
        name: {
            key: _alone(value, damper) if name.endswith(".damping") else value
            for key, value in row.items()
        }
        for name, row in content["base_parameters"].items()
    }
    return {
        **content,
        "base_parameters": numbers,
        "next_experiment": None,
        "no_experiment": "none is computed beside an observer",
        "observer": {
            "damper": damper,
            "free_run_left": float(np.sqrt(free.left)),
            "errors_grow": float(np.sqrt(free.growth)),
            "sentence": words,
        },
        "reason": f"{content['reason']}; {words}",
    }

"""All variants of an effect beside a model, each over its grid.

Few samples choose a point of a grid, more search around it.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from functools import lru_cache
from math import ceil
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from hystbench.blocks.base import Block
from hystbench.blocks.linear import LinearBlock
from hystbench.blocks.simulated_column import NEEDS_RERUN
from hystbench.blocks.simulator import Simulator
from hystbench.cores import each
from hystbench.errors import InputError
from hystbench.gap.effects.effect import Declined, Effect
from hystbench.gap.effects.variant import Variant
from hystbench.gap.fitting.model_score import score_of
from hystbench.gap.fitting.score import Score
from hystbench.gap.fitting.serialize import remembered_of
from hystbench.gap.fitting.state import ModelState
from hystbench.gap.fitting.variant_search import (
    Attempt,
    Point,
    Trial,
    best_of,
    best_points,
)
from hystbench.gap.records.scored_samples import ScoredSamples
from hystbench.gap.simulation.reshape import orthonormal
from hystbench.gap.simulation.simulation import NOT_LINEAR
from hystbench.gap.thresholds import PARAMETER
from hystbench.record import Record

ENOUGH = 4
"""Records of which half is looked at."""
STRAIGHT, STRAIGHTER = 3e-3, 1e-3
"""Share of an input's largest size by which straight lines between samples may miss it:
at a glance, and where all records are looked at."""
LEAST = 150
"""Samples that a record keeps."""
EACH = 3
"""One of so many scored samples is looked at, where enough are left."""

MORE = 4.0
"""Most that a variant may gain on all records, in times of what a glance showed,
uncharged."""


class Seen(NamedTuple):
    """A variant of which a part of the records was looked at."""

    attempt: Attempt
    """The variant beside all records."""
    points: tuple[Point, ...]
    """Points of its grid that do best at a glance."""
    gain: float
    """How far it lowers the score if the other records are like those looked at;
    without a grid all that it may be, as nothing was looked at."""

    @property
    def most(self) -> float:
        """By how much it may lower the score if the other records show more of it."""
        charge = PARAMETER * self.attempt.variant.freedom
        return MORE * (self.gain + charge) - charge

    def on_all(self) -> Trial:
        """Score it on all records."""
        return best_of(self.attempt, self.points)

    def as_seen(self, now: float) -> Trial:
        """Give it as it was seen, beside a model of such a score."""
        values = dict(zip(self.attempt.variant.grids, self.points[0], strict=True))
        return Trial(self.attempt, values, now - self.gain)


def trials_of(
    effect: Effect, state: ModelState, score: Score
) -> tuple[list[Trial], str]:
    """Score every variant of an effect over its grid; or say why it declines."""
    looks, why_not = seen([effect], state, score)
    found, refused = on_all_records(looks, 0.0, lambda most: -np.inf)
    return found, (why_not | refused).get(effect.name, "")


def on_all_records(
    looks: Sequence[Seen], now: float, least: Callable[[float], float]
) -> tuple[list[Trial], dict[str, str]]:
    """Score variants on all records, best first; leave as seen what gains too little.

    Parameters
    ----------
    looks : sequence of Seen
    now : float
        Score of the model without any of them.
    least : callable
        Tells by the most that one of them gains how much is enough.

    Returns
    -------
    found : list of Trial
        In the order of the looks.
    refused : dict of str to str
        Why, of each effect whose variants all decline.
    """
    most, found, refused = -np.inf, {}, {}
    for number in sorted(range(len(looks)), key=lambda k: -looks[k].most):
        item = looks[number]
        variant = item.attempt.variant
        if item.most < least(most) and not variant.begun:
            found[number] = item.as_seen(now)
            continue
        try:
            found[number] = item.on_all()
        except Declined as reason:
            refused[variant.effect] = str(reason)
            continue
        most = max(most, now - found[number].score)
    for trial in found.values():
        refused.pop(trial.variant.effect, None)
    return [found[number] for number in sorted(found)], refused


Look = tuple[int, tuple[Point, ...], float]
"""Number of a variant among all of its effect, and what :class:`Seen` tells of it."""


def seen(
    every: Sequence[Effect], state: ModelState, score: Score
) -> tuple[list[Seen], dict[str, str]]:
    """Look at every variant of effects over its grid; tell why not, by name."""
    looks: list[Seen] = []
    why_not: dict[str, str] = {}
    found = each(lambda effect: _looks(effect, state, score), every, "looks")
    for effect, (own, why) in zip(every, found, strict=True):
        if why:
            why_not[effect.name] = why
        variants = list(effect.every_variant(state.simulation)) if own else []
        for number, points, gain in own:
            attempt = _thinned(Attempt(state, variants[number], score, number))
            looks.append(Seen(attempt, points, gain))
    return looks, why_not


def _looks(
    effect: Effect, state: ModelState, score: Score
) -> tuple[tuple[Look, ...], str]:
    """Look at an effect's variants that can be run, or say why there is none."""
    try:
        variants = list(effect.every_variant(state.simulation))
    except Declined as reason:
        return (), str(reason)
    runnable = [
        (number, item)
        for number, item in enumerate(variants)
        if not _needs_rerun(state, item)
    ]
    if variants and not runnable:
        return (), NEEDS_RERUN
    return remembered_of(
        state,
        lambda: ["seen", effect.name, score.digest],
        lambda: _seen(runnable, state, score),
    )


def _seen(
    runnable: Sequence[tuple[int, Variant]], state: ModelState, score: Score
) -> tuple[tuple[Look, ...], str]:
    """Look at variants over their grids; say why none can be, if so."""
    found: list[Look] = []
    refused = ""
    for number, item in runnable:
        look: tuple[tuple[Point, ...], float] = ((),), np.inf
        try:
            if item.grids:
                look = _at_a_glance(Attempt(state, item, score))
        except Declined as reason:
            refused = str(reason)
        else:
            found.append((number, *look))
    return tuple(found), "" if found else refused


def _at_a_glance(attempt: Attempt) -> tuple[tuple[Point, ...], float]:
    """Look at a variant over its grid on few samples: its best points, and the gain."""
    look = _glance_of(attempt)
    best = best_points(look)
    charge = PARAMETER * attempt.variant.freedom
    gain = _score_of(look.state, look.score) - best[0][0] + charge
    more = _evidence(attempt.score) / _evidence(look.score)
    return tuple(point for _, point in best), more * gain - charge


_score_of = lru_cache(maxsize=2)(score_of)


def _evidence(score: Score) -> float:
    """Count the independent samples of all records."""
    return score.weight * len(score.sample.positions)


def _needs_rerun(state: ModelState, variant: Variant) -> bool:
    """Tell whether a variant changes what enters a block whose output is stored."""
    behind = state.chain[variant.start :]
    return variant.beside is None and not all(block.reruns for block in behind)


def _glance_of(attempt: Attempt) -> Attempt:
    """Give a variant on few samples: of half of the records, and fewer of each.

    The half has most of the gap. Of an input that moves slowly not every sample is
    taken, where blocks take steps of any length.
    """
    state, score, variant = attempt.state, attempt.score, attempt.variant
    half = _half(state, score)
    few = _coarser(*half) if _takes_any_step(state, variant) else half
    return Attempt(few[0], variant, few[1])


def _thinned(attempt: Attempt) -> Attempt:
    """Give a variant on all records, with fewer samples of those that move slowly.

    What is scored stays the same. A mode rings faster than its input moves.
    """
    state, variant = attempt.state, attempt.variant
    if not _takes_any_step(state, variant) or any(map(_rings, _blocks(state, variant))):
        return attempt
    thin = _in_longer_steps(attempt.state, STRAIGHTER)
    return Attempt(thin, attempt.variant, attempt.score, attempt.number)


def records_at_a_glance(count: int) -> int:
    """Tell how many of so many records are looked at."""
    return count if count < ENOUGH else count - count // 2


@lru_cache(maxsize=1)
def _half(state: ModelState, score: Score) -> tuple[ModelState, Score]:
    """Give a model and its score on the half of the records with most of the gap.

    Of whole periods the first ones stand for all. But a part of a record is a further
    call of a simulator of a user's own.
    """
    slices = state.sample.slices
    whole = any(isinstance(block, Simulator) for block in state.chain)
    count = len(slices)
    squares = [float(np.mean(state.residual[part] ** 2)) for part in slices]
    order = np.argsort(squares, kind="stable")[count - records_at_a_glance(count) :]
    kept = sorted(order.tolist())
    records, positions, rows = [], [], []
    for k in kept:
        places = state.sample.positions[k]
        record = state.records[k]
        records.append(record if whole else first_periods(record, len(places)))
        positions.append(places[places < len(records[-1])])
        rows.append(slices[k].start + np.arange(len(positions[-1])))
    every = np.concatenate(rows)
    if len(every) == len(score.directions):
        return state, score
    sample = replace(state.sample.on(kept), positions=tuple(positions))
    few = state.on(tuple(records), sample, every)
    return few, _on(few.sample, every, score)


def first_periods(record: Record, scored: int) -> Record:
    """Give the first periods of a record, as many as hold enough scored samples.

    The first one may be on the way from rest.
    """
    period = record.period_samples
    if not period or not record.repeats or record.decay_s is not None:
        return record
    measured = len(record) - record.past
    count = max(2, ceil(LEAST * measured / (scored * period))) + record.past // period
    if count * period >= len(record):
        return record
    cut = record.cut(slice(count * period))
    return replace(cut, period_samples=period)


def _on(sample: ScoredSamples, rows: NDArray[np.intp], score: Score) -> Score:
    """Give a score of fewer samples."""
    return Score(sample, orthonormal(score.directions[rows]), score.floor)


@lru_cache(maxsize=1)
def _coarser(state: ModelState, score: Score) -> tuple[ModelState, Score]:
    """Give a model and its score on fewer scored samples, and records of fewer."""
    kept = [
        np.arange(part.start, part.stop, EACH if len(places) >= EACH * LEAST else 1)
        for part, places in zip(
            state.sample.slices, state.sample.positions, strict=True
        )
    ]
    rows = np.concatenate(kept)
    every = np.concatenate(state.sample.positions)
    sample = ScoredSamples(tuple(every[own] for own in kept))
    few = _in_longer_steps(state.on(state.records, sample, rows), STRAIGHT)
    return few, _on(few.sample, rows, score)


@lru_cache(maxsize=2)
def _in_longer_steps(state: ModelState, straight: float) -> ModelState:
    """Give a model on records of fewer samples.

    What it leaves of the records stays as it is: the difference of the simulation in
    longer steps is made up for, as that of a quick one is.
    """
    steps = tuple(_step(record, straight) for record in state.records)
    few = replace(
        state,
        records=tuple(map(_every, state.records, steps)),
        sample=ScoredSamples(state.sample.positions, apart=steps),
        correction=None,
    )
    return replace(few, correction=few.residual - state.residual)


def _takes_any_step(state: ModelState, variant: Variant) -> bool:
    """Tell whether a chain with an effect may be simulated in longer steps.

    Not what the input does not explain, nor a staircase, nor a simulator of somebody's
    own, nor what is integrated step by step.
    """
    if state.beside or variant.beside is not None or state.sample.of_start:
        return False
    if state.hold == "zero-order":
        return False
    try:
        blocks = _blocks(state, variant)
    except InputError:
        return False  # one end of the grid is refused: nothing is known of its blocks
    return not any(
        isinstance(block, NOT_LINEAR) or not (block.seen and block.reruns)
        for block in blocks
    )


def _blocks(state: ModelState, variant: Variant) -> tuple[Block, ...]:
    """Give the blocks of a chain, and of an effect at one end of its grid."""
    point = {name: float(axis[0]) for name, axis in variant.grids.items()}
    return (*state.chain, *variant.build(point | variant.unit))


def _rings(block: Block) -> bool:
    """Tell whether a block has modes that are no lags."""
    return isinstance(block, LinearBlock) and not block.continuous().is_diagonal


def _step(record: Record, straight: float) -> int:
    """Give the longest step of which straight lines are the input, nearly."""
    most = straight * float(np.abs(record.u).max())
    longest = max(len(record) // LEAST, 1)
    for step in range(2, longest + 1):
        kept = record.u[::step]
        ends = step * np.arange(len(kept))
        lines = np.interp(np.arange(ends[-1] + 1), ends, kept)
        if np.abs(lines - record.u[: len(lines)]).max() > most:
            return step - 1
    return longest


def _every(record: Record, step: int) -> Record:
    """Give every so many samples of a record."""
    return replace(record.cut(slice(None, None, step)), simulated=None)

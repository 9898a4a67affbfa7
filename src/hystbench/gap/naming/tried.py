"""All variants of an effect beside a model, each over its grid."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from hystbench.blocks.simulated_column import NEEDS_RERUN
from hystbench.gap.effects.effect import Declined, Effect
from hystbench.gap.effects.variant import Variant
from hystbench.gap.fitting.glance import glance_of, thinned
from hystbench.gap.fitting.score import Score
from hystbench.gap.fitting.serialize import remembered_of
from hystbench.gap.fitting.state import ModelState
from hystbench.gap.fitting.variant_search import Attempt, Trial, coarse

Tried = tuple[Attempt, Trial]
"""A variant beside a model, and how it does over its grid."""


def tried(effect: Effect, state: ModelState, score: Score) -> tuple[list[Tried], str]:
    """Score every variant of an effect over its grid; or say why it declines."""
    try:
        variants = list(effect.every_variant(state.simulation))
    except Declined as reason:
        return [], str(reason)
    runnable = [
        (number, item)
        for number, item in enumerate(variants)
        if not _needs_rerun(state, item)
    ]
    if variants and not runnable:
        return [], NEEDS_RERUN

    def read(content: Any) -> tuple[list[Tried], str]:
        kept, why = content
        found = [
            (
                thinned(Attempt(state, variants[number], score, number)),
                Trial(variants[number], values, value),
            )
            for number, values, value in kept
        ]
        return found, why

    return remembered_of(
        state,
        lambda: ["tried", effect.name, score.digest],
        lambda: _tried(runnable, state, score),
        lambda result: [
            [[each.number, x.values, x.score] for each, x in result[0]],
            result[1],
        ],
        read,
    )


def _tried(
    runnable: Sequence[tuple[int, Variant]], state: ModelState, score: Score
) -> tuple[list[Tried], str]:
    """Score variants over their grids; say why none can be, if so."""
    found: list[Tried] = []
    refused = ""
    for number, item in runnable:
        attempt = Attempt(state, item, score, number)
        try:
            glance = glance_of(attempt)
            attempt = thinned(attempt)
            trial = coarse(attempt, glance)
        except Declined as reason:
            refused = str(reason)
            continue
        found.append((attempt, trial))
    return found, "" if found else refused


def _needs_rerun(state: ModelState, variant: Variant) -> bool:
    """Tell whether a variant changes what enters a block whose output is stored."""
    behind = state.chain[variant.start :]
    return variant.beside is None and not all(block.reruns for block in behind)

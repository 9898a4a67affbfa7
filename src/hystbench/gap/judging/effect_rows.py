"""What a decision tells of the effects and their numbers, as gap.json holds it."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from dataclasses import fields
from typing import Any

import numpy as np

from hystbench.blocks.calls import USED_UP
from hystbench.blocks.external import External
from hystbench.blocks.parameter import HUGE
from hystbench.blocks.simulated_column import NEEDS_RERUN
from hystbench.gap.fitting.parameters import parameters_of
from hystbench.gap.fitting.state import Added, ModelState
from hystbench.gap.fitting.uncertainty import Errors
from hystbench.gap.judging.leftover import Leftover
from hystbench.gap.judging.verdict import confidence, error_of
from hystbench.gap.naming.add_effects import Named
from hystbench.gap.naming.rounds import Candidate, near
from hystbench.model import Model
from hystbench.record import FloatArray, Record


def effect_mapping(
    item: Added,
    state: ModelState,
    errors: FloatArray,
    of_beside: Sequence[Errors],
    ranking: Sequence[Candidate],
    left: Leftover,
    size_error: float = np.nan,
    trust: float = 1.0,
) -> dict[str, Any]:
    """Give an added effect with its numbers and how sure the name is.

    Parameters
    ----------
    item, state, errors, of_beside
        As for :func:`hystbench.gap.fitting.parameters.parameters_of`.
    ranking : sequence of Candidate
        The last by which it was taken.
    left : Leftover
    size_error : float
        Standard error of what it adds to the output, in times of it; not finite where
        it cannot be told.
    trust : float
        Factor on the confidence, less than one where more stays unnamed than may.
    """
    own = next((x for x in ranking if x.effect == item.effect), None)
    parameters = parameters_of(item, state, errors, of_beside)
    # Of a shape each number stands in for its neighbours: only all together say much.
    # Of a path in every record the mean slope is told, which may well be nothing.
    shape = any(state.chain[k].hysteretic for k in item.blocks)
    path = any(x.effect == item.effect and not given for x, given in state.beside)
    of_size = size_error if np.isfinite(size_error) else None
    # A level that may be infinite means nothing at zero: there it is not missing.
    levels = {
        field.name
        for k in item.blocks
        for field in fields(state.chain[k])
        if field.default in (HUGE, -HUGE)
    }
    known = {key: x for key, x in parameters.items() if key not in levels}
    error = error_of(of_size, {} if shape or path else known)
    sure = 0.0 if own is None else confidence(own, ranking, left, error)
    return {
        "name": item.effect,
        "place": item.place,
        "parameters": parameters,
        "size_error": of_size,
        "confidence": trust * sure,
        "cannot_be_told_from": [] if own is None else list(near(own, ranking)),
    }


def not_tried(named: Named) -> list[str]:
    """Name the effects that no fit could try: the simulator could not be run for them.

    It cannot be run again at all, or not more often than was allowed.
    """
    return [
        item.effect
        for one in named.rounds[:1]
        for item in one.ranking
        if item.declined == NEEDS_RERUN or USED_UP in item.declined
    ]


def simulator_mapping(model: Model, records: Sequence[Record]) -> dict[str, Any]:
    """Tell what the model with its effects takes and gives, and how it can be run."""
    channels = {"input": model.input, "output": model.output}
    return {
        side: {"name": item.name, "unit": item.unit} for side, item in channels.items()
    } | {
        "functions": [x.function for x in model.chain if isinstance(x, External)],
        "runs_again": all(block.reruns for block in model.chain),
        "sampling_interval_s": records[0].dt,
    }


def paths_no_surer(
    rows: Sequence[dict[str, Any]], paths: Collection[str]
) -> list[dict[str, Any]]:
    """Give effects of which a path is no surer than the surest law beside it.

    A path bends to whatever a wrong law leaves.

    Parameters
    ----------
    rows : sequence of dict
        Effects as gap.json has them.
    paths : collection of str
        Names of those that are a path of each record's own.
    """
    laws = [row["confidence"] for row in rows if row["name"] not in paths]
    most = max(laws, default=1.0)
    return [
        row | {"confidence": min(row["confidence"], most)}
        if row["name"] in paths
        else row
        for row in rows
    ]


def ranking_rows(named: Named) -> list[dict[str, Any]]:
    """Give every candidate of every round and of the second looks after it.

    Rankings stand in the order in which they were made, each with the best first.
    """
    rows = []
    for number, one in enumerate(named.rounds, start=1):
        beside = [item.effect for item in one.before.added]
        about = {"round": number, "look": 0, "instead_of": None, "beside": beside}
        best = one.ranking[0].effect if one.taken else None
        rows += _rows(about, one.ranking, best)
        for k, look in enumerate(one.looks, start=1):
            where = {"instead_of": look.instead_of, "beside": list(look.beside)}
            rows += _rows(about | {"look": k} | where, look.ranking, look.taken)
    return rows


def _rows(
    about: Mapping[str, Any], ranking: Sequence[Candidate], taken: str | None
) -> list[dict[str, Any]]:
    rows = []
    for item in ranking:
        row: dict[str, Any] = {
            **about,
            "name": item.effect,
            "place": item.place,
            "taken": item.effect == taken,
            "refitted": item.state is not None,
            "held_back": item.gain_on_folds,
        }
        if item.form:
            row["form"] = item.form
        if item.variants:
            tried = [x._asdict() for x in item.variants if np.isfinite(x.score)]
            row["variants"] = tried
        if item.declined:
            row["declined"] = item.declined
        elif np.isfinite(item.score):
            row |= {"score": item.score, "gain": item.gain}
        rows.append(row)
    return rows

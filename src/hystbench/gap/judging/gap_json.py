"""What a finding tells of the effects and their numbers, as gap.json holds it."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from hystbench.blocks import registry
from hystbench.blocks.base import Block
from hystbench.blocks.calls import USED_UP
from hystbench.blocks.external import External
from hystbench.blocks.parameter import SETTINGS
from hystbench.blocks.simulated_column import NEEDS_RERUN
from hystbench.gap.effects import effects
from hystbench.gap.fitting.parameter_units import unit_at, unit_behind, written
from hystbench.gap.fitting.state import Added, State, beside_count
from hystbench.gap.fitting.uncertainty_beside import Errors
from hystbench.gap.judging.verdict import Left, confidence, error_of
from hystbench.gap.naming.name import Named
from hystbench.gap.naming.rounds import Candidate, near
from hystbench.model import Model
from hystbench.record import FloatArray, Record

OFFSET = "offset"
"""Of a plain gain."""


def base_parameters(base: Model, state: State) -> dict[str, Any]:
    """Give the base's free parameters before and after.

    None after, where an effect stands for the block: the number is then the effect's.
    """
    labels = (label for label, _ in base.labelled())
    places = dict(zip(labels, places_of_base(state), strict=True))
    found: dict[str, Any] = {}
    for name in base.free:
        label, _, parameter = name.rpartition(".")
        before, place = base.value(name), places[label]
        if isinstance(before, str):
            continue
        after = None
        if place is not None:
            after = _plain(getattr(state.chain[place], parameter))
        found[name] = {"before": _plain(before), "after": after}
    return found


def places_of_base(state: State) -> list[int | None]:
    """Find where the base's blocks stand; None where an effect stands for one."""
    beside = {item.effect for item, _ in state.beside}
    # An effect without a block lost it to a later one, which then stands for no block
    # of the base.
    lost = any(not item.blocks and item.effect not in beside for item in state.added)
    # Of a store an effect has some numbers, and the base the others.
    inserted = [item for item in state.added if not effects()[item.effect].numbers]
    own = {k for item in inserted for k in item.blocks}
    instead = {item.blocks[0] for item in state.added if item.replaced and item.blocks}
    return [
        None if k in own else k
        for k in range(len(state.chain))
        if k not in own or (k in instead and not lost)
    ]


def _plain(value: object) -> object:
    return list(value) if isinstance(value, tuple) else value


def beside_blocks(state: State) -> list[Block]:
    """Give the blocks of what lies beside the chain."""
    if not state.beside:
        return []
    blocks, first = [], 0
    for beside, values in state.beside:
        count = beside_count(state, beside, values)
        own = state.beside_amplitudes[first : first + count]
        rows = own.reshape(len(state.records), -1)
        described = effects()[beside.effect].describe(values, rows)
        blocks.append(registry()[beside.effect].from_mapping(described))
        first += count
    return blocks


def effect_mapping(
    item: Added,
    state: State,
    errors: FloatArray,
    of_beside: Sequence[Errors],
    ranking: Sequence[Candidate],
    left: Left,
    size_error: float | None = None,
    trust: float = 1.0,
) -> dict[str, Any]:
    """Give an added effect with its numbers and how sure the name is.

    Parameters
    ----------
    item : Added
    state : State
    errors : ndarray, shape (free numbers,)
    of_beside : sequence of dict
        Standard errors of the signals beside the chain.
    ranking : sequence of Candidate
        The last by which it was taken.
    left : Left
    size_error : float, optional
        Standard error of what it adds to the output, in times of it.
    trust : float
        Factor on the confidence, less than one where more stays unnamed than may.
    """
    own = next((x for x in ranking if x.effect == item.effect), None)
    parameters = parameters_of(item, state, errors, of_beside)
    # Of a shape each number stands in for its neighbours: only all together say much.
    # Of a path in every record the mean slope is told, which may well be nothing.
    shape = any(state.chain[k].hysteretic for k in item.blocks)
    path = any(x.effect == item.effect and not given for x, given in state.beside)
    error = error_of(size_error, {} if shape or path else parameters)
    sure = 0.0 if own is None else confidence(own, ranking, left, error)
    return {
        "name": item.effect,
        "place": item.place,
        "parameters": parameters,
        "size_error": size_error,
        "confidence": trust * sure,
        "cannot_be_told_from": [] if own is None else list(near(own, ranking)),
    }


def parameters_of(
    item: Added, state: State, errors: FloatArray, of_beside: Sequence[Errors] = ()
) -> dict[str, Any]:
    """Give the numbers of an added effect with their standard errors and units.

    Parameters
    ----------
    item : Added
    state : State
    errors : ndarray, shape (free numbers,)
    of_beside : sequence of dict
        Standard errors of the signals beside the chain.
    """
    found: dict[str, Any] = {}
    record = state.records[0]
    if not item.blocks:
        blocks = {beside.effect: k for k, (beside, _) in enumerate(state.beside)}
        if item.effect not in blocks:
            return found  # a later effect stands for its block and has its numbers
        block = beside_blocks(state)[blocks[item.effect]]
        known = of_beside[blocks[item.effect]]
        for key, about in block.parameters().items():
            value = about.plain(getattr(block, key))
            if value is not None and value != ():
                found[key] = {
                    "value": value,
                    "standard_error": known.get(key),
                    "unit": written(about.unit, record.input.unit, record.output.unit),
                }
        return found
    offsets = effects()[item.effect].offsets.get(item.form, ())
    if offsets:
        for place, (label, unit) in zip(item.blocks, offsets, strict=True):
            value = getattr(state.chain[place], OFFSET)
            found[label] = {
                "value": value,
                "standard_error": _errors_of(place, OFFSET, value, state, errors),
                "unit": _unit(unit, place, state),
            }
        return found
    numbers = effects()[item.effect].numbers
    for place in item.blocks:
        block = state.chain[place]
        if block.name not in (item.effect, *effects()[item.effect].laws):
            continue  # what the effect left of a block that it was taken out of
        for key, about in block.parameters().items():
            value = getattr(block, key)
            if key in SETTINGS or value == () or (numbers and key not in numbers):
                continue
            error = _errors_of(place, key, value, state, errors)
            label = key if key not in found else f"{key}#2"
            found[label] = {
                "value": list(value) if isinstance(value, tuple) else value,
                "standard_error": error,
                "unit": _unit(about.unit, place, state),
            }
    return found


AT_END = 1e-3
"""Share of a number by which it may be off the end of its range and be at it."""


def _unit(unit: str, place: int, state: State) -> str:
    of_input, behind = state.records[0].input.unit, unit_behind(place, state)
    return unit_at(unit, state.chain, place, of_input, behind)


def _errors_of(
    place: int, key: str, value: object, state: State, errors: FloatArray
) -> float | list[float | None] | None:
    own = {
        free.element: float(errors[k]) if np.isfinite(errors[k]) else None
        for k, free in enumerate(state.free)
        if free.block == place and free.parameter == key
    }
    if isinstance(value, tuple):
        each = [own.get(k) for k in range(len(value))]
        return each if any(x is not None for x in each) else None
    return own.get(None)


def at_ends(state: State) -> str:
    """Tell which numbers of effects lie at an end of the range that was searched.

    There the range may have shut a better number out.
    """
    told = []
    for free in state.free:
        value = state.value(free)
        named = next((x.effect for x in state.added if free.block in x.blocks), None)
        ends = [end for end in (free.low, free.high) if np.isfinite(end)]
        if named and any(np.isclose(value, end, rtol=AT_END, atol=0) for end in ends):
            unit = state.chain[free.block].parameters()[free.parameter].unit
            told.append(
                f"{free.parameter} of {named}, {value:.3g} "
                f"{_unit(unit, free.block, state)},"
            )
    if not told:
        return ""
    lies = "lies" if len(told) == 1 else "lie"
    return f"{' and '.join(told)} {lies} at the end of the range that was searched"


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
    return [{**about, **_candidate_row(x, x.effect == taken)} for x in ranking]


def _candidate_row(item: Candidate, taken: bool) -> dict[str, Any]:
    row: dict[str, Any] = {
        "name": item.effect,
        "place": item.place,
        "taken": taken,
        "refitted": item.state is not None,
        "held_back": item.held_back,
    }
    if item.form:
        row["form"] = item.form
    if item.variants:
        row["variants"] = [x._asdict() for x in item.variants if np.isfinite(x.score)]
    if item.declined:
        row["declined"] = item.declined
    elif np.isfinite(item.score):
        row |= {"score": item.score, "gain": item.gain}
    return row

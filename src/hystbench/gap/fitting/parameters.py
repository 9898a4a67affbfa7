"""The numbers of a model and of its effects, with their errors and units."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from typing import Any

import numpy as np

from hystbench.blocks.parameter import HUGE, SETTINGS, TINY
from hystbench.gap.bases.roughly_known import defaults
from hystbench.gap.effects import effects
from hystbench.gap.fitting.augmented_model import beside_blocks, places_of_base
from hystbench.gap.fitting.parameter_units import unit_at, unit_behind, unit_written
from hystbench.gap.fitting.state import Added, Free, ModelState
from hystbench.gap.fitting.uncertainty import Errors
from hystbench.model import Model
from hystbench.record import FloatArray

OFFSET = "offset"
"""Name of the offset of a plain gain."""


def base_parameters(base: Model, state: ModelState) -> dict[str, Any]:
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


def _plain(value: object) -> object:
    return list(value) if isinstance(value, tuple) else value


def parameters_of(
    item: Added, state: ModelState, errors: FloatArray, of_beside: Sequence[Errors] = ()
) -> dict[str, Any]:
    """Give the numbers of an added effect with their standard errors and units.

    Parameters
    ----------
    item : Added
    state : ModelState
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
                unit = unit_written(about.unit, record.input.unit, record.output.unit)
                found[key] = _number(value, known.get(key), unit)
        return found
    offsets = effects()[item.effect].offsets.get(item.form, ())
    if offsets:
        for place, (label, unit) in zip(item.blocks, offsets, strict=True):
            value = getattr(state.chain[place], OFFSET)
            error = _errors_of(place, OFFSET, value, state, errors)
            found[label] = _number(value, error, _unit(unit, place, state))
        return found
    numbers = effects()[item.effect].numbers
    fitted = {(free.block, free.parameter) for free in state.free}
    met: Counter[str] = Counter()
    for place in item.blocks:
        block = state.chain[place]
        if block.name not in (item.effect, *effects()[item.effect].laws):
            continue  # what the effect left of a block that it was taken out of
        usual = defaults(block)
        for key, about in block.parameters().items():
            value = getattr(block, key)
            if key in SETTINGS or value == () or (numbers and key not in numbers):
                continue
            if not numbers and value == usual[key] and (place, key) not in fitted:
                continue  # no law that was named has it
            met[key] += 1
            if value == usual[key] == HUGE:
                continue  # a store without a rim or a weir
            error = _errors_of(place, key, value, state, errors)
            label = key if met[key] == 1 else f"{key}#{met[key]}"
            found[label] = _number(value, error, _unit(about.unit, place, state))
    return found


def _number(value: object, error: object, unit: str) -> dict[str, object]:
    return {"value": _plain(value), "standard_error": error, "unit": unit}


AT_END = 1e-3
"""Share of a number by which it may be off the end of its range and be at it."""


def _unit(unit: str, place: int, state: ModelState) -> str:
    of_input, behind = state.records[0].input.unit, unit_behind(place, state)
    return unit_at(unit, state.chain, place, of_input, behind)


def _errors_of(
    place: int, key: str, value: object, state: ModelState, errors: FloatArray
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


def at_ends(state: ModelState) -> str:
    """Tell which numbers of effects lie at an end of the range that was searched.

    There the range may have shut a better number out. The range is the narrower of
    what the effect and its block allow. An end that physics sets is none: zero, as of a
    gap, a force or a lag, and all or nothing, as of a share.
    """
    told = []
    for free in state.free:
        value = state.value(free)
        named = next((x.effect for x in state.added if free.block in x.blocks), None)
        ends = _searched_ends(state, free)
        if named and any(np.isclose(value, end, rtol=AT_END, atol=0) for end in ends):
            unit = state.chain[free.block].parameters()[free.parameter].unit
            shown = f"{value:.3g} {_unit(unit, free.block, state)}".removesuffix(" -")
            told.append(f"{free.parameter} of {named}, {shown},")
    if not told:
        return ""
    lies = "lies" if len(told) == 1 else "lie"
    return f"{' and '.join(told)} {lies} at the end of the range that was searched"


def _searched_ends(state: ModelState, free: Free) -> list[float]:
    """Give the ends of a number's range that a search may have set."""
    about = state.chain[free.block].parameters()[free.parameter]
    of_share = (-1.0, 1.0) if about.high == 1.0 else ()
    physical = (0.0, -HUGE, TINY, HUGE, *of_share)
    return [end for end in state.range_of(free) if end not in physical]

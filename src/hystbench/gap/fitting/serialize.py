"""A model as far as it has come, as JSON, and results that follow from it, kept.

Of arrays only the correction of the quick simulation is kept, as it costs an exact
one. All others follow from the chain and the records, and are computed anew; effects
give back the shapes of what lies beside a chain.
"""

from __future__ import annotations

import json
from base64 import b64decode, b64encode
from collections.abc import Callable, Mapping
from dataclasses import replace
from typing import Any

import numpy as np

from hystbench.blocks import block_class
from hystbench.blocks.base import Block
from hystbench.blocks.simulator import Simulator
from hystbench.gap.cache import Result, records_digest, remembered
from hystbench.gap.effects import effects
from hystbench.gap.effects.sensor import Drift
from hystbench.gap.effects.variant import Beside
from hystbench.gap.fitting.state import Added, Free, ModelState
from hystbench.gap.simulation.simulation import Simulation

Mapped = dict[str, Any]
MODEL = "a model"
"""Key under which a model stands in a result: no number has such a name."""


def state_mapping(state: ModelState) -> Mapped:
    """Give a model as far as it has come, as JSON holds it."""
    lacks = state.correction
    return {
        "hold": state.hold,
        "chain": [_block_mapping(block) for block in state.chain],
        "free": [_free_mapping(item) for item in state.free],
        "added": [
            item._asdict()
            | {
                "replaced": item.replaced and _block_mapping(item.replaced),
                "was_free": [_free_mapping(free) for free in item.was_free],
            }
            for item in state.added
        ],
        "beside": [
            {"effect": beside.effect, "order": beside.order, "values": dict(values)}
            for beside, values in state.beside
        ],
        "correction": None if lacks is None else _text(lacks),
    }


def state_of(content: Mapped, like: ModelState) -> ModelState:
    """Give the model that :func:`state_mapping` wrote.

    Parameters
    ----------
    content : dict
    like : ModelState
        On the same records. Blocks of its own are given back where they are the same:
        one may hold more than JSON does, such as the output of a simulator that ran
        elsewhere.
    """

    def block(content: Mapping[str, Any]) -> Block:
        ((name, values),) = content.items()
        found = block_class(name).from_mapping(values)
        kept = _block_mapping(found)
        own = (item for item in like.chain if _block_mapping(item) == kept)
        return next(own, found)

    def added(content: Mapped) -> Added:
        old = content["replaced"]
        return Added(
            **content
            | {
                "blocks": tuple(content["blocks"]),
                "replaced": None if old is None else block(old),
                "was_free": tuple(map(_free, content["was_free"])),
            }
        )

    lacks = content["correction"]
    state = replace(
        like,
        chain=tuple(map(block, content["chain"])),
        free=tuple(map(_free, content["free"])),
        added=tuple(map(added, content["added"])),
        hold=content["hold"],
        correction=None
        if lacks is None
        else np.frombuffer(b64decode(lacks), dtype=np.float64).copy(),
    )
    beside = tuple(
        (_beside(item["effect"], item["order"], state.simulation), item["values"])
        for item in content["beside"]
    )
    return replace(state, beside=beside)


def state_key(state: ModelState) -> list[str]:
    """Tell all that a model computes from, in words and digests."""
    return [
        records_digest(state.records),
        json.dumps(state_mapping(state), sort_keys=True),
        *(_text(positions) for positions in state.sample.positions),
    ]


def remembered_of(
    state: ModelState,
    more: Callable[[], list[Any]],
    compute: Callable[[], Result],
) -> Result:
    """Give a result that follows from a model, by all that it is made of.

    Parameters
    ----------
    state : ModelState
        One with a simulator of somebody's own is always computed: what it is made of is
        not known. Its outputs are kept elsewhere.
    more : callable
        Gives what the result depends on beside it: words and digests.
    compute : callable
        Gives what JSON can hold, or models on the same records, or tuples of both.
    """
    if any(isinstance(block, Simulator) for block in state.chain):
        return compute()
    found: Result = remembered(
        lambda: [*more(), *state_key(state)],
        compute,
        written,
        lambda content: read_like(content, state),
    )
    return found


def written(result: Any) -> Any:
    """Write models, and tuples that hold some, as JSON holds them."""
    if isinstance(result, ModelState):
        return {MODEL: state_mapping(result)}
    return list(map(written, result)) if isinstance(result, tuple) else result


def read_like(content: Any, like: ModelState) -> Any:
    """Give what :func:`written` wrote, of models on the records of another one."""
    if isinstance(content, dict) and MODEL in content:
        return state_of(content[MODEL], like)
    if isinstance(content, list):
        return tuple(read_like(item, like) for item in content)
    return content


def _text(array: np.ndarray[Any, Any]) -> str:
    return b64encode(np.ascontiguousarray(array).tobytes()).decode("ascii")


def _free_mapping(item: Free) -> Mapped:
    return item._asdict() | {"low": _number(item.low), "high": _number(item.high)}


def _free(content: Mapped) -> Free:
    ends = {"low": _limit(content["low"], -1), "high": _limit(content["high"])}
    return Free(**content | ends)


def _number(value: float) -> float | None:
    """Give a number, or None for an infinite one: JSON has none."""
    return float(value) if np.isfinite(value) else None


def _limit(value: float | None, sign: int = 1) -> float:
    """Give a number back, and infinity for None."""
    return sign * float("inf") if value is None else value


def _block_mapping(block: Block) -> Mapped:
    return {block.name: block.to_mapping()}


def _beside(effect: str, order: int, simulation: Simulation) -> Beside:
    """Give the shapes of what lies beside, as its effect offers them."""
    if (effect, order) == (Drift.name, 0):
        return Drift.levels()  # no effect, but fitted beside laws as one is
    offered = (variant.beside for variant in effects()[effect].variants(simulation))
    return next(item for item in offered if item is not None and item.order == order)

"""A model with its effects, as JSON: one job names them, another shows what they do.

Arrays are not kept. They follow from the chain and the records, and are computed anew;
effects give back the shapes of what lies beside a chain.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from hystbench.blocks import registry
from hystbench.blocks.base import Block
from hystbench.gap.effects import effects
from hystbench.gap.effects.base import Beside
from hystbench.gap.sample import Sample
from hystbench.gap.scene import Scene
from hystbench.gap.state import Added, Free, State
from hystbench.model import Model
from hystbench.record import FloatArray, Record

Mapped = dict[str, Any]


def state_mapping(state: State) -> Mapped:
    """Give a model as JSON holds it."""
    at = state.corrected_at
    return {
        "hold": state.hold,
        "chain": _chain_mapping(state.chain),
        "free": [
            item._asdict() | {"low": _number(item.low), "high": _number(item.high)}
            for item in state.free
        ],
        "added": [
            item._asdict()
            | {"replaced": item.replaced and _block_mapping(item.replaced)}
            for item in state.added
        ],
        "beside": [
            {"effect": beside.effect, "order": beside.order, "values": dict(values)}
            for beside, values in state.beside
        ],
        # The chain at which the quick simulation was last held against the exact one.
        "corrected_at": None if at is None else _chain_mapping(at),
    }


class Restorer:
    """Makes models of JSON on the same records; what they share is computed once.

    Parameters
    ----------
    records : tuple of Record
        The fit records.
    base : Model
        Gives its own blocks back: one may hold more than a file does, such as the
        output of a simulator that ran elsewhere.
    """

    def __init__(self, records: tuple[Record, ...], base: Model) -> None:
        self.records, self.sample = records, Sample.of(records)
        self._own = base.chain
        self._corrections: dict[tuple[Block, ...], FloatArray | None] = {}

    def state(self, content: Mapped) -> State:
        """Give the model that :func:`state_mapping` wrote."""
        hold = content["hold"]
        state = State(
            self._chain(content["chain"]),
            self.records,
            self.sample,
            tuple(
                Free(
                    **item
                    | {"low": _limit(item["low"], -1), "high": _limit(item["high"])}
                )
                for item in content["free"]
            ),
            tuple(self._added(item) for item in content["added"]),
            hold=hold,
        )
        beside = tuple(
            (_beside(item["effect"], item["order"], state.scene), item["values"])
            for item in content["beside"]
        )
        at = content["corrected_at"]
        if at is None:
            return _replaced(state, beside)
        chain = self._chain(at)
        if chain not in self._corrections:
            settled = State(chain, self.records, self.sample, hold=hold).settled()
            self._corrections[chain] = settled.correction
        return _replaced(state, beside, self._corrections[chain], chain)

    def _block(self, content: Mapping[str, Any]) -> Block:
        ((name, values),) = content.items()
        block = registry()[name].from_mapping(values)
        kept = _block_mapping(block)
        own = (item for item in self._own if _block_mapping(item) == kept)
        return next(own, block)

    def _chain(self, content: Sequence[Mapping[str, Any]]) -> tuple[Block, ...]:
        return tuple(self._block(item) for item in content)

    def _added(self, content: Mapped) -> Added:
        old = content["replaced"]
        return Added(
            **content
            | {
                "blocks": tuple(content["blocks"]),
                "replaced": None if old is None else self._block(old),
            }
        )


def _number(value: float) -> float | None:
    """Give a number, or None for an infinite one: JSON has none."""
    return float(value) if np.isfinite(value) else None


def _limit(value: float | None, sign: int = 1) -> float:
    """Give a number back, and infinity for None."""
    return sign * float("inf") if value is None else value


def _block_mapping(block: Block) -> Mapped:
    return {block.name: block.to_mapping()}


def _chain_mapping(chain: Sequence[Block]) -> list[Mapped]:
    return [_block_mapping(block) for block in chain]


def _beside(effect: str, order: int, scene: Scene) -> Beside:
    """Give the shapes of what lies beside, as its effect offers them."""
    offered = (variant.beside for variant in effects()[effect].variants(scene))
    return next(item for item in offered if item is not None and item.order == order)


def _replaced(
    state: State,
    beside: tuple[tuple[Beside, Any], ...],
    correction: FloatArray | None = None,
    at: tuple[Block, ...] | None = None,
) -> State:
    return State(
        state.chain,
        state.records,
        state.sample,
        state.free,
        state.added,
        beside,
        state.hold,
        correction,
        at,
    )

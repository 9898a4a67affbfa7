"""A model as far as it has come, as JSON.

Arrays are not kept. They follow from the chain and the records, and are computed anew;
effects give back the shapes of what lies beside a chain. The correction of the quick
simulation alone may be kept beside it, as it costs an exact one.
"""

from __future__ import annotations

import json
from base64 import b64decode, b64encode
from collections.abc import Callable, Mapping, Sequence
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
from hystbench.gap.records.scored_samples import ScoredSamples
from hystbench.gap.simulation.simulation import Simulation
from hystbench.record import FloatArray, Record

Mapped = dict[str, Any]


def state_mapping(state: ModelState) -> Mapped:
    """Give a model as far as it has come, as JSON holds it."""
    at = state.corrected_at
    return {
        "hold": state.hold,
        "chain": _chain_mapping(state.chain),
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
        # The chain at which the quick simulation was last held against the exact one.
        "corrected_at": None if at is None else _chain_mapping(at),
    }


def state_key(state: ModelState) -> list[str]:
    """Tell all that a model computes from, in words and digests."""
    return [
        records_digest(state.records),
        json.dumps(state_with_correction(state), sort_keys=True),
        *(_text(positions) for positions in state.sample.positions),
    ]


def state_with_correction(state: ModelState) -> Mapped:
    """Give a model as JSON holds it, and what the quick simulation lacks."""
    lacks = None if state.correction is None else _text(state.correction)
    return state_mapping(state) | {"correction": lacks}


def state_again(content: Mapped, like: ModelState) -> ModelState:
    """Give the model that :func:`state_with_correction` wrote.

    Parameters
    ----------
    content : dict
    like : ModelState
        On the same records, with the same blocks where they are the base's own.
    """
    plain = content | {"corrected_at": None}
    restorer = Restorer(like.records, like.chain)
    at, lacks = content["corrected_at"], content["correction"]
    return replace(
        restorer.state(plain),
        sample=like.sample,
        offered=like.offered,
        correction=None if lacks is None else _array(lacks),
        corrected_at=None if at is None else restorer.chain(at),
    )


def remembered_of(
    state: ModelState,
    more: Callable[[], list[Any]],
    compute: Callable[[], Result],
    write: Callable[[Result], Any],
    read: Callable[[Any], Result],
) -> Result:
    """Give a result that follows from a model, by all that it is made of.

    Parameters
    ----------
    state : ModelState
        One with a simulator of somebody's own is always computed: what it is made of is
        not known. Its outputs are kept elsewhere.
    more : callable
        Gives what the result depends on beside it: words and digests.
    compute, write, read : callable
        As for :meth:`hystbench.gap.cache.Remembered.result`.
    """
    if any(isinstance(block, Simulator) for block in state.chain):
        return compute()
    return remembered(lambda: [*more(), *state_key(state)], compute, write, read)


def _text(array: np.ndarray[Any, Any]) -> str:
    return b64encode(np.ascontiguousarray(array).tobytes()).decode("ascii")


def _array(text: str) -> FloatArray:
    return np.frombuffer(b64decode(text), dtype=np.float64).copy()


class Restorer:
    """Makes models of JSON on the same records; what they share is computed once.

    Parameters
    ----------
    records : tuple of Record
        The fit records.
    own : sequence of Block
        Blocks to be given back: one may hold more than a file does, such as the output
        of a simulator that ran elsewhere.
    """

    def __init__(self, records: tuple[Record, ...], own: Sequence[Block]) -> None:
        self.records, self.sample = records, ScoredSamples.of(records)
        self._own = own
        self._corrections: dict[tuple[Block, ...], FloatArray | None] = {}

    def state(self, content: Mapped) -> ModelState:
        """Give the model that :func:`state_mapping` wrote."""
        hold = content["hold"]
        state = ModelState(
            self.chain(content["chain"]),
            self.records,
            self.sample,
            tuple(map(_free, content["free"])),
            tuple(self._added(item) for item in content["added"]),
            hold=hold,
        )
        beside = tuple(
            (_beside(item["effect"], item["order"], state.simulation), item["values"])
            for item in content["beside"]
        )
        at = content["corrected_at"]
        if at is None:
            return replace(state, beside=beside)
        chain = self.chain(at)
        if chain not in self._corrections:
            settled = ModelState(chain, self.records, self.sample, hold=hold).settled()
            self._corrections[chain] = settled.correction
        return replace(
            state,
            beside=beside,
            correction=self._corrections[chain],
            corrected_at=chain,
        )

    def _block(self, content: Mapping[str, Any]) -> Block:
        ((name, values),) = content.items()
        block = block_class(name).from_mapping(values)
        kept = _block_mapping(block)
        own = (item for item in self._own if _block_mapping(item) == kept)
        return next(own, block)

    def chain(self, content: Sequence[Mapping[str, Any]]) -> tuple[Block, ...]:
        """Give the blocks of a chain."""
        return tuple(self._block(item) for item in content)

    def _added(self, content: Mapped) -> Added:
        old = content["replaced"]
        return Added(
            **content
            | {
                "blocks": tuple(content["blocks"]),
                "replaced": None if old is None else self._block(old),
                "was_free": tuple(map(_free, content["was_free"])),
            }
        )


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


def _chain_mapping(chain: Sequence[Block]) -> list[Mapped]:
    return [_block_mapping(block) for block in chain]


def _beside(effect: str, order: int, simulation: Simulation) -> Beside:
    """Give the shapes of what lies beside, as its effect offers them."""
    if (effect, order) == (Drift.name, 0):
        return Drift.levels()  # no effect, but fitted beside laws as one is
    offered = (variant.beside for variant in effects()[effect].variants(simulation))
    return next(item for item in offered if item is not None and item.order == order)

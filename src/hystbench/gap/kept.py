"""How far naming has come, as JSON: so that one job goes on where another stopped.

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
from hystbench.gap.name import Progress
from hystbench.gap.rounds import Candidate, Look, Round, Tested
from hystbench.gap.sample import Sample
from hystbench.gap.scene import Scene
from hystbench.gap.state import Added, Free, State
from hystbench.model import Model
from hystbench.record import FloatArray, Record

Mapped = dict[str, Any]


def state_mapping(state: State) -> Mapped:
    """Give a model as far as it has come, as JSON holds it."""
    at = state.corrected_at
    return {
        "hold": state.hold,
        "chain": _chain_mapping(state.chain),
        "free": [
            item._asdict() | {"low": number(item.low), "high": number(item.high)}
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
                    | {"low": limit(item["low"], -1), "high": limit(item["high"])}
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

    def progress(self, content: Mapped) -> Progress:
        """Give the progress that :func:`progress_mapping` wrote."""
        return Progress(
            self.state(content["state"]),
            content["gap"],
            tuple(self._round(item) for item in content["rounds"]),
            content["deferred"],
            content["closed"],
        )

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

    def _round(self, content: Mapped) -> Round:
        return Round(
            self.state(content["before"]),
            content["score"],
            self._ranking(content),
            content["taken"],
            tuple(self._look(item) for item in content["looks"]),
        )

    def _look(self, content: Mapped) -> Look:
        return Look(
            content["instead_of"],
            tuple(content["beside"]),
            self._ranking(content),
            content["taken"],
        )

    def _ranking(self, content: Mapped) -> tuple[Candidate, ...]:
        return tuple(self._candidate(item) for item in content["ranking"])

    def _candidate(self, content: Mapped) -> Candidate:
        state = content["state"]
        own: Mapped = {
            "score": limit(content["score"]),
            "state": None if state is None else self.state(state),
            "variants": tuple(
                Tested(place, form, position, limit(score))
                for place, form, position, score in content["variants"]
            ),
        }
        return Candidate(**content | own)


def progress_mapping(progress: Progress) -> Mapped:
    """Give how far naming has come, as JSON holds it."""
    return {
        "done": progress.done,
        "gap": progress.gap,
        "deferred": progress.deferred,
        "closed": progress.closed,
        "state": state_mapping(progress.state),
        "rounds": [
            {
                "before": state_mapping(one.before),
                "score": one.score,
                "ranking": [_candidate_mapping(item) for item in one.ranking],
                "taken": one.taken,
                "looks": [_look_mapping(item) for item in one.looks],
            }
            for one in progress.rounds
        ],
    }


def number(value: float) -> float | None:
    """Give a number, or None for an infinite one: JSON has none."""
    return float(value) if np.isfinite(value) else None


def limit(value: float | None, sign: int = 1) -> float:
    """Give a number back, and infinity for None."""
    return sign * float("inf") if value is None else value


def _look_mapping(look: Look) -> Mapped:
    return {
        "instead_of": look.instead_of,
        "beside": list(look.beside),
        "ranking": [_candidate_mapping(item) for item in look.ranking],
        "taken": look.taken,
    }


def _candidate_mapping(item: Candidate) -> Mapped:
    return {
        "effect": item.effect,
        "place": item.place,
        "form": item.form,
        "score": number(item.score),
        "gain": item.gain,
        "state": None if item.state is None else state_mapping(item.state),
        "declined": item.declined,
        "held_back": item.held_back,
        "variants": [[*x[:3], number(x.score)] for x in item.variants],
    }


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

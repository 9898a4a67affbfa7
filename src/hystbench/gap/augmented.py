"""The base with the effects that were added, as a model that runs anywhere."""

from __future__ import annotations

from dataclasses import replace

from hystbench.gap.state import State
from hystbench.gap.told import beside_blocks
from hystbench.model import Model


def augmented(base: Model, state: State) -> Model:
    """Give the base with the effects that were added, as a model that runs anywhere.

    What is new in every record has the mean amplitude and the first record's phase.
    Free are the numbers of the effects, and those that the base leaves free.
    """
    chain = [*state.chain, *(block for block in beside_blocks(state))]
    model = Model(f"{base.name}-augmented", base.input, base.output, tuple(chain))
    names = list(model.parameter_names())
    own = [k for item in state.added for k in item.blocks]
    labels = [label for label, _ in model.labelled()]
    left = {f"{labels[item.block]}.{item.parameter}" for item in state.free}
    effects = {labels[k] for k in own}
    free = tuple(n for n in names if n in left or n.rpartition(".")[0] in effects)
    return replace(model, free=tuple(f for f in free if _numeric(model, f)))


def _numeric(model: Model, name: str) -> bool:
    return not isinstance(model.value(name), str)

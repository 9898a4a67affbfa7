"""The base with the effects that were added, as a model that runs anywhere."""

from __future__ import annotations

from dataclasses import replace

from hystbench.blocks import block_class
from hystbench.blocks.base import Block
from hystbench.blocks.parameter import SETTINGS
from hystbench.gap.bases.roughly_known import as_it_was, defaults
from hystbench.gap.effects import effects
from hystbench.gap.fitting.state import Added, ModelState
from hystbench.model import Model


def augmented(base: Model, state: ModelState) -> Model:
    """Give the base with the effects that were added, as a model that runs anywhere.

    What is new in every record has the mean amplitude and the first record's phase.
    Free are the numbers of the effects, but for those that no law of theirs has, and
    those that the base leaves free, within the same share of what they are now. What
    the base tells of where numbers came from stays with those that were not re-tuned.
    """
    chain = (*state.chain, *beside_blocks(state))
    about = f"{base.name}-augmented", base.input, base.output, chain
    model = Model(*about, exact=base.exact)
    names = list(model.parameter_names())
    own = state.places_added
    labels = [label for label, _ in model.labelled()]
    # What nobody freed but the search is known now.
    given = as_it_was(base) is base
    left = {
        f"{labels[item.block]}.{item.parameter}"
        for item in state.free
        if given or item.block in own
    }
    stated = {
        f"{labels[k]}.{name}"
        for item in state.added
        for k in item.blocks
        for name, usual in defaults(chain[k]).items()
        if getattr(chain[k], name) != usual or effects()[item.effect].numbers
    }
    free = tuple(name for name in names if name in left | stated)
    free = tuple(name for name in free if _numeric(model, name))
    now = _names_now(base, state, labels)
    return replace(
        model,
        free=free,
        tolerances={
            now[name]: share
            for name, share in base.tolerances.items()
            if now.get(name) in free
        },
        provenance={
            now[name]: item
            for name, item in base.provenance.items()
            if name in now and model.value(now[name]) == base.value(name)
        },
    )


def blocks_of(item: Added, state: ModelState, model: Model) -> list[str]:
    """Give the labels of the blocks that stand for an added effect.

    Parameters
    ----------
    item : Added
    state : ModelState
    model : Model
        As :func:`augmented` gives it: what lies beside the chain stands behind it.
    """
    return [
        label
        for k, (label, block) in enumerate(model.labelled())
        if k in item.blocks or (k >= len(state.chain) and block.name == item.effect)
    ]


def _names_now(base: Model, state: ModelState, labels: list[str]) -> dict[str, str]:
    """Give the names that the base's parameters have in the longer chain."""
    before = [label for label, _ in base.labelled()]
    places = zip(before, places_of_base(state), strict=True)
    moved = {label: labels[k] for label, k in places if k is not None}
    split = (name.rpartition(".") for name in base.parameter_names())
    return {
        f"{label}.{parameter}": f"{moved[label]}.{parameter}"
        for label, _, parameter in split
        if label in moved
    }


def _numeric(model: Model, name: str) -> bool:
    setting = name.rpartition(".")[2] in SETTINGS
    return not setting and not isinstance(model.value(name), str)


def places_of_base(state: ModelState) -> list[int | None]:
    """Find where the base's blocks stand; None where an effect stands for one."""
    beside = {item.effect for item, _ in state.beside}
    # A later effect replaced the block of an effect that has none, and stands in place
    # of no block of the base.
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


def beside_blocks(state: ModelState) -> list[Block]:
    """Give the blocks of what lies beside the chain."""
    if not state.beside:
        return []
    blocks = []
    each = state.by_signal(state.beside_amplitudes)
    for (beside, values), rows in zip(state.beside, each, strict=True):
        described = effects()[beside.effect].describe(values, rows)
        blocks.append(block_class(beside.effect).from_mapping(described))
    return blocks

"""Effects put into a model and taken out again."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator, Mapping
from dataclasses import replace

import numpy as np

from hystbench.blocks.base import Block
from hystbench.blocks.force import Force
from hystbench.blocks.held import held_until_smooth
from hystbench.blocks.structure import SHAPES, Structure
from hystbench.blocks.wrapping import WrappingBlock
from hystbench.gap.effects import effects
from hystbench.gap.effects.variant import Values, Variant
from hystbench.gap.fitting.state import Added, Free, ModelState

AT_END = 0.02
"""Share of a range that is an end of it; of its logarithm, if it has one sign."""


def numbers_of(block: Block, position: int, variant: Variant) -> Iterator[Free]:
    """Give the numbers that a variant leaves free, inside the range searched."""
    for name in variant.free:
        if name not in block.parameters():
            continue  # another block of the effect has it
        value = getattr(block, name)
        if isinstance(value, tuple):
            for element in range(len(value)):
                yield Free(position, name, element)
        elif name in variant.grids or name in variant.limits:
            refused = variant.refused.get(name, "")
            yield Free(position, name, None, None, *variant.ends(name), refused)
        else:
            yield Free(position, name)


def with_effect(state: ModelState, variant: Variant, values: Values) -> ModelState:
    """Add an effect to the chain, or beside it."""
    note = dict(values)
    own = (variant.effect, variant.place, variant.form)
    if variant.beside is not None:
        added = Added(*own, (), note, variant.freedom)
        return replace(
            state,
            added=(*state.added, added),
            beside=(*state.beside, (variant.beside, note)),
        )
    chain = (*state.chain[: variant.start], *variant.build(values))
    places = tuple(variant.start + k for k in variant.positions)
    old = state.chain[variant.start] if variant.replaces else None
    # The chain's own blocks stay in their order around those of the effect.
    stays = [k for k in range(len(chain)) if k not in places]
    came = [k for k in range(len(state.chain)) if old is None or k != variant.start]
    smooths = any(
        chain[new] != state.chain[was] for was, new in zip(came, stays, strict=True)
    )
    state = rearranged(state, chain, dict(zip(came, stays, strict=True)))
    numbers = (free for k in places for free in numbers_of(chain[k], k, variant))
    return replace(
        state,
        free=(*state.free, *numbers),
        added=(*state.added, Added(*own, places, note, variant.freedom, old, smooths)),
    )


def without_effect(state: ModelState, number: int) -> ModelState:
    """Take an added effect out again."""
    gone = state.added[number]
    rest = tuple(item for k, item in enumerate(state.added) if k != number)
    if effects()[gone.effect].numbers:
        return _with_old_numbers(state, gone, rest)
    if not gone.blocks:  # beside the chain, or its block was replaced by another's
        beside = tuple(item for item in state.beside if item[0].effect != gone.effect)
        return replace(state, added=rest, beside=beside)
    chain: list[Block] = []
    moved = {}
    for k, block in enumerate(state.chain):
        if k not in gone.blocks:
            moved[k] = len(chain)
            chain.append(block)
        elif gone.replaced is not None and k == gone.blocks[0]:
            chain.append(gone.replaced)
    smooths = gone.smooths
    taken = held_until_smooth(chain, "zero-order") if smooths else tuple(chain)
    left = rearranged(replace(state, added=rest), taken, moved)
    return _without_joint(left, gone.blocks[0] - 1) if gone.blocks[0] else left


def without(state: ModelState, names: Collection[str]) -> ModelState:
    """Take the effects of some names out, where they can be."""
    for number in reversed(range(len(state.added))):
        if state.added[number].effect in names and removable(state, number):
            state = without_effect(state, number)
    return state


def _without_joint(state: ModelState, place: int) -> ModelState:
    """Let the shapes of a joint go where no force is left behind its host."""
    host, behind = state.chain[place], state.chain[place + 1 :]
    shapes = [x for x in state.free if x.block == place and x.parameter in SHAPES]
    acts = any(isinstance(block, Force) for block in behind[:1])
    if acts or not (isinstance(host, Structure) and shapes):
        return state
    free = tuple(x for x in state.free if x not in shapes)
    return replace(state, free=free).with_values({place: {"joint": ()}})


def _with_old_numbers(
    state: ModelState, gone: Added, rest: tuple[Added, ...]
) -> ModelState:
    """Give blocks the numbers back that an effect changed, free as they were before."""
    changed = gone.old_numbers
    old: dict[int, dict[str, float]] = {}
    for (place, name), value in changed.items():
        old.setdefault(place, {})[name] = value
    stays = (item for item in state.free if (item.block, item.parameter) not in changed)
    free = (*stays, *gone.was_free)
    return replace(state, free=free, added=rest).with_values(old)


def rearranged(
    state: ModelState, chain: tuple[Block, ...], moved: Mapping[int, int]
) -> ModelState:
    """Give a model with its blocks at other places, in a chain of others too.

    Free numbers and effects follow their blocks; what has no place any more goes.

    Parameters
    ----------
    state : ModelState
    chain : tuple of Block
    moved : mapping of int to int
        Places in it of the blocks that stay, by their places now.
    """
    return replace(
        state,
        chain=chain,
        free=_moved_numbers(state.free, moved),
        added=tuple(_moved_effect(item, moved) for item in state.added),
    )


def _moved_effect(item: Added, moved: Mapping[int, int]) -> Added:
    """Give an effect whose blocks stand elsewhere; values name some by their place."""
    values = {key: value for key, value in item.values.items() if "." not in key}
    for (place, name), value in item.old_numbers.items():
        if place in moved:
            values[f"{moved[place]}.{name}"] = value
    blocks = tuple(moved[k] for k in item.blocks if k in moved)
    was_free = _moved_numbers(item.was_free, moved)
    return item._replace(blocks=blocks, values=values, was_free=was_free)


def _moved_numbers(free: Iterable[Free], moved: Mapping[int, int]) -> tuple[Free, ...]:
    return tuple(x._replace(block=moved[x.block]) for x in free if x.block in moved)


def last_to(state: ModelState, number: int) -> ModelState:
    """Give the effect added last the number of the one whose place it takes."""
    *others, last = state.added
    return replace(state, added=(*others[:number], last, *others[number:]))


def removable(state: ModelState, number: int) -> bool:
    """Tell whether an added effect can be taken out with the others left in.

    Not a hysteresis that another effect wraps, nor a block that another replaced.
    """
    gone = state.added[number]
    if not gone.blocks:
        return any(item.effect == gone.effect for item, _ in state.beside)
    chain = without_effect(state, number).chain
    before = [None, *chain[:-1]]
    return all(
        first is not None and (first.hysteretic or isinstance(first, WrappingBlock))
        for first, block in zip(before, chain, strict=True)
        if isinstance(block, WrappingBlock)
    )


def at_end(state: ModelState) -> str:
    """Name a number of the effect added last that lies at a refused end."""
    for free in state.free:
        if free.block not in state.added[-1].blocks or not free.refused:
            continue
        value = state.value(free)
        if free.low < 0.0 < free.high:
            place = (value - free.low) / (free.high - free.low)
        else:
            place = np.log(value / free.low) / np.log(free.high / free.low)
        upper = free.refused != "lower" and place > 1 - AT_END
        if upper or (free.refused != "upper" and place < AT_END):
            return f"{free.parameter} = {value:.3g}"
    return ""

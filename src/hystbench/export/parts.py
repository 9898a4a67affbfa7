"""The parts of a model around a simulator of somebody's own, which run beside it."""

from typing import Literal

from hystbench.errors import InputError
from hystbench.export.described import Described
from hystbench.model import Model
from hystbench.record import Channel

Part = Literal["before", "behind"]


def part_of(model: Model, part: Part) -> Model:
    """Give what stands before a model's simulator, or behind it, as a model.

    What is before it takes the model's input and gives the simulator's, in its unit;
    what is behind takes the simulator's output, in the unit of the model's.

    Raises
    ------
    InputError
        If the model has no simulator or several, or nothing stands there.
    """
    places = [place for place, block in enumerate(model.chain) if not block.seen]
    if len(places) != 1:
        raise InputError(
            f"--part: {len(places)} simulators of somebody's own in the chain; "
            "expected one, before or behind which the part stands"
        )
    (place,) = places
    own = model.chain[place].name
    before = part == "before"
    chain = model.chain[:place] if before else model.chain[place + 1 :]
    if not chain:
        other = f"--part {'behind' if before else 'before'}"
        expected = other if len(model.chain) > 1 else "another model: that is all of it"
        raise InputError(
            f"--part {part}: no block stands {part} {own}; expected {expected}"
        )
    if before:
        sides = model.input, Channel(f"input of {own}", model.input.unit)
    else:
        sides = (
            Channel(f"{model.output.name} of {own}", model.output.unit),
            model.output,
        )
    return Model(f"{model.name} {part} {own}", *sides, chain)


def check_alone(part: Described) -> None:
    """Refuse a part behind a simulator that looks at the input of the whole model.

    Raises
    ------
    InputError
        With the block.
    """
    for piece in part.watching:
        raise InputError(
            f"--part behind: {piece.label}: looks at the model's input, which does not "
            "enter there; expected blocks that take the simulator's output alone"
        )

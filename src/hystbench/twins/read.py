"""Twins: model files, each with the family of its hysteresis."""

from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path

from hystbench.errors import InputError
from hystbench.model import Model, load_model

#: Blocks that make hysteresis; the first one in a twin's chain names its family.
HYSTERESIS = ("gpi", "preisach", "jiles-atherton", "rdgpi")


@dataclass(frozen=True)
class Twin:
    """A twin.

    Parameters
    ----------
    name : str
        Stem of its file.
    place : str
        The file.
    model : Model
        The model.
    family : str
        Name of the block that makes its hysteresis.
    """

    name: str
    place: str
    model: Model
    family: str


def read_twins(paths: Iterable[Path]) -> tuple[Twin, ...]:
    """Read twins; the first is the one that the claims are judged on.

    Raises
    ------
    InputError
        If a file is not what it should be, no block makes hysteresis or two twins
        have one name.
    """
    twins: dict[str, Twin] = {}
    for path in paths:
        if path.stem in twins:
            raise InputError(f"{path}: a second twin of the name {path.stem!r}")
        model = load_model(path)
        family = family_of(model, str(path))
        twins[path.stem] = Twin(path.stem, str(path), model, family)
    return tuple(twins.values())


def family_of(model: Model, place: str) -> str:
    """Name the family of a model: its first block that makes hysteresis.

    Raises
    ------
    InputError
        If there is none.
    """
    for block in model.chain:
        if block.name in HYSTERESIS:
            return block.name
    raise InputError(
        f"{place}: no block makes hysteresis; expected one of {', '.join(HYSTERESIS)}"
    )

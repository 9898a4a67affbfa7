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
    """A twin."""

    name: str
    place: str
    """Stem of its file, and the file."""
    model: Model
    family: str
    """Name of the block that makes its hysteresis."""


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
        makers = [block.name for block in model.chain if block.name in HYSTERESIS]
        if not makers:
            raise InputError(
                f"{path}: no block makes hysteresis; expected one of "
                f"{', '.join(HYSTERESIS)}"
            )
        twins[path.stem] = Twin(path.stem, str(path), model, makers[0])
    return tuple(twins.values())

"""Twins: model files, and the readings that were calibrated with them."""

from __future__ import annotations

import json
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from hystbench.errors import InputError, nearest
from hystbench.files import read_json
from hystbench.model import Model, load_model

#: Blocks that make hysteresis; the first one in a twin's chain names its family.
HYSTERESIS = ("gpi", "preisach", "jiles-atherton", "rdgpi")

_KEYS = ("input_zero_error", "convergence_factor")


@dataclass(frozen=True)
class Twin:
    """A twin and how it is read.

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
    readings : mapping
        What was calibrated with the model but is no part of it:
        ``input_zero_error`` and ``convergence_factor`` by filter. What is not there
        is as in config.yaml.
    """

    name: str
    place: str
    model: Model
    family: str
    readings: Mapping[str, Any]


def read_twin(path: Path) -> Twin:
    """Read a twin: a model file, and a JSON file of readings beside it if there is.

    Raises
    ------
    InputError
        If a file is missing or not what it should be, or no block makes hysteresis.
    """
    model = load_model(path)
    return Twin(path.stem, str(path), model, family_of(model, str(path)), _read(path))


def read_twins(paths: Iterable[Path]) -> tuple[Twin, ...]:
    """Read twins; the first is the one that the claims are judged on.

    Raises
    ------
    InputError
        As :func:`read_twin`, or if two twins have one name.
    """
    twins: dict[str, Twin] = {}
    for path in paths:
        twin = read_twin(path)
        if twin.name in twins:
            raise InputError(f"{path}: a second twin of the name {twin.name!r}")
        twins[twin.name] = twin
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


def _read(model_file: Path) -> dict[str, Any]:
    path = model_file.with_suffix(".json")
    if not path.is_file():
        return {}
    try:
        content = read_json(path)
    except json.JSONDecodeError as error:
        raise InputError(f"{path}: not JSON ({error})") from error
    if not isinstance(content, dict):
        raise InputError(f"{path}: expected a JSON object")
    for key in content:
        if key not in _KEYS:
            raise InputError(f"{path}: unknown key {key!r}; {nearest(key, _KEYS)}")
    return content

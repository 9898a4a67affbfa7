"""What the page is made of: gap.json, model.yaml, hold-out tables and curves."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from hystbench.errors import InputError
from hystbench.formats import read_table
from hystbench.gap.schema import SCHEMA
from hystbench.model import Model, load_model
from hystbench.record import FloatArray
from hystbench.schema import check_against_schema
from hystbench.text_files import read_text

COLUMNS = ("time_s", "measured", "before", "after")


@dataclass(frozen=True, repr=False)
class HoldOut:
    """A hold-out record before and after, shape (n,) each, in output units.

    ``after`` is NaN throughout where the model runs away on the record; ``floor`` is
    the rms of the noise.
    """

    name: str
    floor: float
    unit: str
    time_s: FloatArray
    measured: FloatArray
    before: FloatArray
    after: FloatArray


@dataclass(frozen=True, repr=False)
class Content:
    """All that a folder holds."""

    gap: dict[str, Any]
    """Content of gap.json, checked."""
    hold_out: tuple[HoldOut, ...]
    curves: Mapping[str, Any]
    """Content of curves.json."""
    model: Model
    """The model of model.yaml."""


def read_content(folder: Path) -> Content:
    """Read and check the files of a folder that the gap workflow wrote.

    Raises
    ------
    InputError
        If gap.json, the curves or the model are missing or cannot be read, or gap.json
        is not as its schema says.
    """
    place = folder / "gap.json"
    gap = _json(place)
    check_against_schema(gap, SCHEMA, str(place))
    order = [item["name"] for item in gap.get("records", [])]
    tables = sorted(
        (folder / "holdout").glob("*.csv"),
        # in the order of gap.json; those that it does not name come last
        key=lambda path: (
            order.index(path.stem) if path.stem in order else len(order),
            path.stem,
        ),
    )
    return Content(
        gap,
        tuple(_hold_out(table, gap) for table in tables),
        _json(folder / "curves.json"),
        load_model(folder / "model.yaml"),
    )


def _json(path: Path) -> Any:
    text = read_text(path, "a JSON file")
    try:
        return json.loads(text)
    except ValueError as error:
        raise InputError(f"{path}: not JSON ({error})") from error


def _hold_out(path: Path, gap: Mapping[str, Any]) -> HoldOut:
    table = read_table(path, COLUMNS)
    columns = [table.column(name).values for name in COLUMNS]
    *known, after = map(np.isfinite, columns)
    if len(after) < 2 or not (np.all(known) and (after.all() or not after.any())):
        raise InputError(f"{path}: expected at least 2 rows of finite numbers")
    return HoldOut(path.stem, gap["gap"]["noise_floor"], gap["unit"], *columns)

"""HDF5 files, by h5py: each numeric dataset is a column, or a matrix of them."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np

from hystbench.formats.table import (
    FREQUENCIES,
    INTERVALS,
    Filling,
    Table,
    fields_of,
    told,
)
from hystbench.libraries import library

OCTAVE = "OCTAVE_NEW_FORMAT"
"""Marks a group in which Octave keeps one variable: its type and its value."""
UNITS = ("units", "unit", "Units", "Unit", "unit_string")


def read(path: Path) -> Table:
    """Read all datasets that hold numbers, named by their path in the file."""
    h5py = library("h5py", path, "formats")
    found = Filling(path)

    def take(name: str, item: Any) -> None:
        found.numbers.update(_numbers(name, item.attrs))
        if OCTAVE in item.parent.attrs:
            if not name.endswith("/value"):
                return
            name = name.removesuffix("/value")
        if not isinstance(item, h5py.Dataset):
            return
        unit = unit_of(item.attrs)
        own = _numbers("", item.attrs)
        frequency = Table(path, (), own).sampling_frequency()
        for each, part in fields_of(name, item).items():
            kind = part.dtype.kind
            if kind not in "fiubMm" or part.shape is None or 0 in part.shape:
                found.leave_out(each, "no numbers")
            else:
                found.add(each, part[()], unit, frequency)

    with told(path, "HDF5 file"), h5py.File(path, "r") as content:
        found.numbers.update(_numbers("", content.attrs))
        content.visititems(take)
    return found.table()


def unit_of(attributes: Mapping[str, Any]) -> str | None:
    """Give the unit that attributes tell."""
    for key in UNITS:
        value = attributes.get(key)
        if isinstance(value, np.ndarray) and value.size == 1:
            value = value.reshape(-1)[0]
        if isinstance(value, bytes):
            value = value.decode("utf-8", "replace")
        if isinstance(value, str) and value.strip():
            return value.strip()
    return None


def _numbers(name: str, attributes: Mapping[str, Any]) -> dict[str, float]:
    """Give a sampling frequency or interval that attributes tell."""
    found = {}
    for key, value in attributes.items():
        single = np.asarray(value)
        known = key.lower() in FREQUENCIES | INTERVALS
        if known and single.size == 1 and single.dtype.kind in "fiu":
            found[f"{name}/{key}".lstrip("/")] = float(single.reshape(-1)[0])
    return found

"""NumPy archives (.npz), without pickled objects."""

from __future__ import annotations

import zipfile
from pathlib import Path

import numpy as np

from hystbench.errors import InputError
from hystbench.formats.damaged import told
from hystbench.formats.table import Column, Table, columns_of


def read(path: Path) -> Table:
    """Read the arrays of an archive; what would have to be unpickled is refused."""
    columns: list[Column] = []
    numbers: dict[str, float] = {}
    notes: list[str] = []
    if not zipfile.is_zipfile(path):
        raise InputError(f"{path}: no archive of NumPy; expected a file of numpy.savez")
    with told(path, "archive of NumPy"), np.load(path, allow_pickle=False) as archive:
        for name in archive.files:
            try:
                array = archive[name]
            except ValueError:  # an object: only its program could unpickle it
                notes.append(f"{name}: a pickled object; never unpickled, left out")
                continue
            parts = (
                {f"{name}/{key}": array[key] for key in array.dtype.names}
                if array.dtype.names
                else {name: array}
            )
            for each, values in parts.items():
                found = columns_of(each, values)
                columns += found[0]
                numbers |= found[1]
                notes += found[2]
    return Table(path, tuple(columns), numbers, tuple(notes))

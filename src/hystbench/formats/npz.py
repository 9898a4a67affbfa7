"""NumPy archives (.npz), without pickled objects."""

import zipfile
from pathlib import Path

import numpy as np

from hystbench.errors import InputError
from hystbench.formats.table import Filling, Table, fields_of, told


def read(path: Path) -> Table:
    """Read the arrays of an archive; what would have to be unpickled is refused."""
    found = Filling(path)
    if not zipfile.is_zipfile(path):
        raise InputError(f"{path}: no archive of NumPy; expected a file of numpy.savez")
    with told(path, "archive of NumPy"), np.load(path, allow_pickle=False) as archive:
        for name in archive.files:
            try:
                array = archive[name]
            except ValueError:  # an object: only its program could unpickle it
                found.leave_out(name, "a pickled object", ", as never unpickled")
                continue
            for each, values in fields_of(name, array).items():
                found.add(each, values)
    return found.table()

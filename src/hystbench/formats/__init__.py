"""Files of measurements, one format a module: each gives named columns of numbers.

A module has ``read(path) -> Table``. It is imported when a file of its format is read,
and so is the library that it needs. Nothing in a file is executed.
"""

import importlib
from collections.abc import Collection
from pathlib import Path

from hystbench.errors import InputError, nearest
from hystbench.formats.table import Column, Table

__all__ = ["Column", "Table", "format_of", "read_table"]

#: Module of each suffix.
SUFFIXES = {
    **dict.fromkeys((".csv", ".tsv", ".txt", ".dat", ".asc", ".lvm", ".prn"), "text"),
    ".mat": "matlab",
    **dict.fromkeys((".h5", ".hdf5", ".hdf", ".nxs", ".he5"), "hdf5"),
    **dict.fromkeys((".parquet", ".pq"), "parquet"),
    ".tdms": "tdms",
    ".npz": "npz",
    **dict.fromkeys((".wav", ".wave"), "wav"),
}
#: Module of each beginning of a file, where the suffix tells none or another.
BEGINNINGS = {
    b"MATLAB 5.0 MAT-file": "matlab",
    b"MATLAB 7.3 MAT-file": "matlab",
    b"\x89HDF\r\n\x1a\n": "hdf5",
    b"PAR1": "parquet",
    b"TDSm": "tdms",
    b"RIFF": "wav",
    b"RIFX": "wav",
    b"RF64": "wav",
}
EXPECTED = (
    "expected text such as CSV, MATLAB (.mat), Parquet, HDF5 (.h5), TDMS, NumPy (.npz) "
    "or WAV"
)
"""What files may be, for messages."""
_FIRST_BYTES = 128
"""Bytes at the start of a file that tell its format."""


def format_of(path: Path) -> str:
    """Tell the format of a file: by how it begins, else by its suffix.

    Returns
    -------
    str
        Name of the module that reads it.

    Raises
    ------
    InputError
        If it is a workbook or has an unknown suffix.
    """
    suffix = path.suffix.lower()
    try:
        with path.open("rb") as stream:
            start = stream.read(_FIRST_BYTES)
    except OSError:
        start = b""  # whoever reads it says so
    for beginning, module in BEGINNINGS.items():
        if start.startswith(beginning):
            # MATLAB's own HDF5 has 512 bytes of text first, that of others none.
            return "matlab" if suffix == ".mat" else module
    if suffix in (".xlsx", ".xls", ".ods"):
        raise InputError(f"{path}: a workbook; save the sheet as 'CSV UTF-8'")
    if suffix in SUFFIXES:
        return SUFFIXES[suffix]
    is_utf_16 = start.startswith((b"\xff\xfe", b"\xfe\xff"))
    if start and (b"\0" not in start or is_utf_16):
        return "text"
    raise InputError(
        f"{path}: the suffix {path.suffix!r} tells no known format; {EXPECTED} "
        f"({nearest(suffix, SUFFIXES)})"
    )


def read_table(path: Path, wanted: Collection[str] | None = None) -> Table:
    """Read the columns of a file of measurements.

    Parameters
    ----------
    path : Path
    wanted : collection of str, optional
        Names of columns that must be numbers: a text's other cells are not looked at.
        Without them, columns that hold no numbers are left out and noted.

    Returns
    -------
    Table

    Raises
    ------
    InputError
        If there is no such file, it is damaged or of an unknown format, a library is
        missing, or a cell of a wanted column is no number.
    """
    if path.is_dir():
        raise InputError(f"{path}: a folder; {EXPECTED}")
    if not path.is_file():
        kin = sorted(item.name for item in path.parent.glob("*") if item.is_file())
        raise InputError(f"{path}: no such file; {nearest(path.name, kin)}")
    kind = format_of(path)
    module = importlib.import_module(f"{__name__}.{kind}")
    if kind == "text":
        found: Table = module.read(path, wanted)
    else:
        found = module.read(path)
    return found

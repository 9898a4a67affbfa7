"""MATLAB files: up to v7 by scipy, v7.3 (which is HDF5) by h5py."""

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np

from hystbench.formats.table import Filling, Table, told
from hystbench.libraries import library

_HDF5 = b"\x89HDF"
_TEXT_73 = b"MATLAB 7.3"  # also of a file that ends before its HDF5 begins
"""What HDF5 begins with; MATLAB writes 512 bytes of its own before it."""
_OBJECT = "a MATLAB object such as a table or timeseries"
_SAVE = ": save its columns as plain arrays or as fields of a struct"
DEEPEST = 8
"""Levels of structs inside structs that are looked at."""


def read(path: Path) -> Table:
    """Read all numeric variables; fields of structs are named ``struct/field``.

    The elements of an array of structs are groups ``runs(1)``, ``runs(2)`` and so on,
    and so are those of a cell array.
    """
    with path.open("rb") as stream:
        start = stream.read(512 + len(_HDF5))
    found = Filling(path)
    is_hdf5 = _HDF5 in (start[: len(_HDF5)], start[512:]) or start.startswith(_TEXT_73)
    variables = _version_73(path) if is_hdf5 else _version_5(path)
    for name, values in variables:
        if values is None:
            found.leave_out(name, _OBJECT, _SAVE)
        else:
            found.add(name, values)
    return found.table()


def _version_5(path: Path) -> Iterator[tuple[str, Any]]:
    with told(path, "MATLAB file"):
        from scipy.io import loadmat  # late: scipy
        from scipy.io.matlab import MatlabOpaque

        content = loadmat(path, squeeze_me=False, struct_as_record=True)
        for name, value in content.items():
            if name.startswith("__"):
                continue
            if isinstance(value, MatlabOpaque):
                yield name, None
            else:
                yield from _inside(name, value, 0)


def _inside(name: str, value: Any, depth: int) -> Iterator[tuple[str, Any]]:
    """Give the arrays in a variable of scipy's: structs and cells are arrays too."""
    array = np.asarray(value)
    if depth > DEEPEST or not array.size:
        return
    if array.dtype.names:
        for element, where in _elements(array, name):
            for key in array.dtype.names:
                yield from _inside(f"{where}/{key}", element[key], depth + 1)
    elif array.dtype.kind == "O":
        for element, where in _elements(array, name):
            yield from _inside(where, element, depth + 1)
    elif array.dtype.kind != "U":
        yield name, array


def _elements(array: np.ndarray, name: str) -> Iterator[tuple[Any, str]]:
    flat = array.ravel(order="F")
    for k, element in enumerate(flat, start=1):
        yield element, name if len(flat) == 1 else f"{name}({k})"


def _version_73(path: Path) -> Iterator[tuple[str, Any]]:
    h5py = library("h5py", path, "formats")
    with told(path, "MATLAB file"), h5py.File(path, "r") as content:
        seen: set[int] = set()
        for name in content:
            if not name.startswith("#"):  # where MATLAB keeps what is referred to
                yield from _inside_73(h5py, content, name, content[name], 0, seen)


def _inside_73(
    h5py: Any, content: Any, name: str, item: Any, depth: int, seen: set[int]
) -> Iterator[tuple[str, Any]]:
    """Give the arrays in a variable; each struct and cell array is entered once."""
    if depth > DEEPEST:
        return
    if isinstance(item, h5py.Group) or _refers(h5py, item):
        address = h5py.h5o.get_info(item.id).addr
        if address in seen:
            return  # it refers to itself, by way of others perhaps
        seen.add(address)
    if "MATLAB_object_decode" in item.attrs:
        yield name, None
        return
    if isinstance(item, h5py.Group):
        fields = {key: item[key] for key in item}
        arrays = {
            key: part[()]
            for key, part in fields.items()
            if _refers(h5py, part) and "MATLAB_class" not in part.attrs
        }
        # Each field of an array of structs is an array of references.
        counts = {array.size for array in arrays.values()}
        for key, part in fields.items():
            of_struct = key in arrays and len(counts) == 1
            targets = (
                [(content[one], where) for one, where in _elements(arrays[key].T, name)]
                if of_struct
                else [(part, name)]
            )
            for target, where in targets:
                yield from _inside_73(
                    h5py, content, f"{where}/{key}", target, depth + 1, seen
                )
        return
    if item.attrs.get("MATLAB_empty") or item.shape is None or 0 in item.shape:
        return
    if _refers(h5py, item):  # a cell array
        for reference, where in _elements(item[()].T, name):
            target = content[reference]
            yield from _inside_73(h5py, content, where, target, depth + 1, seen)
        return
    kind = item.attrs.get("MATLAB_class", b"")
    if kind in (b"char", "char"):
        return
    if item.dtype.names == ("real", "imag"):
        parts = item[()]
        yield name, (parts["real"] + 1j * parts["imag"]).T
        return
    yield name, item[()].T  # MATLAB counts down columns, HDF5 along rows


def _refers(h5py: Any, item: Any) -> bool:
    return isinstance(item, h5py.Dataset) and item.dtype == h5py.ref_dtype

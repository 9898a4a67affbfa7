"""Libraries: those that are not installed with hystbench itself, and its own in C."""

import ctypes
import importlib
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hystbench.errors import InputError


def library(name: str, place: object, extra: str) -> Any:
    """Import a library that a file or a simulator needs.

    Parameters
    ----------
    name : str
        As Python imports it; pip installs its first part.
    place : object
        What needs it, for the message.
    extra : str
        The group of pyproject.toml that it belongs to.

    Raises
    ------
    InputError
        If it is not installed: what to install.
    """
    try:
        return importlib.import_module(name)
    except ImportError as error:
        package = name.partition(".")[0]
        raise InputError(
            f"{place}: needs the package {package} ({error}); install it with "
            f"\"pip install 'hystbench[{extra}]'\" or 'pip install {package}'"
        ) from error


SIZE, REAL, ARRAY = ctypes.c_ssize_t, ctypes.c_double, ctypes.c_void_p
_KINDS = {"i": SIZE, "f": REAL, "a": ARRAY}
_FLOAT64 = np.dtype(np.float64)
_NOTHING = ctypes.c_char * 0  # a place in memory, of no size
FloatArray = NDArray[np.float64]


class Fixed:
    """An array that many calls take: where it lies is asked once."""

    def __init__(self, values: FloatArray) -> None:
        self.values = values  # kept, so that the place stays its own
        self.place = address(values)


class Loops:
    """A shared library of hystbench's own: its functions are called by their names.

    Parameters
    ----------
    path : Path
    signatures : mapping of str to (type, str)
        Of each function what it returns and a letter for each argument: i for a size,
        f for a number, a for an array.
    what : str
        What the library holds, for the message.

    Raises
    ------
    InputError
        If it was not built, or was built for another machine.
    """

    def __init__(
        self, path: Path, signatures: Mapping[str, tuple[Any, str]], what: str
    ) -> None:
        try:
            found = ctypes.CDLL(str(path))
        except OSError as error:
            raise InputError(
                f"{path}: {what} do not load ({error}); build them with "
                "`pip install --no-deps --no-build-isolation -e .`"
            ) from error
        self.functions = {name: getattr(found, name) for name in signatures}
        for name, (result, arguments) in signatures.items():
            self.functions[name].restype = result
            self.functions[name].argtypes = [_KINDS[kind] for kind in arguments]

    def __call__(self, name: str, *arguments: FloatArray | Fixed | float | int) -> int:
        """Call a function; an array must be of float64 in C order.

        Returns
        -------
        int
            What it returns: the samples taken, 0 where it returns nothing.

        Raises
        ------
        TypeError
            If an array is of another kind.
        MemoryError
            If it found no room for its state.
        """
        plain = [
            address(value)
            if isinstance(value, np.ndarray)
            else value.place
            if isinstance(value, Fixed)
            else value
            for value in arguments
        ]
        result = int(self.functions[name](*plain) or 0)
        if result < 0:
            raise MemoryError(name)
        return result


def address(values: FloatArray) -> int:
    """Where an array lies. Most calls are short: this is a good part of their time."""
    flags = values.flags
    if values.dtype != _FLOAT64 or not flags.c_contiguous:
        raise TypeError("arrays of a compiled loop must be float64 in C order")
    if flags.writeable:
        buffer: Any = values
        return ctypes.addressof(_NOTHING.from_buffer(buffer))
    return values.ctypes.data  # six times slower, but takes read-only arrays

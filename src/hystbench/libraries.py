"""Libraries that are not installed with hystbench itself."""

from __future__ import annotations

import importlib
from typing import Any

from hystbench.errors import InputError


def library(name: str, package: str, place: object, extra: str) -> Any:
    """Import a library that a file or a simulator needs.

    Parameters
    ----------
    name : str
        As Python imports it.
    package : str
        As pip installs it.
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
        raise InputError(
            f"{place}: needs the package {package} ({error}); install it with "
            f"\"pip install 'hystbench[{extra}]'\" or 'pip install {package}'"
        ) from error

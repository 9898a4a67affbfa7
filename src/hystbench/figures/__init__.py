"""Figures, drawn from the files of results.

A figure is a function of a module here. It takes the files it needs by keyword
(``records``, ``runs``, ``table``, ``identified``) and returns a
``matplotlib.figure.Figure``. To add one, write the function and name it in
``figures.yaml``; a module is imported when its figure is drawn.
"""

import importlib
from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import Any

from hystbench.errors import refuse_unknown
from hystbench.yaml_files import load_yaml

#: Module, function and first arguments of each.
FIGURES: dict[str, list[Any]] = load_yaml(Path(__file__).with_name("figures.yaml"))


def module_of(name: str) -> str:
    """Give the module that draws a figure, by its full name.

    Raises
    ------
    InputError
        If there is no such figure.
    """
    refuse_unknown(name, FIGURES, f"no figure {name!r}")
    return f"{__name__}.{FIGURES[name][0]}"


def drawer(name: str) -> Callable[..., Any]:
    """Give the function that draws a figure; raises as :func:`module_of`."""
    module = importlib.import_module(module_of(name))
    _, function, *first = FIGURES[name]
    return partial(getattr(module, function), *first)

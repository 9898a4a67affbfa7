"""Figures: one small file each, drawn from the files of results.

A figure is a module here with a function ``draw`` that takes the files it needs by
keyword (``records``, ``runs``, ``table``, ``identified``) and returns a
``matplotlib.figure.Figure``. To add one, write the module and name it in
:data:`NAMES`; a module is imported when its figure is drawn.
"""

from __future__ import annotations

import importlib
from collections.abc import Callable
from typing import Any

from hystbench.errors import InputError, nearest

#: Those with a number redraw the figure of the paper with that number.
NAMES = (
    "figure-03-play",
    "figure-04-generalized-play",
    "figure-07-order",
    "figure-08-loops",
    "figure-09-chirp",
    "figure-10-sum",
    "figure-11-sum",
    "figure-12-random-sum",
    "headline",
    "identification",
    "learning-curves",
    "errors-heat-map",
    "step-edges",
    "loops",
    "errors-by-record",
    "gap-loop",
    "blind-confusion",
    "blind-effects",
    "blind-power",
    "blind-reliability",
    "blind-where",
    "tracking-errors",
)


def drawer(name: str) -> Callable[..., Any]:
    """Give the function that draws a figure.

    Raises
    ------
    InputError
        If there is no such figure.
    """
    if name not in NAMES:
        raise InputError(f"no figure {name!r}; {nearest(name, NAMES)}")
    module = importlib.import_module(f"{__name__}.{name.replace('-', '_')}")
    draw: Callable[..., Any] = module.draw
    return draw

"""Figures, drawn from the files of results.

A figure is a function of a module here. It takes the files it needs by keyword
(``records``, ``runs``, ``table``, ``identified``) and returns a
``matplotlib.figure.Figure``. To add one, write the function and name it in
:data:`FIGURES`; a module is imported when its figure is drawn.
"""

import importlib
from collections.abc import Callable
from functools import partial
from typing import Any

from hystbench.errors import refuse_unknown

#: Module, function and first arguments of each. Those with a number redraw the figure
#: of the paper with that number.
FIGURES: dict[str, tuple[Any, ...]] = {
    "figure-03-play": ("characteristics", "draw_play"),
    "figure-04-generalized-play": ("characteristics", "draw_generalized_play"),
    "figure-07-order": ("filters", "draw_order"),
    "figure-08-loops": ("loops", "draw_with_errors", 5),
    "figure-09-chirp": ("over_time", "draw_chirp"),
    # Two periods of each sum, in seconds.
    "figure-10-sum": ("over_time", "draw_curves", 0.2),
    "figure-11-sum": ("over_time", "draw_curves", 0.4),
    # Enough to see single swings of the fastest sine, 100 Hz.
    "figure-12-random-sum": ("over_time", "draw_errors", 0.5),
    "headline": ("loops", "draw_with_errors", 3),
    "identification": ("identification", "draw"),
    "learning-curves": ("filters", "draw_learning"),
    "errors-heat-map": ("errors", "draw_heat_map"),
    "step-edges": ("filters", "draw_edges"),
    "loops": ("loops", "draw"),
    "errors-by-record": ("errors", "draw_by_record"),
    "gap-loop": ("gap_loop", "draw"),
    "blind-confusion": ("blind", "draw_confusion"),
    "blind-effects": (
        "blind",
        "draw_shares",
        {"top1": "named first", "exact": "named, and nothing beside it"},
    ),
    "blind-power": ("blind", "draw_power"),
    "blind-reliability": ("blind", "draw_reliability"),
    "blind-where": (
        "blind",
        "draw_shares",
        {"where_hit": "first view is the right one"},
    ),
}


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

"""Adaptive filters: each file beside this one adds its own to the registry.

An installed package adds one by an entry point of the group ``hystbench.filters``.
"""

from functools import cache

from hystbench.errors import refuse_unknown
from hystbench.filters.base import AdaptiveFilter as AdaptiveFilter
from hystbench.filters.bound import MOST_CORRECTION as MOST_CORRECTION
from hystbench.filters.state import Result as Result
from hystbench.filters.together import run_many as run_many
from hystbench.published import in_order
from hystbench.registered import classes_in, with_installed

FILTERS: dict[str, type[AdaptiveFilter]] = classes_in(
    __name__, __path__, AdaptiveFilter
)
"""Every filter of hystbench itself, by its name."""


@cache
def registry() -> dict[str, type[AdaptiveFilter]]:
    """Give every filter by its name: the paper's as it lists them, then the others.

    Raises
    ------
    InputError
        If an installed package offers what is no filter, or a name that is taken.
    """
    found = with_installed(FILTERS, "hystbench.filters", AdaptiveFilter)
    return {name: found[name] for name in in_order(found)}


def filter_class(name: str) -> type[AdaptiveFilter]:
    """Give a filter by its name.

    Raises
    ------
    InputError
        If there is none of this name.
    """
    # What is installed is asked last: it takes longer than to make a filter.
    known = FILTERS if name in FILTERS else registry()
    refuse_unknown(name, known, f"no filter {name!r}")
    return known[name]

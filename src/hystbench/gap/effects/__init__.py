"""The effects that can be named, one a module, in the order of the signal's way.

A new effect is a new module in this package; it is found by its class's ``name``.
"""

from __future__ import annotations

import importlib
import inspect
import pkgutil
from collections.abc import Iterable
from functools import cache

from hystbench.gap.effects.base import Effect


@cache
def effects() -> dict[str, Effect]:
    """Give one of each effect, by name."""
    found: dict[str, Effect] = {}
    for module_info in pkgutil.iter_modules(__path__):
        module = importlib.import_module(f"{__name__}.{module_info.name}")
        for item in vars(module).values():
            if (
                inspect.isclass(item)
                and issubclass(item, Effect)
                and hasattr(item, "name")  # else it is a kind of effects
                and item.__module__ == module.__name__
            ):
                found[item.name] = item()
    return dict(sorted(found.items()))


def among(names: Iterable[str] | None) -> dict[str, Effect]:
    """Give one of each of some effects, by name; of all where none are told."""
    kept = set(effects() if names is None else names)
    return {name: item for name, item in effects().items() if name in kept}
